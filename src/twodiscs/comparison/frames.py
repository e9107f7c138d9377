"""The tables of a folder of results, as pandas reads them."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from twodiscs.comparison.scene_tables import SCENE_TABLES
from twodiscs.model.box import Box
from twodiscs.model.checks import (
    InputError,
    answering,
)
from twodiscs.model.plugins import plugin
from twodiscs.points.digests import digest

if TYPE_CHECKING:
    from os import PathLike

    import pandas as pd


@answering
def load(folder: str | PathLike[str]) -> dict[str, pd.DataFrame]:
    """Read every table in a folder of results.

    Parameters
    ----------
    folder : path-like
        The folder of a scene below results, such as "results/paper".

    Returns
    -------
    dict
        {name: ``DataFrame``}. ``attrs`` of a table has its units, the meanings of its columns, and
        its origin: path, sha256 and the configuration, all as plain values.

    Raises
    ------
    InputError
        For a folder without tables, and for a damaged table.

    Examples
    --------
    >>> tables = td.load("results/paper")  # doctest: +SKIP
    >>> figure = td.plot(tables["mean_times"])  # doctest: +SKIP
    """
    if not isinstance(folder, str | Path):
        raise InputError(f"folder must be the path of a folder, not {folder!r}")
    frames, folder = {}, Path(folder)
    if not folder.is_dir():
        what = "is no folder" if folder.exists() else "does not exist"
        raise InputError(f"folder must hold tables of results, but {str(folder)!r} {what}")
    known = plugin("tables") or SCENE_TABLES
    for path in sorted(folder.glob("*.csv")):
        if path.stem in known:
            frames[path.stem] = read(path, known[path.stem])
    if not frames:
        raise InputError(f"folder must hold tables of results, but {str(folder)!r} has none")
    return frames


def read(path, table):
    """Return the file of a ``Table`` as a ``DataFrame`` with units and meanings in ``attrs``."""
    frame, configuration = table.frame(path), _configuration(path)
    columns = table.columns_of(frame)
    frame.attrs = {
        "table": table.name(),
        "meaning": table.meaning(),
        "meanings": {name: column.meaning for name, column in columns.items()},
        "units": {name: column.unit for name, column in columns.items()},
        "path": str(path),
        "sha256": digest(path),
        "configuration": configuration,
    }
    if (box := _box(configuration)) is not None:
        frame.attrs["box"] = box.parameters()
    return frame


def _box(configuration):
    """Return the ``Box`` of the only scene of a configuration; None if there is none."""
    scenes = configuration.get("scenes", []) if isinstance(configuration, Mapping) else []
    try:
        (scene,) = scenes
        # YAML reads 1e0 as text.
        sides, effects = (
            {name: value if name == "periodic" else float(value) for name, value in block.items()}
            for block in (scene["box"], scene.get("effects", {}))
        )
        return Box.configured(sides, effects, scene.get("discs", 2))
    except (InputError, AttributeError, KeyError, TypeError, ValueError):
        return None


def _configuration(path):
    """Return the configuration, with only the scene of a table; None if it is not known."""
    for folder in (path.parent, path.parent.parent):
        try:
            known = json.loads((folder / "configuration.json").read_text(encoding="utf-8"))
        except (OSError, ValueError):
            continue
        if folder == path.parent or not isinstance(known, Mapping):
            return known
        scenes = [s for s in known.get("scenes", []) if s.get("name") == path.parent.name]
        return {**known, "scenes": scenes}
    return None
