"""Which hops are passages, and how fast discs diffuse by them."""

from twodiscs.figures.catalogue import DYNAMICS, Entry
from twodiscs_paper.studies.passages.table import Passages
from twodiscs_paper.study import Study, scaled

#: Moments of inertia of rough discs, in the first box and in others.
INERTIAS, OTHERS = [0.1, 0.25, 0.5, 1.0], [0.5]


def _parts(configuration):
    """Return {name: parameters} of the parts, which have random streams of their own."""
    parts, seed = {}, {"seed": configuration.seed}
    events = {"events": scaled(configuration.main.event_budget, 160, 2**19, 2**25)}
    for scene in configuration.plain:
        own = {"name": scene.name, "box": scene.box.parameters()} | events | seed
        first = scene == configuration.main
        inertias = {"inertias": INERTIAS if first else OTHERS}
        parts[f"near_threshold_{scene.name}"] = {"part": "near_threshold"} | own | inertias
        if first and scene.box.fits(scene.box.height / 4):
            parts |= {part: {"part": part} | own for part in ("on_ring", "in_file")}
    return parts | {"on_lattice": {"part": "on_lattice"} | seed}


STUDY = Study(
    "passages",
    families=("plain", "effects", "many"),
    builds="which hops are passages, and diffusion by them",
    tables=(Passages,),
    seconds=60.0,
    order=6,
    figures={
        "passages": Entry(
            "Hops that are passages",
            DYNAMICS,
            """
            What becomes of hops near the radius r_c where they become blocked, at distances δ =
            (r_c − r)/r_c that are halved from one to the next. (a) Transmission coefficient κ(t):
            how the order of the discs at a time t after a hop is correlated with the direction of
            the hop, over states on the surface of the hop, for smooth discs (circles) and rough
            ones (squares). It starts with the exact slope −2p(0⁺) (dashed, in the limit δ → 0).
            Where hops are rare it has a plateau, which falls as passages follow one another
            (lines): κ is the fraction of odd clusters among all hops, from independent runs. (b)
            Smooth discs: 1 − κ falls about as ∛δ, so that transition state theory becomes
            exact; of rough discs it is κ that vanishes, and the power depends on their moment of
            inertia I, in units of mr². (c) Exact mean time τ between hops (lines, ∝ δ⁻² in the
            end) and mean time τ/κ between passages (symbols), with the powers fitted to all that
            is shown. (d) Coefficient D of diffusion of two discs on a ring, over that of a random
            walk with ν hops per time in either direction, each by ℓ, by correlations of hops
            (open symbols) and by displacements (dots); of discs in a file of four and of eight, by
            displacements; and of a tagged particle of a single file on a lattice, whose neighbours
            swap with the probability p. (e) Residuals z, in
            standard errors, against exact values or between two estimators. Error bars are one
            standard error.
            """,
            "twodiscs_paper.studies.passages.figure",
            tables=("passages",),
        ),
    },
    parts=_parts,
    checked=True,
)
