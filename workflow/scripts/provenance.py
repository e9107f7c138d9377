"""The origin of the results."""

import json
from pathlib import Path

from twodiscs_paper.pipeline.job import start
from twodiscs_paper.pipeline.results.provenance import provenance

start(snakemake.log[0])
origin = provenance(snakemake.params.sources, snakemake.input.files)
text = json.dumps(origin, indent=1) + "\n"
Path(snakemake.output.json).write_text(text, encoding="utf-8")
