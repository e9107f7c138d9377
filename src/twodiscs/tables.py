"""Every table of a scene: its columns, their units and meaning, declared once.

Tables are CSV files with one row for each thing said. Floats are written with all their digits,
integers as integers, truth values as ``true`` and ``false``; an empty cell is a value that does not
exist. Lengths are in the unit of the box, and the time unit is that in which the speed √(v1² + v2²)
is one.
Nothing but the standard library is imported here.
"""

import csv
import math
from dataclasses import dataclass
from numbers import Integral, Real


@dataclass(frozen=True)
class Column:
    """A column: its name, the unit of its values ("" for none), what it means, and its type."""

    name: str
    unit: str
    meaning: str
    kind: type = float


@dataclass(frozen=True)
class Table:
    """A table: what a row of it says, and its columns in order."""

    meaning: str
    columns: tuple[Column, ...]

    @property
    def names(self):
        """The names of the columns, in order."""
        return [column.name for column in self.columns]


BOX = (
    Column("scene", "", "the scene", str),
    Column("width", "length", "side of the box along x"),
    Column("height", "length", "side of the box along y"),
)
RADIUS = Column("radius", "length", "radius of the discs")
COMPONENTS = Column("ergodic_components", "", "disjoint parts of configuration space", int)
Z = Column("z", "", "standard normal deviate of the comparison, positive when the estimate is high")
TEST = Column(
    "test",
    "",
    "how z was found: normal (1000 or more events expected), exact-tail (binomial tail, doubled), "
    "cluster-bound (Chernoff's bound with an allowance for clusters of events), certain (the "
    "probability is 0 or 1), chi-square (sum of squared scores)",
    str,
)


def _sampled(unit, quantity):
    return (
        RADIUS,
        Column("quantity", "", quantity, str),
        Column(
            "method",
            "",
            "monte_carlo: rejection from the prism; conditioned: draws that keep to where the "
            "discs fit, where less than one in 64 of the prism does; areas by a thin shell",
            str,
        ),
        Column("exact", unit, "exact value"),
        Column("estimate", unit, "measure × hits/samples; empty without a hit"),
        Column("stderr", unit, "binomial standard error; empty below 100 hits or misses"),
        Z,
        Column("samples", "", "configurations drawn from the prism, or proposed", int),
        Column("hits", "", "configurations that count", int),
        Column(
            "epsilon",
            "length",
            "thickness of the shell in configuration space (to either side, for a hop), × √mass "
            "where masses differ; empty for the volume and, without effects, for any_wall_area = "
            "4 (right + top), which joins two shells",
        ),
        Column("expectation", unit, "exact expectation of the estimate; z is against it"),
        Column("bias", unit, "expectation − exact: what the thickness of the shell adds"),
        Column(
            "status",
            "",
            "sampled; too-few: under 100 hits or misses, no honest error; none-seen; impossible: "
            "blocked by geometry",
            str,
        ),
        TEST,
    )


STABILITY = (
    Column(
        "part",
        "",
        "theory: relative errors against 50 digits; sampling: accepted share of the proposals; "
        "estimates: conditioned Monte Carlo; times: errors of predicted times; dynamics: worst of "
        "a run; reversal: reversed velocities, and the Lyapunov exponent; coverage: of 95 % "
        "intervals",
        str,
    ),
    Column(
        "quantity",
        "",
        "what is measured. theory: of areas and mean_times the worst one. times: error in units of "
        "2⁻⁵² × conditioning. dynamics: energy_error, the largest |E − 1/2|; smallest_gap, of "
        "|Δx| − 2r, and excess, the largest of a centre beyond its range, both in units of the "
        "largest power of two in the side of the box; lanes_lost, trajectories that ended up "
        "infinite or stuck. reversal: exponent, per event; return_error, after count events and "
        "back; events_retraced, until it is 2⁻²⁶. coverage: the event",
        str,
    ),
    Column(
        "method",
        "",
        "stable, or closed-form in plain doubles; conditioned draws, or rejection from the prism",
        str,
    ),
    Column(
        "case",
        "",
        "ordinary, tiny (1e-9 of the shorter side), or the limit nearby: h/4, w/4, largest radius. "
        "times: how the discs approach. reversal: from the way out and back (return), or from a "
        "small separation",
        str,
    ),
    RADIUS,
    Column("distance", "", "radius/limit − 1, for the limit that case names"),
    Column("count", "", "samples, cases, events or repetitions behind the value", int),
    Column("value", "see quantity", "what was seen; empty where nothing can be said"),
    Column("exact", "see quantity", "what it should be, apart from random and rounding errors"),
    Column("stderr", "see quantity", "standard error of the value"),
    Z,
    Column("low", "see quantity", "smallest value that passes"),
    Column("high", "see quantity", "largest value that passes"),
    Column(
        "status",
        "",
        "estimates: as in areas.csv; coverage: counted, or too-few where intervals are not shown; "
        "reversal: long where the path stays exact for more than 2000 events",
        str,
    ),
    Column(
        "passed",
        "",
        "whether low ≤ value ≤ high and |z| ≤ 5, as far as they are given; empty without any",
        bool,
    ),
)


