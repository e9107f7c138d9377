"""Statistics over the comparisons of all scenes: scores, and errors of chains."""

import math
import statistics
from itertools import groupby

import numpy as np

from twodiscs.model.scene import Scene
from twodiscs.points.estimates import Estimate, density_of_chains_at_zero, sums_of_others
from twodiscs.theory import exact
from twodiscs.theory.three import integrals
from twodiscs_paper.study import row, select


def normal_tests(check):
    """Return the independent tests of mean times by dynamics with a normal distribution."""
    wanted = {"comparison": "mean_time", "method": "dynamics", "test": "normal"}
    found = select(check, independent=True, **wanted)
    return [one for one in found if one["passed"] is not None]


def scores(tests):
    """Yield the row on the scores of ``tests`` (see ``normal_tests``) of all scenes."""
    if tests:
        number = len(tests)
        square = statistics.fmean(one["z"] ** 2 for one in tests)
        found = Estimate(square, math.sqrt(2 / number), number)
        yield row({}, found, quantity="mean_square", count=number)


def error_ratio(bins):
    """Return the row on how much errors of chains exceed errors of independent counts.

    ``bins`` are rows of hop_histogram.csv.
    """
    ratios = []
    for one in bins:
        # Bins with fewer intervals do not show how errors of chains differ from errors of counts.
        if one["count"] >= 1000:
            fraction = one["count"] / one["intervals"]
            independent = math.sqrt(fraction * (1 - fraction) / one["intervals"])
            ratios.append(one["stderr"] * (one["right"] - one["left"]) / independent)
    return row({}, quantity="error_ratio", count=len(ratios), estimate=max([1.0, *ratios]))


def densities(scene, bins):
    """Yield the rows on the density at zero of a ``scene``, from the first two equal bins."""
    equal = [one for one in bins if one["bins"] == "equal"]
    for (event, radius), found in groupby(equal, key=lambda one: (one["event"], one["radius"])):
        first = [*found][:2]
        if len(first) == 2 and all(one["stderr"] for one in first):
            value, error = density_of_chains_at_zero(
                [one["density"] for one in first], [one["stderr"] for one in first]
            )
            start = {"scene": scene, "event": event, "radius": radius, "count": 2}
            yield row(start, quantity="density_at_zero", estimate=value, stderr=error)


def tests_of_effects(rows):
    """Yield the row on the tests among the ``rows`` of effects.csv, if there are tests.

    If a count is the sum of other counts, its mean time is not an independent test.
    """
    judged = [one for one in rows if one["z"] is not None]
    tests = []
    for _, some in groupby(judged, key=lambda one: (one["scene"], one["radius"])):
        of_event = {one["quantity"].removesuffix("_time"): one for one in some}
        summed = sums_of_others(
            {e: one["count"] for e, one in of_event.items() if one["starts"] == "invariant"}
        )
        tests += [one for event, one in of_event.items() if event not in summed]
    if tests:
        possible = sum(one["status"] != "impossible" for one in tests)
        largest = max(abs(one["z"]) for one in tests)
        yield row({}, quantity="effects", count=possible, estimate=largest)


#: Ranges A × B of the centres in units of σ, in which three discs in a row have room.
RANGES = ((2.5, 2.5), (2.5, 3.0), (3.0, 3.0))


def third_virial():
    """Return the row on B₃/B₂² of hard discs, from the exact volumes of two and three discs.

    The cluster integral β = V₃/6 − V₁V₂/2 + V₁³/3 is bulk, edges and corners:
    (2B₂² − B₃/2) AB + e (A + B) + c, if three discs in a row have room, so three boxes give it.
    """
    equations, clusters = [], []
    for across, up in RANGES:
        sides = across + 1, up + 1  # of a box of discs with the diameter 1
        two = exact.volume(Scene(*sides, 0.5))
        three = integrals(across, up, 1.0)[0]
        one = across * up
        equations.append((one, across + up, 1))
        clusters.append(three / 6 - one * two / 2 + one**3 / 3)
    bulk = np.linalg.solve(equations, clusters)[0]
    second = math.pi / 2
    return row({}, quantity="third_virial", estimate=float(2 * (2 - bulk / second**2)))


def rows(tables):
    """Yield the rows of agreement.csv.

    ``tables`` has the rows of <scene>/check, <scene>/hop_histogram and effects.
    """
    checks = [rows for path, rows in tables.items() if path.endswith("/check")]
    yield from scores([one for rows in checks for one in normal_tests(rows)])
    histograms = {
        path.removesuffix("/hop_histogram"): rows
        for path, rows in tables.items()
        if path.endswith("/hop_histogram")
    }
    yield error_ratio([one for found in histograms.values() for one in found])
    for scene, found in histograms.items():
        yield from densities(scene, found)
    yield from tests_of_effects(tables["effects"])
    yield third_virial()
