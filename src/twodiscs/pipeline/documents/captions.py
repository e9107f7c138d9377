"""Captions as the figures are: without what a figure of this box and of these tables has not."""

from pathlib import Path

from twodiscs.comparison.scene_tables import SCENE_TABLES
from twodiscs.figures.kit.captions import Shown
from twodiscs.studies.catalogue import STUDY_TABLES


def _rows(entry, results, scene):
    """Return the rows that a figure shows, of the tables that there are."""
    shown = []
    for name in entry.tables:
        path = Path(results, "" if name in STUDY_TABLES else scene["name"], f"{name}.csv")
        if path.exists():
            rows = (SCENE_TABLES | STUDY_TABLES)[name].read(path)
            quantities = (row.get("quantity") or f"{row.get('event')}_time" for row in rows)
            pairs = zip(rows, quantities, strict=True)
            shown += [row for row, q in pairs if not entry.needs or q in entry.needs]
    return shown


def said(entry, results, scene):
    """Return what the caption of a figure says of it alone, and what it says as others do.

    ``results`` is the folder of all results; ``scene`` has the "name" of the figure's scene, the
    first one for a figure of none, its "width" and "height", and its "effects" if there are any.
    """
    sides, effects = (scene["width"], scene["height"]), scene.get("effects", ())
    return entry.said(Shown(effects, sides, _rows(entry, results, scene)))


def caption(entry, results, scene):
    """Return the whole caption of a figure, see ``said``."""
    return " ".join(filter(None, said(entry, results, scene)))
