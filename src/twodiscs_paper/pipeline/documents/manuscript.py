"""The manuscript: Typst compiles it from the tables and figures of a build."""

import json
import os
from pathlib import Path

from twodiscs.analysis.columns import NUMBER, TEXT, Table
from twodiscs.dynamics.runs import CHAIN_HOPS
from twodiscs.dynamics.transmission import CLUSTER_PAUSE
from twodiscs.figures.scene_figures import FIGURES
from twodiscs.model.scene import Box
from twodiscs.sampling.montecarlo import PROPOSAL_TIME
from twodiscs_paper.catalogue import STUDY_FIGURES
from twodiscs_paper.pipeline.results.provenance import commit, versions

#: Numbers of the methods; they are in no table.
CONSTANTS = {"dearer": PROPOSAL_TIME, "intervals": CHAIN_HOPS, "passages_pause": CLUSTER_PAUSE}


class PaperNumbersTable(Table):
    """One row per number that the manuscript prints."""

    columns = {
        "name": TEXT("its name in the manuscript; table/row/column for a cell of a table"),
        "value": NUMBER("the number itself, if the text shows one number"),
        "text": TEXT("the printed text, as markup of Typst; empty for an empty cell"),
    }


def captions(scene):
    """Return {figure: (its own caption, the sentences that it shares with others or "")}.

    ``scene`` is the scene that the manuscript is about, with its "width" and "height".
    """
    box = Box(scene["width"], scene["height"])
    return {name: entry.captions(box) for name, entry in (FIGURES | STUDY_FIGURES).items()}


def typeset(template, output, scenes, figures, seed, configuration):
    """Compile the Typst file ``template`` to the PDF file ``output``; return its numbers.

    The numbers are rows of ``PaperNumbersTable``, from numbers.typ beside the template. Typst reads
    the tables and figures below the folder of ``output``. ``scenes`` are [{"name", "width",
    "height", "tables": [names], "figures": [names]}]; the manuscript is about the first one. The
    ``figures`` of studies are also names. ``configuration`` is its hash. The template finds all
    this as JSON under ``sys.inputs.contents``; ``results`` is a path there from the root that
    results and project have in common. The same inputs at the same commit give the same bytes on
    every machine, because only the fonts of Typst are used.
    """
    import typst

    # Without "..": Typst compares paths as texts.
    results, folder = (Path(os.path.abspath(path)).parent for path in (output, template))
    root = Path(os.path.commonpath([results, folder.parent]))  # CITATION.cff is there
    contents = {
        "captions": captions(scenes[0]),
        "commit": commit(folder),
        "configuration": configuration,
        "constants": CONSTANTS | {"seed": seed},
        "figures": figures,
        "results": f"/{results.relative_to(root).as_posix()}",
        "scenes": scenes,
        "versions": versions(),
    }
    given = {"root": root, "sys_inputs": {"contents": json.dumps(contents)}}
    given["ignore_system_fonts"] = True
    typst.compile(template, output=output, **given)
    numbers = folder / "numbers.typ"
    found = json.loads(typst.query(numbers, "<numbers>", field="value", one=True, **given))
    return [
        {"name": name, "value": number["value"], "text": number["text"] or None}
        for name, number in found.items()
        if number
    ]
