"""Captions of built figures: their tables decide which symbols a caption explains."""

from pathlib import Path

from twodiscs.figures.kit.captions import Shown
from twodiscs.model.box import Box
from twodiscs_paper.catalogue import STUDY_TABLES, TABLES


def _rows(entry, results, scene):
    """Return {quantity: rows} of the built tables that a figure shows."""
    by_quantity = {}
    for name in entry.tables:
        path = Path(results, "" if name in STUDY_TABLES else scene["name"], f"{name}.csv")
        if path.exists():
            for row in TABLES[name].read(path):
                quantity = row.get("quantity") or f"{row.get('event')}_time"
                if not entry.needs or {quantity, name} & entry.needs:
                    by_quantity.setdefault(quantity, []).append(row)
    return by_quantity


def _has_value(row):
    """Return whether a row has a value to be drawn."""
    return any(row.get(value) for value in ("exact", "estimate", "bound"))


def box_of(scene):
    """Return the ``Box`` of a scene with "width", "height" and "effects", among these "discs"."""
    effects = dict(scene.get("effects", ()))
    discs = effects.pop("discs", 2)
    return Box(scene["width"], scene["height"], effects, discs)


def caption_parts(entry, results, scene):
    """Return the caption of a figure, and apart from it the sentences that other captions share.

    ``results`` is the folder of all results. ``scene`` has the "name" of the figure's scene, its
    "width" and "height", and its "effects" if there are any. A number of "discs" above two is among
    the effects. A figure without a scene takes the first scene.
    """
    box = box_of(scene)
    rows = _rows(entry, results, scene)
    quantities = frozenset(name for name, some in rows.items() if any(map(_has_value, some)))
    return entry.caption_parts(
        Shown(box, quantities or None, [row for some in rows.values() for row in some])
    )


def caption(entry, results, scene):
    """Return the whole caption of a figure, see ``caption_parts``."""
    return " ".join(filter(None, caption_parts(entry, results, scene)))
