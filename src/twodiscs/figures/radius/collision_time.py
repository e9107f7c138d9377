"""The mean time between disc collisions over the radius."""

from twodiscs.figures.radius.over_radius import over_radius


def draw(box, tables):
    """Draw the mean time between disc collisions in a ``Box``, with the rows of mean_times.csv."""
    names = {"disc_collision_time": "disc collisions"}
    label = r"mean time between collisions $\tau_{\mathrm{coll}}$"
    return over_radius(box, tables, names, label, "best", single="MD", laws=("small", "last"))


def caption(shown):
    """Return the caption."""
    text = """
    Mean time between collisions of the discs: exact (line) and by event-driven molecular dynamics
    (symbols).
    """
    if shown.many:
        text += "Collisions are those of any pair. "
    if shown.plain:
        text += """
        Dashed lines are the first two orders of the law for small discs, which starts as
        3wh/(8√2 r), and the limiting law below the largest radius.
        """
    return text
