"""The tables of a scene, of its points and of the exact values.

    python -m twodiscs_paper.pipeline.jobs.table mean_times --width 1.5 --height 1 \\
        --theory results/paper/theory.csv --dynamics results/paper/points/dynamics/*.json \\
        --output results/paper/mean_times.csv
"""

import csv
import inspect
from pathlib import Path

from twodiscs.arguments import Parser, add_box, box_of, number, run, whole_number
from twodiscs.comparison.digests import read_json
from twodiscs.comparison.points import checked_point
from twodiscs.comparison.scene_tables import SCENE_TABLES
from twodiscs.comparison.tables.cost import Forecast
from twodiscs_paper.pipeline.configuration.request import STAGES


def read_points(stage, paths):
    """Return the points of a stage; raise ``InputError`` for a file that holds another thing."""
    return [checked_point(stage, read_json(path), path) for path in paths]


def measured(results, scene):
    """Return {(stage, radius): seconds} that the jobs of a scene took, as Snakemake measured them.

    A point in shards took what all of them did. ``results`` is the folder of all results.
    """
    points = {}
    for path in Path(results, "benchmarks", scene).glob("*/*.tsv"):
        stage, radius = path.parent.name, float(path.stem.split("_")[0])
        with open(path, encoding="utf-8", newline="") as file:
            seconds = sum(float(row["s"]) for row in csv.DictReader(file, delimiter="\t"))
        points[stage, radius] = points.get((stage, radius), 0.0) + seconds
    return points


def forecast(results, scene):
    """Return {(stage, radius): seconds} of the last forecast of a scene; empty without one."""
    path = Path(results, "forecast.csv")
    rows = Forecast.read(path) if path.exists() else []
    return {
        (row["stage"], row["radius"]): row["seconds"]
        for row in rows
        if row["scene"] == scene and row["radius"] is not None
    }


def rows_of(table, **given):
    """Return the rows of a ``table``, a class, of those of the arguments that it takes."""
    taken = inspect.signature(table.rows).parameters
    return table.rows(**{name: value for name, value in given.items() if name in taken})


def main():
    parser = Parser(prog=__spec__.name, description=__doc__.split("\n")[0])
    parser.add_argument("table", choices=SCENE_TABLES)
    add_box(parser)
    parser.add_argument("--radii", nargs="*", type=number, default=[], help="grid, theory: which")
    parser.add_argument("--radius", type=number, help="trajectory: the radius")
    parser.add_argument("--seed", type=whole_number, help="trajectory: of the random numbers")
    parser.add_argument("--areas", nargs="*", default=[], help="areas, check: of which events")
    parser.add_argument("--theory", metavar="CSV", help="the exact values")
    for stage in STAGES:
        parser.add_argument(f"--{stage}", nargs="*", default=[], metavar="JSON", help="points")
    parser.add_argument("--results", help="cost: the folder of all results")
    parser.add_argument("--output", required=True, type=Path, metavar="CSV")
    options = parser.parse_args()
    given = {name: getattr(options, name) for name in ("radii", "radius", "seed", "areas")}
    given["box"] = box_of(options)
    given["theory"] = options.theory and SCENE_TABLES["theory"].read(options.theory)
    given["points"] = {stage: read_points(stage, getattr(options, stage)) for stage in STAGES}
    if options.results:
        scene = options.output.parent.name
        given["seconds"] = measured(options.results, scene)
        given["forecast"] = forecast(options.results, scene)
    table = SCENE_TABLES[options.table]
    table.write(options.output, rows_of(table, **given))


if __name__ == "__main__":
    run(main)
