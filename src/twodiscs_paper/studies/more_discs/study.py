"""More than two discs: mean times against exact values if these are known, and the virial sum."""

from twodiscs.figures.catalogue import DYNAMICS, Entry
from twodiscs_paper.studies.more_discs.table import MoreDiscs
from twodiscs_paper.study import Study, scaled


def _parameters(configuration):
    budget = configuration.main.event_budget
    return {
        "events": scaled(budget, 500, 10**5, 10**8),
        "samples": scaled(budget, 4000, 10**4, 10**7),
        "seed": configuration.seed,
    }


def _due(configuration):
    """Yield the columns that identify each row."""
    from twodiscs_paper.studies.more_discs import measure

    return measure.due()


STUDY = Study(
    "more_discs",
    families=("many",),
    builds="mean times of three to 64 discs",
    tables=(MoreDiscs,),
    seconds=10.0,
    order=8,
    figures={
        "more_discs": Entry(
            "More discs",
            DYNAMICS,
            "twodiscs_paper.studies.more_discs.figure",
            tables=("more_discs",),
        ),
    },
    parameters=_parameters,
    due=_due,
)
