"""Intervals between hops: means, bins and their errors.

Without these tests intervals could be cut off at an end, put in another bin or have too small
errors.
"""

import math
from itertools import islice
from unittest.mock import Mock

import numpy as np
import pytest
from effect_scenes import PAPER, SCENES, THREE
from exact_motion import path_events
from marks import slow

import twodiscs as td
from twodiscs.dynamics import ensemble, runs
from twodiscs.dynamics.many import all_pairs, many_intervals, many_paths, many_rates
from twodiscs.dynamics.two import hop_clusters, returns, strip
from twodiscs.measure.intervals import make_intervals, resolving_edges
from twodiscs.points.intervals_point import BIN_GROWTH, N_BINS, wide_edges
from twodiscs.sampling.initial_states import STATE_ROWS, draw_states, start_sampler
from twodiscs.sampling.many import many_initial_states
from twodiscs.sampling.streams import open_stream
from twodiscs.theory.exact import event_rate
from twodiscs.theory.laws import density_at_zero


@pytest.mark.parametrize("hop", ["vertical_hop", "horizontal_hop"])
@pytest.mark.parametrize("radius", [0.05, 0.245])
def test_usual_bins_begin_with_less_than_an_event_of_a_pair_and_a_part_of_the_mean(hop, radius):
    """The first bin is the widest power of two with at most 0.4 events and 1/16 of the mean.

    The last one ends before 32 means, and one more bin, of 8 % of its time, would end after them.
    """
    scene = PAPER.with_radius(radius)
    mean, (_, first, *_, last) = td.mean_times(scene)[f"{hop}_time"], resolving_edges(scene, hop)
    most = min(0.4 / event_rate(scene), mean / 16)
    assert most / 2 < first <= most
    assert 32 / 1.081 * mean < last <= 32 * mean


@pytest.mark.parametrize(("event", "side"), [("vertical_hop", 1.0), ("horizontal_hop", 1.5)])
@pytest.mark.parametrize("scene", [PAPER.with_radius(0.1), PAPER, slow(SCENES["field"])], ids=repr)
def test_hop_intervals_have_their_exact_mean_and_density_at_zero(event, side, scene):
    """p(0⁺) = 3√2 / (16 (side − 2r)). In a field horizontal hops have separate starts."""
    found = runs.IntervalsRun(scene, event, 1_000_000, 10).run()
    assert abs(found.mean - td.mean_times(scene)[f"{event}_time"]) <= 5 * found.stderr
    assert sum(found.equal.counts) + found.overflow == found.intervals >= 1_000_000
    width, n = found.bin_width, found.intervals
    assert math.frexp(width)[0] == 0.5  # a power of two
    if scene.radius == 0.1:  # where the law p(0) − at² holds for two bins
        counts, squares = np.array(found.equal.counts[:2]), np.array(found.equal.squares[:2])
        error = np.sqrt(squares - counts**2 / found.chains) / (n * width)
        at_zero = np.array([7.0, -1.0]) / 6
        exact = 3 * math.sqrt(2) / (16 * (side - 0.2))
        assert density_at_zero(scene, event) == pytest.approx(exact, rel=1e-15)
        assert abs(counts @ at_zero / (n * width) - exact) <= 5 * np.hypot(*error * at_zero)


@pytest.mark.parametrize(("hop", "axis"), [("horizontal_hop", 0), ("vertical_hop", 1)])
def test_hops_are_those_along_their_axis_where_axes_are_not_exchanged(hop, axis, monkeypatch):
    """In a field, and for more than two discs; the kernels themselves are slow to compile."""
    scene, follow, record = SCENES["field"], Mock(), Mock(return_value=np.zeros((2, 1)))
    for module in (strip, returns, hop_clusters):
        monkeypatch.setattr(module, "follow", follow)
    monkeypatch.setattr(all_pairs, "record_intervals", record)
    given = hop, 1, 0, 1, 1, (1.0, None, np.zeros(2, int)), np.ones(1, bool)
    strip.run_blocks(scene, hop, strip.choose_strip(scene, hop), 1, 0, 1)
    returns.record_intervals(scene, *given)
    hop_clusters.hop_sums(scene, hop, [1.0], 1, 1)
    many_intervals.record_intervals(THREE, *given, window=1.0)
    experiments, scenes, samplers = zip(*(one.args[:3] for one in follow.mock_calls), strict=True)
    found = [*(one.horizontal for one in experiments[:2]), experiments[2].axis[0]]
    assert [*found, record.call_args.args[5]] == [True if axis == 0 else None] * 4
    assert scenes == (scene,) * 3
    assert [samplers[0].prism.neck.axis, *(one.surface for one in samplers[1:])] == [axis] * 3


