"""Rates of many discs, against theory, Monte Carlo and a scalar program.

Without these tests many discs could collide at another rate than theory, Monte Carlo or another
program says.
"""

import math
from dataclasses import replace
from unittest.mock import Mock

import numpy as np
import pytest
import scalar_many
from dynamics.rates import five
from marks import slow

from twodiscs.dynamics.ensemble import REPLICAS
from twodiscs.dynamics.many import all_pairs as many
from twodiscs.dynamics.many import class_counts, many_rates
from twodiscs.dynamics.runs import DynamicsRun, relative_errors
from twodiscs.model.events import EVENT_AXES, EVENTS, HOPS, SHELL_EVENTS, WALLS
from twodiscs.model.many_geometry import CELL_DISCS
from twodiscs.model.scene import Scene
from twodiscs.sampling.many import insertions, many_initial_states
from twodiscs.theory.flux import rates
from twodiscs.theory.n_discs import known_derivatives


def counted(scene, blocks, seed=1, events=None):
    """Return ({class: rate}, {class: standard error})."""
    duration = many_rates.expected_duration(scene, events)
    one, products = class_counts.run_classes(scene, seed, 0, 1, duration, replicas=1)
    assert np.array_equal(products, np.triu(np.outer(one, one)))
    sums, products = class_counts.run_classes(scene, seed, 0, blocks, duration, replicas=REPLICAS)
    found = sums / (blocks * REPLICAS) / duration
    errors = found * np.where(sums > 0, relative_errors(sums, products, blocks * REPLICAS), 0.0)
    return dict(zip(SHELL_EVENTS, found, strict=True)), dict(zip(SHELL_EVENTS, errors, strict=True))


def check(found, errors, expected, spread=None):
    """Five sigma on every class."""
    for event, rate in expected.items():
        five(found[event], rate, math.hypot(errors[event], (spread or {}).get(event, 0.0)))


THREE, CHANNEL = Scene(1.5, 1.0, 0.15, discs=3), Scene(2.0, 0.6, 0.18, discs=4)
#: The rough discs have hardly room one above the other, so hops in x are rare.
ROUGH, UPRIGHT = replace(THREE, radius=0.23, moment_of_inertia=0.5), CHANNEL.turned()
EXACT = [THREE, replace(THREE, radius=0.26), ROUGH, CHANNEL, UPRIGHT]
#: In a low channel no hops in x are counted, by a kernel of its own. All such kernels are slow.
EXACT += [
    Scene(0.6, 7.0, 0.18, discs=CELL_DISCS),
    slow(Scene(7.0, 0.6, 0.18, discs=CELL_DISCS)),
    slow(Scene(7.0, 0.6, 0.18, discs=CELL_DISCS, moment_of_inertia=0.5)),
    slow(replace(THREE, friction=4.0)),
]


@pytest.mark.parametrize("scene", EXACT, ids=repr)
def test_rates_are_exact(scene):
    large = many_initial_states.large_grid(scene) is not None
    found, errors = counted(scene, 2 if large else 4, events=256 if large else None)
    assert max(errors.values()) < 0.05 * max(found.values())
    check(found, errors, rates(scene, known_derivatives(scene)))


#: Without an exact value: Monte Carlo, and another program, say what dynamics is to say.
OTHERS = [
    Scene(1.5, 1.0, 0.12, discs=4),
    Scene(1.5, 1.0, 0.15, discs=4, periodic="x"),
    Scene(1.5, 1.0, 0.15, discs=4, periodic="xy"),
    Scene(1.0, 1.0, 0.249, discs=3, periodic="xy"),
    Scene(1.5, 0.6, 0.18, discs=3, periodic="x"),
    Scene(1.5, 1.0, 0.2, discs=2, periodic="x"),
    Scene(1.5, 1.0, 0.17, discs=5, moment_of_inertia=0.3),
    slow(Scene(2.0, 1.5, 0.15, discs=8)),
    slow(Scene(1.5, 1.0, 0.15, discs=4, periodic="x", moment_of_inertia=0.5)),
]


@pytest.mark.parametrize("scene", OTHERS, ids=repr)
def test_monte_carlo_and_another_program_have_the_same_rates(scene):
    """Time averages of one trajectory: batches of some ten thousand events are independent."""
    found, errors = counted(scene, 2, seed=2)
    known, spread = insertions.sample(scene, 300_000, 3)
    expected = rates(scene, known)
    for axis in scene.periodic:
        del expected["horizontal_hop" if axis == "x" else "vertical_hop"]  # where it is no event
    check(found, errors, expected, rates(scene, spread))
    if scene.discs > 3:
        other, spread = scalar_many.rates(scene, 400_000, 6)
        named = dict(zip(SHELL_EVENTS, other, strict=True))
        check(found, errors, named, dict(zip(SHELL_EVENTS, spread, strict=True)))


