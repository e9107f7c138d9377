"""SHA-256 of all results that are the same bytes on every run.

    python -m twodiscs_paper.pipeline.results.manifest results/paper/areas.csv … \\
        --output manifest.sha256

Names are relative to the folder of the manifest, as ``sha256sum --check`` reads them.
"""

from pathlib import Path

from twodiscs.arguments import Parser, run
from twodiscs.points.digests import digest
from twodiscs_paper.catalogue import STUDIES, STUDY_FIGURES

#: The tables with seconds that belong to no study, and the documents that show them.
TIMED = {"cost", "benchmark", "forecast", "paper", "paper_numbers", "report"}
TIMED |= {name for study in STUDIES.values() for name in study.timed}


def is_reproducible(path):
    """Return whether a result is the same bytes on every run: a table or figure without seconds."""
    path = Path(path)
    figure = STUDY_FIGURES.get(path.stem) if path.suffix != ".csv" else None
    timed = not TIMED.isdisjoint(figure.tables if figure else [path.stem])
    return path.suffix in (".csv", ".pdf", ".png", ".gif") and not timed


def manifest(folder, paths):
    """Return the sorted lines of ``sha256sum`` for the files at ``paths``, relative to ``folder``.

    Raises ``OSError`` for a file that cannot be read, ``ValueError`` for a file outside the folder.
    """
    names = sorted(Path(path).relative_to(folder).as_posix() for path in paths)
    return "".join(f"{digest(Path(folder, name))}  {name}\n" for name in names)


def main():
    parser = Parser(prog=__spec__.name, description=__doc__.split("\n")[0])
    parser.add_argument("files", nargs="+", metavar="FILE")
    parser.add_argument("--output", required=True, type=Path, metavar="FILE")
    options = parser.parse_args()
    text = manifest(options.output.parent, options.files)
    options.output.write_text(text, encoding="utf-8", newline="\n")


if __name__ == "__main__":
    run(main)
