"""Statistics over the comparisons of all scenes."""

from twodiscs_paper.studies.agreement.table import Agreement
from twodiscs_paper.study import Study


def _reads(configuration):
    return {
        f"{scene.name}/{table}": (scene.name, table)
        for scene in configuration.plain
        for table in ("check", "hop_histogram")
        if table in scene.tables
    } | {"effects": (None, "effects")}


STUDY = Study(
    "agreement",
    builds="how deviations from the exact values are correlated",
    tables=(Agreement,),
    seconds=2.0,
    order=8,
    reads=_reads,
)
