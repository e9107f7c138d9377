"""Files of points and shards: a job reads them, and refuses files of other work."""

import json
from pathlib import Path

from twodiscs.model.checks import InputError
from twodiscs.model.formats import quote
from twodiscs.points.base import MALFORMED_ERRORS, SECONDS_KEY, read_json, restore_arrays

#: The remedy for a wrong file.
REMEDY = "delete it, and it is made again"


def read_components(path, stage, scene, settings):
    """Return the ``components`` of a run in the file of a point or a shard.

    Raises ``InputError`` if the file was changed, or if it is not of this ``Stage``, this ``Scene``
    and these ``settings`` of its call; ``OSError`` if it cannot be read.
    """
    try:
        content = read_json(path)
    except IsADirectoryError:
        raise InputError(f"{path} must be a file, not a folder; {REMEDY}") from None
    try:
        found = {"kind": content["kind"]} | content["scene"] | content["settings"]
        components = restore_arrays(content["parts"])
    except MALFORMED_ERRORS:
        raise InputError(f"{path} must be a point or a shard of one; {REMEDY}") from None
    asked = json.loads(json.dumps({"kind": stage.call} | scene.parameters() | settings))
    for name in asked | found:
        has, wanted = found.get(name), asked.get(name)
        if has != wanted:
            wrong = f"has {name} {quote(has)}, but its job asks for {quote(wanted)}"
            raise InputError(f"{path} {wrong}; {REMEDY}")
    return components


def read_point(path, stage, scene, settings):
    """Return the point of a ``Stage`` in a file; the arguments are those of ``read_components``."""
    components = read_components(path, stage, scene, settings)
    try:
        return stage.point.of(scene, components)
    except MALFORMED_ERRORS:
        raise InputError(f"{path} is a point of another version; {REMEDY}") from None


def read_seconds(path):
    """Return the seconds in a file of ``write_json``, None without any."""
    return json.loads(Path(path).read_bytes()).get(SECONDS_KEY)


def read_shards(paths, stage, scene, settings):
    """Return {component: {(first, stop): sums}} of the shards of a point.

    Raises ``InputError`` as ``read_components``, and if a shard has other blocks than in its name.
    """
    ranges = {}
    for path in paths:
        for name, component in read_components(path, stage, scene, settings).items():
            for (first, stop), sums in component["sums"].items():
                if Path(path).stem != f"{name}-{first}-{stop}":
                    raise InputError(f"{path} has the blocks {name}-{first}-{stop}; {REMEDY}")
                ranges.setdefault(name, {})[first, stop] = sums
    return ranges


def shard_ranges(blocks, per_shard):
    """Return the ranges [(first, stop), …] of a number of ``blocks``, on an absolute grid.

    They begin at multiples of ``per_shard``, a power of two; the last one is cut at ``blocks``.
    """
    return [(first, min(first + per_shard, blocks)) for first in range(0, blocks, per_shard)]


def check_coverage(run, ranges):
    """Return ``ranges``, {(first, stop): sums}, of all planned blocks of a run.

    They must cover these blocks without gap or overlap.
    """
    ends = sorted(ranges)
    firsts, stops = [first for first, _ in ends], [stop for _, stop in ends]
    if not ends or [*firsts, run.planned] != [0, *stops]:
        given = ", ".join(f"{first} to {stop}" for first, stop in ends) or "none"
        raise InputError(
            f"shards must cover blocks 0 to {run.planned} without gap or overlap, not {given}"
        )
    return ranges
