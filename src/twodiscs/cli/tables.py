"""One table of a scene, from the files of its points and, but for cost, theory.csv.

    python -m twodiscs.cli.tables areas --scene "{'width': 1.5, 'height': 1.0}" \\
        --theory theory.csv --points points/monte_carlo/0.1.json … --output areas.csv
"""

import json
from pathlib import Path

from twodiscs import comparison, parameters, tables
from twodiscs.cli import arguments
from twodiscs.scene import EVENTS

#: The tables made here, and the points that each of them takes.
TAKES = {
    "volume": ("monte_carlo",),
    "areas": ("monte_carlo",),
    "mean_times": ("dynamics",),
    "hop_histogram": ("intervals",),
    "check": ("monte_carlo", "dynamics", "intervals"),
    "cost": ("cost",),
}

#: What tells the points apart.
MARKS = {
    "quantities": "monte_carlo",
    "products": "dynamics",
    "bin_width": "intervals",
    "seconds": "cost",
}


def _no_number(text):
    raise ValueError(f"{text} is no number")


def _read(path):
    """Return (kind, point) of one file."""
    try:
        point = json.loads(Path(path).read_text(encoding="utf-8"), parse_constant=_no_number)
    except ValueError as error:
        raise ValueError(f"{path} is not the file of a point: {error}") from None
    kinds = [kind for mark, kind in MARKS.items() if isinstance(point, dict) and mark in point]
    if len(kinds) != 1:
        raise ValueError(f"{path} is not the file of a point: it has none of {', '.join(MARKS)}")
    return kinds[0], point


def _cost(path, point):
    """Return (stage, radius, point); a cost file is called stage-radius.json."""
    stage, _, radius = Path(path).stem.partition("-")
    try:
        return stage, float(radius), point
    except ValueError:
        raise ValueError(f"{path} must be called <stage>-<radius>.json") from None


def _points(name, paths):
    """Return {kind: points} of the files at ``paths``, all of them of use to the table ``name``."""
    points = {kind: [] for kind in MARKS.values()}
    for path in paths:
        kind, point = _read(path)
        if kind not in TAKES[name]:
            raise ValueError(f"{path} is a {kind} point, of no use to {name}.csv")
        points[kind].append(_cost(path, point) if kind == "cost" else point)
    return points


def _forecast(path, scene):
    """Return {(stage, radius): seconds} of a scene from the forecast at ``path``, if any."""
    rows = tables.read(path, "forecast") if path else []
    return {(row["stage"], row["radius"]): row["seconds"] for row in rows if row["scene"] == scene}


def _rows(name, box, exact, points, forecast):
    """Return the rows of the table ``name``."""
    if name == "cost":
        return comparison.cost_rows(points["cost"], forecast)
    radius = next(point["radius"] for kind in TAKES[name] for point in points[kind])
    scene = parameters.scene(box, radius)
    watched = box.get("areas", EVENTS)
    found = {
        "volume": lambda: comparison.volume_rows(exact, points["monte_carlo"]),
        "areas": lambda: comparison.area_rows(scene, exact, points["monte_carlo"], watched),
        "mean_times": lambda: comparison.mean_time_rows(scene, exact, points["dynamics"]),
        "hop_histogram": lambda: comparison.histogram_rows(exact, points["intervals"]),
    }
    if name in found:
        return found[name]()
    rows = [make() for make in found.values()]
    return comparison.check_rows(comparison.comparisons(scene, *rows, points["dynamics"]))


def main():
    parser = arguments.Parser(prog="twodiscs.cli.tables", description="Write one table of a scene.")
    parser.add_argument("name", choices=TAKES)
    parser.add_argument("--scene", required=True, help="dict with width, height; areas, effects")
    parser.add_argument("--theory", help="theory.csv of the scene, needed by all tables but cost")
    parser.add_argument("--points", nargs="+", required=True, metavar="JSON")
    parser.add_argument("--forecast", help="forecast.csv, if there is one, for cost.csv")
    parser.add_argument("--output", required=True, metavar="CSV")
    options = parser.parse_args()

    box = arguments.parameters(options.scene)
    if options.theory is None and options.name != "cost":
        raise ValueError(f"{options.name}.csv needs --theory")
    theory = tables.read(options.theory, "theory") if options.theory else []
    points = _points(options.name, options.points)
    forecast = _forecast(options.forecast, Path(options.output).resolve().parent.name)
    try:
        rows = _rows(options.name, box, comparison.exact_values(theory), points, forecast)
    except (KeyError, TypeError, AttributeError) as error:
        raise ValueError(f"scene or points do not fit {options.name}.csv: {error!r}") from None
    tables.write(options.output, options.name, rows)


if __name__ == "__main__":
    arguments.run(main)
