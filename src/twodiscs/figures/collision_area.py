"""The area of the surface of disc collisions."""

from twodiscs.figures import areas, panels


def draw(scene, tables):
    """Draw the area in the box of ``scene`` over the radius, with the rows of areas.csv."""
    radii, found = areas.series(scene, tables, {"disc_collision": "disc collisions"})
    figure, main, lower = panels.panels(scene, r"collision area $A_{\mathrm{coll}}$")
    panels.draw_series(main, lower, radii, found, single=True)
    panels.logarithmic(main, radii, found)
    panels.legend(main, scene, found, "lower left", single="Monte Carlo")
    return figure
