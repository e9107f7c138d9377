"""Sums of a run, as a file with its digest and as a point.

A run works in blocks, and its sums are integers. It has one or more components, {name: component}:
"all", and rare hops in strips. A component is a dict: "sums" are {(first, stop): sums of the blocks
from ``first`` to ``stop`` − 1}, lists of integer arrays. All other entries are constants that its
estimates need, such as the duration of a replica. The pipeline's points and shards, and saved
results, are files of this one shape, with the components as "parts". A result goes on from its
sums, and the sums of several files with other blocks add up.
"""

import json
import math
import operator
from copy import deepcopy
from hashlib import sha256
from pathlib import Path
from typing import ClassVar

import numpy as np

import twodiscs
from twodiscs.model.checks import InputError, writing_to
from twodiscs.model.scene import Scene

# Files --------------------------------------------------------------------------------------------


DIGEST_KEY = "sha256"

#: A key whose value differs from run to run: neither the content nor its digest includes it.
SECONDS_KEY = "seconds"

#: The errors by which the content of a file shows that this package did not write it.
MALFORMED_ERRORS = (ArithmeticError, AttributeError, LookupError, TypeError, ValueError)


def digest(*paths):
    """Return the SHA-256 of concatenated files, in hexadecimal digits."""
    return sha256(b"".join(Path(path).read_bytes() for path in paths)).hexdigest()


def digest_line(path):
    """Return the line of ``sha256sum`` about a file; a job writes that of its table to its log."""
    return f"{digest(path)}  {Path(path).name}"


def require_logged(path):
    """Raise ``InputError`` if the log of the job that wrote a file has another digest of it.

    The log of results/a/b.csv is results/logs/a/b.log. A table of a build must have one; any other
    file without a log may be any.
    """
    path = Path(path)
    for folder in path.parents:
        log = folder / "logs" / path.relative_to(folder).with_suffix(".log")
        text = log.read_text(encoding="utf-8", errors="replace") if log.is_file() else ""
        lines = [line for line in text.splitlines() if line.endswith(f"  {path.name}")]
        build = (folder / "logs").is_dir() and (folder / "configuration.json").is_file()
        of_build = path.suffix == ".csv" and build
        if (lines or of_build) and lines[-1:] != [digest_line(path)]:
            raise InputError(f"{path} is not what its job wrote; delete it, and it is made again")


def write_json(path, content, seconds=None):
    """Write the dict ``content`` with its digest, keys sorted; floats keep all their digits.

    Each key has a line, so that a difference of two files names it. ``seconds`` is the processor
    time that it took, if known.
    """
    content = content | {DIGEST_KEY: _content_digest(content)}
    if seconds is not None:
        content[SECONDS_KEY] = seconds
    compact = {"sort_keys": True, "separators": (",", ":"), "allow_nan": False}
    lines = (f'"{key}": {json.dumps(content[key], **compact)}' for key in sorted(content))
    with writing_to(path) as new:
        text = ",\n".join(lines)
        Path(new).write_text(f"{{\n{text}\n}}\n", encoding="utf-8", newline="\n")


def read_json(path):
    """Return the content of a file of ``write_json``.

    Raises ``InputError`` if the file was changed, ``OSError`` if it cannot be read.
    """
    try:
        content = json.loads(Path(path).read_bytes())
        content.pop(SECONDS_KEY, None)
        written = content.pop(DIGEST_KEY) == _content_digest(content)
    except (*MALFORMED_ERRORS, RecursionError):
        written = False
    if not written:
        raise InputError(f"{path} is not what its job wrote; delete it, and it is made again")
    return content


def _content_digest(content):
    return sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


# Sums ---------------------------------------------------------------------------------------------


class Point:
    """The arithmetic on the sums of one method in one ``scene``.

    ``components`` are those of its run, None if it was made without one. A class has a method
    ``of(scene, components)``, which makes the point of the ``components`` of a run. ``work`` is the
    number of events, samples or intervals.
    """

    stage: ClassVar[str]
    scene: Scene
    work: int

    @property
    def radius(self):
        """The radius of disc 1."""
        return self.scene.radius


def reached(ranges, most=math.inf):
    """Return (sums, stop) of the ``ranges`` that join up from block 0 and end last, at ``stop``.

    They are {(first, stop): sums} of blocks; none ends beyond ``most``. Without any, sums are None.
    """
    joined = {0: None}
    for (first, stop), sums in sorted(ranges.items()):
        if first in joined and stop <= most:
            joined[stop] = added(joined[first], sums)
    stop = max(joined)
    return joined[stop], stop


def added(sums, more):
    """Return the sum of two lists of integer arrays, of which the first may be None."""
    if sums is None:
        return [*more]
    return [_narrow(np.add(a, b, dtype=object)) for a, b in zip(sums, more, strict=True)]


def _narrow(values, kind=np.int64):
    """Return ``values`` as an array of a ``kind``; of integers of any size if 64 bits do not do."""
    try:
        return np.array(values, kind)
    except OverflowError:
        return np.frompyfunc(operator.index, 1, 1)(np.array(values, object))


def file_content(kind, scene, settings, components):
    """Return the ``components`` of a run as a dict of plain values, for a JSON file.

    ``kind`` is the function of the face with these ``settings``, ``scene`` are the parameters of a
    box and the radius.
    """
    plain = {
        name: deepcopy({key: value for key, value in component.items() if key != "sums"})
        | {
            "sums": {
                f"{first}-{stop}": [np.asarray(entry).tolist() for entry in sums]
                for (first, stop), sums in component["sums"].items()
            }
        }
        for name, component in components.items()
    }
    content = {"kind": kind, "scene": scene, "settings": settings, "parts": plain}
    return {"twodiscs": twodiscs.__version__} | content


def restore_arrays(components, kind=np.int64):
    """Return the ``components`` of a run from those of ``file_content``.

    Sums are of this ``kind`` of numbers.
    """
    return {
        name: component
        | {
            "sums": {
                tuple(map(int, blocks.split("-"))): [_narrow(entry, kind) for entry in sums]
                for blocks, sums in component["sums"].items()
            }
        }
        for name, component in components.items()
    }
