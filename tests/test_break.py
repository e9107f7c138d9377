"""The break test: an error bar could be wrong in some scene, so random ones go through the face.

Scores of a scene share its trajectories, so only one random score of each call is used:
scores of different calls are independent and standard normal. Their mean square and their coverage
are tested at 5 sigma each, the largest of all scores at Bonferroni's bound for 6e-7, for
any dependence: false alarms have a probability below 2e-6 for each of the tests. ``pytest -s``
prints the results.
"""

import math

import numpy as np
import pytest
from scipy.stats import binomtest, chi2, norm

import twodiscs as td
from twodiscs.model.events import HOPS
from twodiscs.theory.exact import events_per_interval
from twodiscs.theory.n_discs import exact_method

#: Two-sided, at 5 sigma.
ALARM = 2 * norm.sf(5)

#: Wall and disc events, samples, intervals of a call.
BUDGET, SAMPLES, INTERVALS = 2e6, 1e6, 65536

#: Effects by kind, drawn at random; each compiles other engines, for any numbers.
KINDS = {
    "plain": lambda draw: {},
    "channel": lambda draw: {"periodic": "x", "mass_ratio": draw(0.2, 5.0)},
    "field": lambda draw: {
        "field": draw(0.05, 1.0), "radius_ratio": draw(0.3, 3.0), "mass_ratio": draw(0.2, 5.0),
    },
    "rough": lambda draw: {"moment_of_inertia": draw(0.003, 1.0)},
    "rough ring": lambda draw: {"moment_of_inertia": draw(0.003, 1.0), "periodic": "x"},
    "torus": lambda draw: {"periodic": "xy", "mass_ratio": draw(0.2, 5.0)},
    "friction": lambda draw: {"friction": draw(0.1, 10.0), "mass_ratio": draw(0.2, 5.0)},
    "rough with friction": lambda draw: {
        "friction": draw(0.1, 10.0), "moment_of_inertia": draw(0.003, 1.0),
    },
    "three": lambda draw: {"discs": 3},
    "channel of many": lambda draw: {"discs": round(draw(4, 8)), "width": draw(3.0, 6.0)},
}  # fmt: skip


def random_scene(rng, kind):
    """Return a scene of a kind: any shape of the box, discs of 2 to 97 % of the largest radius."""

    def draw(low, high):
        return math.exp(rng.uniform(math.log(low), math.log(high)))

    while True:
        effects = KINDS[kind](draw)
        discs, width = effects.pop("discs", 2), effects.pop("width", draw(0.5, 3.0))
        box = td.Box(width, 1.0, discs=discs, **effects)
        try:
            scene = box.scene(box.last_radius * draw(0.02, 0.97))
            if discs > 3 and exact_method(scene) is None:
                continue  # no exact value is known
            td.simulate(scene, 0.5, seed=0, budget=1)  # says whether starts can be drawn
        except td.InputError:
            continue
        return scene


def scores_of(scene, seed):
    """Yield rows with scores, of one call after the other."""
    yield td.simulate(scene, 0.01, seed=seed, budget=BUDGET).rows
    yield td.sample(scene, SAMPLES, seed=seed).rows
    for hop in HOPS if scene.moment_of_inertia is None else ():
        if scene.is_possible(hop) and events_per_interval(scene, hop) * INTERVALS < 1e8:
            mean = td.intervals(scene, hop, INTERVALS, seed=seed).mean
            yield [{"z": mean.z, "test": "normal"}]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "number"),
    [(kind, {"plain": 80, "torus": 64, "rough ring": 64}.get(kind, 16)) for kind in KINDS],
)
def test_errors_of_random_scenes_are_what_they_say(kind, number):
    rng = np.random.default_rng(int.from_bytes(kind.encode(), "big"))
    every, picked = [], []
    for seed in range(number):
        scene = random_scene(rng, kind)
        for rows in scores_of(scene, seed):
            every += [(abs(row["z"]), scene, row) for row in rows if row["z"] is not None]
            normal = [row["z"] for row in rows if row["test"] == "normal"]
            if normal:
                picked.append(rng.choice(normal))
    square, covered = math.fsum(z * z for z in picked), sum(abs(z) < 1.96 for z in picked)
    n, largest = len(picked), max(every, key=lambda found: found[0])
    print(f"{kind}: {n} scores, mean square {square / n:.2f}, {covered / n:.1%} within 1.96,")
    print(f"the largest of {len(every)} is {largest[0]:.1f}, in {largest[1]!r}")
    assert 2 * min(chi2.cdf(square, n), chi2.sf(square, n)) > ALARM
    assert binomtest(covered, n, 0.95).pvalue > ALARM
    assert largest[0] < norm.isf(ALARM / 2 / len(every)), largest
