"""Corrections to the source, with the evidence for each."""

from twodiscs_paper.errata.table import Errata
from twodiscs_paper.study import Study


def _reads(configuration):
    main, wanted = configuration.main, ("theory", "volume", "areas", "mean_times")
    return {name: (main.name, name) for name in wanted if name in main.tables}


STUDY = Study(
    "errata",
    builds="which formulas of the source are right, with the evidence",
    tables=(Errata,),
    seconds=3.0,
    order=1,
    parameters=lambda configuration: {"box": configuration.main.box.parameters()},
    reads=_reads,
)
