"""Typeset the manuscript from the results, and write the table of the numbers that it prints."""

import json
import os
import platform
import subprocess
from importlib.metadata import version
from pathlib import Path

from twodiscs.dynamics.intervals import RETURNS
from twodiscs.figures.catalogue import FIGURES
from twodiscs.model.checks import InputError
from twodiscs.pipeline.arguments import Parser, parameters, run
from twodiscs.pipeline.configuration.files import Files
from twodiscs.pipeline.configuration.load import load
from twodiscs.pipeline.documents.captions import said
from twodiscs.pipeline.numbers.rounding import whole
from twodiscs.pipeline.numbers.table import PaperNumbers, numbers, read, table_rows
from twodiscs.sampling.montecarlo import COST_RATIO
from twodiscs.studies.catalogue import STUDY_FIGURES

#: What the manuscript names the versions of, beside Python.
PACKAGES = ("snakemake", "numpy", "numba", "scipy", "matplotlib", "typst")


def captions(results, scene):
    """Return {figure: (its own caption, what others explain alike or "", which of the ``NOTES``)}.

    ``scene`` is the one that the manuscript is about; see ``captions.said``.
    """
    return {
        name: (*said(entry, results, scene), entry.note)
        for name, entry in (FIGURES | STUDY_FIGURES).items()
    }


def commit(folder):
    """Return the commit that ``folder`` is at, marked where files differ from it, or "unknown"."""
    words = ("git", "-C", folder, "describe", "--always", "--abbrev=12", "--exclude=*")
    try:
        run = subprocess.run(
            [*words, "--dirty= with changes"], capture_output=True, text=True, check=True
        )
    except (OSError, subprocess.CalledProcessError):
        return "unknown"
    return run.stdout.strip()


def versions():
    """Return {name: version} of Python and of the packages that do the work."""
    return {"python": platform.python_version()} | {name: version(name) for name in PACKAGES}


def printed(contents):
    """Return {name: ``Number``} of all that the manuscript prints, see ``typeset``."""
    scenes = contents["scenes"]
    found = numbers(read(contents["results"], scenes), scenes)
    constants = {"dearer": COST_RATIO, "intervals": RETURNS, "seed": contents["seed"]}
    return found | {name: whole(value) for name, value in constants.items()}


def typeset(template, output, contents, found):
    """Compile the Typst file ``template`` to the PDF file ``output``.

    ``contents`` are as ``Files.manuscript`` returns them, and ``found`` is {name: ``Number``}. The
    template finds them under ``sys.inputs.contents``, as JSON: the texts of ``numbers``, the
    ``captions`` of all figures, the ``commit`` of the template, the ``versions``, and ``results``,
    their folder, as a path from the root that results and the project have in common. The same
    inputs at the same commit give the same bytes on every machine: fonts are those that come with
    Typst.
    Raises ``InputError`` if the template does not compile.
    """
    import typst

    results = os.path.abspath(contents["results"])
    folder = os.path.dirname(os.path.abspath(template))
    root = os.path.commonpath([results, os.path.dirname(folder)])  # CITATION.cff is there
    contents = contents | {
        "captions": captions(results, contents["scenes"][0]),
        "commit": commit(folder),
        "numbers": {name: number.text for name, number in found.items()},
        "results": "/" + os.path.relpath(results, root).replace(os.sep, "/"),
        "versions": versions(),
    }
    try:
        typst.compile(
            template,
            output=output,
            root=root,
            ignore_system_fonts=True,
            sys_inputs={"contents": json.dumps(contents)},
        )
    except typst.TypstError as error:
        raise InputError(f"{template} does not compile: {error.message}; {error.trace}") from None


def main():
    parser = Parser(prog="twodiscs.pipeline.documents.manuscript", description=__doc__)
    parser.add_argument("--results", required=True, help="the folder of all results")
    parser.add_argument(
        "--configuration",
        help="JSON, or a file of it as @PATH; by default configuration.json of the results",
    )
    parser.add_argument("--template", required=True, help="the Typst file")
    parser.add_argument("--numbers", required=True, metavar="CSV", help="the table of the numbers")
    parser.add_argument("--output", required=True, metavar="PDF", help="the manuscript")
    options = parser.parse_args()
    kept = f"@{Path(options.results, 'configuration.json')}"
    configuration = load(parameters(options.configuration or kept))
    contents = Files(configuration, options.results).manuscript(options.results)
    found = printed(contents)
    PaperNumbers.write(options.numbers, table_rows(found))
    typeset(options.template, options.output, contents, found)


if __name__ == "__main__":
    run(main)
