"""Clusters of hops of two discs, and their correlations.

Without these tests hops that follow one another could be lost, counted twice or begin in other
initial states.

Statistical comparisons allow five standard errors: with some 40 of them a false alarm comes in
fewer than 3e-5 of all seeds.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from dynamics.rates import five, same_sizes
from marks import slow
from scalar_passages import sample
from scipy.stats import f

from twodiscs.dynamics.many import many_hop_clusters as of_many
from twodiscs.dynamics.transmission import cluster_coefficient, odd_clusters_per_passage, plateau
from twodiscs.dynamics.two import hop_clusters as of_two
from twodiscs.model.scene import Scene
from twodiscs_paper.studies.passages import near

HOP = "horizontal_hop"
TIMES = [0.2, 1.0, 5.0, 10.0]
NARROW = 0.246  # 0.016 of the height is left to discs side by side along y


@pytest.mark.slow
@pytest.mark.parametrize("periodic", ["", "x"])
@pytest.mark.parametrize("inertia", [None, 0.5])
def test_correlations_are_those_of_another_program(inertia, periodic):
    for radius in (0.218, NARROW):
        scene = Scene(1.5, 1.0, radius, periodic=periodic, moment_of_inertia=inertia)
        sums, events = of_two.hop_sums(scene, HOP, TIMES, 512, 3)
        assert events > 0
        other, _ = sample(scene, 20_000, 4, times=TIMES)
        means, errors = other.mean(axis=0), other.std(axis=0) / math.sqrt(len(other))
        found = near.coefficients_at_times(sums)
        for estimate, mean, error in zip(found, means, errors, strict=True):
            five(estimate.value, mean, math.hypot(estimate.stderr, error) + 1e-12)


ROUGH = Scene(1.5, 1.0, 0.247, moment_of_inertia=0.1)
KICKED = Scene(1.5, 1.0, NARROW, friction=20.0)


@pytest.mark.parametrize(
    ("scene", "gap"),
    [
        (Scene(1.5, 1.0, 0.247), 6.0),
        (Scene(1.5, 1.0, 0.1), 0.4),
        (ROUGH, 0.6),
        (ROUGH.with_radius(0.1), 0.4),
        (KICKED, 6.0),
        slow(replace(KICKED, moment_of_inertia=0.5), 6.0),
        # In a narrow channel, among small discs and on a ring.
        (Scene(2.25, 1.0, 0.24, discs=3), 6.0),
        slow(Scene(3.0, 1.0, 0.1, discs=4), 0.5),
        slow(Scene(2.25, 1.0, 0.235, discs=3, periodic="x"), 6.0),
    ],
    ids=repr,
)
def test_clusters_to_both_sides_are_those_of_another_program(scene, gap):
    """Spins are reversed with the velocities; kicks before and after time 0 are independent.

    The gap is counted from each hop, not from the bounce after it: of small discs that is as late.
    """
    module = of_two if scene.discs == 2 else of_many
    counts, _ = module.cluster_sizes(scene, HOP, gap, 192, 11)
    assert (counts[0], counts.sum()) == (0, 192 * of_two.HOPS_PER_BLOCK)
    same_sizes(counts, sample(scene, 4000, 12, gap=gap)[1])


EFFECTS = {
    "plain": (HOP, Scene(1.5, 1.0, 0.249)),
    "friction": (HOP, Scene(1.5, 1.0, 0.248, friction=8.0)),
    "unequal": (HOP, Scene(1.5, 1.0, 0.165, radius_ratio=2.0, mass_ratio=3.0)),
    "field": ("vertical_hop", Scene(1.0, 1.5, 0.248, field=0.2, friction=0.5)),
    "channel": (HOP, Scene(1.5, 1.0, 0.249, periodic="y", friction=8.0)),
    "balls": (HOP, Scene(1.5, 0.8, 0.232, depth=0.8)),
}


@pytest.mark.parametrize("name", ["plain", "friction", *map(slow, [*EFFECTS][2:])])
def test_both_estimates_of_effects_agree(name):
    """By clusters and by κ(t), where passages are rare; corrected for those in the gap."""
    (hop, scene), gap = EFFECTS[name], 6.0
    mean = 1 / near.passing_rate(scene, hop)
    early = cluster_coefficient(of_two.cluster_sizes(scene, hop, gap, 128, 6)[0])
    (late,) = near.coefficients_at_times(of_two.hop_sums(scene, hop, [gap], 256, 7)[0])
    kappa = plateau(early, gap, mean, odd_clusters_per_passage)
    other = plateau(late, gap, mean, near.order_correlation)
    five(kappa.value, other.value, math.hypot(kappa.stderr, other.stderr))
    assert 0 < kappa.value < 1


@pytest.mark.parametrize("effects", [{}, slow({"moment_of_inertia": 0.5}), slow({"field": 0.8})])
def test_hops_on_a_ring_have_their_exact_rate(effects):
    """In a field the flux has another power of the energy than the volume."""
    scene = Scene(1.5, 1.0, 0.2, periodic="x", **effects)
    sums, _ = of_two.hop_sums(scene, HOP, [20.0], 256, 8, on_surface=False)
    counts = sums[:, 2, 0] / (20.0 * of_two.HOPS_PER_BLOCK)
    five(counts.mean(), near.passing_rate(scene, HOP), counts.std(ddof=1) / 16)


def test_displacements_grow_as_the_correlations_say():
    """d⟨n²⟩/dt = Γ C(t), between t = 20 and 40 where C has its limit."""
    scene = Scene(1.5, 1.0, 0.22, periodic="x")
    sums, _ = of_two.hop_sums(scene, HOP, [20.0, 40.0], 512, 9, on_surface=False)
    rate = near.passing_rate(scene, HOP)
    grown = (sums[:, 1, 1] - sums[:, 1, 0]) / (20.0 * of_two.HOPS_PER_BLOCK * rate)
    (due,) = near.coefficients_at_times(of_two.hop_sums(scene, HOP, [30.0], 512, 10)[0])
    error = grown.std(ddof=1) / math.sqrt(len(grown))
    five(grown.mean(), due.value, math.hypot(error, due.stderr))


def test_blocks_are_what_results_depend_on():
    scene = Scene(1.5, 1.0, 0.24)
    whole, events = of_two.hop_sums(scene, HOP, TIMES, 6, 11)
    parts = [of_two.hop_sums(scene, HOP, TIMES, 3, 11, first) for first in (0, 3)]
    np.testing.assert_array_equal(whole, np.concatenate([sums for sums, _ in parts]))
    # Hops between walls alternate: C = 1 + 2 n is +1 or −1 in every replica.
    np.testing.assert_array_equal(whole[:, 1], -whole[:, 0])
    assert events == sum(events for _, events in parts)
    turned = scene.turned().with_radius(0.24)
    np.testing.assert_array_equal(whole, of_two.hop_sums(turned, "vertical_hop", TIMES, 6, 11)[0])


def test_blocks_of_a_pair_among_others_have_separate_kicks(monkeypatch):
    opened = []
    monkeypatch.setattr(of_many, "open_kicks", lambda *given: opened.append(given[2]))
    monkeypatch.setattr(of_many, "follow_pair", lambda *given: 0)
    monkeypatch.setattr(of_many, "follow_blocks", of_many.follow_blocks.py_func)
    of_many.hop_sums(Scene(1.5, 1.0, 0.1, friction=20.0), HOP, [2.0], 2, 1, first=3)
    assert opened == [*range(3 * of_two.HOPS_PER_BLOCK, 5 * of_two.HOPS_PER_BLOCK)]


def test_blocks_have_separate_kicks():
    """The means of 20 seeds vary as those of 16 independent blocks: F test, five errors."""
    scene, blocks = Scene(1.5, 1.0, 0.1, friction=20.0), 16
    sums = [of_two.hop_sums(scene, HOP, [2.0], blocks, seed)[0][:, 2, 0] for seed in range(20)]
    within = np.var(sums, axis=1, ddof=1).mean()
    ratio = blocks * np.mean(sums, axis=1).var(ddof=1) / within
    assert f.sf(ratio, 19, 20 * (blocks - 1)) > 5.7e-7
