"""The exact values of a scene: grid.csv and theory.csv."""

from twodiscs.comparison.tables.base import COUNT, LENGTH, RADIUS, TEXT, Column, Table
from twodiscs.model.checks import InputError
from twodiscs.theory.exact import exact


class Grid(Table):
    """One row per radius that the scene computes."""

    columns = {
        "radius": RADIUS,
        "regime": TEXT("all-hops, vertical-hops, horizontal-hops or no-hops"),
        "ergodic_components": COUNT(
            "disjoint parts of configuration space; empty if not known, for more than two discs"
        ),
        "largest_radius": LENGTH(
            "largest radius at which the discs fit, as far as an arrangement of them is known"
        ),
    }

    @staticmethod
    def rows(box, radii):
        """Return the rows of a ``Box``, one for each radius."""
        return [
            {
                "radius": scene.radius,
                "regime": scene.regime,
                "ergodic_components": scene.ergodic_components,
                "largest_radius": scene.largest_radius,
            }
            for scene in map(box.scene, radii)
        ]


class Theory(Table):
    """One row per radius and quantity: the exact values."""

    columns = {
        "radius": RADIUS,
        "quantity": TEXT("volume, <event>_area or <event>_time"),
        "exact": Column(
            float,
            "length⁴, length³ or time",
            "exact value, empty if none is known; if the event is impossible, the area is 0 and "
            "the time is empty",
        ),
    }

    @staticmethod
    def rows(box, radii):
        """Return the rows of a ``Box``, radius by radius."""
        rows = []
        for radius in radii:
            numbers = exact(box.scene(radius))
            values = {"volume": numbers["volume"]}
            values |= {f"{event}_area": area for event, area in numbers["areas"].items()}
            values |= {f"{event}_time": time for event, time in numbers["mean_times"].items()}
            rows += [{"radius": radius, "quantity": q, "exact": x} for q, x in values.items()]
        return rows


class ExactValues(dict):
    """{(radius, quantity): exact value or None}, made of the rows of theory.csv."""

    def __init__(self, theory):
        super().__init__({(row["radius"], row["quantity"]): row["exact"] for row in theory})

    def __missing__(self, wanted):
        radius, quantity = wanted
        raise InputError(f"theory.csv has no {quantity} at radius {radius!r}")
