"""A point: the result of a job at one radius of a scene, as an object and as a JSON file.

Each method has a class, a frozen dataclass whose fields are the keys of its file. The reader checks
a file against the types of these fields, and names the first difference.
"""

from dataclasses import MISSING, fields, is_dataclass
from itertools import groupby
from sys import float_info
from types import UnionType
from typing import ClassVar, get_args, get_origin

from twodiscs.model.checks import InputError
from twodiscs.points.digests import read_json, write_json


class Point:
    """The sums of one method at one ``radius``.

    Each class of points has a method ``estimate``, which returns an ``Estimate`` by name, or None
    without a count. A field with its default value is left out of the file.
    """

    stage: ClassVar[str]
    radius: float

    @classmethod
    def of(cls, content):
        """Return the point from a dict that ``content`` returned.

        Raises ``InputError`` for a dict of another shape.
        """
        return decoded(cls, content)

    def content(self):
        """Return the point as a dict for a JSON file."""
        return encoded(self)

    @classmethod
    def read(cls, path):
        """Return the point in a file of ``write``.

        Raises ``InputError`` if the file was changed, or has another shape than the points of this
        version; ``OSError`` if it cannot be read.
        """
        content = read_json(path)
        try:
            return cls.of(content)
        except InputError as error:
            raise InputError(
                f"{path} must be a point of {cls.stage}, but was made by another version: {error}; "
                "delete it, and it is made again"
            ) from None

    def write(self, path, seconds=None):
        """Write the point with its digest, and the ``seconds`` that it took, if they are known."""
        write_json(path, self.content(), seconds)


def encoded(value):
    """Return a dataclass as a dict, at any depth without fields that have their default."""
    if is_dataclass(value):
        some = {field: getattr(value, field.name) for field in fields(value)}
        return {
            f.name: encoded(v) for f, v in some.items() if f.default is MISSING or v is not None
        }
    if isinstance(value, dict):
        return {name: encoded(one) for name, one in value.items()}
    return value


#: The largest finite number.
MOST = float_info.max

#: The name of a value of a type, and a function that returns whether a ``value`` is one.
SIMPLE = {
    int: ("an integer from 0 to 2**127", lambda value: type(value) is int and 0 <= value <= 2**127),
    float: ("a finite number", lambda value: type(value) in (int, float) and abs(value) <= MOST),
    str: ("text", lambda value: isinstance(value, str)),
    dict: ("an object", lambda value: isinstance(value, dict)),
    list: ("a list", lambda value: isinstance(value, list)),
}


def decoded(kind, value, name=""):
    """Return a JSON ``value`` as a ``kind``: a dataclass, dict, list, number or text, or None.

    Raises ``InputError`` that begins with the ``name`` of the wrong value.
    """
    parts, below = get_args(kind), f"{name}." if name else ""
    if get_origin(kind) is UnionType:
        return None if value is None else decoded(parts[0], value, name)
    simple = dict if is_dataclass(kind) else get_origin(kind) or kind
    what, is_one = SIMPLE[simple]
    if not is_one(value):
        raise InputError(f"{name or 'it'} must be {what}, not of type {type(value).__name__}")
    if is_dataclass(kind):
        known = {field.name: field for field in fields(kind)}
        needed = {n for n, field in known.items() if field.default is MISSING}
        if wrong := sorted(needed - value.keys()):
            raise InputError(f"{below}{wrong[0]} is missing")
        if wrong := sorted(value.keys() - known.keys()):
            raise InputError(f"{below}{wrong[0]} is not known")
        return kind(**{n: decoded(known[n].type, v, below + n) for n, v in value.items()})
    if simple is dict:
        return {n: decoded(parts[1], one, below + n) for n, one in value.items()}
    if simple is list:
        return [decoded(parts[0], one, name) for one in value]
    return value


def require_positive(block, *names):
    """Raise ``InputError`` unless the fields of these ``names`` are larger than 0."""
    for name in names:
        if not getattr(block, name) > 0:
            raise InputError(f"{name} must be larger than 0, not {getattr(block, name)!r}")


def require_same_keys(what, found, expected):
    """Raise ``InputError`` unless ``what``, a dict ``found``, has the ``expected`` keys."""
    if wrong := sorted({*found} ^ {*expected}):
        state = "missing" if wrong[0] in expected else "not known"
        raise InputError(f"{what}.{wrong[0]} is {state}")


def by_radius(points):
    """Return ``points`` in the order of radii; raises ``InputError`` if two have the same."""
    points = sorted(points, key=lambda point: point.radius)
    for radius, same in groupby(point.radius for point in points):
        if len(list(same)) > 1:
            raise InputError(f"points must not contain radius {radius!r} twice")
    return points
