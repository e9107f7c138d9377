"""How probable long intervals are."""

from twodiscs.figures.catalogue import DYNAMICS, Entry
from twodiscs_paper.studies.tails.table import Tails
from twodiscs_paper.study import Study, main_box, scaled


def _parameters(configuration):
    budget = configuration.main.event_budget
    return {
        **main_box(configuration),
        "replicas": scaled(budget, 20_000, 4_000, 100_000),
        "samples": scaled(budget, 2 * 10**7, 2, 100),
    }


STUDY = Study(
    "tails",
    builds="how probable long intervals are",
    tables=(Tails,),
    seconds=8.0,
    order=4,
    figures={
        "tails": Entry(
            "Tails of the times between events",
            DYNAMICS,
            "twodiscs_paper.studies.tails.figure",
            tables=("tails",),
        ),
    },
    parameters=_parameters,
)
