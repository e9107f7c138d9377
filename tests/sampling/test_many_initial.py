"""Initial states of many discs: all three methods have one law.

Without these tests initial states of many discs could overlap, or one way to draw them have another
law.
"""

import itertools
import math

import numpy as np
import pytest
from marks import slow
from scipy.stats import f

from twodiscs.model.many_geometry import arrangement, is_ordered
from twodiscs.model.scene import Scene
from twodiscs.sampling.many import many_initial_states
from twodiscs.sampling.streams import open_stream


def box(discs, packing, periodic=""):
    """Return discs of the radius .1 at a packing fraction, in a square."""
    side = math.sqrt(discs * math.pi * 0.01 / packing)
    return Scene(side, side, 0.1, discs=discs, periodic=periodic)


GASES = {
    "rejection": Scene(1.5, 1.0, 0.16, discs=5),
    "channel": Scene(1.5, 0.6, 0.18, discs=4),
    "channel, dense": Scene(2.3, 0.6, 0.18, discs=8),
    "channel, upright": Scene(0.6, 2.0, 0.18, discs=5),
    "channel, narrow": Scene(40.0, 0.6, 0.29, discs=64),
    "chain": Scene(1.5, 1.0, 0.2, discs=6),
    "rejection, ring": Scene(1.5, 1.0, 0.15, discs=4, periodic="x"),
}
#: Enough discs that chains of events draw them.
LARGE = [
    box(256, 0.6),
    box(256, 0.6, "x"),
    Scene(40.0, 0.6, 0.18, discs=128),
    Scene(0.41, 30.0, 0.1, discs=128, periodic="x"),
]


def apart(scene, found):
    """Return (x, y, u, v) of states and the distances of all pairs, in rows."""
    x, y, u, v = np.split(found, 4)
    i, j = np.array([*itertools.combinations(range(scene.discs), 2)]).T
    dx = x[i] - x[j]
    dx -= scene.width * np.round(dx / scene.width) if scene.periodic else 0.0
    return x, y, u, v, dx, y[i] - y[j]


@pytest.mark.parametrize("scene", [*GASES.values(), *LARGE], ids=repr)
def test_states_are_allowed(scene):
    found = many_initial_states.states(scene, 10 if scene in LARGE else 200, 1)
    x, y, u, v, dx, dy = apart(scene, found)
    assert np.min(np.hypot(dx, dy)) >= scene.contact_distance * (1 - 1e-14)
    assert np.max(np.abs(x)) <= scene.range_x / 2
    assert np.max(np.abs(y)) <= scene.range_y / 2
    assert np.sum(u**2 + v**2, axis=0) == pytest.approx(1.0, rel=1e-12)
    assert not scene.periodic or np.max(np.abs(np.sum(u, axis=0))) < 1e-14
    if scene in LARGE:  # no disc is left where it began
        began = np.array(arrangement(scene)).T
        assert not np.any(x == began[0][:, None])
        assert is_ordered(scene) or not np.any(y == began[1][:, None])


@pytest.mark.parametrize("name", GASES)
def test_the_way_to_draw_is_chosen(name):
    assert many_initial_states.method(GASES[name]) == name.split(",")[0]


EDGES = (1.0, 1.05, 1.2, 1.5, 2.0, 2.5, 3.5)


def moments(scene, found):
    """Return numbers of each state: places, velocities, pair distances, and sixfold order."""
    x, y, u, v, dx, dy = apart(scene, found)
    distance = np.hypot(dx, dy) / scene.contact_distance
    shells = [((a < distance) & (distance < b)).sum(0) for a, b in itertools.pairwise(EDGES)]
    six = np.exp(6j * np.arctan2(dy, dx)) * (distance < 1.4)
    return np.array(
        [(x**2).mean(0), (y**2).mean(0), (y**4).mean(0), (u**4).mean(0), (v**4).mean(0),
         distance.min(0), (distance**2).mean(0), np.abs(dy).mean(0), *shells,
         np.abs(six.sum(0)) ** 2, np.cos(2 * math.pi * x / scene.width).mean(0) ** 2]
    )  # fmt: skip


