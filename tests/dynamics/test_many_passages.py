"""Clusters of hops of a pair among many discs.

Without these tests hops of a pair could be correlated in another way if other discs collide with
it.

Statistical comparisons allow five standard errors: with some 40 of them a false alarm comes in
fewer than 3e-5 of all seeds.
"""

import math

import numpy as np
import pytest
from dynamics.rates import five, same_sizes
from marks import slow

from twodiscs.dynamics.many import many_hop_clusters as of_many
from twodiscs.dynamics.transmission import cluster_coefficient, odd_clusters_per_passage, plateau
from twodiscs.dynamics.two import hop_clusters as of_two
from twodiscs.model.scene import Scene
from twodiscs.theory import n_discs
from twodiscs_paper.studies.passages.near import coefficients_at_times

HOP = "horizontal_hop"


@pytest.mark.parametrize(
    ("hop", "effects"),
    [
        (HOP, {}),
        slow(HOP, {"friction": 20.0}),
        ("vertical_hop", {}),
        slow(HOP, {"moment_of_inertia": 0.5}),
        slow(HOP, {"moment_of_inertia": 0.5, "friction": 1.0}),
    ],
)
def test_two_discs_among_no_others_are_two_discs(hop, effects):
    sides = (1.5, 1.0) if hop == HOP else (1.0, 1.5)
    scene = Scene(*sides, 0.246, **effects)
    counts, events = of_many.cluster_sizes(scene, hop, 6.0, 128, 11)
    other, due = of_two.cluster_sizes(scene, hop, 6.0, 128, 12)
    same_sizes(counts, np.repeat(np.arange(other.size), other))
    assert events == pytest.approx(due, rel=0.05)
    found, reference = (
        coefficients_at_times(module.hop_sums(scene, hop, [0.2, 1.0, 5.0], 256, 3)[0])
        for module in (of_many, of_two)
    )
    for mine, known in zip(found, reference, strict=True):
        five(mine.value, known.value, math.hypot(mine.stderr, known.stderr))


@pytest.mark.parametrize("module", [of_two, of_many])
def test_the_hop_at_time_0_is_not_among_those_after_it(module):
    assert not module.hop_sums(Scene(1.5, 1.0, 0.246), HOP, [1e-12], 1, 3)[0].any()


@pytest.mark.parametrize("module", [of_two, of_many])
def test_the_last_size_has_all_larger_clusters_which_are_not_followed(module, monkeypatch):
    clusters = Scene(1.5, 1.0, 0.246), HOP, 6.0, 16, 11
    sizes, events = module.cluster_sizes(*clusters)
    monkeypatch.setattr(module, "LARGEST_CLUSTER", 2)
    some, fewer = module.cluster_sizes(*clusters)
    assert some.tolist() == [*sizes[:2], sizes[2:].sum()]
    assert 0 < fewer < events


def test_it_does_not_matter_where_a_ring_begins():
    """Hops within a short gap after random ones, and after the same ones half a turn further."""
    scene, gap = Scene(1.0, 1.0, 0.1, discs=3, periodic="x"), 1.0
    pair = of_many.surface_pair(scene, HOP)
    states, found = np.zeros((12, 2**11)), []
    of_many.draw_on_surface(of_many.open_stream(np.uint64(2), 0), pair, states, -1)
    for begun in (0.0, scene.width / 2):
        turned = states.copy()
        turned[:3] -= np.where(turned[:3] > 0, begun, -begun)
        net, hops = np.zeros((2, states.shape[1]))
        now = of_many.begin(3, turned, 0, net, hops)
        time = np.full(states.shape[1], gap)
        of_many.follow_pair(now, time, gap, 2**13, net, hops, pair.law, None)
        found.append(hops)
    assert found[0].sum() > 400
    assert np.array_equal(*found)


@pytest.mark.parametrize(("periodic", "components"), [("", 4), ("x", 3)])
def test_states_on_the_surface_have_the_law_of_the_flux(periodic, components):
    """For s, the relative speed over its largest, (1 − s²)^((D − 1)/2) is uniform.

    Places are uniform: each disc has, on average, a third of the room between it and its wall.
    """
    scene = Scene(1.5, 1.0, 0.2, discs=2, periodic=periodic)
    states = np.zeros((8, 2**14))
    stream = of_many.open_stream(np.uint64(1), 0)
    of_many.draw_on_surface(stream, of_many.surface_pair(scene, HOP), states, -1)
    law = (1 - (states[4] - states[5]) ** 2 / 2) ** ((components - 1) / 2)
    five(law.mean(), 0.5, 1 / math.sqrt(12 * law.size))
    rooms = (scene.range_y / 2 - np.abs(states[2:4])) / scene.clearance(HOP)
    assert np.all(rooms.sum(axis=0) < 1 + 1e-14)
    for share in rooms:
        five(share.mean(), 1 / 3, 1 / math.sqrt(18 * share.size))
    five((states[0] ** 2).mean() * 12 / scene.range_x**2, 1.0, math.sqrt(0.8 / law.size))


