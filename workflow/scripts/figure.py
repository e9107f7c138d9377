"""A figure, or the animation, from its tables."""

from twodiscs_paper.pipeline.job import start  # isort: split

from twodiscs.figures import animation, draw, style
from twodiscs.model.scene import Box
from twodiscs.points.base import digest, digest_line
from twodiscs_paper.catalogue import STUDY_FIGURES, read_table

start(snakemake.log[0])
params, wildcards, files = snakemake.params, snakemake.wildcards, snakemake.input
paths = zip(params.names, files.tables, strict=True)
tables = {name: read_table(path) for name, path in paths}
box = params.box and Box(**params.box)
name, radius = wildcards.figure, params.radius
with style.context():
    if name == "animation":
        animation.animate(box, radius, tables["trajectory"], list(snakemake.output))
    else:
        if name in STUDY_FIGURES:
            from twodiscs_paper.draw import DRAW  # which imports what studies measure with

            figure = DRAW[name](box, tables)
        else:
            figure = draw.draw(name, box, *tables.values(), radius=radius)
        scene = f"scene {wildcards.scene}, " if wildcards.get("scene") else ""
        # Not of this script: one that git fetched from elsewhere lacks its last newline.
        code = digest(*files.code[1:], *files.own_code)[:16]
        origin = f"twodiscs: {scene}seed {params.seed}, code {code}"
        if tables:
            origin += f", tables {digest(*files.tables)[:16]}"
        for path in snakemake.output:
            style.save(figure, path, origin)
for path in snakemake.output:
    print(digest_line(path))
