"""Draw one figure of a scene.

    python -m twodiscs.cli.figure volume --scene "{'width': 1.5, 'height': 1.0}" \\
        --table volume=results/paper/volume.csv --output volume.pdf volume.png
"""

from importlib import import_module
from importlib.util import find_spec

from twodiscs import tables
from twodiscs.cli import arguments


def drawing(name):
    """Return the function ``draw`` of the figure ``name``; raise ``ValueError`` if there is none.

    The module is looked up by name, so that the edit of one figure does not concern the others.
    """
    module = f"twodiscs.figures.{name}"
    if name.isidentifier() and find_spec(module):
        draw = getattr(import_module(module), "draw", None)
        if draw:
            return draw
    raise ValueError(f"there is no figure called {name!r}; twodiscs.figures.catalogue lists them")


def table(text):
    """Return (name, rows) of the table that the argument NAME=PATH speaks of."""
    name, mark, path = text.partition("=")
    if not mark:
        raise ValueError(f"table must be given as NAME=PATH, not {text!r}")
    return name, tables.read(path, name)


def main():
    parser = arguments.Parser(prog="twodiscs.cli.figure", description="Draw one figure of a scene.")
    parser.add_argument("name", help="the figure's name")
    parser.add_argument("--scene", required=True, help="dict with width and height")
    parser.add_argument("--table", action="append", default=[], metavar="NAME=CSV")
    parser.add_argument("--output", nargs="+", required=True, metavar="FILE", help=".pdf, .png")
    options = parser.parse_args()

    scene = arguments.parameters(options.scene)
    read = dict(map(table, options.table))
    draw = drawing(options.name)
    from twodiscs.figures import style

    with style.context():
        try:
            figure = draw(scene, read)
        except KeyError as error:
            raise ValueError(f"figure {options.name} needs {error}, which is not given") from None
        for path in options.output:
            style.save(figure, path)


if __name__ == "__main__":
    arguments.run(main)
