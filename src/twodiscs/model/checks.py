"""Checks of arguments; the message of each names the allowed values."""

import math
import numbers
import os
from collections.abc import Iterable
from contextlib import contextmanager
from decimal import Decimal
from itertools import islice
from shutil import copymode
from tempfile import TemporaryDirectory

import numpy as np

from twodiscs.model.formats import decimal_hint, did_you_mean, format_number, quote

#: Products of four lengths outside this range would overflow or underflow.
SHORTEST_LENGTH, LONGEST_LENGTH = 1e-60, 1e60

#: Seeds and counts are signed 64-bit integers in the kernels.
LARGEST_INTEGER = 2**63 - 1

#: The thinnest shell: thinner ones are of few grains (see ``sampling.montecarlo``).
THINNEST_SHELL = 1e-6

#: The largest number of discs, and the largest for the volume of configuration space.
MOST_DISCS, MOST_DISCS_WITH_VOLUME = 16384, 64

#: Relative errors that have a name.
NAMED_ERRORS = {"draft": 1e-2, "paper": 3e-4, "reference": 1e-4}

#: Letters of the longest sentence, which may quote a value of any length, and the most sentences.
LONGEST_SENTENCE, MOST_SENTENCES = 1000, 20


class AccuracyWarning(UserWarning):
    """A simulation ended at its budget, before the error that was asked for.

    Parameters
    ----------
    sentence : str
        The errors and the budget.

    Examples
    --------
    >>> import warnings
    >>> with warnings.catch_warnings(record=True, action="always") as found:
    ...     _ = td.simulate(scene, 1e-3, budget=1e6)
    >>> found[0].category is td.AccuracyWarning
    True
    """

    def __init__(self, sentence: str):
        super().__init__(sentence)


class InputError(ValueError):
    """A user's mistake in an argument, a configuration or a file, in one sentence.

    It is a ``ValueError``; for a call with a wrong argument it is also a ``TypeError``. The command
    lines print the sentence only. Any other exception is a mistake in the program, and keeps its
    traceback.

    Parameters
    ----------
    *sentences : str
        The sentences, one on each line.

    Examples
    --------
    >>> try:
    ...     td.Scene(1.5, 1.0, 0.2, feild=1)
    ... except td.InputError as error:
    ...     print(str(error).rpartition("; ")[2])
    did you mean field?
    """

    def __init__(self, *sentences):
        texts = (" ".join(str(sentence).split()) for sentence in sentences)
        short = (t if len(t) <= LONGEST_SENTENCE else f"{t[:LONGEST_SENTENCE]}…" for t in texts)
        first = list(islice(short, MOST_SENTENCES + 1))
        if len(first) > MOST_SENTENCES:
            first[MOST_SENTENCES - 1 :] = ["you see more mistakes after you mend these"]
        super().__init__("\n".join(first))


def path_text(path):
    """Return the text of a path-like object: ``str`` of an entry of ``os.scandir`` is no path."""
    return os.fsdecode(path) if isinstance(path, os.PathLike) else str(path)


@contextmanager
def writing_to(path):
    """Give a path beside the file ``path``, which replaces that file when the block has ended.

    If the block fails, an old file stays as it was. Raises ``InputError`` if it cannot be written.
    """
    refused = f"path must be a file to write, not {path_text(path)!r}"
    if "\0" in path_text(path):
        raise InputError(f"{refused}: it has a null character")
    try:
        if (old := os.path.isfile(path)) or not os.path.exists(path):
            folder, name = os.path.split(whole := os.path.realpath(path))  # a link stays a link
            with TemporaryDirectory(prefix=".", dir=folder) as beside:
                yield (new := os.path.join(beside, name))
                if old:
                    with open(whole, "ab"):  # raises if it must not be changed
                        copymode(whole, new)
                os.replace(new, whole)
        else:  # a device
            yield path
    except (OSError, TypeError) as error:
        raise InputError(f"{refused}: {getattr(error, 'strerror', None) or error}") from None


def is_real(value, kind=numbers.Real):
    """Return whether a value is a real number, or of another ``kind`` of the module numbers."""
    # NumPy's durations are integers for Python, whatever their unit.
    return isinstance(value, kind) and not isinstance(value, bool | np.timedelta64)


