"""The mean times between hits of the walls."""

from twodiscs.figures import panels, times

EVENTS = {
    "right_wall": "disc 1, right wall",
    "top_wall": "disc 1, top wall",
    "any_wall": "any disc, any wall",
}


def draw(scene, tables):
    """Draw the mean times in the box of ``scene``, with the rows of mean_times.csv."""
    radii, found = times.series(scene, tables, EVENTS)
    figure, main, lower = panels.panels(scene, r"mean time between wall hits $\tau$")
    series = list(found.values())
    panels.draw_series(main, lower, radii, series)
    for event in found:
        times.small_law(main, scene, event)
        times.last_law(main, scene, event)
    panels.logarithmic(main, radii, series)
    panels.legend(main, scene, series, "lower left")
    return figure
