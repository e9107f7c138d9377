"""The radii at which something ends, and their names, for drawings and for axes."""

from functools import partial

from twodiscs import grid, parameters
from twodiscs.grid import thresholds
from twodiscs.scene import HOPS, largest_radius

#: What changes at some radius of a scene with effects, by the index of that radius: hops become
#: blocked, in a field the top wall comes within reach, disc 1 can no longer change sides.
CHANGES = {
    "v": lambda scene: scene.vertical_hops,
    "h": lambda scene: scene.horizontal_hops,
    "t": lambda scene: scene.is_possible("top_wall"),
    "x": lambda scene: scene.confined[0],
    "y": lambda scene: scene.confined[1],
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
    of disc 2, if that is not where the hop becomes blocked; and the largest radius, which a field
    may lower.
    """
    if "effects" not in scene:
        return limits(scene["width"], scene["height"])
    scene_at = partial(parameters.scene, scene)
    widest = min(scene["width"], scene["height"]) / 2
    largest = grid.end(scene_at, widest)
    names = {}
    for index, state in CHANGES.items():
        first = state(scene_at(1e-6 * largest))
        radius = grid.end(scene_at, widest, lambda here, s=state, f=first: s(here) == f)
        if radius < largest and not (index in "xy" and radius in names):
            names.setdefault(radius, []).append(rf"r_{{\mathrm{{{index}}}}}")
    found = sorted((radius, "=".join(same)) for radius, same in names.items())
    return [*found, (largest, r"r_{\mathrm{max}}")]


def hop_ends(scene):
    """Return {hop: (radius at which it ends, its name)} of a figure's ``scene``."""
    found = scene_limits(scene)
    names = ("w/4", "h/4") if "effects" not in scene else (rf"r_{{\mathrm{{{i}}}}}" for i in "vh")
    return {
        hop: next((limit for limit in found if name in limit[1].split("=")), found[-1])
        for hop, name in zip(HOPS, names, strict=True)
    }
