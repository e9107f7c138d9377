"""The tables of a scene, from the files of its points and the exact values."""

import json
from pathlib import Path

import numpy as np

from twodiscs.comparison import check, rows
from twodiscs.model.checks import InputError, one_of
from twodiscs.model.events import EVENTS
from twodiscs.sampling.strata import mean_of

#: What a strip of a point of dynamics has.
STRIP = ("duration", "share", "replicas", "count", "squares", "status", "strata")
#: What is the sum of a part of the strata, and of which one.
STRATA = {"replicas": "starts", "count": "counts", "squares": "squares"}

STAGES = ("monte_carlo", "dynamics", "intervals")

#: What the file of a point has, stage by stage, and that of what a job took.
FIELDS = {
    "monte_carlo": ("radius", "method", "samples", "quantities"),
    "dynamics": (
        "radius", "duration", "replicas", "counts", "products", "target", "status", "strips",
    ),
    "intervals": (
        "radius", "event", "bin_width", "counts", "intervals", "chains", "mean", "stderr",
    ),
    "cost": ("events", "seconds"),
}  # fmt: skip

#: Which of them are objects, by name.
OBJECTS = {
    "monte_carlo": ("quantities",),
    "dynamics": ("counts", "products", "target", "status", "strips"),
}


def _no_number(text):
    raise InputError(f"{text} is no number")


def _read(path, kind):
    """Return what the JSON file at ``path`` holds, an object with the ``FIELDS`` of its kind."""
    try:
        point = json.loads(Path(path).read_text(encoding="utf-8"), parse_constant=_no_number)
    except ValueError as error:
        raise InputError(f"{path} is not the file of a point: {error}") from None
    if not isinstance(point, dict):
        raise InputError(f"{path} is not the file of a point: it holds no JSON object")
    missing = [name for name in FIELDS[kind] if name not in point]
    if missing:
        raise InputError(f"{path} is not a file of {kind}: it has no {', '.join(missing)}")
    for name in OBJECTS.get(kind, ()):
        if not isinstance(point[name], dict):
            raise InputError(f"{path} is not a file of {kind}: {name} is not an object")
    for hop, found in point.get("strips", {}).items():
        _check_strip(f"{path} is not a file of {kind}: its strip of {hop}", found)
    return point


def _check_strip(text, found):
    """Raise ``InputError`` that begins with ``text`` unless a strip holds what it should."""
    if not isinstance(found, dict):
        raise InputError(f"{text} is not an object")
    missing = [name for name in STRIP if name not in found]
    if missing:
        raise InputError(f"{text} has no {', '.join(missing)}")
    try:
        mean_of(**found["strata"])
        sums = {name: np.sum(found["strata"][part]) for name, part in STRATA.items()}
    except (InputError, TypeError) as error:
        raise InputError(f"{text} has wrong strata: {error}") from None
    for name, total in sums.items():
        if total != found[name]:
            raise InputError(f"{text} has {name} {found[name]!r}, but in its strata {total}")


def read_points(folder, keys):
    """Return {stage: points} from the files ``folder``/stage/key.json; ``keys`` is {stage: keys}.

    Raises ``InputError`` for an unknown stage and a file that holds no point of its stage,
    ``OSError`` for a missing one.
    """
    found = {stage: [] for stage in STAGES}
    for stage, names in keys.items():
        one_of("stage", stage, STAGES)
        found[stage] = [_read(Path(folder, stage, f"{name}.json"), stage) for name in names]
    return found


def _scene_of(box, points):
    """Return the ``Scene`` of the first point there is; raise ``InputError`` without any."""
    radii = [point["radius"] for some in points.values() for point in some]
    if not radii:
        raise InputError("keys must name one point at least")
    return box.scene(radii[0])


def volume_rows(tables, points, box, keys, watched=EVENTS):
    """Return the rows of volume.csv; ``points`` is a list of the folder that holds them."""
    found = read_points(points[0], keys)
    return rows.volume_rows(rows.exact_values(tables["theory"]), found["monte_carlo"])


def areas_rows(tables, points, box, keys, watched=EVENTS):
    """Return the rows of areas.csv for the ``watched`` events."""
    found, exact = read_points(points[0], keys), rows.exact_values(tables["theory"])
    return rows.area_rows(_scene_of(box, found), exact, found["monte_carlo"], watched)


def mean_times_rows(tables, points, box, keys, watched=EVENTS):
    """Return the rows of mean_times.csv."""
    found, exact = read_points(points[0], keys), rows.exact_values(tables["theory"])
    return rows.mean_time_rows(_scene_of(box, found), exact, found["dynamics"])


def hop_histogram_rows(tables, points, box, keys, watched=EVENTS):
    """Return the rows of hop_histogram.csv."""
    found = read_points(points[0], keys)
    return rows.histogram_rows(rows.exact_values(tables["theory"]), found["intervals"])


def check_rows(tables, points, box, keys, watched=EVENTS):
    """Return the rows of check.csv."""
    found, exact = read_points(points[0], keys), rows.exact_values(tables["theory"])
    scene = _scene_of(box, found)
    compared = check.comparisons(
        scene,
        rows.volume_rows(exact, found["monte_carlo"]),
        rows.area_rows(scene, exact, found["monte_carlo"], watched),
        rows.mean_time_rows(scene, exact, found["dynamics"])
        + rows.seen_anyway(scene, exact, found["dynamics"]),
        rows.histogram_rows(exact, found["intervals"]),
        found["dynamics"],
    )
    return check.check_rows(compared)


def cost_rows(tables, points, keys, box=None, watched=EVENTS):
    """Return the rows of cost.csv, with the forecast of the scene if ``tables`` have one."""
    folder = Path(points[0])
    costs = [
        (stage, float(name), _read(folder / "cost" / f"{stage}-{name}.json", "cost"))
        for stage, names in keys.items()
        for name in names
    ]
    scene = folder.resolve().parent.name
    forecast = {
        (row["stage"], row["radius"]): row["seconds"]
        for row in tables.get("forecast", [])
        if row["scene"] == scene
    }
    return rows.cost_rows(costs, forecast)
