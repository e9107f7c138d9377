"""Checks of plain arguments, each with one sentence that says what is allowed."""

import math
import numbers

from twodiscs.scene import Scene

#: Seeds and counts are signed 64-bit integers in the kernels.
LARGEST_INTEGER = 2**63 - 1


def a_scene(value):
    """Return ``value``; raise ``ValueError`` unless it is a ``Scene``."""
    if not isinstance(value, Scene):
        raise ValueError(f"scene must be a Scene, not {value!r}")
    return value


def whole(name, value, least=1):
    """Return ``value`` as an int; raise ``ValueError`` unless it is an integer ≥ ``least``."""
    if isinstance(value, bool) or not isinstance(value, numbers.Integral):
        raise ValueError(f"{name} must be an integer of at least {least}, not {value!r}")
    if not least <= value <= LARGEST_INTEGER:
        raise ValueError(f"{name} must be an integer from {least} to 2^63 - 1, not {value!r}")
    return int(value)


def proportion(name, value):
    """Return ``value`` as a float; raise ``ValueError`` unless it is strictly between 0 and 1."""
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        raise ValueError(f"{name} must be a number between 0 and 1, not {value!r}")
    if not (math.isfinite(value) and 0 < value < 1):
        raise ValueError(f"{name} must lie between 0 and 1, ends excluded, not {value!r}")
    return float(value)


def one_of(name, value, allowed):
    """Return ``value``; raise ``ValueError`` unless it is one of ``allowed``."""
    if value not in allowed:
        raise ValueError(f"{name} must be one of {', '.join(allowed)}, not {value!r}")
    return value