def test_intervals_of_two_are_those_of_trajectories():
    """Equal and wide bins have the counts of all chains and the squares of each, in few lanes."""
    wide, number, going = 65 + np.arange(65) // 8, 32, np.ones(1, np.bool_)
    given = PAPER, "vertical_hop", 3, 4, 6, 4, (0.25, None, wide)
    times, sums = returns.record_intervals(*given, going, returns=number, lanes=3)
    assert not returns.record_intervals(*given, ~going, returns=number)[1].any()  # it is stopped
    drawn, due = np.zeros((2, STATE_ROWS, 4)), np.zeros_like(sums)
    for block, states in enumerate(drawn, 4):
        draw_states(open_stream(np.uint64(3), block), start_sampler(PAPER, surface=1), states)
    for time, state in zip(times, np.hstack(drawn)[:8].T, strict=True):
        rows = path_events(PAPER, tuple(state), math.inf)
        hops = (at for at, name, *_ in rows if name == "vertical_hop" and at > 0)
        own = np.diff([0.0, *islice(hops, number)])
        assert own.sum() == pytest.approx(time, rel=1e-12)
        bins = np.minimum(own / 0.25, 64).astype(int)
        c = np.bincount(np.concatenate([bins, wide[bins]]), minlength=wide[-1] + 1)
        due += [c, c * c]
    assert np.array_equal(sums, due)


def test_wide_bins_widen():
    edges = wide_edges()
    assert edges[:14] == list(range(14))
    growth = np.diff(edges) / np.maximum(edges[:-1], 1)
    assert (growth >= BIN_GROWTH).all()
    assert edges[-1] <= N_BINS < (1 + BIN_GROWTH) * edges[-1]


def test_intervals_end_at_their_error_or_at_the_budget():
    """A block is enough for ten per cent, some for three thousandths; one budget ends earlier."""
    given = {"seed": 1, "name": None, "bins": None, "hop": "vertical_hop"}
    assert make_intervals(PAPER, error=0.1, budget=1e6, **given).note is None
    # Half of what reaches an error has an error √2 larger, up to one block.
    assert 2e-3 < make_intervals(PAPER, error=3e-3, **given).mean.relative_stderr <= 3e-3
    said = r"an error of 0.001 of the mean, but the budget"
    with pytest.warns(td.AccuracyWarning, match=said) as all_:
        short = make_intervals(PAPER, error=1e-3, budget=1e6, **given)
    assert all_[0].filename == __file__
    assert f"ended the run at {short.mean.relative_stderr:.2g}" in short.note


# More than two discs -----------------------------------------------------------------------------


RING = td.Scene(1.5, 1.0, 0.15, discs=4, periodic="x")
#: An interval has ninety events: a window ends long before the interval that begins in it.
RARE = td.Scene(1.0, 1.5, 0.24, discs=3)
CELLS = td.Scene(4.0, 2.0, 0.15, discs=20, periodic="x", friction=4.0)


@pytest.mark.parametrize(
    ("scene", "event"),
    [
        (RARE, "vertical_hop"),
        slow(THREE, "horizontal_hop"),
        slow(RING, "vertical_hop"),
        (CELLS, "vertical_hop"),
        slow(td.Scene(4.0, 2.0, 0.2, discs=20), "horizontal_hop"),
    ],
    ids=repr,
)
def test_intervals_of_many_are_those_of_trajectories(scene, event, monkeypatch):
    """All that begin within the window, to their end, counted from the rows of each replica."""
    opened, open_block_kicks = [], ensemble.open_block_kicks

    def same_kicks(kicks, seed, replica=0):
        """Trajectories have the kicks of the replica 0, so here all have."""
        opened.append(replica)
        return open_block_kicks(kicks, seed)

    monkeypatch.setattr(ensemble, "open_block_kicks", same_kicks)
    monkeypatch.setattr(many_paths, "LOG_ENTRIES", 50)
    replicas, window = 5, 16.0
    if scene.discs == 20:
        window *= many_intervals.mean_interval(scene, event)
    width = window / 128
    wide, going = np.full(65, 65), np.ones(1, np.bool_)
    given = scene, event, 7, 3, 4, replicas, (width, None, wide)
    (times, numbers), sums = many_intervals.record_intervals(*given, going, window=window)
    # The same block after another one.
    two, _ = many_intervals.record_intervals(*given[:3], 2, 4, *given[5:], going, window=window)
    assert np.array_equal(two[:, replicas:], [times, numbers])
    # A call that is stopped has none, nor a window without a hop.
    for none in ({"going": ~going, "window": window}, {"going": going, "window": 1e-9}):
        assert not any(found.any() for found in many_intervals.record_intervals(*given, **none))
    due = np.zeros((3, 66), np.int64)
    for k, state in enumerate(many_initial_states.states(scene, replicas, 7, 3).T):
        rows = path_events(scene, state, 4 * window, seed=7)
        at = np.array([time for time, name, *_ in rows if name == event])
        own = np.diff(at)[at[:-1] < window]
        assert (numbers[k], times[k]) == (own.size, pytest.approx(own.sum(), rel=1e-9))
        bins = np.minimum(own / width, 64).astype(int)
        c = np.bincount(np.concatenate([bins, wide[bins]]), minlength=66)
        due += [c, c * c, c * own.size]
    assert np.array_equal(sums, due)
    # The price: a window has as many intervals as a chain counts at least, or up to twice as many.
    most = many_intervals.events_per_interval(scene, event) / many_rates.work_per_event(scene)
    most /= many_rates.expected_event_rate(scene) * many_intervals.mean_interval(scene, event)
    assert 1 <= most <= 2 + 2 / many_intervals.per_chain(scene, event)
    assert scene.discs < 20 or opened[:replicas] == [*range(3 * replicas, 4 * replicas)]
