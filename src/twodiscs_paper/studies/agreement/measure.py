"""Statistics over the comparisons of all scenes: correlations, and errors of chains."""

import math
import statistics
from itertools import groupby

import numpy as np

from twodiscs.model.scene import Scene
from twodiscs.points.estimates import density_of_chains_at_zero, sums_of_others
from twodiscs.theory import exact
from twodiscs.theory.many.three import integrals

#: The pairs of events whose scores are correlated.
PAIRS = (("right_wall", "top_wall"), ("vertical_hop", "disc_collision"))

#: Bins with fewer intervals do not show how errors of chains differ from errors of counts.
WELL_FILLED = 1000


def normal_tests(check):
    """Return the independent tests of mean times by dynamics with a normal distribution."""
    wanted = {"comparison": "mean_time", "method": "dynamics", "test": "normal"}
    return [
        row
        for row in check
        if row["passed"] is not None and row["independent"] and wanted.items() <= row.items()
    ]


def scores(tests):
    """Yield the rows on the scores of ``tests`` (see ``normal_tests``) of all scenes."""
    if not tests:
        return
    mean_square = statistics.fmean(row["z"] ** 2 for row in tests)
    error = math.sqrt(2 / len(tests))
    yield {
        "quantity": "mean_square", "count": len(tests), "estimate": mean_square, "stderr": error
    }  # fmt: skip
    z = {(row["scene"], row["radius"], row["quantity"]): row["z"] for row in tests}
    for event, other in PAIRS:
        pairs = [
            (value, z[scene, radius, f"{other}_time"])
            for (scene, radius, quantity), value in z.items()
            if quantity == f"{event}_time" and (scene, radius, f"{other}_time") in z
        ]
        if len(pairs) > 2:
            correlation = statistics.correlation(*zip(*pairs, strict=True))
            row = {"quantity": "correlation", "event": event, "other": other}
            yield row | {"count": len(pairs), "estimate": correlation}


def error_ratio(bins):
    """Return the row on how much errors of chains exceed errors of independent counts.

    ``bins`` are rows of hop_histogram.csv.
    """
    ratios = []
    for row in bins:
        if row["count"] >= WELL_FILLED:
            fraction = row["count"] / row["intervals"]
            independent = math.sqrt(fraction * (1 - fraction) / row["intervals"])
            ratios.append(row["stderr"] * (row["right"] - row["left"]) / independent)
    return {"quantity": "error_ratio", "count": len(ratios), "estimate": max([1.0, *ratios])}


def densities(scene, bins):
    """Yield the rows on the density at zero of a ``scene``, from the first two equal bins."""
    equal = [row for row in bins if row["bins"] == "equal"]
    for (event, radius), found in groupby(equal, key=lambda row: (row["event"], row["radius"])):
        first = [*found][:2]
        if len(first) == 2 and all(row["stderr"] for row in first):
            value, error = density_of_chains_at_zero(
                [row["density"] for row in first], [row["stderr"] for row in first]
            )
            row = {"quantity": "density_at_zero", "scene": scene, "event": event}
            yield row | {"radius": radius, "count": 2, "estimate": value, "stderr": error}


def tests_of_effects(rows):
    """Return the row on the tests among the ``rows`` of effects.csv, or None without tests.

    If a count is the sum of other counts, its mean time is not an independent test.
    """
    judged = [row for row in rows if row["z"] is not None]
    tests = []
    for _, some in groupby(judged, key=lambda row: (row["scene"], row["radius"])):
        of_event = {row["quantity"].removesuffix("_time"): row for row in some}
        summed = sums_of_others(
            {e: row["count"] for e, row in of_event.items() if row["starts"] == "invariant"}
        )
        tests += [row for event, row in of_event.items() if event not in summed]
    if not tests:
        return None
    possible = sum(row["status"] != "impossible" for row in tests)
    largest = max(abs(row["z"]) for row in tests)
    return {"quantity": "effects", "count": possible, "estimate": largest}


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
    return {"quantity": "third_virial", "estimate": float(2 * (2 - bulk / second**2))}


def rows(tables):
    """Yield the rows of agreement.csv, without their empty cells.

    ``tables`` has the rows of <scene>/check, <scene>/hop_histogram and effects.
    """
    by_name = {"check": {}, "hop_histogram": {}}
    for path, found in tables.items():
        scene, _, name = path.rpartition("/")
        if scene:
            by_name[name][scene] = found
    check = by_name["check"].items()
    yield from scores(
        [row | {"scene": name} for name, found in check for row in normal_tests(found)]
    )
    histograms = by_name["hop_histogram"]
    yield error_ratio([row for found in histograms.values() for row in found])
    for scene, found in histograms.items():
        yield from densities(scene, found)
    if row := tests_of_effects(tables["effects"]):
        yield row
    yield third_virial()
