"""The area of the surface of disc collisions over the radius."""

from twodiscs.figures.radius.over_radius import over_radius


def draw(box, tables):
    """Draw the area of disc collisions in a ``Box``, with the rows of areas.csv."""
    names = {"disc_collision_area": "disc collisions"}
    label = r"collision area $S_{\mathrm{coll}}$"
    return over_radius(box, tables, names, label, "lower left", single="Monte Carlo")


def caption(shown):
    """Return the caption."""
    text = """
    Area of the surface on which the discs touch: exact (line) and from a thin shell outside it
    (symbols).
    """
    return text + ("It is the sum over all pairs of discs." if shown.many else "")
