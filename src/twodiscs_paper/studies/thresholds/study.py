"""The laws where a hop becomes blocked."""

from twodiscs.figures.catalogue import DYNAMICS, Entry
from twodiscs_paper.studies.thresholds.table import Thresholds
from twodiscs_paper.study import Study


def _reads(configuration):
    times = {
        f"{scene.name}/mean_times": (scene.name, "mean_times")
        for scene in configuration.plain
        if "mean_times" in scene.tables
    }
    return {"distributions": (None, "distributions")} | times


STUDY = Study(
    "thresholds",
    builds="the laws where a hop becomes blocked",
    tables=(Thresholds,),
    seconds=4.0,
    order=6,
    figures={
        "thresholds": Entry(
            "Power laws where events die out",
            DYNAMICS,
            "twodiscs_paper.studies.thresholds.figure",
            tables=("distributions", "thresholds"),
            main_tables=("mean_times",),
        ),
    },
    parameters=lambda configuration: {
        "scenes": {scene.name: scene.box.parameters() for scene in configuration.plain}
    },
    reads=_reads,
)
