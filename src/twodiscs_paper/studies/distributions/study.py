"""How intervals between hops are distributed."""

from twodiscs.figures.catalogue import DYNAMICS, Entry
from twodiscs_paper.studies.distributions.table import Distributions
from twodiscs_paper.study import Study, scaled


def _parameters(configuration):
    return {
        "events": scaled(configuration.main.event_budget, 400, 2**16, 2**22),
        "scenes": [
            {
                "box": scene.box.parameters(),
                "event": scene.histogram["event"],
                "name": scene.name,
                "radii": list(scene.quantities.hop_histogram),
            }
            for scene in configuration.plain
        ],
        "seed": configuration.seed,
    }


STUDY = Study(
    "distributions",
    builds="how intervals between hops are distributed",
    tables=(Distributions,),
    seconds=10.0,
    order=5,
    figures={
        "distributions": Entry(
            "Rate of hops since the last one",
            DYNAMICS,
            "twodiscs_paper.studies.distributions.figure",
            tables=("distributions",),
        ),
    },
    parameters=_parameters,
)