def test_counts_of_events_are_those_of_their_classes():
    """Replica by replica: hits of all walls are those of both classes of them."""
    by_class = np.random.default_rng(1).integers(0, 50, (100, len(SHELL_EVENTS)))
    columns = dict(zip(SHELL_EVENTS, by_class.T, strict=True))
    columns["any_wall"] = columns["right_wall"] + columns["top_wall"]
    of_axis = {"x": columns["right_wall"], "y": columns["top_wall"]}
    columns |= {wall: of_axis[EVENT_AXES[wall]] for wall in WALLS}
    by_event = np.array([columns[event] for event in EVENTS]).T
    given = by_class.sum(axis=0), np.triu(by_class.T @ by_class)
    sums, products = class_counts.combine_classes(*given)
    assert np.array_equal(sums, by_event.sum(axis=0))
    assert np.array_equal(products, np.triu(by_event.T @ by_event))


RINGS = [Scene(3.0, 0.6, radius, discs=4, periodic="x") for radius in (0.14, 0.2)]


@pytest.mark.parametrize("scene", [THREE, CHANNEL, UPRIGHT, *RINGS], ids=repr)
def test_orders_are_those_of_the_ergodic_components(scene):
    """From one of them, of labels along the longer side, all are reached that are in one part."""
    n, start = scene.discs, 0 if scene.width > scene.height else scene.discs
    states = many_initial_states.states(scene, 2000, 3)
    order = np.argsort(states[start : start + n], axis=0)
    for k in range(2):
        part = states[k * n : (k + 1) * n]
        part[:] = np.take_along_axis(part, order, axis=0)
    hops = np.zeros(2000) if scene.periodic else None  # as in other tests of these kernels
    laps, law = np.zeros((2 * n, 2000)), many.many_disc_law(scene)
    many.advance_states(states, laps, 200.0, law, None, hops)
    order = np.argsort(states[start : start + n], axis=0)
    if scene.periodic:  # up to a cyclic shift
        order = np.take_along_axis(order, (np.argmin(order, axis=0) + np.arange(n)[:, None]) % n, 0)
    orders = math.factorial(n) // (n if scene.periodic else 1)
    assert np.unique(order, axis=1).shape[1] * scene.ergodic_components == orders


def test_hops_whose_rate_is_not_known_have_the_whole_budget():
    """Insertions find no room for twelve discs."""
    crowded, hop = Scene(1.5, 1.0, 0.15, discs=12), HOPS[0]
    run = DynamicsRun(crowded, {hop: 0.1}, 10**9, 1).components["all"]
    assert 1 <= run.planned * run.block_events / 10**9 < 1.07


def test_states_of_one_block_at_a_time(monkeypatch):
    """A shard of many blocks needs no more memory than one block."""
    monkeypatch.setattr(many, "count_events", counted := Mock(wraps=many.count_events))
    class_counts.run_classes(THREE, 7, 0, 3, 8.0, replicas=100)
    assert [one.args[0].shape[1] for one in counted.mock_calls] == [100, 100, 100]


@pytest.mark.parametrize(("width", "discs"), [(1.0, 3), (3.0, 8)])
def test_a_flight_on_a_ring_ends_before_a_third_image_comes_near(width, discs):
    """The largest relative speed is √2, and half the ring is the most between two looks."""
    law = many.many_disc_law(Scene(width, 1.0, 0.1, discs=discs, periodic="x"))
    fastest = math.sqrt(2)
    assert law.ring_x / 2 / many.SQRT_2 * fastest == pytest.approx(width / 2, rel=1e-15)
    # Two discs side by side, in opposite directions: they look again, then meet the next image.
    x, y = np.zeros((discs, 1)), np.linspace(-0.35, 0.35, discs)[:, None].copy()
    u, v = np.zeros((discs, 1)), np.zeros((discs, 1))
    u[0], u[1] = 1 / fastest, -1 / fastest
    lanes = many.new_lanes(np.vstack([x, y, u, v]), np.full(1, np.inf), law)
    many.find_events(lanes, law, None)
    assert lanes.times[0] * fastest <= width / 2 * (1 + 1e-15)
