"""Typeset the manuscript from the results, and write the table of the numbers that it prints."""

import json
import os
from pathlib import Path

from twodiscs.arguments import Parser, named, run
from twodiscs.comparison.measured.transmission import QUIET
from twodiscs.dynamics.intervals import RETURNS
from twodiscs.figures.catalogue import FIGURES
from twodiscs.model.checks import InputError
from twodiscs.sampling.montecarlo import COST_RATIO
from twodiscs_paper.catalogue import STUDY_FIGURES
from twodiscs_paper.pipeline.documents.captions import caption_parts
from twodiscs_paper.pipeline.documents.formats import integer
from twodiscs_paper.pipeline.documents.numbers import PaperNumbers, printed, read, table_rows
from twodiscs_paper.pipeline.results.provenance import commit, versions

#: Numbers of the methods; they are in no table.
CONSTANTS = {"dearer": COST_RATIO, "intervals": RETURNS, "passages_pause": QUIET}


def captions(results, scene):
    """Return {figure: (its own caption, the sentences that it shares or "", its key in ``NOTES``)}.

    ``scene`` is the scene that the manuscript is about; see ``captions.caption_parts``.
    """
    return {
        name: (*caption_parts(entry, results, scene), entry.note)
        for name, entry in (FIGURES | STUDY_FIGURES).items()
    }


def numbers_of(contents):
    """Return {name: ``Printed``} of every number of the manuscript; see ``typeset``."""
    scenes = contents["scenes"]
    constants = CONSTANTS | {"seed": contents["seed"]}
    values = printed(read(contents["results"], scenes, contents["long_runs"]), scenes)
    return values | {name: integer(value) for name, value in constants.items()}


def typeset(template, output, contents, values):
    """Compile the Typst file ``template`` to the PDF file ``output``.

    ``contents`` are as ``contents_of`` returns them, with a "configuration" (its hash) and a
    "seed"; ``values`` is {name: ``Printed``}. The template finds them as JSON under
    ``sys.inputs.contents``. They also have the texts of ``numbers``, the ``captions`` of all
    figures, the ``commit`` of the template and the ``versions``. ``results`` is their folder there,
    as a path from the root that results and the project have in common. The same inputs at the same
    commit give the same bytes on every machine: only the fonts of Typst are used. Raises
    ``InputError`` if the template does not compile.
    """
    import typst

    results = os.path.abspath(contents["results"])
    folder = os.path.dirname(os.path.abspath(template))
    root = os.path.commonpath([results, os.path.dirname(folder)])  # CITATION.cff is there
    contents = contents | {
        "captions": captions(results, contents["scenes"][0]),
        "commit": commit(folder),
        "numbers": {name: number.text for name, number in values.items()},
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


def contents_of(files, boxes, output):
    """Return the figures and tables for the manuscript ``output``, a path in the folder of results.

    ``files`` are the paths of figures and tables. ``boxes`` is {scene: (width, height)}; the
    manuscript is about the first scene. The result is {"results": folder, "figures": [names of
    shared figures], "scenes": [{"name", "width", "height", "figures", "tables"}]}.
    """
    figures, tables = {None: []}, {None: []}
    for path in map(Path, files):
        table = path.suffix == ".csv"
        folder = path.parent if table else path.parent.parent
        own = folder.name if folder.name in boxes else None
        (tables if table else figures).setdefault(own, []).append(path.stem)
    scenes = [
        {"name": name, "width": width, "height": height}
        | {"figures": figures.get(name, []), "tables": tables.get(name, [])}
        for name, (width, height) in boxes.items()
    ]
    return {"results": str(Path(output).parent), "figures": figures[None], "scenes": scenes}


def box_sides(text):
    """Return (width, height) of a box in the form 1.5x1.0."""
    try:
        width, height = map(float, text.split("x"))
    except ValueError:
        raise InputError(f"the box of a scene must be as 1.5x1.0, not {text!r}") from None
    return width, height


def main():
    parser = Parser(prog=__spec__.name, description=__doc__)
    parser.add_argument("files", nargs="+", metavar="FILE", help="figures and tables, PDF and CSV")
    parser.add_argument("--template", required=True, help="the Typst file")
    parser.add_argument(
        "--boxes",
        nargs="+",
        required=True,
        metavar="SCENE=WIDTHxHEIGHT",
        help="scenes without effects; the manuscript is about the first one",
    )
    parser.add_argument("--seed", required=True, type=int, help="the seed of the configuration")
    parser.add_argument("--configuration", required=True, help="its hash")
    parser.add_argument(
        "--long-runs", nargs="*", default=[], metavar="NAME=CSV", help="tables that no build makes"
    )
    parser.add_argument("--numbers", required=True, metavar="CSV", help="the table of numbers")
    parser.add_argument("--output", required=True, metavar="PDF", help="the manuscript")
    options = parser.parse_args()
    boxes = {scene: box_sides(box) for scene, box in named(options.boxes, "boxes").items()}
    contents = contents_of(options.files, boxes, options.output)
    contents |= {"configuration": options.configuration, "seed": options.seed}
    contents |= {"long_runs": named(options.long_runs, "long-runs")}
    values = numbers_of(contents)
    PaperNumbers.write(options.numbers, table_rows(values))
    typeset(options.template, options.output, contents, values)


if __name__ == "__main__":
    run(main)
