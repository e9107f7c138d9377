"""The functions that draw the figures of the catalogue, by name."""

from functools import partial

from twodiscs.figures import configuration_space, geometry, motion, radius

#: {figure: function of a ``Box`` and of the rows of its table}
FROM_ROWS = {name: partial(radius.draw, name) for name in radius.OVER_RADIUS} | {
    "all_areas": radius.draw_areas,
    "pressure": radius.draw_pressure,
    "hop_histogram": motion.draw_hop_histogram,
    "hopping_trajectory": motion.draw_trajectory,
}

#: {drawing: function of a ``Box``}
OF_A_BOX = {
    "model": geometry.draw_model,
    "configuration_space": configuration_space.draw,
    "largest_radius": geometry.draw_largest_radius,
    "integration_regimes": geometry.draw_regimes,
    "surface_shell": geometry.draw_shells,
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
