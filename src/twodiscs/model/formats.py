"""Texts of numbers and of values, as pages and messages write them."""

import math
import re
import reprlib
from decimal import ROUND_CEILING, Context
from difflib import get_close_matches

#: The form of quoted values: some items of a list, and of the lists in it.
_SHORT_REPR = reprlib.Repr()
_SHORT_REPR.maxlevel = 2

#: {a word of other programs: the name here, or a sentence if there is none}.
SYNONYMS = {
    **dict.fromkeys(("g", "gravity"), "field"),
    "r": "radius",
    "diameter": "give the radius, half of the diameter",
    **dict.fromkeys(("n", "particles"), "discs"),
    **dict.fromkeys(("restitution", "elasticity"), "collisions are elastic, without a restitution"),
    **dict.fromkeys(("tol", "rtol", "precision"), "error"),
    **dict.fromkeys(("t", "time", "t_max"), "duration"),
    **dict.fromkeys(("n_jobs", "threads", "workers"), "cores"),
    **dict.fromkeys(("random_state", "rng"), "seed"),
    "temperature": "the total energy is 1/2, which sets the temperature",
}  # fmt: skip


def quote(value):
    """Return the short text of any ``value`` for a message, of a large object its class."""
    try:
        if type(value).__module__ != "builtins" and len(repr(value)) > _SHORT_REPR.maxother:
            name = type(value).__name__
            return f"a result of {value.kind}" if hasattr(value, "more") else f"a {name} object"
        return " ".join(_SHORT_REPR.repr(value).split())
    except Exception:  # an integer of more than 4300 digits, or an odd class
        return f"a {type(value).__name__}"


def did_you_mean(name, allowed):
    """Return the hint about an unknown ``name``: the nearest of ``allowed``, or ""."""
    if not isinstance(name, str):
        return ""
    word = name[:100].lower().replace("-", "_")
    meant = SYNONYMS.get(word, word)
    if " " in meant and word != meant:
        return f"; {meant}"
    words = [meant] if meant in allowed else [word, meant]
    found = [near for each in words for near in get_close_matches(each, [*allowed], 1)]
    return f"; did you mean {found[0]}?" if found else ""


def decimal_hint(value):
    """Return the hint about a decimal comma in the text ``value``, "" for any other value."""
    if not isinstance(value, str) or not re.fullmatch(r"[-+]?\d+,\d+", value):
        return ""
    return f"; decimals follow a point, {value.replace(',', '.')}"


def format_number(value, form=""):
    """Return a number as the pages write it: 1e60 for Python's 1e+60."""
    return re.sub(r"e\+?(-?)0*(\d)", r"e\1\2", format(value, form))


def texts_with_error(value, error):
    """Return the texts of a value and its error; both end at the second digit of the error.

    Without an error, its text is empty. The value None is "–".
    """
    if value is None:
        return "–", ""
    if not error:
        return f"{value:.8g}", ""
    error = float(f"{error:.1e}")
    place = _exponent(error) - 1
    value = round(float(value), -place) + 0.0  # no -0
    digits = min(max(_exponent(value) - place + 1, 1), 17)
    return _to_digits(value, digits), _to_digits(error, 2)


def _exponent(x):
    """Return the power of ten of the first digit of ``x``."""
    return int(f"{x:e}".partition("e")[2])


def _to_digits(x, n):
    """Return ``x`` to ``n`` significant digits, zeros at the end among them: 1.3380."""
    return f"{x:#.{n}g}".rstrip(".")


def round_up(number):
    """Return the text of the next number from ``number`` > 0 on with two digits."""
    two_digits = Context(prec=2, rounding=ROUND_CEILING)
    return format_number(float(two_digits.create_decimal(repr(float(number)))), "g")


#: (seconds, the unit that they are) from the longest unit down.
_TIME_UNITS = (
    (365.25 * 86400, "years"), (86400.0, "d"), (3600.0, "h"), (60.0, "min"), (1.0, "s"),
    (1e-3, "ms"), (1e-6, "µs"),
)  # fmt: skip


def format_seconds(seconds):
    """Return a time to two digits: 0.12 s, 20 min, 3.5 d; "–" for None and infinity."""
    if seconds is None or not math.isfinite(seconds):
        return "–"
    length, unit = next((pair for pair in _TIME_UNITS if seconds >= pair[0]), _TIME_UNITS[-1])
    return f"{format_number(float(f'{seconds / length:.2g}'), 'g')} {unit}"


def shortest_decimal(value, distance, avoid=()):
    """Return the number of fewest digits within ``distance`` of ``value`` and not in ``avoid``."""
    candidates = (float(f"{value:.{digits}g}") for digits in range(1, 18))
    return next(c for c in candidates if abs(c - value) <= distance and c not in avoid)
