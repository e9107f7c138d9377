"""The sums at one radius, or those of a shard of the work: JSON with a digest."""

import time

import twodiscs.sampling.jit  # noqa: F401 - start saves collections of what is imported before it
from twodiscs.model.box import Box
from twodiscs.points.base import content_of, write_json
from twodiscs_paper.pipeline.job import start
from twodiscs_paper.pipeline.points import KINDS, joined, pieces_of, read_seconds, run_of

start(snakemake.log[0])
wildcards, shards = snakemake.wildcards, snakemake.input.get("shards", [])
box, settings = snakemake.params.box, snakemake.params.work
scene = Box(**box).scene(float(wildcards.radius))
run, before = run_of(wildcards.stage, scene, settings), time.process_time()
if part := wildcards.get("part"):
    first, stop = int(wildcards.first), int(wildcards.stop)
    parts = {part: {"sums": {(first, stop): run.parts[part].work(first, stop)}}}
elif shards:
    pieces = pieces_of(shards)
    parts = run.point({name: joined(run.parts[name], pieces[name]) for name in run.parts}).parts
else:
    parts = run.run().parts
content = content_of(KINDS[wildcards.stage], box | {"radius": scene.radius}, settings, parts)
of_shards = sum(read_seconds(path) or 0.0 for path in shards)
write_json(snakemake.output.point, content, round(time.process_time() - before + of_shards, 2))
