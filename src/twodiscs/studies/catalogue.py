"""Every study: an analysis with a folder, a table and a figure of its own.

The rule that makes its table, its target, its key in the configuration, its place in forecast,
report and README follow from the entry here. Standard library only: the Snakefile imports this.
"""

from collections.abc import Callable
from dataclasses import dataclass, field

from twodiscs.comparison.tables import Table
from twodiscs.figures.catalogue import DYNAMICS, Entry
from twodiscs.studies.accuracy_cost.table import AccuracyCost
from twodiscs.studies.distributions.table import Distributions
from twodiscs.studies.effects.table import Effects, EffectsCost
from twodiscs.studies.errata.table import Errata
from twodiscs.studies.stability.table import LongRuns, Stability
from twodiscs.studies.tails.table import Tails
from twodiscs.studies.thresholds.table import Thresholds

# A report lists categories by the alphabet.
COST, NUMERICS = "4 What accuracy costs", "5 Numerical stability"


@dataclass(frozen=True)
class Study:
    """An analysis: its ``name``, what its target ``builds``, its ``tables`` and ``figures``.

    The first table is made by the function ``rows`` of ``module``, which takes the
    ``parameters`` of a ``Configuration`` and, as ``tables``, the rows of what it ``reads``: {name:
    (name of a scene or None, table)}. Other tables have rules of their own.

    ``figures`` are {name: ``Entry``}. ``kernels`` names the compiled code that is to be there
    first. ``about_plain`` studies are about scenes without effects. ``seconds`` is what the table
    takes, a round figure or what a ``Configuration`` says. ``timed`` tables hold seconds, so that
    they differ from run to run. One that is not ``shared`` is built only when asked for.
    """

    name: str
    builds: str
    tables: tuple[type[Table], ...]
    seconds: Callable | float
    figures: dict = field(default_factory=dict)
    module: str = ""
    function: str = "rows"
    parameters: Callable = lambda configuration: {}
    reads: Callable = lambda configuration: {}
    kernels: tuple = ()
    about_plain: bool = True
    timed: tuple = ()
    shared: bool = True

    @property
    def code(self):
        """The module that makes the first table."""
        return self.module or f"studies.{self.name}.measure"


