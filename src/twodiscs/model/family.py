"""The families of scenes, and the modules that each of them has.

A scene is "plain" (two equal, smooth discs between walls), has "effects" (two discs), or has "many"
discs. Each floor has a module for each family, ``<floor>.families.<family>``, and these have the
same function names. They are imported by a computed name, so an edit for one family changes the
fingerprint of no other. A family does not define what it cannot do.
"""

from functools import cache
from importlib import import_module

from twodiscs.model.checks import InputError

FAMILIES = ("plain", "effects", "many")

_PACKAGE = __package__.partition(".")[0]


def module_of(floor, family):
    """Return the dotted name of the module that a ``family`` has on a ``floor``, "theory" say."""
    return f"{_PACKAGE}.{floor}.families.{family}"


@cache
def _found(floor, family, function):
    return getattr(import_module(module_of(floor, family)), function, None)


def of_family(scene, floor, function, what=None):
    """Return the ``function`` that the family of a ``Scene`` has on a ``floor``.

    Raises ``InputError`` where it has none; ``what`` names then what is not possible, in words that
    follow "for", the name of the function if it is None.
    """
    found = _found(floor, scene.family, function)
    if found is None:
        what = what or function.replace("_", " ")
        if scene.family == "many":
            raise InputError(f"discs must be 2 for {what}, not {scene.discs}")
        raise InputError(f"scene must be plain for {what}, but it has {', '.join(scene.calls_for)}")
    return found