def check_number(name, value, low, high, kind="number"):
    """Return ``value`` as a float in [``low``, ``high``], or raise ``InputError`` naming ``name``.

    ``low`` is positive: the value must be a real number, finite and positive.
    """
    if not is_real(value):
        wrong = f"{quote(value)}{decimal_hint(value)}"
        raise InputError(f"{name} must be a positive {kind}, not {wrong}")
    try:
        number = float(value)
    except (ValueError, OverflowError):
        raise InputError(f"{name} must be a positive {kind}, not {quote(value)}") from None
    if not math.isfinite(number) or number <= 0:
        raise InputError(f"{name} must be a positive, finite {kind}, not {number!r}")
    if not low <= number <= high:
        low, high, number = map(format_number, (low, high, number))
        raise InputError(f"{name} must lie between {low} and {high}, not {number}")
    return number


def check_length(name, value):
    """Return ``value`` as a float, or raise ``InputError`` naming ``name`` if it is no length.

    A length is a real number, finite and positive, between 1e-60 and 1e60.
    """
    return check_number(name, value, SHORTEST_LENGTH, LONGEST_LENGTH)


def check_integer(name, value, least=1, most=LARGEST_INTEGER):
    """Return ``value`` as an int; raise ``InputError`` unless it is an integer in the range."""
    if not is_real(value, numbers.Integral):
        raise InputError(f"{name} must be an integer of at least {least}, not {quote(value)}")
    if not least <= value <= most:
        end = "2^63 - 1" if most == LARGEST_INTEGER else most
        raise InputError(f"{name} must be an integer from {least} to {end}, not {quote(value)}")
    return int(value)


def check_fraction(name, value, low=0):
    """Return ``value`` as a float; raise ``InputError`` unless it is between ``low`` and 1."""
    if not is_real(value):
        wrong = f"{quote(value)}{decimal_hint(value)}"
        raise InputError(f"{name} must be a number between 0 and 1, not {wrong}")
    if not low < value < 1:
        ends = f"{format_number(low, 'g')} and 1, ends excluded"
        raise InputError(f"{name} must lie between {ends}, not {quote(value)}")
    return float(value)


def check_error(name, value):
    """Return a relative error as a float: a number above 0, at most 1, or one of ``NAMED_ERRORS``.

    Raises ``InputError`` for anything else.
    """
    if isinstance(value, str) and value in NAMED_ERRORS:
        return NAMED_ERRORS[value]
    if not is_real(value) or not 0 < value <= 1:
        raise InputError(
            f"{name} must be a number above 0 and at most 1, or one of "
            f"{', '.join(NAMED_ERRORS)}, not {quote(value)}{decimal_hint(value)}"
        )
    return float(value)


def check_count(name, value, most=LARGEST_INTEGER):
    """Return ``value`` ≥ 1 as an int, also from an integral float, such as 1e6."""
    if isinstance(value, float) and value.is_integer():
        value = int(value)
    return check_integer(name, value, 1, most)


def parse_number(text):
    """Return the ``text`` of a number: an int without rounding if it is integral, else a float."""
    number, exact = float(text), Decimal(text)
    is_integer = number.is_integer() and abs(number) < 1e19 and exact == int(exact)
    return int(exact) if is_integer else number


def make_list(values):
    """Return an iterable, which may be an iterator, as a list; an array or a text is unchanged."""
    if isinstance(values, str | bytes) or hasattr(values, "__array__"):
        return values
    return [*values] if isinstance(values, Iterable) else values


def has_units(values):
    """Return whether one of the values, or of these types, is a quantity with a unit."""
    return any(hasattr(value, "unit") or hasattr(value, "units") for value in values)


def check_numbers(name, values, allowed, is_allowed):
    """Return ``values`` as an array of doubles in one dimension.

    Raises ``InputError`` for anything but real numbers without units, and if ``is_allowed(array)``
    is false. ``allowed`` says in words which ones are allowed.
    """
    given = make_list(values)
    kinds = {type(value) for value in (given if isinstance(given, list) else [given])}
    in_units = has_units((given, *kinds)) or getattr(given, "dtype", np.dtype(float)).kind in "mM"
    if not in_units and kinds.isdisjoint((bool, np.bool_)) and not np.ma.is_masked(given):
        try:
            found = np.atleast_1d(np.asarray(given))
            if found.dtype.kind in "iuf" or all(map(is_real, found.flat)):
                array = found.astype(float)
                if array.ndim == 1 and is_allowed(array):
                    return array
        except (TypeError, ValueError, OverflowError):
            pass
    hint = ": give numbers without units" if in_units else ""
    raise InputError(f"{name} must be {allowed}, not {quote(given)}{hint}")


def check_choice(name, value, allowed):
    """Return ``value``; raise ``InputError`` unless it is one of ``allowed``."""
    if not isinstance(value, str) or value not in allowed:
        hint = did_you_mean(value, allowed)
        raise InputError(f"{name} must be one of {', '.join(allowed)}, not {quote(value)}{hint}")
    return value
