"""The volume of configuration space over the radius."""

from twodiscs.figures.radius.over_radius import over_radius


def draw(box, tables):
    """Draw the volume of a ``Box``, with the rows of volume.csv."""
    names = {"volume": "volume"}
    return over_radius(box, tables, names, "volume $V$", "lower left", single="Monte Carlo")


def caption(shown):
    """Return the caption."""
    return """
    Volume of configuration space against the radius of the discs: exact (line) and by Monte Carlo
    sampling (symbols).
    """
