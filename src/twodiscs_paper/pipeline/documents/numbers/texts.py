"""Formats for single numbers or columns of a table: lists of cases, and corrections."""

import math
import re

from twodiscs_paper.pipeline.documents.numbers.rounding import (
    Format,
    Printed,
    at_most,
    in_words,
    plain,
    several,
    significant,
    with_error,
    words,
)

#: Words that a narrow table cuts in the names of events.
SHORT = {"vertical": "v.", "horizontal": "h.", "collision": "coll."}

#: A probability below this level is printed as 0.
LEVEL = 1e-3


def _cases(cases):
    parts = []
    for event in ("vertical_hop", "horizontal_hop"):
        radii = [significant(radius, 5).text for hop, radius in cases if hop == event]
        if radii:
            parts.append(f"{event.replace('_', ' ')}s at $r =$ {', '.join(radii)}")
    return Printed(None, "; ".join(parts))


def _step_floors(floors):
    return ", ".join(
        f"{significant(error, 2).text} at $Delta t =$ {significant(step, 2).text}"
        for step, error in sorted(floors, reverse=True)
    )


def _plurals(events):
    return " and ".join(f"{event.replace('_', ' ')}s" for event in events)


def _number_words(numbers):
    return " and ".join(in_words(n).text for n in sorted({*numbers}))


def _share(count, replicas):
    share = count / replicas
    return Printed(share, f"a share of {significant(share, 1).text}" if count else "none")


def _spread(pairs):
    of_radius = {}
    for radius, value in pairs:
        of_radius.setdefault(radius, []).append(value)
    return at_most([100 * (max(values) / min(values) - 1) for values in of_radius.values()])


def _chance(p):
    return significant(p, 1) if p > LEVEL else Printed(p, "$0$")


def _exact_or_measured(measured, error, exact):
    return significant(exact, 5) if exact is not None else with_error(measured, error)


def _list(write):
    return several(lambda values: Printed(None, write(values)))


#: Hops and radii, as part of a sentence.
CASES = several(_cases)
STEP_FLOORS, PLURALS, NUMBER_WORDS = map(_list, (_step_floors, _plurals, _number_words))
#: The largest of several values over the smallest.
QUOTIENT = several(lambda values: significant(max(values) / min(values), 2))
#: By how many per cent values at one radius differ at most, from pairs (radius, value).
SPREAD = several(_spread)
SHARE, CHANCE = Format(_share), Format(_chance)
EXACT_OR_MEASURED = Format(_exact_or_measured, takes_empty=True)
FIRST_LETTER = words(lambda event: event[0])
SHORT_EVENT = words(lambda event: " ".join(SHORT.get(word, word) for word in event.split("_")))
THEORY = words(lambda theory: theory.replace("none", "--"))
#: The second largest size of several values; the depth of an overlap, a negative gap.
OTHERS = several(lambda z: at_most(sorted(map(abs, z))[:-1]) if len(z) > 1 else None)
OVERLAP = several(lambda gaps: at_most([-min(gaps)]))
POWER_OF_TWO = Format(lambda x: Printed(x, f"$2^({round(math.log2(x))})$"))
FAILED = several(lambda passed: Printed(n := passed.count(False), str(n)))

# Corrections --------------------------------------------------------------------------------------


def _severity(severity, verdict):
    return severity if verdict == "wrong" else f"{severity}, in range"


def _ratio(ratio, radius):
    at = "" if radius is None else f" at {significant(radius, 3).text}"
    return Printed(ratio, significant(ratio, 3).text + at)


def _methods(decided_by):
    letters = {"Monte Carlo": "C", "dynamics": "D"}
    return " ".join(letters[method] for method in letters if method in decided_by) or "--"


def formulas(text):
    """Return a correction as markup; between its backticks is mathematics, as in plain text."""
    parts = text.split("`")
    parts[::2] = [plain(part) for part in parts[::2]]
    parts[1::2] = [_formula(part) for part in parts[1::2]]
    return "".join(parts)


def _formula(text):
    text = text.replace("−", "-")
    text = re.sub(r"√(\d)", r" sqrt(\1)", text).replace("√", " sqrt")
    text = re.sub("[²³⁴]", lambda match: "^" + str("  ²³⁴".index(match[0])), text)

    def letters(match):
        word = match[0]
        return word if word in ("sqrt", "arcsin", "min", "max") else f" {' '.join(word)} "

    text = re.sub("[A-Za-z]+", letters, text).replace(" _", "_")
    text = re.sub(r" *([‖|]) *", r"\1", text).replace("/", r"\/")
    return f"${text.strip()}$"


PLAIN, CORRECTION = (words(write)._replace(empty="") for write in (plain, formulas))
SEVERITY, METHODS = words(_severity), words(_methods)
RATIO = Format(_ratio, takes_empty=True)
