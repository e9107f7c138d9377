"""Typeset the manuscript; the template reads every number and figure from the results."""

import json
import os

from twodiscs.cli import arguments
from twodiscs.figures.catalogue import FIGURES, SHARED


def typeset(template, output, contents):
    """Compile the Typst file ``template`` to the PDF file ``output``.

    The template finds ``contents`` under ``sys.inputs.contents``, as JSON, with the captions of all
    figures added as ``captions``; its entry ``results``, their folder, is there a path from the
    root that template and results have in common. The same inputs give the same bytes on every
    machine: fonts are those that come with Typst. Raises ``ValueError`` if the template does not
    compile.
    """
    import typst

    results = os.path.abspath(contents["results"])
    root = os.path.commonpath([results, os.path.dirname(os.path.abspath(template))])
    place = "/" + os.path.relpath(results, root).replace(os.sep, "/")
    captions = {name: entry.caption for name, entry in (FIGURES | SHARED).items()}
    contents = {**contents, "captions": captions, "results": place}
    try:
        typst.compile(
            template,
            output=output,
            root=root,
            ignore_system_fonts=True,
            sys_inputs={"contents": json.dumps(contents)},
        )
    except typst.TypstError as error:
        raise ValueError(f"{template} does not compile: {error.message}; {error.trace}") from None


def main():
    parser = arguments.Parser(prog="python -m twodiscs.cli.manuscript", description=__doc__)
    parser.add_argument("--template", required=True, help="the Typst file")
    parser.add_argument("--parameters", required=True, help="a dict of results, scenes")
    parser.add_argument("--output", required=True, help="the PDF file")
    options = parser.parse_args()
    typeset(options.template, options.output, arguments.parameters(options.parameters))


if __name__ == "__main__":
    arguments.run(main)
