"""More than two discs: mean times against exact ones where they are known, and the virial sum."""

from twodiscs.figures.catalogue import DYNAMICS, Entry
from twodiscs_paper.studies.more_discs.table import MoreDiscs
from twodiscs_paper.study import Study, scaled


def _parameters(configuration):
    budget = configuration.main.event_budget
    return {
        "events": scaled(budget, 500, 10**5, 10**8),
        "samples": scaled(budget, 2000, 10**4, 10**7),
        "seed": configuration.seed,
    }


STUDY = Study(
    "more_discs",
    families=("plain", "effects", "many"),
    builds="mean times of three, four and eight discs",
    tables=(MoreDiscs,),
    seconds=10.0,
    order=8,
    figures={
        "more_discs": Entry(
            "More discs",
            DYNAMICS,
            """
            Mean times of N discs in a box of 0.75 N × 1, at the energy per disc of two of them:
            exact where a theory is known (lines), by Monte Carlo (dotted) and by event-driven
            molecular dynamics (symbols; error bars of one standard error are hidden where
            smaller). Collisions and hops are those of any pair of discs, wall hits those of one
            disc at one wall. Two discs have the theory of the box, three discs an exact
            quadrature; at r = 0.28 only neighbours touch, and a transfer operator gives every N.
            Times beyond 1000 are not shown. (d) Residuals z of the dynamics, in standard errors,
            from exact values, or from Monte Carlo where none is known; radii stand side by side.
            """,
            "twodiscs_paper.studies.more_discs.figure",
            tables=("more_discs",),
        ),
    },
    parameters=_parameters,
    checked=True,
)
