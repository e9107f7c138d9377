"""A table of a scene: exact values, a trajectory, or its points beside the exact values."""

import inspect
from pathlib import Path

from twodiscs.analysis.tables import SCENE_TABLES
from twodiscs.model.box import Box
from twodiscs.points.dynamics_point import DynamicsPoint
from twodiscs.points.intervals_point import IntervalsPoint
from twodiscs.points.monte_carlo_point import MonteCarloPoint
from twodiscs_paper.pipeline.job import start
from twodiscs_paper.pipeline.points import read_point, read_seconds

start(snakemake.log[0])
table = SCENE_TABLES[Path(snakemake.output.table).stem]
given = snakemake.params.given | {"box": Box(**snakemake.params.box), "points": [], "seconds": {}}
for kind in (MonteCarloPoint, DynamicsPoint, IntervalsPoint):
    for path in snakemake.input.get(kind.stage, []):
        given["points"].append(point := read_point(kind, path))
        given["seconds"][kind.stage, point.radius] = read_seconds(path)
taken = inspect.signature(table.rows).parameters
rows = table.rows(**{name: value for name, value in given.items() if name in taken})
table.write(snakemake.output.table, rows)
