"""The processor time that a digit costs, by each method."""

from twodiscs.figures.catalogue import Entry
from twodiscs_paper.studies.accuracy_cost.table import AccuracyCost
from twodiscs_paper.study import Study

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
            "twodiscs_paper.studies.accuracy_cost.figure",
            tables=("accuracy_cost",),
        ),
        "accuracy_cost_by_radius": Entry(
            "The price of a relative error of 1e-3",
            "4 What accuracy costs",
            "twodiscs_paper.studies.accuracy_cost.figure_by_radius",
            tables=("accuracy_cost",),
        ),
    },
    parameters=lambda configuration: configuration.accuracy_cost,
    about_plain=False,
    timed=("accuracy_cost",),
)
