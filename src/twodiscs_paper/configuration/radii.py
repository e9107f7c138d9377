"""The grid of radii of a scene, if its configuration does not list them."""

import math
from itertools import pairwise

from twodiscs.model.checks import InputError
from twodiscs.model.formats import shortest_decimal
from twodiscs.model.scene import Box

#: A regime narrower than this fraction of the largest radius has no points.
NARROWEST_REGIME = 1e-6


def radii(width, height, smallest, count):
    """Return ``count`` ascending radii from ``smallest`` up to just below the largest that fits.

    The points of every regime are Chebyshev nodes. They are dense on both sides of h/4 and w/4 and
    below the largest radius, but none is at one of the three. From the smallest radius on they
    begin evenly. Each is then rounded to the fewest digits that leave it near its value.
    """
    box = Box(width, height)
    largest, limits = box.largest_radius, box.thresholds
    if smallest >= largest * (1 - NARROWEST_REGIME):
        raise InputError(
            f"smallest must be below the largest radius of the box, {largest!r}, not {smallest!r}"
        )
    if smallest in limits:
        raise InputError(f"smallest must not be {smallest!r}, at which a hop becomes blocked")

    edges = [smallest]
    for limit in (*limits, largest):
        if limit - edges[-1] > NARROWEST_REGIME * largest:
            edges.append(limit)
    regimes = list(pairwise(edges))
    places = []
    shared = 0.0
    for low, high in regimes:
        # Half of the points are divided equally among the regimes, half by length.
        shared += 1 / len(regimes) + (high - low) / (largest - smallest)
        n = max(1, round(count * shared / 2)) - len(places)
        if not places:
            fractions = [math.sin(math.pi / 2 * j / n) for j in range(n)]
        else:
            fractions = [math.sin(math.pi / 2 * (j + 0.5) / n) ** 2 for j in range(n)]
        # Twelve digits of the sines, because the last one depends on the math library.
        places += [low + round(fraction, 12) * (high - low) for fraction in fractions]

    result = [smallest]
    for i in range(1, len(places)):
        near = [*edges, places[i - 1], *places[i + 1 : i + 2]]
        room = min(abs(places[i] - other) for other in near)
        result.append(shortest_decimal(places[i], room / 4, avoid=limits))
    return tuple(result)


def even_radii(smallest, largest, count):
    """Return ``count`` ascending radii in equal steps from ``smallest`` to ``largest``.

    Each except the first is rounded to the fewest digits that leave it near its value.
    """
    if smallest >= largest:
        raise InputError(f"smallest must be below {largest!r}, not {smallest!r}")
    step = (largest - smallest) / max(count - 1, 1)
    places = [largest - i * step for i in reversed(range(count - 1))]
    return (smallest, *(shortest_decimal(p, min(step / 4, p / 100)) for p in places))
