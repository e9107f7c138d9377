"""N discs in lock step: exact rates where there are any, another program, the engine of two."""

import math
import os
import subprocess
import sys

import numpy as np
import pytest
import scalar_many

from twodiscs.dynamics import runs
from twodiscs.dynamics.ensemble import REPLICAS
from twodiscs.dynamics.many import engine
from twodiscs.dynamics.many import lockstep as many
from twodiscs.dynamics.runs import relative_errors
from twodiscs.model.events import AXIS, EVENTS, SHELLS, WALLS
from twodiscs.model.scene import Scene
from twodiscs.sampling.many import initial, insertions
from twodiscs.theory import n_discs
from twodiscs.theory.virial import rates, virial_sum, virial_weights


def counted(scene, blocks, seed=1, events=None):
    """Return ({class: rate}, {class: standard error}, rates for the virial theorem by replica)."""
    duration = engine.duration_of(scene, events)
    sums, products = engine.run_classes(scene, seed, 0, blocks, duration)
    replicas = blocks * REPLICAS
    found = sums / replicas / duration
    errors = found * np.where(sums > 0, relative_errors(sums, products, replicas), 0.0)
    second = np.triu(products) + np.triu(products, 1).T
    covariance = (second / replicas - np.outer(sums, sums) / replicas**2) / replicas / duration**2
    named = dict(zip(SHELLS, found, strict=True))
    return named, dict(zip(SHELLS, errors, strict=True)), covariance


def check(scene, found, errors, expected, expected_errors=None):
    """Five sigma on every class."""
    for event, rate in expected.items():
        error = math.hypot(errors[event], (expected_errors or {}).get(event, 0.0))
        assert abs(found[event] - rate) <= 5 * error, (scene, event, found[event], rate, error)


EXACT = {
    "three": Scene(1.5, 1.0, 0.15, discs=3),
    "three, dense": Scene(1.5, 1.0, 0.26, discs=3),
    "three, upright": Scene(1.0, 1.5, 0.24, discs=3),
    "three in a channel": Scene(1.5, 0.6, 0.18, discs=3),
    "four in a channel": Scene(1.6, 0.6, 0.18, discs=4),
    "eight in a channel": Scene(3.5, 0.6, 0.18, discs=8),
    "eight, dense": Scene(2.4, 0.6, 0.18, discs=8),
    "four, upright": Scene(0.6, 1.6, 0.18, discs=4),
    "three, rough": Scene(1.5, 1.0, 0.15, discs=3, moment_of_inertia=0.5),
    "eight, rough, in a channel": Scene(3.5, 0.6, 0.18, discs=8, moment_of_inertia=0.2),
}


#: Rough discs in a channel have a kernel of their own, which takes seconds to compile.
SLOW = pytest.param("eight, rough, in a channel", marks=pytest.mark.slow)


@pytest.mark.parametrize("name", [*[*EXACT][:-1], SLOW])
def test_rates_are_exact(name):
    scene = EXACT[name]
    found, errors, covariance = counted(scene, 6)
    check(scene, found, errors, rates(scene, n_discs.known_derivatives(scene)))
    weights = np.array([virial_weights(scene).get(event, 0.0) for event in SHELLS])
    error = math.sqrt(weights @ covariance @ weights)
    assert abs(virial_sum(scene, found) - 1) < 5 * error
    assert error < 0.05


#: Without an exact value: Monte Carlo, and another program, say what dynamics is to say.
OTHERS = {
    "four": Scene(1.5, 1.0, 0.12, discs=4),
    "five, dense": Scene(1.5, 1.0, 0.19, discs=5),
    "eight": Scene(2.0, 1.5, 0.15, discs=8),
    "four on a ring": Scene(1.5, 1.0, 0.15, discs=4, periodic="x"),
    "three on a narrow ring": Scene(1.5, 0.6, 0.18, discs=3, periodic="x"),
    "two on a ring": Scene(1.5, 1.0, 0.2, discs=2, periodic="x"),
    "five, rough": Scene(1.5, 1.0, 0.17, discs=5, moment_of_inertia=0.3),
    "four rough ones on a ring": Scene(
        1.5, 1.0, 0.15, discs=4, periodic="x", moment_of_inertia=0.5
    ),
}

#: Compiles a kernel of its own.
ROUGH_RING = pytest.param("four rough ones on a ring", marks=pytest.mark.slow)


@pytest.mark.parametrize("name", [*[*OTHERS][:-1], ROUGH_RING])
def test_monte_carlo_and_dynamics_agree(name):
    scene = OTHERS[name]
    found, errors, _ = counted(scene, 4, seed=2)
    known, spread = insertions.sample(scene, 300_000, 3)
    expected = rates(scene, known)
    if scene.periodic:
        del expected["horizontal_hop"]  # along the ring, where it is no event
    error_of = rates(scene, spread)
    check(scene, found, errors, expected, error_of)


SCALAR = {
    name: scene
    for name, scene in (EXACT | OTHERS).items()
    if name
    in (
        "three, dense",
        "eight in a channel",
        "four",
        "five, dense",
        "eight",
        "four on a ring",
        "five, rough",
        "four rough ones on a ring",
    )
}


@pytest.mark.parametrize("name", [*[*SCALAR][:-1], ROUGH_RING])
def test_another_program_has_the_same_rates(name):
    """Time averages of one trajectory: batches of some ten thousand events are independent."""
    scene = SCALAR[name]
    found, errors, _ = counted(scene, 4, seed=5)
    other, spread = scalar_many.rates(scene, 1_000_000, 6)
    named = dict(zip(SHELLS, other, strict=True))
    check(scene, found, errors, named, dict(zip(SHELLS, spread, strict=True)))