def _scaled(budget, share, least, most):
    """Return a share of a budget between two limits."""
    return min(most, max(least, budget // share))


def _main_box(configuration):
    return {"box": configuration.main.box.parameters(), "seed": configuration.seed}


def _errata_reads(configuration):
    main, wanted = configuration.main, ("theory", "volume", "areas", "mean_times")
    return {name: (main.name, name) for name in wanted if name in main.tables}


def _stability_parameters(times):
    def parameters(configuration):
        ordinary = times * _scaled(configuration.main.event_budget, 2, 10**7, 10**9)
        return {**_main_box(configuration), "hard": ordinary // 10, "ordinary": ordinary}

    return parameters


def _tails_parameters(configuration):
    budget = configuration.main.event_budget
    return {
        **_main_box(configuration),
        "replicas": _scaled(budget, 5_000, 4_000, 400_000),
        "samples": _scaled(budget, 10**7, 2, 200),
    }


def _distributions_parameters(configuration):
    return {
        "events": _scaled(configuration.main.event_budget, 200, 2**16, 2**23),
        "scenes": [
            {
                "box": scene.box.parameters(),
                "event": scene.histogram["event"],
                "name": scene.name,
                "radii": list(scene.watch.hop_histogram),
            }
            for scene in configuration.plain
        ],
        "seed": configuration.seed,
    }


def _thresholds_reads(configuration):
    times = {
        f"{scene.name}/mean_times": (scene.name, "mean_times")
        for scene in configuration.plain
        if "mean_times" in scene.tables
    }
    return {"distributions": (None, "distributions")} | times


STUDIES = {
    study.name: study
    for study in (
        Study(
            "errata",
            "which formulas of the source are right, and what decides it",
            (Errata,),
            3.0,
            parameters=lambda configuration: {"box": configuration.main.box.parameters()},
            reads=_errata_reads,
        ),
        Study(
            "accuracy_cost",
            "what a digit costs by each method",
            (AccuracyCost,),
            lambda configuration: 10.0 + configuration.accuracy_cost["seconds"],
            {
                "accuracy_cost": Entry(
                    "Error against processor time",
                    COST,
                    """
                    What a digit costs: true relative error against processor time on one core,
                    root mean square over repeated runs; bars are its standard error, and powers
                    in the legend are fitted. (a) Volume and (b) area of disc collisions by
                    rejection sampling, by the conditioned sampler, by scrambled Sobol points, by
                    shells of thickness ε, whose bias (dotted) no work removes, and of the ε at
                    which bias and noise balance, by samples on the surface itself, by Gauss
                    quadrature along the arc (numbers of nodes beside) and by exact evaluation;
                    below 3e-5 the scale changes. (c) Mean time between vertical hops by
                    event-driven dynamics, one trajectory at a time, many in lock step, and these
                    in single precision; and by looking for overlaps every Δt, which leaves an
                    error ∝ Δt (dotted). The dashed line is the least error that time steps reach,
                    whatever Δt; the arrow says how much sooner lock step knows the mean to 1e-3.
                    """,
                    "studies.accuracy_cost.figure",
                    tables=("accuracy_cost",),
                ),
                "accuracy_cost_by_radius": Entry(
                    "The price of a relative error of 1e-3",
                    COST,
                    """
                    (a) Processor time for a relative error of 1e-3 in each mean time, against the
                    radius: from the speed and the errors of a pilot (open symbols), by running to
                    that error (full symbols), and predicted from the exact rates and one speed
                    for the noise of a Poisson process (lines). Below its line an event comes more
                    evenly than at random, above it in clusters. Hops near the radius where they
                    are blocked are counted from starts in a strip next to their surface (grey), at
                    a price that stays flat, here up to a relative distance of 1e-6. (b) Error of
                    the mean time between disc collisions where there is little room left, in double
                    and in single precision: lengths rounded to 24 bits make another room (dashed).
                    """,
                    "studies.accuracy_cost.figure_by_radius",
                    tables=("accuracy_cost",),
                ),
            },
            parameters=lambda configuration: configuration.accuracy_cost,
            kernels=("montecarlo", "dynamics"),
            about_plain=False,
            timed=("accuracy_cost",),
        ),
        Study(
            "stability",
            "how accurate each method is in numerically hard cases",
            (Stability,),
            30.0,
            {
                "stability": Entry(
                    "Numerically hard cases",
                    NUMERICS,
                    """
                    How the methods behave at hard radii; dashed lines are what is asked for. (a)
                    Relative error of volume and areas in double precision below the largest
                    radius, and (b) on both sides of the radii where a hop becomes blocked: closed
                    forms, and the worst of volume, areas and mean times as computed here. (c)
                    Share of proposed configurations that is accepted, by rejection from the prism
                    and by the draws that trajectories start from. (d) Residuals of volume and
                    areas estimated by those draws. (e) Worst of a long run: error of the energy,
                    overlap of the discs, centres beyond their range. (f) Worst error of predicted
                    times to a contact (circles) and to a wall (squares), against 50 digits, for
                    many ways to approach. (g) Velocities are reversed after n events: error of
                    return after n more, over the binary digits that the Lyapunov exponent λ per
                    event costs; the line is one rounding that grows at this rate. The legend says
                    after how many events half of the digits are lost, and in brackets after how
                    many they should be. (h) Share of 95 % intervals that cover the exact mean
                    time, over independent repetitions. Rows without a symbol were not run.
                    Crosses are events too rare for an interval.
                    """,
                    "studies.stability.figure",
                    tables=("stability",),
                ),
            },
            parameters=_stability_parameters(1),
            kernels=("montecarlo", "dynamics"),
        ),
        Study(
            "tails",
            "how probable long intervals are",
            (Tails,),
            15.0,
            {
                "tails": Entry(
                    "Tails of the times between events",
                    DYNAMICS,
                    """
                    (a) Probability that the next event takes longer than t, in units of the exact
                    mean time τ: by starts drawn near the motions that last, with exact weights
                    (open symbols), and by plain counting (dots). Discs that move almost along an
                    axis pass clear of each other for a time ∝ 1/(their drift), so that the tail
                    falls as C/t³, with the exact C (lines) and not exponentially (dashed). (b)
                    Their ratio to C/t³. (c) Beyond h/4 no such motion avoids vertical hops: the
                    tail looks exponential, but not with the rate 1/τ (dashed). Error bars are one
                    standard error.
                    """,
                    "studies.tails.figure",
                    tables=("tails",),
                ),
            },
            parameters=_tails_parameters,
        ),
        Study(
            "distributions",
            "how intervals between hops are distributed",
            (Distributions,),
            20.0,
            {
                "distributions": Entry(
                    "Rate of hops since the last one",
                    DYNAMICS,
                    """
                    (a) How often a hop comes after a time t without one, in units of the exact mean
                    time τ; an exponential law would be the dashed line. It starts from the exact
                    density at 0 (thick dashes), of a hop undone after one bounce, and jumps where
                    both discs may have bounced, from t = √2 (h − 2r) on for vertical hops. Bars are
                    constant rates fitted to all that comes after four mean times, dotted where the
                    rate is not constant there (by χ² or by a trend, at the level of 1e-3). Those of
                    small discs fall on, towards the rate of a cubic tail, 3τ/t (dash-dotted). (b)
                    Mean time from a random moment to the next hop (open symbols) and what intervals
                    make of it, τ(1 + CV²)/2 (dots), with CV their coefficient of variation. Error
                    bars are one standard error.
                    """,
                    "studies.distributions.figure",
                    tables=("distributions",),
                ),
            },
            parameters=_distributions_parameters,
            kernels=("dynamics",),
        ),
        Study(
            "thresholds",
            "the laws where a hop becomes blocked",
            (Thresholds,),
            4.0,
            {
                "thresholds": Entry(
                    "Power laws where events die out",
                    DYNAMICS,
                    """
                    Mean times near the radius at which their event ends, r = r_c − δ with r_c = w/4
                    for vertical hops, h/4 for horizontal ones and the largest radius for all else:
                    event-driven molecular dynamics (symbols) and exact (lines). (a) Times between
                    hops against their leading laws Cδ⁻² (dashed), and mean first passages from a
                    random moment (crosses); slopes are those of inertial and of diffusive motion.
                    (b) Times over their leading laws, of exponent −2 for hops that become blocked
                    and 1 for what vanishes: how near the limit these are reached. Error bars are
                    one standard error.
                    """,
                    "studies.thresholds.figure",
                    tables=("distributions", "thresholds"),
                    main_tables=("mean_times",),
                ),
            },
            parameters=lambda configuration: {
                "scenes": {scene.name: scene.box.parameters() for scene in configuration.plain}
            },
            reads=_thresholds_reads,
        ),
        Study(
            "effects",
            "what each effect does to the mean times, and what it costs",
            (Effects, EffectsCost),
            80.0,
            {
                "effects": Entry(
                    "What each effect does",
                    DYNAMICS,
                    """
                    Mean times of scenes with one effect or two, over those of plain discs in the
                    same box at the same radius (of disc 1) and total energy, up to the largest
                    radius of these: exact (lines) and by event-driven molecular dynamics
                    (symbols; error bars of one standard error are hidden where smaller), for (a)
                    vertical hops, (b) disc collisions and (c) hits of any disc on any wall.
                    Vertical lines mark h/4 and w/4, where hops of plain discs become blocked, and
                    their largest radius. The torus has neither hops nor walls. Residuals z
                    beneath are in standard errors, with guide lines at ±2 and ±5. (d) Processor
                    time per wall hit or disc collision at r = 0.2, relative to that of plain
                    discs with all events watched; to leave a periodic cell takes as much time as
                    an event, but is none.
                    """,
                    "studies.effects.figure",
                    tables=("effects", "effects_cost"),
                ),
            },
            about_plain=False,
            timed=("effects_cost",),
        ),
        Study(
            "long_runs",
            "`stability` of the dynamics over ten times the events",
            (LongRuns,),
            200.0,
            module="studies.stability.measure",
            function="dynamics_rows",
            parameters=_stability_parameters(10),
            kernels=("montecarlo", "dynamics"),
            shared=False,
        ),
    )
}

#: The figures of studies, {name: ``Entry``}.
STUDY_FIGURES = {name: e for study in STUDIES.values() for name, e in study.figures.items()}

#: The tables of studies, {name: table}.
STUDY_TABLES = {table.name(): table for study in STUDIES.values() for table in study.tables}