def difference(scene, one, other):
    """Return the largest difference of mean numbers of two sets of states, in standard errors."""
    one, other = moments(scene, one), moments(scene, other)
    # Rare numbers may be in one of the sets only: both have the spread of their union.
    spread = np.hstack([some - some.mean(1, keepdims=True) for some in (one, other)]).std(1)
    error = spread * math.sqrt(1 / one.shape[1] + 1 / other.shape[1])
    return np.max(np.abs(one.mean(1) - other.mean(1)) / np.maximum(error, 1e-300))


def drawn(scene, number, seed, **changes):
    """Return ``number`` states of a ``Scene``, with some ``changes`` of how they are drawn."""
    how = many_initial_states.make_initial(scene)._replace(**changes)
    found = np.zeros((4 * scene.discs, number))
    many_initial_states.draw_states(open_stream(np.uint64(seed), 0), how, found)
    return found


@pytest.mark.parametrize(
    ("scene", "one", "other"),
    [
        (Scene(2.0, 0.6, 0.18, discs=4), "channel", "rejection"),
        (Scene(1.2, 0.6, 0.18, discs=3), "channel", "rejection"),
        (Scene(1.5, 1.0, 0.19, discs=5), "chain", "rejection"),
        # It takes long until the zigzag that the chain starts from has its defects.
        (Scene(2.5, 0.6, 0.18, discs=8), "chain", "channel"),
    ],
)
def test_ways_to_draw_agree(scene, one, other):
    number = {"chain": 500}
    found, same = (
        many_initial_states.states(scene, number.get(way, 10_000), seed, by=way)
        for seed, way in ((1, one), (2, other))
    )
    assert difference(scene, found, same) < 5


#: Squares, a channel and two short rings, whose single moves take long.
MOVED_SINGLY = [box(20, 0.55), box(20, 0.1), box(32, 0.6), Scene(9.6, 0.75, 0.18, discs=24)]
MOVED_SINGLY += [Scene(0.54, 5.0, 0.13, discs=20, periodic="x")]
MOVED_SINGLY += [Scene(0.7, 3.0, 0.1, discs=24, periodic="x")]


@pytest.mark.parametrize("scene", [box(20, 0.5, "x"), *map(slow, MOVED_SINGLY)], ids=repr)
def test_chains_of_events_have_the_law_of_chains_of_single_moves(scene):
    chain = many_initial_states._chain(scene)
    singly = many_initial_states.Chain(chain.centres, 4000, 0, chain.scales)
    assert difference(scene, drawn(scene, 500, 1), drawn(scene, 250, 2, chain=singly)) < 5


def free_length(scene, found):
    """Return A − S of discs in an ordered channel."""
    x, y, _, _ = np.split(found, 4)
    heights = np.take_along_axis(y, np.argsort(x, axis=0), 0)
    return scene.range_x - np.sqrt(scene.contact_distance**2 - np.diff(heights, axis=0) ** 2).sum(0)


def test_long_channels_are_those_of_exact_draws():
    """The variance of the free length is too large in the states that chains begin with."""
    scene = Scene(23.1, 0.6, 0.18, discs=66)
    both = drawn(scene, 120, 1), drawn(scene, 250, 2, chain=None)
    assert difference(scene, *both) < 5
    one, other = (free_length(scene, found) for found in both)
    law = f(one.size - 1, other.size - 1)
    ratio = one.var(ddof=1) / other.var(ddof=1)
    assert min(law.sf(ratio), law.cdf(ratio)) > 2.9e-7


