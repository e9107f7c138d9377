"""A figure, or the animation, from its tables."""

from importlib import import_module

from twodiscs.figures.kit import style
from twodiscs.figures.motion import animation
from twodiscs.model.box import Box
from twodiscs.points.digests import digest
from twodiscs_paper.catalogue import ENTRIES, read_table
from twodiscs_paper.pipeline.job import start

start(snakemake.log[0])
params, wildcards, files = snakemake.params, snakemake.wildcards, snakemake.input
paths = zip(params.names, files.tables, strict=True)
tables = {name: read_table(path) for name, path in paths}
box = params.box and Box(**params.box)
more = {} if params.radius is None else {"radius": params.radius}
with style.context():
    if wildcards.figure == "animation":
        animation.animate(rows=tables["trajectory"], paths=list(snakemake.output), box=box, **more)
    else:
        module = import_module(ENTRIES[wildcards.figure].module)
        figure = module.draw(box=box, tables=tables, **params.options, **more)
        scene = f"scene {wildcards.scene}, " if wildcards.get("scene") else ""
        code = digest(*files.code, *files.own_code)[:16]
        origin = f"twodiscs: {scene}seed {params.seed}, code {code}"
        if tables:
            origin += f", tables {digest(*files.tables)[:16]}"
        for path in snakemake.output:
            style.save(figure, path, origin)
