"""The areas of the surfaces of wall hits over the radius."""

from twodiscs.figures.radius.over_radius import WALLS, over_radius


def draw(box, tables):
    """Draw the areas of wall hits in a ``Box``, with the rows of areas.csv."""
    names = {f"{event}_area": name for event, name in WALLS.items()}
    return over_radius(box, tables, names, "wall area $S$", "lower left")


def caption(shown):
    """Return the caption."""
    text = """
    Areas of the surfaces on which discs touch walls: exact (lines) and from thin shells (symbols).
    """
    if shown.square and shown.shows("right_wall_area", "top_wall_area"):
        text += "In a square box the areas of both walls are the same. "
    if shown.plain and shown.shows(*(f"{event}_area" for event in WALLS)):
        text += "The area of any wall and any disc is four times the sum of the two others."
    return text
