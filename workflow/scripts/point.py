"""The counts at one radius, or those of a shard of the work: JSON with a digest."""

import time

from twodiscs.model.box import Box
from twodiscs.points.digests import read_json, read_seconds, write_json
from twodiscs.sampling.blocks.rounds import joined
from twodiscs_paper.pipeline.cost import run_of
from twodiscs_paper.pipeline.job import start

start(snakemake.log[0])
wildcards, shards = snakemake.wildcards, snakemake.input.get("shards", [])
scene = Box(**snakemake.params.box).scene(float(wildcards.radius))
run = run_of(wildcards.stage, scene, snakemake.params.work)
if wildcards.get("part"):
    first, stop = int(wildcards.first), int(wildcards.stop)
    sums = [array.tolist() for array in run.parts[wildcards.part].work(first, stop)]
    content = {"part": wildcards.part, "first": first, "stop": stop, "sums": sums}
elif shards:
    parts = {name: [] for name in run.parts}
    for path in shards:
        shard = read_json(path)
        parts[shard["part"]].append(shard)
    sums = {name: joined(part, parts[name]) for name, part in run.parts.items()}
    content = run.point(sums).content()
else:
    content = run.run().content()
of_shards = sum(read_seconds(path) or 0.0 for path in shards)
write_json(snakemake.output.point, content, round(time.process_time() + of_shards, 2))
