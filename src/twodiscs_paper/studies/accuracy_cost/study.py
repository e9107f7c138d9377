"""What a digit costs, by each method."""

from twodiscs.figures.catalogue import Entry
from twodiscs_paper.studies.accuracy_cost.table import AccuracyCost
from twodiscs_paper.study import Study

STUDY = Study(
    "accuracy_cost",
    builds="what a digit costs by each method",
    tables=(AccuracyCost,),
    seconds=lambda configuration: 10.0 + configuration.accuracy_cost["seconds"],
    order=2,
    figures={
        "accuracy_cost": Entry(
            "Error against processor time",
            "4 What accuracy costs",
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
            "twodiscs_paper.studies.accuracy_cost.figure",
            tables=("accuracy_cost",),
        ),
        "accuracy_cost_by_radius": Entry(
            "The price of a relative error of 1e-3",
            "4 What accuracy costs",
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
            "twodiscs_paper.studies.accuracy_cost.figure_by_radius",
            tables=("accuracy_cost",),
        ),
    },
    parameters=lambda configuration: configuration.accuracy_cost,
    about_plain=False,
    timed=("accuracy_cost",),
)
