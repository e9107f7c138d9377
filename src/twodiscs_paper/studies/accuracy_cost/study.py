"""The processor time that an accuracy costs, by each method."""

from twodiscs.analysis.columns import (
    COUNT,
    HEIGHT,
    NUMBER,
    RADIUS,
    SECONDS,
    TEXT,
    WIDTH,
    Column,
    Table,
)
from twodiscs.figures.scene_figures import Figure
from twodiscs_paper.study import Study


class AccuracyCostTable(Table):
    """
    One row per method and amount of work: its true error against the processor time it takes, on
    one core.
    """

    columns = {
        "part": TEXT(
            "error: the true error after some time; exact: of quadrature and of the exact "
            "evaluation; radius: c at a distance from the radius where horizontal hops are blocked"
        ),
        "quantity": TEXT("volume, <event>_area or <event>_time"),
        "width": WIDTH,
        "height": HEIGHT,
        "radius": RADIUS,
        "distance": NUMBER("part radius: 1 − radius/(h/4), h/4 where horizontal hops are blocked"),
        "method": TEXT(
            "lockstep: the engine; strip: from initial states next to the hop; scalar: one "
            "trajectory after another; time_step; rejection: samples of the prism; shell: the "
            "same, for an area; conditioned; surface: samples on the surface; quadrature; exact. "
            "radius: as in td.cost"
        ),
        "setting": Column(
            float, "see method", "ε of a shell, Δt of time steps, T of a strip, nodes of quadrature"
        ),
        "seconds": SECONDS("processor time of a run, or of an evaluation"),
        "error": NUMBER("root mean square of the relative error against the exact value"),
        "repetitions": COUNT("independent runs behind it"),
        "c": SECONDS("time × error² of this method, above its floor"),
        "floor": NUMBER("error that remains in long runs; 0 if it is within the noise"),
        "slope": NUMBER("power of the time by which errors fall, above the floor"),
        "slope_stderr": NUMBER("its standard error"),
    }

    @staticmethod
    def rows(seconds, seed):
        """Return the rows for some ``seconds`` of processor time (see ``measure.rows``)."""
        from twodiscs_paper.studies.accuracy_cost import measure

        return measure.rows(seconds, seed)

    @staticmethod
    def part(seed, blocks):
        """Return the rows of a long run (see ``measure.long_run``)."""
        from twodiscs_paper.studies.accuracy_cost import measure

        return measure.long_run(seed, blocks)


STUDY = Study(
    "accuracy_cost",
    builds="the cost of an accuracy by each method",
    tables=(AccuracyCostTable,),
    seconds=lambda configuration: 20.0 + configuration.accuracy_cost["seconds"],
    order=2,
    figures={
        "accuracy_cost": Figure(
            "Error against processor time",
            "4 What accuracy costs",
            """Processor time on one core for a relative error, (a) of the mean time between
            horizontal hops, (b) of the volume and of the area of disc collisions, at r = 0.2 h and
            1e-4 below h/4 (dashed), where the hop becomes blocked. Symbols are true errors against
            the exact value, root mean square over independent runs: full symbols are from a long
            run, open symbols from this build on this machine. Lines are c/error², for a method with
            a bias c/(error² − bias²): the bias of time steps Δt and of thick shells ε remains.
            Error bars are one standard error, where runs are few. "Dynamics" follows trajectories
            in lock step from ordinary initial states, "strips" from initial states next to the hop;
            "one by one" is the same dynamics, one trajectory after another. Near h/4 this is a line
            without symbols, because its counts are the same. The exact value is at the bottom, and
            crosses are Gauss quadrature with 1, 2, … nodes.""",
            tables=("accuracy_cost",),
            long_runs={"kept": "paper/long_run/accuracy_cost/accuracy_cost.csv"},
        ),
        "accuracy_cost_by_radius": Figure(
            "The cost of an accuracy against the radius",
            "4 What accuracy costs",
            """c, the processor time to a relative error times its square, against the distance from
            the radius h/4 at which horizontal hops are blocked: (a) mean times by dynamics from
            ordinary initial states, (b) hops from initial states in a strip, (c) volume and areas
            by samples of the prism, (d) by conditioned samples. Areas have thin shells. An error ε
            takes the time c/ε², above the bias of the shells.""",
            tables=("accuracy_cost",),
        ),
    },
    parameters=lambda configuration: configuration.accuracy_cost | {"seed": configuration.seed},
    about_plain=False,
    timed=("accuracy_cost",),
)
