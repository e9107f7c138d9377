"""Count what the figure of effects shows, a scene at a time, and gather it in one table.

    python -m twodiscs.cli.effects count config/scenes/rough.yaml --seed 1908 --output rough.json
    python -m twodiscs.cli.effects table rough.json torus.json --output results/effects.csv

What a scene needs is in its file; the seed is for a file that names none.
"""

import json
from pathlib import Path

from twodiscs import tables
from twodiscs.cli import arguments
from twodiscs.cli.points import write_json


def main():
    parser = arguments.Parser(prog="twodiscs.cli.effects", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    count = commands.add_parser("count", help="simulate the scene of a file")
    count.add_argument("file", metavar="YAML")
    count.add_argument("--seed", type=int, required=True, help="root seed of the configuration")
    table = commands.add_parser("table", help="write effects.csv")
    table.add_argument("points", nargs="+", metavar="JSON")
    for command in (count, table):
        command.add_argument("--output", required=True, metavar="FILE")
    options = parser.parse_args()
    from twodiscs import effects

    if options.command == "count":
        write_json(options.output, effects.count(effects.read(options.file, options.seed)))
    else:
        found = [json.loads(Path(path).read_text(encoding="utf-8")) for path in options.points]
        tables.write(options.output, "effects", [row for one in found for row in effects.rows(one)])


if __name__ == "__main__":
    arguments.run(main)
