"""Captions as the figures are: without what a figure of this box and of these tables has not."""

import csv
import re
from pathlib import Path

from twodiscs.figures.catalogue import NOTES

#: What only some figures have: how the sentence on it begins, and which rows of their tables, as
#: texts, call for it.
MARKS = {
    "Crosses are estimates": lambda row: row.get("status") == "too-few",
    "Crosses are events": lambda row: row.get("part") == "coverage" and not row["value"],
    "Arrows start": lambda row: bool(row.get("bound")),
}


def _rows(entry, results, scene):
    """Yield the rows that a figure shows, of the tables that there are, as texts."""
    for name in entry.tables:
        for folder in (Path(results, scene["name"]), Path(results)):
            if not (path := folder / f"{name}.csv").exists():
                continue
            with open(path, encoding="utf-8", newline="") as file:
                for row in csv.DictReader(file):
                    quantity = row.get("quantity") or f"{row.get('event')}_time"
                    if not entry.needs or quantity in entry.needs:
                        yield row


def said(entry, results, scene):
    """Return what the caption of a figure says of it alone, and what it says as others do.

    ``results`` is the folder of all results; ``scene`` has the "name" of the figure's scene, the
    first one for a figure of none, its "width" and "height", and its "effects" if there are any.
    """
    effects = scene.get("effects", {})
    note = NOTES.get(entry.note)
    alike = "" if note is None else note.with_effects if effects else note.plain
    own = entry.own_caption(effects)
    for begins, calls_for_it in MARKS.items():
        sentence = re.compile(rf" ?{begins}[^.]*\.")
        found = sentence.search(f"{own} {alike}")
        own, alike = (sentence.sub("", text).strip() for text in (own, alike))
        if found and any(map(calls_for_it, _rows(entry, results, scene))):
            own += f" {found[0].strip()}"
    sides = scene["width"], scene["height"]
    longer = max(sides) / min(sides)
    shorter = re.compile(r" Boxes longer than ([\d.]+):1 [^.]*\.")
    own = shorter.sub(lambda found: found[0] if longer > float(found[1]) else "", own)
    return own if longer == 1 else re.sub(r" In a square box [^.]*\.", "", own), alike


def caption(entry, results, scene):
    """Return the whole caption of a figure, see ``said``."""
    return " ".join(filter(None, said(entry, results, scene)))