def test_the_sampled_rate_of_hops_is_the_exact_one(monkeypatch):
    """Its error is that of 2¹⁴ accepted proposals, and the smaller one of the volume."""
    scene = Scene(2.25, 1.0, 0.2499, discs=3)
    due = n_discs.rate(scene, HOP)
    monkeypatch.setattr(n_discs, "rate", lambda scene, hop: None)
    of_many.hop_rate.cache_clear()
    found = of_many.hop_rate(scene, HOP)
    of_many.hop_rate.cache_clear()
    _, volume_error = of_many.insertions.sample(scene, of_many.VOLUME_SAMPLES, 0)
    error = math.hypot(1 / math.sqrt(of_many.SURFACE_STATES), volume_error[0])
    five(found / due, 1.0, error)


@pytest.mark.parametrize(("discs", "blocks"), [(3, 256), slow(6, 4096)])
def test_the_coefficient_does_not_depend_on_the_gap(discs, blocks):
    """Passages in the longer gap take 15 % of κ, one per cent of κ less because of other pairs.

    The slow one sees both.
    """
    scene = Scene(0.75 * discs, 1.0, 0.246, discs=discs)
    mean, others = of_many.neighbours(scene, HOP)
    assert others == pytest.approx(2 * (discs - 2) / (discs - 1), rel=1e-14)
    found = []
    for gap in (8.0, 80.0):
        kappa = cluster_coefficient(of_many.cluster_sizes(scene, HOP, gap, blocks, 9)[0])
        found.append(plateau(kappa, gap, mean, lambda x: odd_clusters_per_passage(x, others)))
    short, long = found
    five(short.value, long.value, math.hypot(short.stderr, long.stderr))


@pytest.mark.parametrize(
    ("scene", "hop", "said"),
    [
        (Scene(48, 1, 0.2, discs=64), HOP, r"^discs must be at most 19 for passages, not 64$"),
        (Scene(3, 1, 0.25, discs=4), HOP, "must be open for passages, but is blocked at radius"),
        (Scene(3, 1, 0.25, discs=4, periodic="x"), HOP, "must be open for passages, but is"),
        (Scene(3, 1, 0.2, discs=4, periodic="x"), "vertical_hop", "along the only periodic axis"),
        (Scene(4, 1, 0.15, discs=14), HOP, "fewer than 0.0001 of the proposals of a hop have no"),
    ],
)
def test_what_cannot_be_followed_is_refused_in_a_sentence(scene, hop, said, monkeypatch):
    monkeypatch.setattr(of_many, "MOST_SURFACE_PROPOSALS", 2**16)
    with pytest.raises(of_many.InputError, match=said):
        of_many.require_coefficient(scene, hop)


def test_hops_on_a_ring_can_be_followed_although_they_are_no_events():
    ring = Scene(3, 1, 0.1, discs=4, periodic="x")
    assert HOP not in ring.events
    of_many.require_coefficient(ring, HOP)


def test_all_tiny_discs_on_the_surface_of_a_hop_are_apart():
    accepted, proposals = of_many.surface_fraction(Scene(1.5, 1.0, 1e-6, discs=3), HOP)
    assert accepted == proposals


@pytest.mark.parametrize("periodic", ["", "x"])
def test_neighbours_share_as_many_hops_as_pairs_have_a_disc_in_common(periodic, monkeypatch):
    monkeypatch.setattr(of_many, "hop_rate", lambda scene, hop: 2.0)
    scene = Scene(4.0, 1.0, 0.2, discs=5, periodic=periodic)
    pairs = [{n, (n + 1) % 5} for n in range(5 if periodic else 4)]
    shared = [sum(len(one & other) == 1 for other in pairs) for one in pairs]
    assert of_many.neighbours(scene, HOP) == (len(pairs) / 2.0, np.mean(shared))
