"""Tables, results and points of a build, read from their files."""

from __future__ import annotations

import json
import re
from importlib import metadata
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

import twodiscs
from twodiscs.analysis.tables import SCENE_TABLES
from twodiscs.model.calls import checked_call
from twodiscs.model.checks import InputError, path_text
from twodiscs.model.formats import quote
from twodiscs.model.scene import Box, Scene
from twodiscs.points.base import MALFORMED_ERRORS, digest, read_json, restore_arrays
from twodiscs.sampling.rounds import FinishedComponents

if TYPE_CHECKING:
    import pandas as pd

    from twodiscs.measure.measurements import Measurements


def plugin(name):
    """Return the object that an installed package registers as ``name``, None if none does.

    It is an entry point of the group "twodiscs", by which packages on top of this one extend it.
    ``tables`` are its tables, {name: ``Table``}; ``build`` is the module of ``twodiscs run`` and
    ``twodiscs new``.
    """
    for entry in metadata.entry_points(group="twodiscs", name=name):
        return entry.load()
    return None


@checked_call
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
    if not isinstance(folder, str | PathLike):
        raise InputError(f"folder must be the path of a folder, not {folder!r}")
    folder, known = Path(folder), plugin("tables") or SCENE_TABLES
    paths = [path for path in sorted(folder.glob("*.csv")) if path.stem in known]
    if not paths:
        what = "has none"
        if not folder.is_dir():
            what = "is no folder" if folder.exists() else "does not exist"
        raise InputError(f"folder must hold tables of results, but {str(folder)!r} {what}")
    return {path.stem: read(path, known[path.stem]) for path in paths}


def read(path, table):
    """Return the file of a ``Table`` as a ``DataFrame`` with units and meanings in ``attrs``."""
    frame, configuration = table.frame(path), _configuration(path)
    columns = table.present_columns(frame)
    units = {name: column.unit for name, column in columns.items()}
    frame.attrs = {
        "table": table.name(),
        "meaning": table.meaning(),
        "meanings": {name: column.meaning for name, column in columns.items()},
        "units": units,
        "path": str(path),
        "sha256": digest(path),
        "configuration": configuration,
    }
    if (box := read_box(configuration)) is not None:
        frame.attrs["box"] = box.parameters()
        # A table names the units of two discs.
        of_two = {"length⁴": box.unit("volume"), "length³": box.unit("area")}
        frame.attrs["units"] = {
            name: re.sub("length[⁴³]", lambda found: of_two[found[0]], unit)
            for name, unit in units.items()
        }
    return frame


def read_box(configuration):
    """Return the ``Box`` of the only scene of a configuration; None if there is none."""
    try:
        (scene,) = configuration["scenes"]
        # YAML reads 1e0 as text.
        sides, effects = (
            {name: value if name == "periodic" else float(value) for name, value in block.items()}
            for block in (scene["box"], scene.get("effects", {}))
        )
        return Box(**sides, **effects, discs=scene.get("discs", 2))
    except (AttributeError, KeyError, TypeError, ValueError):
        return None


def _configuration(path):
    """Return the configuration, with only the scene of a table; None if it is not known."""
    for folder in (path.parent, path.parent.parent):
        try:
            configuration = json.loads((folder / "configuration.json").read_text(encoding="utf-8"))
            if folder == path.parent:
                return configuration
            scenes = [s for s in configuration["scenes"] if s["name"] == path.parent.name]
            return {**configuration, "scenes": scenes}
        except (OSError, *MALFORMED_ERRORS):
            continue
    return None


def from_dict(content):
    """Return the result that ``to_dict`` describes, made again from its sums without any work.

    Raises ``InputError``, or one of ``MALFORMED_ERRORS``, if no result has this content.
    """
    if content["kind"] == "scan":
        from twodiscs.measure.scan import Scan

        names = content["parameters"]
        refused = {tuple(values): "".join(why) for values, why in content["refused"]}
        found = Scan(map(from_dict, content["results"]), refused, names)
        rest = {
            repr({**one.scene.parameters(), **dict.fromkeys(names), "": one.kind}) for one in found
        }
        is_right = len(rest) == 1 and {"radius"} <= {*names} <= {*vars(found[0].scene)}
        is_right = is_right and {*map(len, refused)} <= {len(names)}
        known = {"results": content["results"]}
    else:
        from twodiscs.measure.intervals import Intervals
        from twodiscs.measure.measurements import Measurements
        from twodiscs.measure.observe import Observed
        from twodiscs.measure.transmission import Transmission

        results = Measurements, Intervals, Transmission, Observed
        kind, settings = content["kind"], content["settings"]
        result = {kind: one for one in results for kind in one.makers}[kind]
        parts = FinishedComponents(restore_arrays(content["parts"], result.sums))
        with np.errstate(invalid="ignore"):  # counts that no run has are refused below
            found = result.makers[kind](Scene(**content["scene"]), **settings, resume_from=parts)
        # A point of a build has some of the settings, maybe in another order.
        is_right, known = settings.keys() <= found.settings.keys(), {"settings": settings}
    made = found.to_dict() | known | {"twodiscs": content["twodiscs"]}
    if not is_right or json.loads(json.dumps(made)) != content:
        raise InputError("the content must be that of a result")
    return found


@checked_call
def load_result(path: str | PathLike[str]) -> Measurements | Any:
    """Read a result that ``save(path)`` wrote, or a point of a build; ``more`` goes on from it.

    Parameters
    ----------
    path : path-like
        The file. A version of the package with other first two digits cannot read it.

    Returns
    -------
    Measurements, Intervals, Transmission, Observed or Scan
        The result. One of ``observe`` has its averages, not its function, which no file holds:
        ``more`` takes it again.

    Raises
    ------
    InputError
        For a file of another version, and for any other file.

    Examples
    --------
    >>> td.simulate(scene, 0.1, seed=1, events="any_wall").save("walls.json")
    >>> more = td.load_result("walls.json").more(error=5e-4)
    >>> more["any_wall_time"].relative_stderr < 5e-4
    True
    """
    if not isinstance(path, str | PathLike) or "\0" in path_text(path):
        raise InputError(f"path must be the path of a file, not {quote(path)}")
    path, saved = path_text(path), "path must be a file that save() wrote, or a point of a build"
    try:
        content = read_json(path)
    except OSError as error:
        raise InputError(f"path must be a file to read, not {path!r}: {error.strerror}") from None
    except InputError:
        raise InputError(f"{saved}, not {path!r}") from None
    # Numbers may change with the second digit of a version, not with the third.
    known, version = twodiscs.__version__.rpartition(".")[0], content.get("twodiscs")
    if not str(version).startswith(f"{known}."):
        raise InputError(
            f"the result must be of version {known}.x, so that its numbers are the same, not of "
            f"{quote(version)}"
        )
    try:
        return from_dict(content)
    except MALFORMED_ERRORS as error:
        raise InputError(f"{saved}, but the content of {path!r} was changed") from error
