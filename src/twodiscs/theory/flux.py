"""The mean flux through a surface of configuration space, for velocities uniform on a sphere."""

import math

from twodiscs.model.checks import check_integer


def constant(components):
    """Return c_D: the mean of |n·s| for a unit vector s uniform in D ``components``.

    2/π, 4/(3π), 16/(15π) in two, four and six dimensions.
    """
    half = check_integer("components", components) / 2
    return math.exp(math.lgamma(half) - math.lgamma(half + 0.5)) / math.sqrt(math.pi)
