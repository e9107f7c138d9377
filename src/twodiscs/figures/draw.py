"""``draw`` returns a figure of a scene by its name. Each figure is a function of another module."""

from functools import partial

from twodiscs.figures import box_drawings, configuration_space, motion, radius

#: {figure: function of a ``Box`` and of the rows of its table}
TABLE_FIGURES = {name: partial(radius.draw, name) for name in radius.CURVES} | {
    "all_areas": radius.draw_areas,
    "pressure": radius.draw_pressure,
    "hop_histogram": motion.draw_hop_histogram,
    "hopping_trajectory": motion.draw_trajectory,
}

#: {drawing: function of a ``Box``}
BOX_DRAWINGS = {
    "model": box_drawings.draw_model,
    "configuration_space": configuration_space.draw,
    "largest_radius": box_drawings.draw_largest_radius,
    "integration_regimes": box_drawings.draw_regimes,
    "surface_shell": box_drawings.draw_shells,
}


def draw(name, box, rows=None, radius=None):
    """Return the figure ``name`` of a ``Box``, with the ``rows`` of its table if it has one.

    ``FIGURES`` of ``scene_figures`` has the names; ``mean_times`` and ``areas`` show all events of
    these tables in one panel. The ``radius`` of a trajectory, if given, is written above it.
    """
    if name in BOX_DRAWINGS:
        return BOX_DRAWINGS[name](box)
    more = {"radius": radius} if name == "hopping_trajectory" else {}
    return TABLE_FIGURES[name](box, rows, **more)
