"""The area of the surface of a hop over the radius."""

from twodiscs.figures.radius.over_radius import over_radius
from twodiscs.model.events import AXIS


def draw(box, tables, hop):
    """Draw the area of a ``hop`` in a ``Box``, with the rows of areas.csv.

    No sample can be in the shell of a blocked hop: this exact result is a symbol at 0.
    """
    direction = hop.removesuffix("_hop")
    label = rf"root of the {direction}-hop area, $\sqrt{{S_{{\mathrm{{{direction[0]}}}}}}}$"
    shown = {name: [_counted(row) for row in rows] for name, rows in tables.items()}
    names = {f"{hop}_area": f"{direction} hops"}
    return over_radius(box, shown, names, label, "lower left", single="Monte Carlo", rooted=True)


def _counted(row):
    if row["exact"] == 0 and row.get("hits") == 0:
        return row | {"estimate": 0.0, "stderr": 0.0}
    return row


def caption(shown, hop):
    """Return the caption."""
    q = AXIS[hop]
    if shown.many:
        text = f"""
        Square root of the area of the surfaces on which two discs have the same {q}, summed over
        all pairs: exact (line) and from thin shells around them (symbols).
        """
    else:
        text = f"""
        Square root of the area of the surface {q}1 = {q}2, which the discs cross when they exchange
        their {hop.removesuffix("_hop")} order: exact (line) and from a thin shell around it
        (symbols).
        """
    if shown.any_row(lambda row: row["exact"] == 0 and row["hits"] == 0):
        text += "A symbol at zero means that no sample was in the shell of a blocked hop. "
    return text + "If an area ends quadratically, its square root ends as a straight line."
