"""Points: what a job found at one radius, a dict as read from its JSON file."""

from itertools import groupby

from twodiscs.model.checks import InputError, check_choice

#: The fields of the point of a stage.
FIELDS = {
    "monte_carlo": ("radius", "method", "samples", "quantities"),
    "dynamics": (
        "radius", "duration", "replicas", "counts", "products", "target", "status", "strips",
    ),
    "intervals": (
        "radius", "event", "bin_width", "counts", "intervals", "chains", "mean", "stderr",
    ),
}  # fmt: skip

#: Which of them are objects, by name.
OBJECTS = {
    "monte_carlo": ("quantities",),
    "dynamics": ("counts", "products", "target", "status", "strips"),
    "intervals": (),
}

#: The fields of a strip of a point of dynamics.
STRIP = ("duration", "share", "replicas", "count", "squares", "status", "strata")

#: The fields of a strip that are sums over its strata, {field: part of the strata}.
SUMS = {"replicas": "starts", "count": "counts", "squares": "squares"}


def checked_point(stage, point, path):
    """Return ``point`` if it is one of a ``stage``.

    Raises ``InputError`` that begins with ``path`` for anything else, and for a strip that is not
    the sum of its strata; and one for an unknown stage.
    """
    fields = FIELDS[check_choice("stage", stage, FIELDS)]
    start = f"{path} is not a point of {stage}: "
    if not isinstance(point, dict):
        raise InputError(f"{start}it is not a JSON object")
    _require(fields, point, f"{start}it")
    for name in OBJECTS[stage]:
        if not isinstance(point[name], dict):
            raise InputError(f"{start}{name} is not an object")
    for hop, strip in point.get("strips", {}).items():
        _check_strip(strip, f"{start}its strip of {hop}")
    return point


def _require(fields, block, what):
    missing = [name for name in fields if name not in block]
    if missing:
        raise InputError(f"{what} has no {', '.join(missing)}")


def _check_strip(strip, what):
    """Raise ``InputError`` that begins with ``what`` unless a strip holds what it should."""
    import numpy as np  # tables, which are quick to import, import this module

    from twodiscs.sampling.blocks.strata import mean_of

    if not isinstance(strip, dict):
        raise InputError(f"{what} is not an object")
    _require(STRIP, strip, what)
    try:
        mean_of(**strip["strata"])
        sums = {name: np.sum(strip["strata"][part]) for name, part in SUMS.items()}
    except (InputError, TypeError) as error:
        raise InputError(f"{what} has wrong strata: {error}") from None
    for name, total in sums.items():
        if total != strip[name]:
            raise InputError(f"{what} has {name} {strip[name]!r}, but in its strata {total}")


def by_radius(points):
    """Return ``points`` by radius; raises ``InputError`` if two of them share one."""
    points = sorted(points, key=lambda point: point["radius"])
    for radius, same in groupby(point["radius"] for point in points):
        if len(list(same)) > 1:
            raise InputError(f"points must not contain radius {radius!r} twice")
    return points
