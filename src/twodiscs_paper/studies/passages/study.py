"""Which hops are passages, and how fast discs diffuse by them."""

from twodiscs.figures.catalogue import DYNAMICS, Entry
from twodiscs_paper.studies.passages.table import Passages
from twodiscs_paper.study import Study, scaled


def _parameters(configuration):
    return {
        "events": scaled(configuration.main.event_budget, 160, 2**19, 2**25),
        "scenes": {scene.name: scene.box.parameters() for scene in configuration.plain},
        "seed": configuration.seed,
    }


STUDY = Study(
    "passages",
    builds="which hops are passages, and diffusion by them",
    tables=(Passages,),
    seconds=60.0,
    order=6,
    figures={
        "passages": Entry(
            "Hops that are passages",
            DYNAMICS,
            "twodiscs_paper.studies.passages.figure",
            tables=("passages",),
        ),
        "diffusion": Entry(
            "Diffusion by hops",
            DYNAMICS,
            "twodiscs_paper.studies.passages.figure_diffusion",
            tables=("passages",),
        ),
    },
    parameters=_parameters,
    checked=True,
)
