"""The mean time between collisions of the discs."""

from twodiscs.figures import panels, times


def draw(scene, tables):
    """Draw the mean time in the box of ``scene``, with the rows of mean_times.csv."""
    radii, found = times.series(scene, tables, {"disc_collision": "disc collisions"})
    figure, main, lower = panels.panels(
        scene, r"mean time between collisions $\tau_{\mathrm{coll}}$"
    )
    series = list(found.values())
    panels.draw_series(main, lower, radii, series, single=True)
    times.small_law(main, scene, "disc_collision")
    times.last_law(main, scene, "disc_collision")
    panels.logarithmic(main, radii, series)
    panels.legend(main, scene, series, "beside", single="MD")
    return figure
