"""Draw a figure from its tables.

    python -m twodiscs_paper.pipeline.jobs.figure volume --width 1.5 --height 1 \\
        --tables volume=results/paper/volume.csv --output volume.pdf volume.png
"""

from importlib import import_module

from twodiscs.arguments import Parser, add_box, box_of, number, run
from twodiscs.points.digests import digest
from twodiscs_paper.catalogue import ENTRIES
from twodiscs_paper.pipeline.jobs.study import read_tables


def draw_figure(name, tables, box=None, **more):
    """Return the figure called ``name`` from ``tables``, {name: rows}."""
    draw = import_module(ENTRIES[name].module).draw
    return draw(box=box, tables=tables, **ENTRIES[name].options, **more)


def main():
    parser = Parser(prog=__spec__.name, description=__doc__.split("\n")[0])
    parser.add_argument("figure", choices=ENTRIES)
    add_box(parser, required=False)
    parser.add_argument("--radius", type=number, help="of a trajectory")
    parser.add_argument("--tables", nargs="*", default=[], metavar="NAME=CSV")
    parser.add_argument("--origin", default="", help="its origin, for its metadata")
    parser.add_argument("--output", nargs="+", required=True, metavar="FILE")
    options = parser.parse_args()
    tables, box = read_tables(options.tables), box_of(options)
    from twodiscs.figures.kit import style

    more = {} if options.radius is None else {"radius": options.radius}
    paths = [text.partition("=")[2] for text in sorted(options.tables)]
    made_of = f", tables {digest(*paths)[:16]}" if paths else ""
    with style.context():
        if options.figure == "animation":
            animate = import_module(ENTRIES["animation"].module).animate
            animate(rows=tables["trajectory"], paths=options.output, box=box, **more)
            return
        figure = draw_figure(options.figure, tables, box, **more)
        for path in options.output:
            style.save(figure, path, f"twodiscs: {options.origin}{made_of}")


if __name__ == "__main__":
    run(main)