BENCHMARK = (
    Column("benchmark", "", "what is measured", str),
    Column(
        "variant",
        "",
        "which engine or method; in effects, which scene of config/scenes, and plain: the scene "
        "without effects, or plain_walls: with no hops detected",
        str,
    ),
    Column("value", "see unit", "median over the repetitions"),
    Column("unit", "", "unit of the value", str),
    Column("ratio", "", "how many times better than the baseline of the same run"),
)


TABLES = {
    "grid": Table(
        "One row a radius: what the scene computes.",
        (
            RADIUS,
            Column("regime", "", "all-hops, vertical-hops, horizontal-hops or no-hops", str),
            COMPONENTS,
            Column("largest_radius", "length", "radius at which the discs have no room left"),
        ),
    ),
    "theory": Table(
        "One row a radius and quantity: the exact values.",
        (
            RADIUS,
            Column("quantity", "", "volume, <event>_area or <event>_time", str),
            Column(
                "exact",
                "length⁴, length³ or time",
                "exact value; no time where the event is impossible",
            ),
        ),
    ),
    "volume": Table(
        "One row a radius: the volume of configuration space, exact and by Monte Carlo. In a field "
        "it is weighted with the invariant density; for balls it is in length⁶.",
        _sampled("length⁴", "volume"),
    ),
    "areas": Table(
        "One row a radius and event: the area of the event's surface, exact and by Monte Carlo. A "
        "shell of finite thickness is not a surface, so its exact expectation has a column. In a "
        "field areas are weighted as the flux is; for balls they are in length⁵.",
        _sampled("length³", "<event>_area"),
    ),
    "mean_times": Table(
        "One row a radius and event: the mean time between events, exact and by dynamics.",
        (
            RADIUS,
            Column("event", "", "the event", str),
            Column("exact", "time", "exact mean time; empty where the event is impossible"),
            Column("estimate", "time", "T · replicas/count; empty where none was seen"),
            Column(
                "stderr",
                "time",
                "standard error from the spread between replicas; empty when too few to be honest",
            ),
            Column(
                "z",
                "",
                "standard normal deviate, positive when the time is too long; of the mean count, "
                "which is unbiased for every T",
            ),
            Column("count", "", "events counted in all replicas", int),
            COMPONENTS,
            Column("replicas", "", "independent trajectories that can see the event", int),
            Column("duration", "time", "length T of a replica"),
            Column("relative_stderr", "", "stderr/estimate"),
            Column("target", "", "relative standard error asked for"),
            Column(
                "status",
                "",
                "reached: the target; budget: stopped by the event budget; too-few: under 100 "
                "replicas or 100 effective events (clusters count once), no honest error; "
                "none-seen; impossible: blocked by geometry",
                str,
            ),
            Column(
                "bound",
                "time",
                "where none was seen: lower bound on the mean time at 95 %, allowing for clusters "
                "of four events",
            ),
            TEST,
        ),
    ),
    "hop_histogram": Table(
        "One row a radius and bin: intervals between hops, from one crossing to the next.",
        (
            RADIUS,
            Column("event", "", "the hop", str),
            Column("left", "time", "lower edge of the bin"),
            Column("right", "time", "upper edge of the bin"),
            Column("count", "", "intervals in the bin", int),
            Column("density", "1/time", "count/(intervals × width of the bin)"),
            Column(
                "stderr",
                "1/time",
                "binomial standard error of the density, as if intervals were independent; empty "
                "for an empty bin",
            ),
            Column("intervals", "", "intervals in all, those beyond the last bin included", int),
            Column("exact_mean", "time", "exact mean interval"),
            Column("mean", "time", "mean of all intervals"),
            Column(
                "mean_stderr",
                "time",
                "its standard error from the spread between independent chains; empty below 100",
            ),
            Z,
        ),
    ),
    "check": Table(
        "One row a comparison with the exact theory.",
        (
            Column(
                "comparison",
                "",
                "volume, area, mean_time, hop_interval, sum_rule, and over all radii z_mean and "
                "z_spread",
                str,
            ),
            Column("quantity", "", "what is compared", str),
            Column("radius", "length", "radius of the discs; empty for a statement on all radii"),
            Column("method", "", "monte_carlo, conditioned, dynamics or intervals", str),
            Column("exact", "see quantity", "exact value; for an area, the shell's expectation"),
            Column("estimate", "see quantity", "estimate; empty where there is none"),
            Column("stderr", "see quantity", "its standard error; empty where there is none"),
            Z,
            Column("p", "", "probability of a |z| as large, or larger, if all is right"),
            Column("bound", "", "largest |z| that passes"),
            Column("passed", "", "whether |z| ≤ bound; empty where nothing can be compared", bool),
            Column("status", "", "status of the estimate in its own table", str),
            TEST,
        ),
    ),
    "cost": Table(
        "One row a job: what it took. The only table of a scene that differs from run to run.",
        (
            Column(
                "stage",
                "",
                "monte_carlo, dynamics or intervals; total of the jobs that were forecast",
                str,
            ),
            RADIUS,
            Column("events", "", "events simulated, configurations or intervals drawn", int),
            Column(
                "seconds",
                "s",
                "processor time of the work itself: compiled code is loaded, Python has started",
            ),
            Column("forecast_seconds", "s", "the same, forecast before the run; empty without one"),
            Column("ratio", "", "seconds/forecast_seconds"),
        ),
    ),
    "accuracy_cost": Table(
        "One row a method and amount of work: its true error against the processor time it takes, "
        "on one core. All rows come from one run, in which the methods take turns.",
        (
            Column(
                "part",
                "",
                "volume, area, time: work and precision; floor: the error that no work removes; "
                "radius: the price of a relative error, radius by radius; precision: where single "
                "precision fails",
                str,
            ),
            Column("quantity", "", "volume, <event>_area, <event>_time or energy", str),
            Column("width", "length", "side of the box along x"),
            Column("height", "length", "side of the box along y"),
            RADIUS,
            Column(
                "method",
                "",
                "rejection, conditioned, sobol, shell, balanced_shell (the best ε for the work), "
                "surface, quadrature, closed_form, exact; lockstep, scalar, single_precision, "
                "time_step. radius: lockstep (speed and error of a pilot), poisson (exact rates, "
                "one speed, the noise of a Poisson process), paid (run to the end)",
                str,
            ),
            Column(
                "setting",
                "see method",
                "ε of a shell, Δt of time steps. precision: 1 − r/r_max, and for the energy the "
                "events of a trajectory",
            ),
            Column(
                "work",
                "",
                "samples, points, nodes, wall and disc events, or time steps",
                int,
            ),
            Column("seconds", "s", "median processor time of one run"),
            Column(
                "error",
                "",
                "root mean square over the repetitions of the relative error against the exact "
                "value; radius: the one asked for",
            ),
            Column(
                "spread",
                "",
                "standard deviation of its size between repetitions. floor: standard error; "
                "precision: statistical error of one run",
            ),
            Column("bias", "", "mean relative error with its sign"),
            Column("floor", "", "part of the error that no work removes; 0 where none was found"),
            Column("repetitions", "", "runs with other random numbers", int),
            Column(
                "slope",
                "",
                "fitted power of the work by which the error of this method and setting falls, "
                "above its floor; for quadrature, digits per node; for floor, power of the setting",
            ),
            Column("slope_stderr", "", "its standard error"),
        ),
    ),
    "forecast": Table(
        "One row a scene and stage: what the configuration is going to take on this machine.",
        (
            Column("scene", "", "the scene; all for what is made once, and for the total", str),
            Column(
                "stage",
                "",
                "monte_carlo, dynamics, intervals, tables, figures; accuracy_cost and, as round "
                "figures, compile, errata, stability, documents; total",
                str,
            ),
            Column("radius", "length", "radius of one job; empty for the sum over a stage"),
            Column("jobs", "", "number of jobs", int),
            Column("events", "", "wall and disc events, samples, or intervals", int),
            Column("seconds", "s", "processor time of the work itself, compiled code loaded"),
            Column("startup", "s", "time to start the jobs, and of those that only start"),
            Column("cores", "", "cores to share the work", int),
            Column("wall_clock", "s", "(seconds + startup)/cores, or over the jobs if fewer"),
        ),
    ),
    "benchmark": Table(
        "One row a benchmark and variant, all variants of a benchmark measured in one run.",
        BENCHMARK,
    ),
    "effects": Table(
        "One row a scene with effects, radius and quantity, beside discs without effects.",
        (
            Column("scene", "", "its name; that of its file in config/scenes", str),
            Column("width", "length", "side of the box along x"),
            Column("height", "length", "side of the box along y"),
            Column(
                "effects",
                "",
                "all that makes it another scene than the plain one in this box, as a Python dict; "
                "never_met_share has rows of smooth discs, too",
                str,
            ),
            Column("radius", "length", "radius of disc 1"),
            Column(
                "quantity",
                "",
                "<event>_time; never_met_share: of starts whose discs have not met within duration",
                str,
            ),
            Column("exact", "time", "exact mean time; empty where the event is impossible"),
            Column(
                "plain",
                "as exact",
                "exact mean time of plain discs of this radius, empty where it does not exist; "
                "for never_met_share 2[A²(B − 2r)₊⁴ + B²(A − 2r)₊⁴]/(πVt²), to which that of plain "
                "discs tends",
            ),
            Column("estimate", "as exact", "T · replicas/count, or count/replicas for the share"),
            Column("stderr", "as exact", "its standard error; empty when too few to be honest"),
            Z,
            Column("count", "", "events counted, or starts that have not met", int),
            Column("replicas", "", "independent trajectories that can see the event", int),
            Column("duration", "time", "length T of a replica"),
            Column(
                "status",
                "",
                "reached, budget, too-few, none-seen, impossible: as in mean_times.csv; sampled: a "
                "share with its error",
                str,
            ),
            TEST,
        ),
    ),
    "effects_cost": Table(
        "As benchmark.csv, the rows on effects alone, from a short run.",
        BENCHMARK,
    ),
    "stability": Table(
        "One row a number that says how a method behaves where arithmetic has it hard, for the box "
        "of the first scene.",
        STABILITY,
    ),
    "long_runs": Table(
        "As stability.csv, the rows on dynamics alone, from the longest runs.",
        STABILITY,
    ),
    "errata": Table(
        "One row a displayed formula of arXiv:1908.04749, or a claim of its text: is it right?",
        (
            Column("label", "", "its label in the source, or a short name", str),
            Column("place", "", "section or appendix", str),
            Column(
                "verdict",
                "",
                "right; wrong; right-in-range: right in some of the regimes that it is stated for",
                str,
            ),
            Column(
                "ratio",
                "",
                "printed/true, where it fails if it does; empty for claims and where what is "
                "printed is no real number",
            ),
            Column(
                "radius",
                "length",
                "radius of the ratio, in the box 1.5 × 1; of a limit the radius that is approached;"
                " empty where it does not matter, or where another box decides",
            ),
            Column("correction", "", "what is right instead, or what else to know", str),
            Column(
                "decided_by",
                "",
                "theory (quadrature to 50 digits), and each method that can tell, with its ratio "
                "measured/printed and the error of the last digit (its distance from 0 where 0 is "
                "printed). Areas and times measure each other by the exact volume; where a part is "
                "printed, the rest is taken as exact; the ratio for a limit is measured at the "
                "radius given and carried over by theory",
                str,
            ),
        ),
    ),
    "tails": Table(
        "One row a time t: how probable an interval T longer than t is, in the box of the first "
        "scene.",
        (
            Column("event", "", "what begins and ends the interval: a hop or disc_collision", str),
            RADIUS,
            Column("exact_mean", "time", "exact mean interval"),
            Column("quantity", "", "survival: P(T > t); rate: of the decay of P(T > t)", str),
            Column(
                "method",
                "",
                "counted: intervals that begin within a window; weighted: those met by starts that "
                "are drawn near the motions that last, with exact weights",
                str,
            ),
            Column("time", "time", "t; for a rate, where the fit begins"),
            Column("until", "time", "where the fit ends; empty for survival"),
            Column("estimate", "1/time for a rate", "estimate"),
            Column("stderr", "as estimate", "its standard error, from independent blocks"),
            Column(
                "law",
                "as estimate",
                "C/t³ with the exact C, empty where it is 0; for a rate 1/mean, which it would be "
                "if intervals were exponential",
            ),
        ),
    ),
    "distributions": Table(
        "One row a scene, radius and quantity: how the times to the next hop are distributed, from "
        "a hop (intervals T) and from a random moment (first passages F). Every T and every F has "
        "a start of its own.",
        (
            *BOX,
            RADIUS,
            Column("event", "", "the hop", str),
            Column("exact_mean", "time", "exact mean interval τ"),
            Column(
                "quantity",
                "",
                "mean: of T; squared_cv: CV² = ⟨T²⟩/τ² − 1; first_passage: ⟨F⟩, or ⟨min(F, c)⟩ "
                "where last is c; density_at_zero: p(0) of p(0) − at² in the first two bins of T; "
                "rate: exponential fitted to T by maximum likelihood from four mean times on; "
                "hazard: rate of hops when there was none since the last one, ln[P(T > "
                "first)/P(T > last)]/(last − first)",
                str,
            ),
            Column("first", "time", "where the bins or the fit begin"),
            Column("last", "time", "where they end; for first_passage the cut c"),
            Column("count", "", "intervals or first passages; those within the fit or bin", int),
            Column("estimate", "see quantity", "estimate, a time, 1/time or number"),
            Column("stderr", "as estimate", "its standard error"),
            Column(
                "reference",
                "as estimate",
                "mean: τ; squared_cv: 1, that of an exponential law; first_passage: ⟨T²⟩/(2τ) = "
                "τ(1 + CV²)/2, or ⟨T² − (T − c)₊²⟩/(2τ) where cut, as measured; density_at_zero: "
                "exact; rate: 1/τ, which it would be if intervals were exponential",
            ),
            Column("reference_stderr", "as estimate", "its standard error where it is measured"),
            Column(
                "z",
                "",
                "(estimate − reference)/error; of a rate, how far intervals are from exponential "
                "at all times; empty where a cubic tail leaves F and T² without a variance: see "
                "the row with the cut",
            ),
            Column("chi2", "", "Pearson's χ² of the exponential law within its window"),
            Column("degrees", "", "its degrees of freedom", int),
            Column("p", "", "probability of a larger χ² if the law is exponential there"),
        ),
    ),
    "thresholds": Table(
        "One row a fitted power law: mean times near a limiting radius r_c, τ = C δ^p with δ = r_c "
        "− r, weighted least squares in ln τ against ln δ.",
        (
            *BOX,
            Column("event", "", "the event", str),
            Column("quantity", "", "mean_time, or first_passage: ⟨F⟩ of distributions.csv", str),
            Column(
                "form",
                "",
                "plain: times as measured; reduced: over the regular factor τ_exact/(C δ^p), which "
                "tends to 1 at r_c",
                str,
            ),
            Column("limit_radius", "length", "r_c: w/4 or h/4 of hops, or the largest radius"),
            Column("points", "", "radii fitted: all within 0.2 r_c and beyond other limits", int),
            Column("nearest", "length", "smallest δ of the fit"),
            Column("farthest", "length", "largest δ of the fit"),
            Column("parameter", "", "exponent p, or coefficient C at the exact exponent", str),
            Column("estimate", "of C: time/length^p", "fitted value"),
            Column("stderr", "as estimate", "its standard error"),
            Column(
                "curve",
                "as estimate",
                "the same fit to the exact times at the same radii; empty for first_passage",
            ),
            Column("law", "as estimate", "exact value at the limit"),
            Column("z", "", "(estimate − curve)/stderr"),
            Column("chi2", "", "sum of squared residuals in standard errors"),
            Column("degrees", "", "its degrees of freedom", int),
            Column("p", "", "probability of a larger χ² if the power law holds over the window"),
        ),
    ),
    "trajectory": Table(
        "One row an event of one trajectory, in order: the state at the event.",
        (
            Column("time", "time", "time of the event"),
            Column("x1", "length", "disc 1, from the centre of the box"),
            Column("y1", "length", "disc 1, from the centre of the box"),
            Column("x2", "length", "disc 2, from the centre of the box"),
            Column("y2", "length", "disc 2, from the centre of the box"),
            Column("event", "", "what happens", str),
            Column("z1", "length", "ball 1; empty in the plane"),
            Column("z2", "length", "ball 2; empty in the plane"),
        ),
    ),
}

