"""Renew the table of README.md on what an accuracy costs.

    python docs/make/prices.py

measures it on this machine. Processor time depends on the machine, so no test does.
"""

import re
from pathlib import Path

import twodiscs as td
from twodiscs.model.formats import format_seconds

#: The rows: radius in a box of 1.5 × 1, quantity, method.
ROWS = (
    (0.249975, "horizontal_hop_time", "dynamics"),
    (0.249975, "horizontal_hop_time", "strips"),
    (0.38, "volume", "rejection"),
    (0.38, "volume", "conditioned"),
    (0.2, "all exact values", "exact"),
)

ERRORS = (1e-3, 1e-4, 1e-5)

#: The table in a page, its head among it.
TABLE = re.compile(r"(?<=^\| quantity \| radius \| method \|).*\n\|[-|]+\n(?:\|.*\n)+", re.M)


def table():
    """Return the table without its first cells, as Markdown."""
    costs = {radius: td.cost(td.Scene(1.5, 1.0, radius), ERRORS) for radius, *_ in ROWS}
    head = [f"{error:.0e}".replace("e-0", "e-") for error in ERRORS]
    lines = [f" {' | '.join(head)} |", "|---" * (3 + len(ERRORS)) + "|"]
    for radius, quantity, method in ROWS:
        price = costs[radius][quantity, method]
        times = " | ".join(format_seconds(price.seconds(error)) for error in ERRORS)
        lines.append(f"| `{quantity}` | {radius:g} | {method} | {times} |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    page = Path("README.md")
    text = TABLE.sub(lambda _: table(), page.read_text(encoding="utf-8"))
    page.write_text(text, encoding="utf-8", newline="\n")
