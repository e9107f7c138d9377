"""How probable long intervals are."""

from twodiscs.figures.catalogue import DYNAMICS, Entry
from twodiscs_paper.studies.tails.table import Tails
from twodiscs_paper.study import Study, main_box, scaled


def _parameters(configuration):
    budget = configuration.main.event_budget
    return {
        **main_box(configuration),
        "replicas": scaled(budget, 5_000, 4_000, 400_000),
        "samples": scaled(budget, 10**7, 2, 200),
    }


STUDY = Study(
    "tails",
    builds="how probable long intervals are",
    tables=(Tails,),
    seconds=15.0,
    order=4,
    figures={
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
            tail looks exponential at first sight, but not with the rate 1/τ (dashed). Error
            bars are one standard error.
            """,
            "twodiscs_paper.studies.tails.figure",
            tables=("tails",),
        ),
    },
    parameters=_parameters,
)
