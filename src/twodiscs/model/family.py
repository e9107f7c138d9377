"""The families of scenes, and the modules of each family.

A scene is "plain" (two equal, smooth discs between walls), has "effects" (two discs), or has "many"
discs. Each floor has a module for each family, ``<floor>.families.<family>``, with the same
function names. They are imported by a computed name, so an edit for one family does not change the
fingerprints of the others. If a family cannot do something, it does not define the function.
"""

from functools import cache
from importlib import import_module

from twodiscs.model.checks import InputError

FAMILIES = ("plain", "effects", "many")

_PACKAGE = __package__.partition(".")[0]


def module_of(floor, family):
    """Return the dotted name of the module of a ``family`` on a ``floor``, such as "theory"."""
    return f"{_PACKAGE}.{floor}.families.{family}"


@cache
def _found(floor, family, function):
    return getattr(import_module(module_of(floor, family)), function, None)


def of_family(scene, floor, function, what=None):
    """Return the ``function`` of the family of a ``Scene`` on a ``floor``.

    Raises ``InputError`` if the family does not have it. In its message ``what``, or the name of
    the function, follows the word "for".
    """
    found = _found(floor, scene.family, function)
    if found is None:
        what = what or function.replace("_", " ")
        if scene.family == "many":
            raise InputError(f"discs must be 2 for {what}, not {scene.discs}")
        raise InputError(f"scene must be plain for {what}, but it has {', '.join(scene.calls_for)}")
    return found
