"""The mean times between hops over the radius."""

from twodiscs.figures.kit.captions import STRIP, is_unknown
from twodiscs.figures.radius.over_radius import over_radius


def draw(box, tables):
    """Draw the mean times between hops in a ``Box``, with the rows of mean_times.csv."""
    names = {"vertical_hop_time": "vertical hops", "horizontal_hop_time": "horizontal hops"}
    label = r"mean time between hops $\tau$"
    return over_radius(box, tables, names, label, "upper left", laws=("small",), approach=True)


def caption(shown):
    """Return the caption."""
    text = """
    Mean times between successive hops: exact (lines) and by event-driven molecular dynamics
    (symbols).
    """
    if shown.rows is None or not is_unknown(shown.rows):
        text += "In (b) the same times approach the radius r_c at which the hop ends. "
    if shown.plain:
        text += """
        Dashed lines in (a) are the laws for small discs, to first order in r. In (b) they are the
        limiting laws: if a hop becomes blocked before the discs jam, its time diverges as
        (r_c − r)⁻².
        """
    if shown.square and shown.shows("vertical_hop_time", "horizontal_hop_time"):
        text += "In a square box both hops have the same mean time. "
    if shown.many:
        text += "Hops are those of any pair of discs. "
    return text + shown.if_any(lambda row: row.get("starts") == "strip", STRIP)