READING_THE_CHECK = """\
## How to read check.csv

Each row compares one estimate with the exact theory. `z` is the deviation in standard errors or,
where a normal law would not be right, the standard normal deviate with the same two-sided
probability `p`. A row has `passed` when |z| ≤ `bound`.

The bounds are Bonferroni's. If everything is right, a scene fails with a probability of one in a
thousand at most: half of that is shared equally by all comparisons at a radius, and half by the
statements on all radii. `z_mean` says whether the scores of one quantity, by one method, scatter
about zero (√n times their mean), and `z_spread` whether they scatter by one (their sum of squares,
a χ² of n degrees): errors that are too small or too large show there. Both take the scores whose
`test` is `normal`, and are exact for any number of them; tails of discrete laws are conservative
by design and would look too narrow.

A row without an honest error says so in `status`. It is still compared wherever a bound holds: no
hit at all is a failure where hits were due. Only where nothing can be said is `passed` empty.
"""


def _text(column, value):
    """Return the text of a cell, or raise ``ValueError`` for a value of another kind."""
    if value is None:
        return ""
    if column.kind is bool and isinstance(value, bool):
        return "true" if value else "false"
    if column.kind is str and isinstance(value, str) and value:
        return value
    number = isinstance(value, Real) and not isinstance(value, bool) and value == value
    if column.kind is float and number:
        return repr(float(value))
    if column.kind is int and number and isinstance(value, Integral):
        return repr(int(value))
    raise ValueError(f"{column.name} must be a {column.kind.__name__} or None, not {value!r}")


