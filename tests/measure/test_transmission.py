"""The transmission coefficient of a hop, and when it has an error.

Without it hops that return could count as passages, or an error be made up.
"""

import math
from dataclasses import replace
from functools import partial

import numpy as np
import pytest

import twodiscs as td
from twodiscs.dynamics import transmission
from twodiscs.dynamics.two import hop_clusters
from twodiscs.model.formats import texts_with_error
from twodiscs.points.estimates import Estimate
from twodiscs.sampling import rounds
from twodiscs_paper.studies.passages.near import coefficients_at_times, order_correlation


def test_clusters_are_weighed_by_their_sizes():
    """Hops in clusters of 1, 2 and 3 are 1, 0 and 1/3 passages each."""
    sizes = np.zeros(hop_clusters.LARGEST_CLUSTER + 1, np.int64)
    sizes[1:4] = 600, 200, 300
    kappa = transmission.cluster_coefficient(sizes)
    values = np.repeat([1, 0, 1 / 3], [600, 200, 300])
    assert kappa.value == pytest.approx(values.mean(), rel=1e-14)
    assert kappa.stderr == pytest.approx(values.std() / math.sqrt(1100), rel=1e-12)
    sizes[-1] = 100  # more than are counted: no passages
    assert transmission.cluster_coefficient(sizes).value == pytest.approx(700 / 1200, rel=1e-14)


def test_errors_of_a_correlation_between_walls_are_binomial():
    sums = np.zeros((2, hop_clusters.N_HOP_SUMS, 1), np.int64)
    sums[:, 0, 0], sums[:, 1, 0] = -10, 10  # 20 of the replicas have changed sides
    (found,) = coefficients_at_times(sums)
    n = 2 * hop_clusters.HOPS_PER_BLOCK
    assert found.value == 1 - 2 * 20 / n
    assert found.stderr == pytest.approx(math.sqrt((1 - found.value**2) / n), rel=1e-14)


LAWS = {
    "order": order_correlation,
    "clusters": transmission.odd_clusters_per_passage,
    "clusters of a pair of many": partial(transmission.odd_clusters_per_passage, others=4 / 3),
}


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_a_plateau_is_what_passages_leave(law):
    """κ follows from its value after 0.01 passages; there is none if passages are too frequent."""
    kappa, time, mean = 0.8, 5.0, 400.0
    left, derivative = law(kappa * time / mean)
    assert left == pytest.approx(1 - 2 * kappa * time / mean, abs=5e-4)
    step = 1e-6
    assert derivative == pytest.approx((law(0.01 + step)[0] - left) / step, rel=1e-5)
    fallen = kappa * left
    found = transmission.plateau(Estimate(fallen, 0.01, 9), time, mean, law)
    assert found.value == pytest.approx(kappa, rel=1e-12)
    higher = transmission.plateau(Estimate(fallen + step, 0.01, 9), time, mean, law).value
    assert found.stderr == pytest.approx(0.01 * (higher - kappa) / step, rel=1e-3)
    # Up to a tenth of a passage in the time.
    assert transmission.plateau(Estimate(0.5, 0.01, 9), 2.0, 10.0, law) is not None
    assert transmission.plateau(Estimate(0.5, 0.01, 9), 2.0, 9.98, law) is None
    for least in (0.0, -0.01):
        assert transmission.plateau(Estimate(least, 0.01, 9), time, mean, law) is None


@pytest.mark.parametrize(("x", "others"), [(0.01, 0.0), (0.3, 0.0), (0.3, 4 / 3)])
def test_a_pair_that_parts_has_fewer_passages(x, others):
    """The next passage of the pair comes in a gap, unless a passage of another pair comes first."""
    rng, size = np.random.default_rng(2), 2**18
    own = rng.exponential(1 / x, size)
    parted = rng.exponential(1 / (others * x), size) if others else np.full(size, np.inf)
    ends = np.flatnonzero((own > 1) | (own > parted))
    sizes = np.diff(ends)
    odd = (sizes % 2).sum() / sizes.sum()
    five_errors = 5 / math.sqrt(sizes.size)
    assert abs(odd - transmission.odd_clusters_per_passage(x, others)[0]) <= five_errors < 0.02


def test_the_face_has_the_coefficient_and_the_curve_of_whole_blocks():
    scene, asked = td.Scene(1.5, 1.0, 0.246), 2**14 - hop_clusters.HOPS_PER_BLOCK + 1
    found = td.transmission(scene, "horizontal_hop", hops=asked, seed=1)
    kappa, passage = found.coefficient, found.passage_time
    # A trial by a scalar program: 0.797(2) at this radius, without what later passages take.
    assert abs(kappa.value - 0.797) < 0.02
    assert passage.value == pytest.approx(td.mean_times(scene)["horizontal_hop_time"] / kappa.value)
    assert passage.relative_stderr == pytest.approx(kappa.relative_stderr)
    frame = found.frame()
    assert list(frame.columns) == ["kappa", "stderr"]
    assert frame.index[-1] == pytest.approx(10 * scene.range_x, rel=1e-12)
    assert "fraction of horizontal hops that are passages 0." in str(found)
    assert found.curve[0].n == sum(found.clusters.values()) == 2**14
    left, _ = transmission.odd_clusters_per_passage(found.gap / passage.value)
    assert found.uncorrected == pytest.approx(kappa.value * left)
    for number in (kappa, passage):
        value, error = texts_with_error(number.value, number.stderr)
        assert f" {value} ± {error}\n" in f"{found}\n"
    for number, error in ((found.uncorrected, kappa.stderr), (found.exact_mean, passage.stderr)):
        assert f" {texts_with_error(number, error)[0]}\n" in str(found)
    assert td.transmission(scene, "horizontal_hop", hops=2**14, seed=2).coefficient != kappa


