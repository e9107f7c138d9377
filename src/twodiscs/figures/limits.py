"""The radii at which something ends, and their names, for drawings and for axes."""

from functools import partial

from twodiscs import grid, parameters
from twodiscs.grid import thresholds
from twodiscs.scene import HOPS, largest_radius

#: The radii of a scene with effects at which something changes: hops become blocked, in a field the
#: top wall comes within reach, disc 1 can no longer change sides; where an axis is periodic, discs
#: can no longer pass each other. Where two are the same, hops give the name, or what comes first.
VERTICAL, HORIZONTAL = r"r_{\mathrm{v}}", r"r_{\mathrm{h}}"
CHANGES = {
    VERTICAL: lambda scene: scene.vertical_hops,
    HORIZONTAL: lambda scene: scene.horizontal_hops,
    r"r_{\mathrm{t}}": lambda scene: scene.is_possible("top_wall"),
    r"r_{\mathrm{x}}": lambda scene: scene.confined[0],
    r"r_{\mathrm{y}}": lambda scene: scene.confined[1],
    r"\sigma=h/2": lambda scene: _fills(scene, "y"),
    r"\sigma=w/2": lambda scene: _fills(scene, "x"),
}


def limits(width, height):
    """Return [(radius, name in mathtext), …], ascending.

    They are h/4 and w/4, where they fit, and the largest radius.
    """
    names = {}
    for side, name in ((height, "h/4"), (width, "w/4")):
        names.setdefault(side / 4, []).append(name)
    found = [(radius, "=".join(names[radius])) for radius in thresholds(width, height)]
    return [*found, (largest_radius(width, height), r"r_{\mathrm{max}}")]


def scene_limits(scene):
    """Return the same for the ``scene`` of a figure, which may have effects.

    Then they are r_v and r_h, where vertical and horizontal hops become blocked; r_t, from which on
    discs rise to the top wall in a field; r_x and r_y, where disc 1 loses its way to the other side
    of disc 2, if that is not where the hop becomes blocked; with a periodic axis, the radii at
    which σ = r1 + r2 is half of a side; and the largest radius, which a field may lower.
    """
    if "effects" not in scene:
        return limits(scene["width"], scene["height"])
    scene_at = partial(parameters.scene, scene)
    widest = min(scene["width"], scene["height"]) / 2
    largest = grid.end(scene_at, widest)
    found = {}
    for name, state in CHANGES.items():
        first = state(scene_at(1e-6 * largest))
        radius = grid.end(scene_at, widest, lambda here, s=state, f=first: s(here) == f)
        if radius in found and name == HORIZONTAL:
            found[radius] += f"={name}"
        elif radius < largest:
            found.setdefault(radius, name)
    return [*sorted(found.items()), (largest, r"r_{\mathrm{max}}")]


def _fills(scene, axis):
    return bool(scene.periodic) and scene.reach(axis) <= sum(scene.exact_radii)


def hop_ends(scene):
    """Return {hop: (radius at which it ends, its name)} of a figure's ``scene``."""
    found = scene_limits(scene)
    names = ("w/4", "h/4") if "effects" not in scene else (VERTICAL, HORIZONTAL)
    return {
        hop: next((limit for limit in found if name in limit[1].split("=")), found[-1])
        for hop, name in zip(HOPS, names, strict=True)
    }
