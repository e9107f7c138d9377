"""The sums at one radius, or those of a shard of the work: JSON with a digest."""

import time

from twodiscs_paper.pipeline.job import start  # isort: split

import twodiscs.sampling.jit  # noqa: F401 - numba is imported before start, which saves 0.12 s
from twodiscs.dynamics.stages import STAGES
from twodiscs.model.scene import Scene
from twodiscs.points.base import file_content, write_json
from twodiscs_paper.pipeline.points import check_coverage, read_seconds, read_shards

start(snakemake.log[0])
wildcards, paths = snakemake.wildcards, snakemake.input.get("shards", [])
params, stage = snakemake.params, STAGES[snakemake.wildcards.stage]
scene = Scene(**params.box, radius=float(wildcards.radius))
run, before = stage.run(scene, params.work), time.process_time()
if name := wildcards.get("component"):
    first, stop = int(wildcards.first), int(wildcards.stop)
    components = {name: {"sums": {(first, stop): run.components[name].work(first, stop)}}}
elif paths:
    shards = read_shards(paths, stage, scene, params.shard_work)
    ranges = {name: check_coverage(run.components[name], shards[name]) for name in run.components}
    components = run.point(ranges).components
else:
    components = run.run().components
content = file_content(stage.call, scene.parameters(), params.work, components)
of_shards = sum(read_seconds(path) or 0.0 for path in paths)
write_json(snakemake.output.point, content, round(time.process_time() - before + of_shards, 2))