@pytest.mark.parametrize("radius", [0.05, 0.2, 0.3])
def test_two_discs_are_those_of_the_engine_of_two(radius):
    """From its states, for its time: the same law gives the same events, replica for replica."""
    scene, scene = Scene(1.5, 1.0, radius), Scene(1.5, 1.0, radius, discs=2)
    duration = runs.replica_duration(scene)
    found, errors, _ = counted(scene, 8, seed=3)
    sums, products = runs.run_blocks(scene, EVENTS, 4, 0, 8, duration)
    replicas = 8 * REPLICAS
    scale = sums / replicas / duration
    spread = scale * np.where(sums > 0, relative_errors(sums, products, replicas), 0.0)
    at = {event: EVENTS.index(event) for event in SHELLS}
    # Four pairs of a disc and a wall of an axis are counted by both.
    expected = {event: scale[at[event]] for event in SHELLS}
    check(scene, found, errors, expected, {event: spread[at[event]] for event in SHELLS})


def test_counts_of_events_are_those_of_their_classes():
    """Replica by replica: hits of all walls are those of both classes of them."""
    by_class = np.random.default_rng(1).integers(0, 50, (100, len(SHELLS)))
    columns = dict(zip(SHELLS, by_class.T, strict=True))
    columns["any_wall"] = columns["right_wall"] + columns["top_wall"]
    of_axis = {"x": columns["right_wall"], "y": columns["top_wall"]}
    columns |= {wall: of_axis[AXIS[wall]] for wall in WALLS}
    by_event = np.array([columns[event] for event in EVENTS]).T
    sums, products = engine.of_events(by_class.sum(axis=0), np.triu(by_class.T @ by_class))
    assert np.array_equal(sums, by_event.sum(axis=0))
    assert np.array_equal(products, np.triu(by_event.T @ by_event))


@pytest.mark.parametrize(
    "scene",
    [
        EXACT["three"],
        EXACT["four in a channel"],
        EXACT["four, upright"],
        Scene(3.0, 0.6, 0.14, discs=4, periodic="x"),
        Scene(3.0, 0.6, 0.2, discs=4, periodic="x"),
    ],
    ids=repr,
)
def test_orders_are_those_of_the_ergodic_components(scene):
    """From one of them, of labels along the longer side, all are reached that are in one part."""
    n, start = scene.discs, 0 if scene.width > scene.height else scene.discs
    states = initial.states(scene, 2000, 3)
    order = np.argsort(states[start : start + n], axis=0)
    for k in range(2):
        part = states[k * n : (k + 1) * n]
        part[:] = np.take_along_axis(part, order, axis=0)
    many.advance_states(states, np.zeros((n, 2000)), 200.0, many.law_of(scene), None, None)
    order = np.argsort(states[start : start + n], axis=0)
    if scene.periodic:  # up to a cyclic shift
        order = np.take_along_axis(order, (np.argmin(order, axis=0) + np.arange(n)[:, None]) % n, 0)
    orders = math.factorial(n) // (n if scene.periodic else 1)
    assert np.unique(order, axis=1).shape[1] * scene.ergodic_components == orders


BITS = """
import hashlib
from twodiscs.dynamics.many import engine
from twodiscs.dynamics.many import lockstep as many
from twodiscs.model.scene import Scene
from twodiscs.sampling.many import initial, insertions
scenes = [Scene(1.5, 1.0, 0.15, discs=3), Scene(2.3, 0.6, 0.18, discs=8)]
scenes += [Scene(1.5, 1.0, 0.2, discs=6), Scene(1.5, 1.0, 0.15, discs=3, moment_of_inertia=0.3)]
found = hashlib.sha256()
for scene in [*scenes, Scene(1.5, 1.0, 0.15, discs=4, periodic="x")]:
    counts = engine.run_classes(scene, 5, 0, 1, 16.0, replicas=64)
    for part in (*counts, *insertions.run_blocks(scene, 5, 0, 1), initial.states(scene, 50, 3)):
        found.update(part.tobytes())
print(found.hexdigest())
"""


@pytest.mark.slow
def test_the_bits_do_not_depend_on_the_processor(tmp_path):
    """A processor without AVX computes the same."""
    generic = {"NUMBA_CPU_NAME": "generic", "NUMBA_CPU_FEATURES": ""}
    generic |= {"NUMBA_CACHE_DIR": str(tmp_path)}
    found = {
        subprocess.run(
            [sys.executable, "-c", BITS], env=environment, check=True, capture_output=True
        ).stdout
        for environment in (os.environ, os.environ | generic)
    }
    assert len(found) == 1


def test_lanes_and_shards_do_not_matter():
    for scene in (EXACT["three, rough"], EXACT["four in a channel"], OTHERS["five, dense"]):
        whole = engine.run_classes(scene, 7, 0, 3, 8.0, replicas=100)
        other = engine.run_classes(scene, 7, 0, 3, 8.0, replicas=100, lanes=5)
        parts = [engine.run_classes(scene, 7, a, b, 8.0, replicas=100) for a, b in ((0, 1), (1, 3))]
        for one, same, *pieces in zip(whole, other, *parts, strict=True):
            assert np.array_equal(one, same)
            assert np.array_equal(one, sum(pieces))


def test_states_of_one_block_at_a_time(monkeypatch):
    """A shard of many blocks needs no more memory than one block."""
    sizes, count = [], many.count_events

    def counting_events(states, *given):
        sizes.append(states.shape[1])
        return count(states, *given)

    monkeypatch.setattr(many, "count_events", counting_events)
    engine.run_classes(EXACT["three, rough"], 7, 0, 3, 8.0, replicas=100)
    assert sizes == [100, 100, 100]
