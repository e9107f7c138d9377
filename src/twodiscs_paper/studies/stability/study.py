"""How accurate each method is in numerically hard cases."""

from twodiscs.figures.catalogue import Entry
from twodiscs_paper.studies.stability.table import LongRuns, Stability
from twodiscs_paper.study import Study, main_box, scaled


def _parameters(times):
    def parameters(configuration):
        ordinary = times * scaled(configuration.main.event_budget, 8, 10**7, 25 * 10**7)
        return {**main_box(configuration), "hard": ordinary // 10, "ordinary": ordinary}

    return parameters


STUDY = Study(
    "stability",
    builds="how accurate each method is in numerically hard cases",
    tables=(Stability,),
    seconds=20.0,
    order=3,
    figures={
        "stability": Entry(
            "Numerically hard cases",
            "5 Numerical stability",
            "twodiscs_paper.studies.stability.figure",
            tables=("stability",),
        ),
        "stability_of_runs": Entry(
            "Numerically hard cases of the dynamics",
            "5 Numerical stability",
            "twodiscs_paper.studies.stability.figure_runs",
            tables=("stability",),
        ),
    },
    parameters=_parameters(1),
)

LONG_RUNS = Study(
    "long_runs",
    builds="`stability` of the dynamics over ten times the events",
    tables=(LongRuns,),
    seconds=60.0,
    order=8,
    parameters=_parameters(10),
    shared=False,
)
