"""The functions that draw the figures of the catalogue, by name."""

from functools import partial

from twodiscs.figures import radius
from twodiscs.figures.geometry import (
    configuration_space,
    integration_regimes,
    largest_radius,
    model,
    surface_shell,
)
from twodiscs.figures.motion import hop_histogram, hopping_trajectory, pressure

#: {figure: function of a ``Box`` and of the rows of its table}
FROM_ROWS = {name: partial(radius.draw, name) for name in radius.OVER_RADIUS} | {
    "pressure": pressure.draw,
    "hop_histogram": hop_histogram.draw,
    "hopping_trajectory": hopping_trajectory.draw,
}

#: {drawing: function of a ``Box``}
OF_A_BOX = {
    "model": model.draw,
    "configuration_space": configuration_space.draw,
    "largest_radius": largest_radius.draw,
    "integration_regimes": integration_regimes.draw,
    "surface_shell": surface_shell.draw,
}


def draw(name, box, rows=None, radius=None):
    """Return the figure ``name`` of a ``Box``, with the ``rows`` of its table if it has one.

    ``FIGURES`` of the catalogue has the names; ``mean_times`` and ``areas`` show all events of
    these tables in one panel. The ``radius`` of a trajectory, if given, is written above it. Raises
    ``InputError`` if no row is about the figure.
    """
    if name in OF_A_BOX:
        return OF_A_BOX[name](box)
    more = {"radius": radius} if name == "hopping_trajectory" else {}
    return FROM_ROWS[name](box, rows, **more)
