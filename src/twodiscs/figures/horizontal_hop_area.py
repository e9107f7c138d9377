"""The area of the surface of horizontal hops, x1 = x2."""

from twodiscs.figures import areas


def draw(scene, tables):
    """Draw the area in the box of ``scene`` over the radius, with the rows of areas.csv."""
    return areas.hop(scene, tables, "horizontal_hop", r"horizontal-hop area $A_{\mathrm{h}}$")
