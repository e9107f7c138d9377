"""The mean times between wall hits over the radius."""

from twodiscs.figures.radius.over_radius import WALLS, over_radius


def draw(box, tables):
    """Draw the mean times between wall hits in a ``Box``, with the rows of mean_times.csv."""
    names = {f"{event}_time": name for event, name in WALLS.items()}
    label = r"mean time between wall hits $\tau$"
    return over_radius(box, tables, names, label, "lower left", laws=("small", "last"))


def caption(shown):
    """Return the caption."""
    text = """
    Mean times between hits of walls: exact (lines) and by event-driven molecular dynamics
    (symbols).
    """
    if shown.many:
        text += "Times of disc 1 are averages over all initial conditions. "
    elif shown.shows("right_wall_time") or shown.shows("top_wall_time"):
        text += "Times of disc 1 are averages over trajectories that can reach the wall. "
    if shown.square and shown.shows("right_wall_time", "top_wall_time"):
        text += "In a square box the mean times of both walls are the same. "
    if shown.plain and shown.shows("right_wall_time") and shown.is_marked("h/4"):
        text += """
        The mean time of the right wall halves at r = h/4, where configuration space becomes
        disconnected and disc 1 keeps to one side.
        """
    if shown.plain and shown.shows("top_wall_time") and shown.is_marked("w/4"):
        text += """
        The mean time of the top wall halves at r = w/4, where disc 1 begins to keep to one side
        along y.
        """
    if shown.plain:
        text += "Dashed lines are the laws for small discs and below the largest radius."
    elif not shown.many and _keeps_side(shown):
        text += "The mean time of a wall halves at the radius from which disc 1 keeps to its side."
    return text


def _keeps_side(shown):
    """Return whether the figure shows a wall that disc 1 reaches only from its side of disc 2."""
    near = shown.box.scene(shown.box.last_radius * (1 - 1e-9))
    walls = zip(near.confined, ("right_wall_time", "top_wall_time"), strict=True)
    return any(confined and shown.shows(time) for confined, time in walls)
