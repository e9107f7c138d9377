"""Every accepted input ends: work is bounded for scenes of the whole allowed range."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from twodiscs.dynamics import counting, intervals, trajectory
from twodiscs.model.box import Box
from twodiscs.model.checks import LONGEST, SHORTEST, InputError
from twodiscs.model.events import HOPS
from twodiscs.model.scene import FOLLOWED
from twodiscs.sampling import rounds
from twodiscs.sampling.starts import require_room
from twodiscs.theory import exact


def decades(low, high):
    return st.floats(math.log10(low), math.log10(high)).map(lambda power: 10**power)


LENGTHS = decades(SHORTEST**0.5, LONGEST**0.5) | decades(1e-3, 1e3)
SHARES = decades(1e-12, 0.999) | st.floats(0.9, 0.999999)
EFFECTS = (
    st.sampled_from(
        [
            {},
            {"periodic": "x"},
            {"periodic": "y"},
            {"periodic": "xy"},
            {"moment_of_inertia": 0.5},
        ]
    )
    | st.builds(
        lambda ratio, mass: {"radius_ratio": ratio, "mass_ratio": mass},
        decades(1e-2, 1e2),
        decades(1e-2, 1e2),
    )
    | st.builds(lambda field: {"field": field}, decades(1e-3, 1e3))
)


def scene_of(width, height, effects, share):
    """Return a scene at a ``share`` of the largest radius; InputError if there is none."""
    box = Box(width, height, effects)
    return box.scene(share * box.largest_radius)


def passes(scene, duration):
    """Return the events of a time, and how often discs leave a periodic cell at most."""
    leaves = sum(math.sqrt(1 + 1 / scene.mass_ratio) / scene.side(a) for a in scene.periodic)
    return duration * exact.event_rate(scene), duration * leaves


@pytest.mark.parametrize("width", [1.0, 1.5])
def test_too_close_to_the_largest_radius_dynamics_is_refused(width):
    box = Box(width, 1.0)
    for run in (lambda scene: counting.count_events(scene, {"any_wall": 0.5}, 1, 1),
                lambda scene: trajectory.trajectory(scene, 1)):  # fmt: skip
        with pytest.raises(InputError, match=r"must not exceed .* for molecular dynamics"):
            run(box.scene(box.largest_radius * (1 - 1e-13)))
    # It holds at the closest radius: five standard errors.
    scene = box.scene(box.largest_radius * (1 - FOLLOWED))
    found = counting.count_events(scene, {"disc_collision": 3e-4}, 10**8, 1)
    mean = found["counts"]["disc_collision"] / found["replicas"] / found["duration"]
    assert mean == pytest.approx(exact.rate(scene, "disc_collision"), rel=5 * 3e-4)
    # Where each disc spans the short side, nothing is lost.
    require_room(Box(3.0, 1.0).scene(0.5 * (1 - 1e-15)))


@settings(max_examples=60, deadline=None, derandomize=True)
@given(LENGTHS, LENGTHS, EFFECTS, SHARES)
def test_the_work_of_a_replica_is_bounded(width, height, effects, share):
    try:
        scene = scene_of(width, height, effects, share)
        require_room(scene)
    except InputError:
        return
    events, leaves = passes(scene, counting.replica_duration(scene))
    # A duration is rounded to a power of two.
    assert events <= 2**0.5 * counting.EVENTS_PER_REPLICA
    assert leaves <= 2**0.5 * counting.EVENTS_PER_REPLICA * exact.PASSES_PER_EVENT
    assert exact.work_per_event(scene) >= 1.0


def test_small_discs_on_a_torus_end():
    scene = Box(1.5, 1.0, {"periodic": "xy"}).scene(1e-9)
    found = counting.count_events(scene, {"disc_collision": 0.001}, 1000, 1)
    _, leaves = passes(scene, found["replicas"] * found["duration"])
    block = counting.REPLICAS * counting.EVENTS_PER_REPLICA * exact.PASSES_PER_EVENT
    assert leaves <= 2**0.5 * rounds.FIRST_ROUND * block
    assert found["status"] == {"disc_collision": "budget"}


@settings(max_examples=40, deadline=None, derandomize=True)
@given(st.sampled_from(HOPS), LENGTHS, LENGTHS, SHARES)
def test_histograms_that_exceed_their_budget_are_refused(hop, width, height, share):
    scene = scene_of(width, height, {}, share)
    if scene.is_possible(hop) and exact.events_per_interval(scene, hop) > 1.0:
        with pytest.raises(InputError, match="budget must allow for 65536 intervals"):
            intervals.hop_intervals(scene, hop, 1, 1, budget=65536)


@pytest.mark.parametrize("effects", [{"field": 1e4}, {"field": 1.0, "depth": 1.0}])
def test_starts_that_are_too_rare_are_refused(effects):
    box = Box(1.5, 1.0, effects)
    scene = box.scene(box.last_radius * 0.999)
    for start in (lambda: counting.count_events(scene, {"any_wall": 0.1}, 1000, 1),
                  lambda: require_room(scene)):  # fmt: skip
        with pytest.raises(InputError, match="needs more room"):
            start()
