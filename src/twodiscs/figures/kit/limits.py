"""The radii at which something ends, and their names, for drawings and for axes."""

from functools import cache

from twodiscs.model.events import AXIS, HOPS

#: What the largest radius is called, and the sides at a quarter of which hops become blocked.
LARGEST, QUARTERS = r"r_{\mathrm{max}}", {"x": "h/4", "y": "w/4"}

#: The radii of a box with effects at which something changes: hops become blocked, in a field the
#: top wall comes within reach, disc 1 can no longer change sides; where an axis is periodic, discs
#: can no longer pass each other. Where two are the same, hops give the name, or what comes first.
VERTICAL, HORIZONTAL = r"r_{\mathrm{v}}", r"r_{\mathrm{h}}"
TOP, ACROSS_X, ACROSS_Y = r"r_{\mathrm{t}}", r"r_{\mathrm{x}}", r"r_{\mathrm{y}}"
CHANGES = {
    VERTICAL: lambda scene: scene.vertical_hops,
    HORIZONTAL: lambda scene: scene.horizontal_hops,
    TOP: lambda scene: scene.is_possible("top_wall"),
    ACROSS_X: lambda scene: scene.confined[0],
    ACROSS_Y: lambda scene: scene.confined[1],
    r"\sigma=h/2": lambda scene: _fills(scene, "y"),
    r"\sigma=w/2": lambda scene: _fills(scene, "x"),
}


@cache
def limits(box):
    """Return ((radius, name in mathtext), …) of a ``Box``, ascending.

    Of more than two discs they are as with effects.

    They are h/4 and w/4, where they fit, and the largest radius. With effects they are r_v and r_h,
    where vertical and horizontal hops become blocked; r_t, from which on discs rise to the top wall
    in a field; r_x and r_y, where disc 1 loses its way to the other side of disc 2, if that is not
    where the hop becomes blocked; with a periodic axis, the radii at which σ = r1 + r2 is half of a
    side; and the largest radius, which a field may lower.
    """
    names = {}
    if box.is_plain:
        for hop in sorted(HOPS, key=AXIS.get):
            radius, name = box.threshold(hop), QUARTERS[AXIS[hop]]
            names[radius] = f"{names[radius]}={name}" if radius in names else name
        names = {radius: name for radius, name in names.items() if radius in box.thresholds}
        return *sorted(names.items()), (box.largest_radius, LARGEST)
    largest = box.last_radius
    for name, state in CHANGES.items():
        first = state(box.scene(1e-6 * largest))
        radius = box.end(lambda here, s=state, f=first: s(here) == f)
        if radius in names and name == HORIZONTAL:
            names[radius] += f"={name}"
        elif radius < largest:
            names.setdefault(radius, name)
    return *sorted(names.items()), (largest, LARGEST)


def _fills(scene, axis):
    return bool(scene.periodic) and scene.reach(axis) <= scene.exact_contact


def hop_ends(box):
    """Return {hop: (radius at which it ends, its name)} of a ``Box``."""
    ends = limits(box)
    names = (QUARTERS["y"], QUARTERS["x"]) if box.is_plain else (VERTICAL, HORIZONTAL)
    return {
        hop: next((limit for limit in ends if name in limit[1].split("=")), ends[-1])
        for hop, name in zip(HOPS, names, strict=True)
    }
