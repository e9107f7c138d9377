"""A table of a scene: exact values, a trajectory, or its points beside the exact values."""

import inspect
from pathlib import Path

from twodiscs.comparison.tables import SCENE_TABLES
from twodiscs.model.box import Box
from twodiscs.points.dynamics import DynamicsPoint
from twodiscs.points.intervals import IntervalsPoint
from twodiscs.points.monte_carlo import MonteCarloPoint
from twodiscs_paper.pipeline.job import start
from twodiscs_paper.pipeline.points import read_point, read_seconds

start(snakemake.log[0])
table = SCENE_TABLES[Path(snakemake.output.table).stem]
given = snakemake.params.given | {"box": Box(**snakemake.params.box)}
if snakemake.input.get("theory"):
    given |= {"theory": SCENE_TABLES["theory"].read(snakemake.input.theory)}
    given |= {"points": {}, "seconds": {}}
    for kind in (MonteCarloPoint, DynamicsPoint, IntervalsPoint):
        paths = snakemake.input.get(kind.stage)
        points = given["points"][kind.stage] = [read_point(kind, path) for path in paths]
        for point, path in zip(points, paths, strict=True):
            given["seconds"][kind.stage, point.radius] = read_seconds(path)
taken = inspect.signature(table.rows).parameters
rows = table.rows(**{name: value for name, value in given.items() if name in taken})
table.write(snakemake.output.table, rows)
