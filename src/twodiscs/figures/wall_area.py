"""The areas of the surfaces where discs hit walls."""

from twodiscs.figures import areas, panels

EVENTS = {
    "right_wall": "disc 1, right wall",
    "top_wall": "disc 1, top wall",
    "any_wall": "any disc, any wall",
}


def draw(scene, tables):
    """Draw the areas in the box of ``scene`` over the radius, with the rows of areas.csv."""
    radii, found = areas.series(scene, tables, EVENTS)
    figure, main, lower = panels.panels(scene, r"wall area $A$")
    panels.draw_series(main, lower, radii, found)
    panels.logarithmic(main, radii, found)
    panels.legend(main, scene, found, "lower left")
    return figure
