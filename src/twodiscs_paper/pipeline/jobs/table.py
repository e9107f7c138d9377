"""Make a table of a scene from its points and the exact values.

    python -m twodiscs_paper.pipeline.jobs.table mean_times --width 1.5 --height 1 \\
        --theory results/paper/theory.csv --dynamics results/paper/points/dynamics/*.json \\
        --output results/paper/mean_times.csv
"""

import inspect
from pathlib import Path

from twodiscs.arguments import Parser, add_box, box_of, number, run, whole_number
from twodiscs.comparison.scene_tables import SCENE_TABLES
from twodiscs.comparison.tables.cost import Forecast
from twodiscs.points.digests import read_seconds
from twodiscs.points.dynamics import DynamicsPoint
from twodiscs.points.intervals import IntervalsPoint
from twodiscs.points.monte_carlo import MonteCarloPoint

#: The points of each stage.
POINTS = {point.stage: point for point in (MonteCarloPoint, DynamicsPoint, IntervalsPoint)}


def forecast(path, scene):
    """Return {(stage, radius): seconds} of a scene in the forecast at ``path``, {} without one."""
    return {
        (row["stage"], row["radius"]): row["seconds"]
        for row in (Forecast.read(path) if path else [])
        if row["scene"] == scene and row["radius"] is not None
    }


def rows_of(table, **given):
    """Return the rows of a ``table``, a class, from those arguments that its function takes."""
    taken = inspect.signature(table.rows).parameters
    return table.rows(**{name: value for name, value in given.items() if name in taken})


def main():
    parser = Parser(prog=__spec__.name, description=__doc__.split("\n")[0])
    parser.add_argument("table", choices=SCENE_TABLES)
    add_box(parser)
    parser.add_argument("--radii", nargs="*", type=number, default=[], help="grid, theory: radii")
    parser.add_argument("--radius", type=number, help="trajectory: the radius")
    parser.add_argument("--seed", type=whole_number, help="trajectory: of the random numbers")
    parser.add_argument("--areas", nargs="*", default=[], help="areas, check: their events")
    parser.add_argument("--theory", metavar="CSV", help="the exact values")
    for stage in POINTS:
        parser.add_argument(f"--{stage}", nargs="*", default=[], metavar="JSON", help="points")
    parser.add_argument("--forecast", nargs="?", metavar="CSV", help="cost: the forecast")
    parser.add_argument("--output", required=True, type=Path, metavar="CSV")
    options = parser.parse_args()
    given = {name: getattr(options, name) for name in ("radii", "radius", "seed", "areas")}
    given["box"] = box_of(options)
    given["theory"] = options.theory and SCENE_TABLES["theory"].read(options.theory)
    paths = {stage: getattr(options, stage) for stage in POINTS}
    given["points"] = {stage: [*map(POINTS[stage].read, some)] for stage, some in paths.items()}
    if options.table == "cost":
        given["seconds"] = {
            (stage, point.radius): read_seconds(path)
            for stage, some in given["points"].items()
            for point, path in zip(some, paths[stage], strict=True)
        }
        given["forecast"] = forecast(options.forecast, options.output.parent.name)
    table = SCENE_TABLES[options.table]
    table.write(options.output, rows_of(table, **given))


if __name__ == "__main__":
    run(main)
