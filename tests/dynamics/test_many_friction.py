"""Friction of many discs: kicks keep energy and momentum, and no mean time changes.

Statistical comparisons allow five standard errors.
"""

import math
from collections import Counter
from itertools import pairwise

import numpy as np
import pytest

from twodiscs.dynamics.many import engine, path
from twodiscs.dynamics.runs import relative_errors
from twodiscs.model.events import SHELLS
from twodiscs.model.scene import Scene
from twodiscs.sampling.many import initial
from twodiscs.theory import n_discs
from twodiscs.theory.virial import rates

FEW = Scene(1.5, 1.0, 0.15, discs=3, friction=4.0)
CHANNEL = Scene(8.75, 0.6, 0.18, discs=20, friction=4.0)
RING = Scene(3.0, 1.0, 0.15, discs=3, periodic="x", friction=4.0)


@pytest.mark.slow
@pytest.mark.parametrize("scene", [FEW, CHANNEL], ids=["few", "channel"])
def test_no_mean_time_changes(scene):
    """Kicks come several times in a replica, in both kernels."""
    duration, replicas = engine.duration_of(scene, 256), 2048
    assert duration * scene.friction > 3
    sums, products = engine.run_classes(scene, 1, 0, 1, duration, replicas=replicas)
    found, relative = sums / replicas / duration, relative_errors(sums, products, replicas)
    for event, rate in rates(scene, n_discs.known_derivatives(scene)).items():
        k = [*SHELLS].index(event)
        error = 5 * found[k] * relative[k] if rate else 0.0
        assert abs(found[k] - rate) <= error, (event, found[k], rate, error)


@pytest.mark.parametrize("scene", [FEW, RING], ids=["few", "ring"])
def test_a_kick_keeps_places_energy_and_momentum(scene):
    """Kicks are rows of a trajectory, and their number is that of a Poisson process."""
    time = 32.0
    start = initial.states(scene, 1, 3)[:, 0]
    if scene.periodic:
        # Another momentum along the ring, which has to stay.
        start[2 * scene.discs : 3 * scene.discs] += 0.1
        start[2 * scene.discs :] /= np.linalg.norm(start[2 * scene.discs :])
    rows = [*path.events_of(scene, start, time, seed=3)]
    names = Counter(row[1] for row in rows)
    assert abs(names["kick"] - scene.friction * time) <= 5 * math.sqrt(scene.friction * time)
    momentum = start[2 * scene.discs : 3 * scene.discs].sum()
    for (before, *_, old), (now, name, first, second, new) in pairwise(rows):
        (x, y, u, v), (*_, w) = np.split(new, 4), np.split(old, 4)
        assert np.sum(u * u + v * v) == pytest.approx(1, abs=1e-12)
        assert not scene.periodic or np.sum(u) == pytest.approx(momentum, abs=1e-12)
        if name == "kick":
            assert (first, second) == (None, None)
            assert np.all(v != w)
            old_x, old_y, old_u, _ = np.split(old, 4)
            assert x == pytest.approx(old_x + old_u * (now - before), abs=1e-9)
            assert y == pytest.approx(old_y + w * (now - before), abs=1e-9)
    other = [*path.events_of(scene, start, time, seed=4)]
    assert np.array_equal(other[0][-1], rows[0][-1])
    assert not np.array_equal(other[-1][-1], rows[-1][-1])


def test_both_kernels_count_the_same_events_between_kicks(monkeypatch):
    """Before roundings have grown, and after some kicks."""
    duration = engine.duration_of(CHANNEL, 160)
    assert duration * CHANNEL.friction > 3
    one = engine.run_classes(CHANNEL, 5, 0, 1, duration, replicas=4)
    monkeypatch.setattr(engine, "large_grid", lambda scene: None)
    other = engine.run_classes(CHANNEL, 5, 0, 1, duration, replicas=4)
    assert np.array_equal(one[0], other[0])
    assert np.array_equal(one[1], other[1])


def test_kicks_belong_to_replicas_not_to_blocks(monkeypatch):
    """Two blocks of four replicas from the same state are one block of eight, in both kernels."""
    duration = engine.duration_of(CHANNEL, 160)
    state = initial.states(CHANNEL, 1, 1)
    monkeypatch.setattr(engine, "states_of", lambda _, number, *__: np.repeat(state, number, 1))
    for _ in range(2):
        first, _ = engine.run_classes(CHANNEL, 5, 0, 1, duration, replicas=4)
        halves = engine.run_classes(CHANNEL, 5, 0, 2, duration, replicas=4)
        whole = engine.run_classes(CHANNEL, 5, 0, 1, duration, replicas=8)
        assert np.array_equal(halves[0], whole[0])
        assert np.array_equal(halves[1], whole[1])
        assert not np.array_equal(halves[0], 2 * first)
        monkeypatch.setattr(engine, "large_grid", lambda scene: None)


@pytest.mark.slow
def test_both_kernels_have_the_same_kicks(monkeypatch):
    """Rows and states are the same, before roundings have grown."""
    duration = engine.duration_of(CHANNEL, 160)
    start = initial.states(CHANNEL, 4, 1)
    found = {}
    for name in ("cells", "all pairs"):
        states, laps = start.copy(), np.zeros((20, 4))
        engine.advance_all(CHANNEL, states, laps, duration, engine.kicks_of(CHANNEL, 4, 5))
        rows = [*path.events_of(CHANNEL, start[:, 0], duration, 5)]
        found[name] = states, [row[1:4] for row in rows], rows[-1][-1]
        monkeypatch.setattr(engine, "large_grid", lambda scene: None)
        monkeypatch.setattr(path, "large_grid", lambda scene: None)
    one, other = found["cells"], found["all pairs"]
    assert one[0] == pytest.approx(other[0], abs=1e-7)
    # The trajectory has the kicks of the first of these states.
    assert one[2] == pytest.approx(one[0][:, 0], abs=1e-7)
    assert one[1] == other[1]
    assert Counter(name for name, *_ in one[1])["kick"] > 3


@pytest.mark.slow
def test_chains_of_different_blocks_have_different_kicks(monkeypatch):
    """From one and the same state, chains differ by their kicks alone, in all blocks."""
    chains, mean = 4, engine.mean_interval(FEW, "vertical_hop")
    states = initial.states_of(initial.initial_of(FEW), 1, 3, 0)
    monkeypatch.setattr(engine, "states_of", lambda *given: np.repeat(states, chains, axis=1))
    bins = mean / 16, np.arange(65) // 8 + 65
    sums = np.zeros((3, 74), np.int64)
    given = 8 * mean, FEW, "vertical_hop", 3, 0, 2, chains, bins, sums
    times, _ = engine.record_within(*given, np.ones(1, np.bool_))
    assert np.unique(times).size == 2 * chains
