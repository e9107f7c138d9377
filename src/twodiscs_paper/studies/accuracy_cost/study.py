"""The processor time that a digit costs, by each method."""

from twodiscs.comparison.table import (
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
from twodiscs.figures.catalogue import Caption, Entry
from twodiscs_paper.study import Study


class AccuracyCost(Table):
    """
    One row per method and amount of work: its true error against the processor time it takes, on
    one core. All rows come from one run, in which the methods take turns.
    """

    columns = {
        "part": TEXT(
            "volume, area, time: work and precision; floor: the error that no work removes; "
            "radius: the cost of a relative error, radius by radius; speed: of the engines, by "
            "their median runs of the part time"
        ),
        "quantity": TEXT("volume, <event>_area, <event>_time or events"),
        "width": WIDTH,
        "height": HEIGHT,
        "radius": RADIUS,
        "method": TEXT(
            "rejection, conditioned, sobol, shell, balanced_shell (the best ε for the work), "
            "surface, quadrature, closed_form, exact; lockstep, scalar, time_step. radius: "
            "lockstep (speed and error of a pilot), strip (the same from starts next to a rare "
            "hop), poisson (exact rates, one speed, the noise of a Poisson process), paid (a run "
            "to this error)"
        ),
        "setting": Column(
            float,
            "see method",
            "ε of a shell, Δt of time steps, T of starts next to a hop. speed: events per second, "
            "divided by the same number for scalar",
        ),
        "work": COUNT("samples, points, nodes, wall and disc events, or time steps"),
        "seconds": SECONDS("median processor time of one run"),
        "error": NUMBER(
            "root mean square over the repetitions of the relative error against the exact value; "
            "radius: the wanted error"
        ),
        "spread": NUMBER(
            "standard deviation of its size between repetitions. floor: standard error"
        ),
        "bias": NUMBER("mean relative error with its sign"),
        "floor": NUMBER("part of the error that no work removes; 0 if it is within the noise"),
        "repetitions": COUNT("runs with other random numbers"),
        "slope": NUMBER(
            "fitted power of the work by which the error of this method and setting falls, above "
            "its floor; for quadrature, digits per node; for floor, power of the setting"
        ),
        "slope_stderr": NUMBER("its standard error"),
    }

    @staticmethod
    def rows(seconds):
        """Return the rows for some ``seconds`` of processor time (see ``measure.rows``)."""
        from twodiscs_paper.studies.accuracy_cost import measure

        return measure.rows(seconds)


STUDY = Study(
    "accuracy_cost",
    builds="the cost of a digit by each method",
    tables=(AccuracyCost,),
    seconds=lambda configuration: 10.0 + configuration.accuracy_cost["seconds"],
    order=2,
    figures={
        "accuracy_cost": Entry(
            "Error against processor time",
            "4 What accuracy costs",
            Caption(
                """
                The cost of a digit: true relative error against processor time on one core, root
                mean square over repeated runs. Error bars are one standard error. Dashed lines ∝
                1/√t are the law of independent samples, with a fitted factor. (a) Volume by
                rejection sampling, by the conditioned sampler and by scrambled Sobol points. (b)
                Area of disc collisions by shells of thickness ε, whose bias (dotted) no work
                removes, and by shells with the ε at which bias and noise balance. The other two
                methods draw samples or Sobol points on the surface itself. (c) Mean time between
                vertical hops by event-driven dynamics: one trajectory at a time, and many in lock
                step. Time steps search for overlaps every Δt; their error ∝ Δt (dotted) does not
                fall with time. The dash-dotted line is the smallest error of time steps with any
                Δt. The arrow compares the times to an error of 1e-3. (d) Gauss quadrature along the
                arc against the number of its nodes, and exact evaluation; the legend has their
                processor times.
                """
            ),
            tables=("accuracy_cost",),
        ),
        "accuracy_cost_by_radius": Entry(
            "The price of a relative error of 1e-3",
            "4 What accuracy costs",
            Caption(
                """
                (a) Processor time for a relative error of 1e-3 in each mean time, against the
                radius, from the speed and the errors of a pilot (open symbols) or from a run to
                that error (full symbols). Lines are predicted from the exact rates and one speed
                for a Poisson process. Near the radius where they are blocked hops are counted from
                initial states in a strip next to their surface (grey). (b) The times of pilots
                divided by the times of a Poisson process: the variance of the number of events
                divided by its mean.
                """
            ),
            tables=("accuracy_cost",),
        ),
    },
    parameters=lambda configuration: configuration.accuracy_cost,
    about_plain=False,
    timed=("accuracy_cost",),
)
