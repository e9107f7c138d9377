"""Typeset the manuscript; the template reads every number and figure from the results."""

import json
import os
import platform
import subprocess
from importlib.metadata import version

from twodiscs.dynamics.intervals import RETURNS
from twodiscs.figures.catalogue import FIGURES
from twodiscs.model.checks import InputError
from twodiscs.pipeline.arguments import Parser, parameters, run
from twodiscs.pipeline.documents.captions import said
from twodiscs.pipeline.results.record import write
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


def typeset(template, output, contents):
    """Compile the Typst file ``template`` to the PDF file ``output``.

    The template finds ``contents`` under ``sys.inputs.contents``, as JSON. Added are the
    ``captions`` of all figures, the ``commit`` of the template, the ``versions``, how many
    ``intervals`` a chain has, and how many times ``dearer`` conditioned samples are. Its entry
    ``results``, their folder, becomes a path from the root that results and the project have in
    common. The same inputs at the same commit give the same bytes on every machine: fonts are
    those that come with Typst.
    Raises ``InputError`` if the template does not compile.
    """
    import typst

    results = os.path.abspath(contents["results"])
    folder = os.path.dirname(os.path.abspath(template))
    root = os.path.commonpath([results, os.path.dirname(folder)])  # CITATION.cff is there
    contents = contents | {
        "captions": captions(results, contents["scenes"][0]),
        "commit": commit(folder),
        "dearer": COST_RATIO,
        "intervals": RETURNS,
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
    parser.add_argument("--template", required=True, help="the Typst file")
    parser.add_argument(
        "--parameters",
        required=True,
        help="configuration (its hash), figures and tables of no scene, results, scenes; JSON",
    )
    parser.add_argument("--output", required=True, help="the PDF file")
    options = parser.parse_args()
    given = parameters(options.parameters)
    typeset(options.template, options.output, given)
    write([options.output], {"template": [options.template]}, job="manuscript", parameters=given)


if __name__ == "__main__":
    run(main)
