"""The radii at which something ends, and their names, for drawings and for axes."""

from twodiscs.grid import thresholds
from twodiscs.scene import largest_radius


def limits(width, height):
    """Return [(radius, name in mathtext), …], ascending.

    They are h/4 and w/4, where they fit, and the largest radius.
    """
    names = {}
    for side, name in ((height, "h/4"), (width, "w/4")):
        names.setdefault(side / 4, []).append(name)
    found = [(radius, "=".join(names[radius])) for radius in thresholds(width, height)]
    return [*found, (largest_radius(width, height), r"r_{\mathrm{max}}")]
