"""The volume of configuration space."""

from twodiscs.figures import curves, panels


def draw(scene, tables):
    """Draw the volume of the box of ``scene`` over the radius, with the rows of volume.csv."""
    radii, exact = curves.exact(scene)
    series = [panels.Series("volume", tables["volume"], exact["volume"])]
    figure, main, lower = panels.panels(scene, "volume $V$")
    panels.draw_series(main, lower, radii, series, single=True)
    panels.logarithmic(main, radii, series)
    panels.legend(main, scene, series, "lower left", single="Monte Carlo")
    return figure
