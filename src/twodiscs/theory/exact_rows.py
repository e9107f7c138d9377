"""The rows of the exact tables of a scene, grid.csv and theory.csv."""

from twodiscs.theory.exact import exact


def grid_rows(box, radii):
    """Return the rows of grid.csv of a ``Box``, one for each radius."""
    return [
        {
            "radius": scene.radius,
            "regime": scene.regime,
            "ergodic_components": scene.ergodic_components,
            "largest_radius": scene.largest_radius,
        }
        for scene in map(box.scene, radii)
    ]


def theory_rows(box, radii):
    """Return the rows of theory.csv of a ``Box``, radius by radius."""
    found = []
    for radius in radii:
        numbers = exact(box.scene(radius))
        values = {"volume": numbers["volume"]}
        values |= {f"{event}_area": area for event, area in numbers["areas"].items()}
        values |= {f"{event}_time": time for event, time in numbers["mean_times"].items()}
        found += [{"radius": radius, "quantity": q, "exact": x} for q, x in values.items()]
    return found