@pytest.mark.parametrize(
    ("scene", "least"),
    [(Scene(1.18, 0.6, 0.18, discs=4), 0.1), (Scene(2.25, 0.6, 0.18, discs=8), 0.05),
     (Scene(18.0, 0.6, 0.18, discs=64), 0.03), (Scene(17.3, 0.6, 0.18, discs=64), 0.01),
     (Scene(6.0, 0.3600001, 0.18, discs=16), 0.5)],
)  # fmt: skip
def test_heights_in_a_channel_are_accepted_at_every_density(scene, least):
    state = open_stream(np.uint64(1), 0)
    cells = many_initial_states.make_initial(scene, "channel").cells
    heights = np.zeros(scene.discs)
    accepted = sum(
        many_initial_states.propose_heights(state, cells, scene.contact_distance, heights)
        for _ in range(2000)
    )
    assert accepted / 2000 > least


@pytest.mark.parametrize("name", ["channel", "channel, upright", "chain", "rejection, ring"])
def test_each_disc_is_any_of_them(name):
    """Five sigma on how often a disc is in which place of the row; the first states stay."""
    scene, number = GASES[name], 400 if name == "chain" else 4000
    found = many_initial_states.labelled(scene, number, 6)
    assert np.array_equal(many_initial_states.labelled(scene, 50, 6), found[:, :50])
    x, y, *_ = np.split(found, 4)
    ranks = np.argsort(np.argsort(y if scene.height > scene.width else x, axis=0), axis=0)
    counts = np.array([np.bincount(rank, minlength=scene.discs) for rank in ranks])
    share = 1 / scene.discs
    assert np.all(np.abs(counts - number * share) < 5 * math.sqrt(number * share * (1 - share)))
    # Nothing else has changed.
    same = np.split(many_initial_states.states(scene, number, 6), 4)
    assert np.array_equal(np.sort(x, axis=0), np.sort(same[0], axis=0))
    assert np.array_equal(found[2 * scene.discs :], np.vstack(same[2:]))


def test_who_waits_hears_how_many_states_are_drawn():
    """In several calls, which continue the streams; progress is reported from the second on."""
    scene, told = GASES["chain"], []
    many_initial_states.labelled(scene, 200, 6, progress=lambda *now: told.append(now))
    done = [drawn for drawn, _ in told if drawn is not None]
    assert (done, done[-1]) == (sorted(done), 200)
    assert len(done) > 5
    assert {number for _, number in told} == {200}


@pytest.mark.parametrize(
    ("width", "height", "discs", "share"),
    [
        (4.0, 4.0, 16, 1 / 16), (160.0, 0.4, 16, (80 / 32) ** 2 / 16), (8.0, 8.0, 64, 1 / 8),
        (64.0, 1.0, 64, 1 / 2), (640.0, 0.4, 64, 0), (1e30, 1.0, 64, 0),
    ],
)  # fmt: skip
def test_the_way_to_the_next_state_is_longer_in_a_long_box(width, height, discs, share):
    """It grows as the square of the length, as diffusion does; it is 0 if a new chain is shorter.

    The smallest moves are below the free length, and moves have 62 sizes at most.
    """
    scene = Scene(width, height, 0.1, discs=discs)
    for turned in (scene, scene.turned()):
        chain = many_initial_states.make_initial(turned, "chain", contacts=512).chain
        assert chain.between == math.ceil(share * chain.sweeps)
        assert 2.0**chain.scales > min(2**61, width / (scene.largest_radius - 0.1))
        assert chain.scales <= 62
        assert not chain.grid or (chain.grid.x.size - 1) * (chain.grid.y.size - 1) <= 4 * discs


@pytest.mark.parametrize("room", [1e-3, 1e-9])
def test_moves_of_crowded_discs_are_as_small_as_their_room(room):
    scene = Scene(1.5, 1.0, 0.25 * (1 - room), discs=5)
    assert 2.0 ** many_initial_states.make_initial(scene, "chain").chain.scales > 1 / room


def test_discs_that_move_little_have_a_shorter_way_to_the_next_state():
    """Two contacts of each disc limit it. It grows as the square of length over height."""
    boxes = [Scene(width, 64 / width, 0.1, discs=64) for width in (8.0, 16.0, 4.0)]
    made = [many_initial_states.make_initial(scene, "chain", contacts=2) for scene in boxes]
    assert [one.chain.between for one in made] == [8, 8 * 4**2, 8 * 4**2]
