"""Compare what is in results/ with what is committed in paper/expected/, point by point.

    python -m twodiscs.cli.verify            # says what differs, exit status 1 if anything does
    python -m twodiscs.cli.verify --write    # makes what is there what is expected

Nothing is built. What is expected are the results of one configuration, and only those of the same
one are compared with it.
"""

import json
import sys
from pathlib import Path

from twodiscs import verify
from twodiscs.cli import arguments


def _mapping(text, name):
    try:
        return json.loads(text)
    except ValueError as error:
        raise ValueError(f"{name} must hold JSON: {error}") from None


def _read(path):
    return _mapping(path.read_text(encoding="utf-8"), path)


def main():
    parser = arguments.Parser(
        prog="twodiscs.cli.verify", description="Compare results with what is expected."
    )
    parser.add_argument("--results", type=Path, default=Path("results"), metavar="FOLDER")
    parser.add_argument("--expected", type=Path, default=Path("paper/expected"), metavar="FOLDER")
    parser.add_argument(
        "--configuration", metavar="JSON", help="the configuration of the results; theirs if absent"
    )
    parser.add_argument("--write", action="store_true", help="renew what is expected instead")
    options = parser.parse_args()

    results, expected = options.results, options.expected
    if not any(path.is_dir() for path in results.glob("*/points")):
        raise ValueError(f"{results} holds no results to verify: they are built by make")
    if options.configuration is None:
        configuration = _read(results / "configuration.json")
    else:
        configuration = _mapping(options.configuration, "--configuration")
    if options.write:
        verify.write(results, expected, configuration)
        print(f"{expected} is now what {results} is")
        return 0

    if not (expected / "configuration.json").exists():
        raise ValueError(f"{expected} holds no results to compare with: --write puts them there")
    other = verify.other_configuration(configuration, _read(expected / "configuration.json"))
    if other:
        raise ValueError(
            f"{expected} holds the results of the default configuration, and this is another one: "
            f"{other}"
        )
    differences, compared = verify.verify(results, expected)
    print(
        f"compared {compared['points']} points and {compared['tables']} tables: "
        f"{compared['integers']} integers, and {compared['floats']} floats to {verify.RELATIVE:g}"
    )
    if differences:
        print(*differences, f"differences: {len(differences)}", sep="\n", file=sys.stderr)
        return 1
    print("no differences")
    return 0


if __name__ == "__main__":
    arguments.run(main)
