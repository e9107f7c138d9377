"""The area of the surface of vertical hops, y1 = y2."""

from twodiscs.figures import areas


def draw(scene, tables):
    """Draw the area in the box of ``scene`` over the radius, with the rows of areas.csv."""
    return areas.hop(scene, tables, "vertical_hop", r"vertical-hop area $A_{\mathrm{v}}$")
