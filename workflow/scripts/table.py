"""A table of a scene: exact values, a trajectory, or its points beside the exact values."""

import inspect
from pathlib import Path

from twodiscs_paper.pipeline.job import start  # isort: split

from twodiscs.analysis.tables import SCENE_TABLES
from twodiscs.dynamics.stages import STAGES
from twodiscs.model.scene import Box
from twodiscs_paper.pipeline.points import read_point, read_seconds

start(snakemake.log[0])
table = SCENE_TABLES[Path(snakemake.output.table).stem]
box = Box(**snakemake.params.box)
given = snakemake.params.given | {"box": box, "points": [], "seconds": {}}
for stage, settings in snakemake.params.get("work", {}).items():
    for path in snakemake.input[stage]:
        scene = box.scene(float(Path(path).stem))
        given["points"].append(read_point(path, STAGES[stage], scene, settings))
        given["seconds"][stage, scene.radius] = read_seconds(path)
taken = inspect.signature(table.rows).parameters
rows = table.rows(**{name: value for name, value in given.items() if name in taken})
table.write_and_log(snakemake.output.table, rows)
