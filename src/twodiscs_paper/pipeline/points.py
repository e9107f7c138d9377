"""Points of the pipeline: the run of a job, its shards, and the files of both."""

import json
from pathlib import Path

from twodiscs.model.box import key, scene_of, stream_seed
from twodiscs.model.checks import InputError
from twodiscs.points.base import SECONDS, read_json, restore_arrays

#: The function of the face that does the work of a stage.
KINDS = {"monte_carlo": "sample", "dynamics": "simulate", "intervals": "intervals"}


def run_of(stage, scene, settings):
    """Return the run of a ``stage`` for a ``Scene``: monte_carlo, dynamics or intervals.

    ``settings`` are the arguments of its function of the face. Only the module of the stage is
    imported.
    """
    given = dict(settings)
    seed = stream_seed(given.pop("seed"), given.pop("name"), stage, key(scene.radius))
    if stage == "monte_carlo":
        from twodiscs.sampling.montecarlo import MonteCarloRun

        return MonteCarloRun(scene, seed=seed, **given)
    from twodiscs.dynamics.runs import DynamicsRun, IntervalsRun

    if stage == "dynamics":
        return DynamicsRun(scene, given["error"], given["budget"], seed)
    return IntervalsRun(scene, given["hop"], given["number"], seed, given["budget"])


def read_point(kind, path):
    """Return the point of a class ``kind`` in a file that a job wrote.

    Raises ``InputError`` if the file was changed, ``OSError`` if it cannot be read.
    """
    content = read_json(path)
    try:
        return kind.of(scene_of(content["scene"]), restore_arrays(content["parts"]))
    except (KeyError, TypeError, ValueError):
        raise InputError(
            f"{path} must be a point of {kind.stage}, but was made by another version or stage; "
            "delete it, and it is made again"
        ) from None


def read_seconds(path):
    """Return the seconds in a file of ``write_json``, None without any."""
    return json.loads(Path(path).read_bytes()).get(SECONDS)


def pieces_of(paths):
    """Return {part: pieces} of all files at ``paths``, such as the shards of a point.

    Raises ``InputError`` if a file was changed.
    """
    pieces = {}
    for path in paths:
        if "parts" not in (content := read_json(path)):
            raise InputError(f"{path} must be a shard of a point; delete it, and it is made again")
        for name, part in restore_arrays(content["parts"]).items():
            pieces.setdefault(name, {}).update(part["sums"])
    return pieces


def pieces(blocks, per_piece):
    """Return the pieces [(first, stop), …] of a number of ``blocks``, on an absolute grid.

    They begin at multiples of ``per_piece``, a power of two; the last one is cut at ``blocks``.
    """
    return [(first, min(first + per_piece, blocks)) for first in range(0, blocks, per_piece)]


def joined(run, pieces):
    """Return the ``pieces`` of all planned blocks of a run.

    They must cover these blocks without gap or overlap.
    """
    ends = sorted(pieces)
    firsts, stops = [first for first, _ in ends], [stop for _, stop in ends]
    if not ends or [*firsts, run.planned] != [0, *stops]:
        given = ", ".join(f"{first} to {stop}" for first, stop in ends) or "none"
        raise InputError(
            f"pieces must cover blocks 0 to {run.planned} without gap or overlap, not {given}"
        )
    return pieces