def _value(column, text):
    if text == "":
        return None
    if column.kind is bool:
        return {"true": True, "false": False}[text]
    value = column.kind(text)
    if column.kind is float and math.isnan(value):
        raise ValueError
    return value


def _table(name):
    if name not in TABLES:
        raise ValueError(f"table must be one of {', '.join(TABLES)}, not {name!r}")
    return TABLES[name]


def write(path, table, rows):
    """Write ``rows`` (mappings from column to value) as the CSV file of ``table`` at ``path``.

    Every row has exactly the table's columns; ``None`` becomes an empty cell. Raises ``ValueError``
    for another set of columns, a value of another type, and NaN, before anything is written.
    """
    columns = _table(table).columns
    names = _table(table).names
    lines = [names]
    for row in rows:
        if set(row) != set(names):
            odd = ", ".join(sorted(set(row) ^ set(names)))
            raise ValueError(f"rows must have the columns of {table}.csv, but see {odd}")
        lines.append([_text(column, row[column.name]) for column in columns])
    with open(path, "w", encoding="utf-8", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows(lines)


def read(path, table):
    """Return the rows of the CSV file at ``path`` as dicts, with ``None`` for empty cells.

    Raises ``ValueError`` if its columns are not those of ``table``, or a cell is not of its type.
    """
    columns = _table(table).columns
    with open(path, encoding="utf-8", newline="") as file:
        lines = list(csv.reader(file))
    if not lines or lines[0] != _table(table).names:
        raise ValueError(f"{path} must be a {table} table with the columns {_table(table).names}")
    rows = []
    for number, line in enumerate(lines[1:], start=2):
        try:
            row = {c.name: _value(c, text) for c, text in zip(columns, line, strict=True)}
        except (ValueError, KeyError):
            raise ValueError(f"{path} has a bad row in line {number}: {line}") from None
        rows.append(row)
    return rows


def _plain(text):
    """Return ``text`` with what Markdown would take for a column or a tag escaped."""
    return text.replace("|", "\\|").replace("<", "&lt;")


def documentation():
    """Return the description of every table, and how to read check.csv, as Markdown."""
    parts = [f"# Tables\n\n{__doc__.split(chr(10), 2)[2].rsplit('Nothing but', 1)[0].strip()}\n"]
    for name, table in TABLES.items():
        lines = [f"| `{c.name}` | {c.unit or '–'} | {_plain(c.meaning)} |\n" for c in table.columns]
        parts.append(
            f"## {name}.csv\n\n{table.meaning}\n\n| column | unit | meaning |\n|---|---|---|\n"
            + "".join(lines)
        )
    return "\n".join([*parts, READING_THE_CHECK])
