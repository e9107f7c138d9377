"""What the figures of areas share: rows of areas.csv against exact areas."""

from twodiscs.figures import curves, panels


def series(scene, tables, events):
    """Return (radii of the curves, a ``Series`` for each of the ``events`` that areas.csv has).

    ``events`` is {event: name in the legend}. Where an area is zero and no sample fell into the
    shell, the estimate is zero.
    """
    radii, exact = curves.exact(scene)
    found = []
    for event, name in events.items():
        rows = [row for row in tables["areas"] if row["quantity"] == f"{event}_area"]
        rows = [
            row | {"estimate": 0.0, "stderr": 0.0}
            if row["exact"] == 0 and row["hits"] == 0
            else row
            for row in rows
        ]
        if rows:
            found.append(panels.Series(name, rows, exact[f"{event}_area"]))
    if not found:
        raise ValueError(f"areas.csv has no row of {', '.join(events)}")
    return radii, found


def hop(scene, tables, event, label):
    """Draw the area of one hop's surface, which is zero where the hop is blocked."""
    radii, found = series(scene, tables, {event: label})
    figure, main, lower = panels.panels(scene, label)
    panels.draw_series(main, lower, radii, found, single=True)
    panels.legend(main, scene, found, "lower left", single="Monte Carlo")
    return figure
