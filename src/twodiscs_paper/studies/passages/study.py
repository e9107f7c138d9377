"""Which hops are passages, and how fast discs diffuse by them."""

from twodiscs.figures.catalogue import DYNAMICS, Entry
from twodiscs.model.box import Box
from twodiscs.model.events import HOPS
from twodiscs_paper.studies.passages.table import Passages
from twodiscs_paper.study import Study, scaled

#: Moments of inertia of rough discs, for the last hop of the first box and for
#: all others.
INERTIAS, OTHERS = [0.1, 0.25, 0.5, 1.0], [0.5]

#: The radius over the height of the box at which discs of a long file cannot pass.
BLOCKED = 0.28


def _parts(configuration):
    """Return {name: parameters} of the parts; each part has its own random streams."""
    parts, seed = {}, {"seed": configuration.seed}
    events = {"events": scaled(configuration.main.event_budget, 800, 2**19, 2**25)}
    for scene in configuration.plain:
        own = {"name": scene.name, "box": scene.box.parameters()} | events | seed
        first = scene == configuration.main
        hops = [hop for hop in HOPS if scene.box.threshold(hop) in scene.box.thresholds]
        for hop in hops:
            inertias = INERTIAS if first and hop == hops[-1] else OTHERS
            near = {"part": "near_threshold", "hop": hop, "inertias": inertias}
            parts[f"near_threshold_{scene.name}_{hop}"] = near | own
        if first and scene.box.fits(scene.box.height / 4):
            own_parts = ("on_ring", "with_friction", "in_file")
            parts |= {part: {"part": part} | own for part in own_parts}
        if first and scene.box.fits(blocked := BLOCKED * scene.box.height):
            alone = {"name": scene.name, "box": scene.box.parameters(), "blocked": blocked} | seed
            parts["in_long_file"] = {"part": "in_long_file"} | alone
    return parts | {part: {"part": part} | seed for part in ("on_lattice", "in_the_limit")}


def _due(configuration):
    """Yield columns that identify the rows of all parts."""
    from twodiscs_paper.studies.passages import measure

    for given in _parts(configuration).values():
        box = given.get("box") and Box(**given["box"])
        yield from measure.due(**given | {"box": box})


STUDY = Study(
    "passages",
    families=("plain", "effects", "many"),
    builds="which hops are passages, and diffusion by them",
    tables=(Passages,),
    seconds=50.0,
    order=6,
    figures={
        "passages": Entry(
            "Hops that are passages",
            DYNAMICS,
            "twodiscs_paper.studies.passages.figure",
            tables=("passages",),
        ),
        "transmission": Entry(
            "Passages near the threshold",
            DYNAMICS,
            "twodiscs_paper.studies.passages.figure_transmission",
            tables=("passages",),
        ),
        "friction": Entry(
            "Passages with friction",
            DYNAMICS,
            "twodiscs_paper.studies.passages.figure_friction",
            tables=("passages",),
        ),
        "diffusion": Entry(
            "Diffusion by hops",
            DYNAMICS,
            "twodiscs_paper.studies.passages.figure_diffusion",
            tables=("passages",),
        ),
    },
    parts=_parts,
    due=_due,
)
