"""Captions of figures that are built: their tables decide which symbols are explained."""

from pathlib import Path

from twodiscs.comparison.scene_tables import SCENE_TABLES
from twodiscs.figures.kit.captions import Shown
from twodiscs.model.box import Box
from twodiscs_paper.catalogue import STUDY_TABLES


def _rows(entry, results, scene):
    """Return {quantity: rows} of what a figure shows, from the tables that are built."""
    shown = {}
    for name in entry.tables:
        path = Path(results, "" if name in STUDY_TABLES else scene["name"], f"{name}.csv")
        if path.exists():
            for row in (SCENE_TABLES | STUDY_TABLES)[name].read(path):
                quantity = row.get("quantity") or f"{row.get('event')}_time"
                if not entry.needs or {quantity, name} & entry.needs:
                    shown.setdefault(quantity, []).append(row)
    return shown


def _is_seen(row):
    """Say whether a row has a value to be drawn."""
    return any(row.get(value) for value in ("exact", "estimate", "bound"))


def caption_parts(entry, results, scene):
    """Return the caption of a figure alone, and what it has in common with other captions.

    ``results`` is the folder of all results; ``scene`` has the "name" of the figure's scene, the
    first one for a figure of none, its "width" and "height", and its "effects" if there are any,
    among them "discs" if they are more than two.
    """
    effects = dict(scene.get("effects", ()))
    discs = effects.pop("discs", 2)
    box = Box(scene["width"], scene["height"], effects, discs)
    rows = _rows(entry, results, scene)
    seen = frozenset(quantity for quantity, some in rows.items() if any(map(_is_seen, some)))
    return entry.caption_parts(
        Shown(box, seen or None, [row for some in rows.values() for row in some])
    )


def caption(entry, results, scene):
    """Return the whole caption of a figure, see ``caption_parts``."""
    return " ".join(filter(None, caption_parts(entry, results, scene)))
