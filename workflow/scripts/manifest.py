"""The SHA-256 of results, as ``sha256sum`` writes it, unless a file is not what its job wrote."""

from pathlib import Path

from twodiscs.points.base import digest, require_logged
from twodiscs_paper.pipeline.job import start

start(snakemake.log[0])
manifest, lines = Path(snakemake.output.manifest), []
for path in snakemake.input.files:
    require_logged(path)
    lines.append((Path(path).relative_to(manifest.parent).as_posix(), digest(path)))
text = "".join(f"{sha256}  {name}\n" for name, sha256 in sorted(lines))
manifest.write_text(text, encoding="utf-8", newline="\n")