def test_a_pause_is_long_against_diffusion():
    """Discs diffuse with ⟨u²⟩/γ, and 1/⟨u²⟩ is the number of components of all velocities.

    The mode cos(πx₁/A) cos(πx₂/A) of their separation lasts γA²/(2π²⟨u²⟩). Two of three discs have
    two thirds of the box, or of the whole ring, whose total momentum is 0.
    """
    smooth = td.Scene(1.5, 1.0, 0.249, friction=640.0)
    rough = replace(smooth, moment_of_inertia=0.5)
    three = replace(smooth, width=2.25, discs=3)
    for scene, squares in ((smooth, 4), (rough, 6), (three, 6), (replace(three, periodic="x"), 5)):
        room = 2 / scene.discs * (scene.width - 2 * scene.radius * (not scene.periodic))
        gap = transmission.quiet_time(scene, "horizontal_hop")
        assert 1 < gap / (scene.friction * room**2 * squares / (2 * math.pi**2)) < 1.3
    slow = replace(smooth, friction=40.0)
    assert transmission.quiet_time(slow, "horizontal_hop") == 48 * slow.range_x


def test_calls_add_up_to_separate_blocks(monkeypatch):
    """One call a block gives what one call gives for all of them."""
    monkeypatch.setattr(rounds, "EVENTS_PER_CALL", 1.0)
    given, blocks = (td.Scene(1.5, 1.0, 0.246), "horizontal_hop"), 16
    hops = blocks * hop_clusters.HOPS_PER_BLOCK
    found = td.transmission(*given, hops, seed=1, name="a")
    seeds = [transmission.hop_seed(*given, "a", 1, part) for part in ("clusters", "times")]
    sizes, followed = hop_clusters.cluster_sizes(*given, found.gap, blocks, seeds[0])
    assert found.clusters == {n: hops for n, hops in enumerate(sizes.tolist()) if hops}
    sums, counted = hop_clusters.hop_sums(*given, found.times, blocks, seeds[1])
    assert found.curve == transmission.time_estimates(sums.sum(axis=0), hops)
    # Events are as many as the plan of the run says, roughly.
    planned = transmission.TransmissionRun(*given, hops, 1, "a").components
    for part, events in (("clusters", followed), ("times", counted)):
        assert 0.5 < events / (blocks * planned[part].block_events) < 2


def test_more_discs_have_a_coefficient_too():
    """The time between passages is known with the exact rate of hops."""
    three, four = (td.Scene(0.75 * n, 1.0, 0.247, discs=n) for n in (3, 4))
    found = td.transmission(three, "horizontal_hop", 2**12)
    assert found.neighbour_mean == pytest.approx(2 * found.exact_mean, rel=1e-14)
    sizes = np.zeros(hop_clusters.LARGEST_CLUSTER + 1, np.int64)
    sizes[[*found.clusters]] = [*found.clusters.values()]
    raw = transmission.cluster_coefficient(sizes)
    law = partial(transmission.odd_clusters_per_passage, others=1.0)
    assert found.coefficient == transmission.plateau(raw, found.gap, found.neighbour_mean, law)
    # By 2¹⁸ hops, which do not depend on the gap.
    assert abs(found.coefficient.value - 0.838) <= 5 * found.coefficient.stderr < 0.05
    assert found.passage_time.value == pytest.approx(found.exact_mean / found.coefficient.value)
    other = td.transmission(four, "horizontal_hop", 2**11)
    assert other.exact_mean is other.passage_time is None
    assert "fraction of horizontal hops that are passages 0.8" in str(other)
    assert "mean time" not in str(other)
    assert other.more(2**12).coefficient.stderr < other.coefficient.stderr


@pytest.mark.parametrize("fewest", [100, 99])
@pytest.mark.parametrize(("rare", "frequent"), [(2, 1), (3, 2), (1, 4), (3, 1)])
def test_which_clusters_have_an_error(rare, frequent, fewest):
    """A hundred of each size that occurs are enough."""
    sizes = np.zeros(5, int)
    sizes[[rare, frequent]] = fewest, 900
    found = transmission.cluster_estimate(sizes)
    assert (found.relative_stderr is not None) == (fewest == 100)
    assert found.value == transmission.cluster_coefficient(sizes).value


def test_which_times_have_an_error():
    """Of 1000 replicas 100 have a hop back, 99, 901, 900, and on a ring as many as go on."""
    sums = np.array([[-100, -99, -901, -900, 0], [100, 99, 901, 900, 5000]])
    found = transmission.time_estimates(sums, 1000)
    assert [one.stderr is not None for one in found] == [True, False, False, True, True]


def test_frequent_hops_have_a_curve_only():
    found = td.transmission(td.Scene(1.5, 1.0, 0.2), "vertical_hop", hops=1000)
    assert found.coefficient is found.passage_time is None
    assert found.clusters == {}  # none are looked for: they would hardly end
    assert "too frequent" in str(found)
    assert len(found.frame()) == len(transmission.KAPPA_TIMES)
    # Up to a quarter of a hop in the pause.
    scene, pause = td.Scene(1.5, 1.0, 0.2), 48 * 1.1
    assert transmission.are_rare(scene, "horizontal_hop", 4.001 * pause)
    assert not transmission.are_rare(scene, "horizontal_hop", 3.999 * pause)
