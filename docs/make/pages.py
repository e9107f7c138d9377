"""Renew what other files repeat of declarations.

    python docs/make/pages.py

writes, in the folder where it is called: config/schema.json, the names that editors complete
in src/twodiscs/__init__.pyi, and the output of `twodiscs` in the pages of docs.
"""

import json
import re
import shlex
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path
from textwrap import fill
from unittest.mock import patch

from twodiscs import cli
from twodiscs.model.events import EVENTS, HOPS
from twodiscs_paper.configuration.schema import schema

#: The names for checkers of types in the face, between their marks.
NAMES = re.compile(
    r"(?<=python docs/make/pages.py renews them.\n).*?(?=# end of names\n)", re.DOTALL
)

#: A command that a page shows, and beneath it what it prints.
COMMAND = re.compile(r"^\$ (twodiscs .+)\n(?:(?!```|\$ ).*\n)+", re.MULTILINE)


def literals():
    """Return the types of the names of events, hops and quantities, for the face."""
    quantities = ("volume", *(f"{event}_area" for event in EVENTS))
    text = ""
    for name, values in {"Event": EVENTS, "Hop": HOPS, "Quantity": quantities}.items():
        names, indent = "".join(f'"{value}", ' for value in values), " " * 4
        lines = fill(names, 100, initial_indent=indent, subsequent_indent=indent)
        text += f"{name} = typing.Literal[\n{lines}\n]  # fmt: skip\n"
    return text


def _tried(example):
    """Return a command with what it prints."""
    with patch("sys.argv", shlex.split(example[1])), redirect_stdout(StringIO()) as printed:
        cli._main()
    return f"$ {example[1]}\n{printed.getvalue()}"


def pages(folder):
    """Return {path below ``folder``: text} of the files as they should be."""
    face = Path(folder, "src/twodiscs/__init__.pyi").read_text(encoding="utf-8")
    renewed = {
        "src/twodiscs/__init__.pyi": NAMES.sub(lambda _: literals(), face),
        "config/schema.json": json.dumps(schema(), ensure_ascii=False, indent=1) + "\n",
    }
    for path in (Path(folder, "README.md"), *sorted(Path(folder, "docs").glob("*.md"))):
        text = path.read_text(encoding="utf-8")
        if COMMAND.search(text):
            renewed[path.relative_to(folder).as_posix()] = COMMAND.sub(_tried, text)
    return renewed


if __name__ == "__main__":
    for name, text in pages(".").items():
        Path(name).write_text(text, encoding="utf-8", newline="\n")
