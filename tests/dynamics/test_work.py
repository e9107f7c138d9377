"""The work of a call has a bound for every input that is accepted.

Without these tests an input that is accepted could never end, because its work has no bound.
"""

import inspect
import math
import re
from dataclasses import replace
from unittest.mock import Mock

import pytest
from effect_scenes import SCENES
from hypothesis import example, given, settings
from hypothesis import strategies as st

from twodiscs.dynamics import paths, runs
from twodiscs.dynamics.engine import Engine, find_engine
from twodiscs.dynamics.ensemble import REPLICAS
from twodiscs.dynamics.two import event_counts, path, strip, two_rates
from twodiscs.model.checks import LONGEST_LENGTH, SHORTEST_LENGTH, InputError
from twodiscs.model.events import EVENTS, WALLS
from twodiscs.model.scene import Box
from twodiscs.model.two_geometry import LEAST_DISTANCE
from twodiscs.sampling.initial_states import require_initial_states
from twodiscs.theory import exact
from twodiscs.theory.exact import CROSSINGS_PER_EVENT


def decades(low, high):
    return st.floats(math.log10(low), math.log10(high)).map(lambda power: 10**power)


LENGTHS = decades(SHORTEST_LENGTH**0.5, LONGEST_LENGTH**0.5) | decades(1e-3, 1e3)
SHARES = decades(1e-12, 0.999) | st.floats(0.9, 0.999999)
EFFECTS = (
    st.sampled_from([{}, *({"periodic": axes} for axes in ("x", "y", "xy"))])
    | st.just({"moment_of_inertia": 0.5})
    | st.fixed_dictionaries(dict.fromkeys(("radius_ratio", "mass_ratio"), decades(1e-2, 1e2)))
    | st.fixed_dictionaries({"field": decades(1e-3, 1e3)})
)


def scene_of(width, height, effects, share):
    """Return a scene at a ``share`` of the largest radius; InputError if there is none."""
    box = Box(width, height, **effects)
    return box.scene(share * box.largest_radius)


@pytest.mark.parametrize("name", ["channel", "rough", "balls", "field", "unequal"])
def test_a_run_is_planned_and_counted_with_the_hits_of_all_walls(name, monkeypatch):
    """Those of both discs at both walls of an axis count as one event.

    If these events have all hits, the kernel may add them up, but not without the walls of z.
    """
    scene = SCENES[name]
    rates = [two_rates.expected_rate(scene, wall) for wall in WALLS if scene.is_possible(wall)]
    have_all = sum(rates) == pytest.approx(two_rates.expected_rate(scene, "any_wall"))
    assert have_all == (name in ("channel", "rough"))
    monkeypatch.setattr(event_counts, "follow", followed := Mock())
    event_counts.run_blocks(scene, EVENTS, 1, 0, 1, 1.0)
    assert have_all or followed.mock_calls[0].args[0].tracked[2]


@pytest.mark.parametrize("width", [1.0, 1.5])
def test_too_close_to_the_largest_radius_dynamics_is_refused(width):
    box = Box(width, 1.0)
    for run in (lambda scene: runs.DynamicsRun(scene, {"any_wall": 0.5}, 1, 1).run(),
                lambda scene: paths.follow_trajectory(scene, 1)):  # fmt: skip
        with pytest.raises(InputError, match=r"must not exceed .* for molecular dynamics"):
            run(box.scene(box.largest_radius * (1 - 1e-13)))
    # It holds at the closest radius: five standard errors.
    scene = box.scene(box.largest_radius * (1 - LEAST_DISTANCE))
    found = runs.DynamicsRun(scene, {"disc_collision": 3e-4}, 10**8, 1).run()
    mean = found.counts["disc_collision"] / found.replicas / found.duration
    assert mean == pytest.approx(exact.rate(scene, "disc_collision"), rel=5 * 3e-4)
    # If each disc spans the short side, no digit is lost.
    require_initial_states(Box(3.0, 1.0).scene(0.5 * (1 - 1e-15)))


@settings(max_examples=60, deadline=None, derandomize=True)
@given(LENGTHS, LENGTHS, EFFECTS, SHARES)
@example(1.5, 1.0, {"periodic": "xy"}, 1e-5)  # crossings take longer than all else
def test_the_work_of_a_replica_is_bounded(width, height, effects, share):
    try:
        scene = scene_of(width, height, effects, share)
        require_initial_states(scene)
    except InputError:
        return
    # The events, and how often discs leave a cell at most. A duration is rounded to a power of two.
    most = 2**0.5 * two_rates.EVENTS_PER_REPLICA / two_rates.replica_duration(scene)
    assert exact.event_rate(scene) <= most
    leaves = sum(math.sqrt(1 + 1 / scene.mass_ratio) / scene.side(a) for a in scene.periodic)
    assert leaves <= most * CROSSINGS_PER_EVENT
    crossings = leaves / CROSSINGS_PER_EVENT / exact.event_rate(scene)
    assert exact.work_per_event(scene) == pytest.approx(max(1.0, crossings))
    rows = exact.event_rate(scene) * max(1.0, crossings)
    assert path.trajectory_rate(scene) == pytest.approx(rows)
    assert path.trajectory_rate(replace(scene, friction=rows)) == pytest.approx(2 * rows)


def test_kicks_between_two_hops_are_work():
    """An interval has the kicks of its length, each with the work of ``KICK_WORK`` events."""
    without, kicked = (
        exact.events_per_interval(Box(1.5, 1.0, friction=g).scene(0.2), "vertical_hop")
        for g in (0.0, 3.0)
    )
    kicks = 3.0 * exact.mean_times(Box(1.5, 1.0).scene(0.2))["vertical_hop"]
    assert kicked - without == pytest.approx(exact.KICK_WORK * kicks)


@pytest.mark.parametrize("effects", [{"field": 1e4}, {"field": 1.0, "depth": 1.0}])
def test_starts_that_are_too_rare_are_refused(effects):
    box = Box(1.5, 1.0, **effects)
    scene = box.scene(box.last_radius * 0.999)
    for start in (lambda: runs.DynamicsRun(scene, {"any_wall": 0.1}, 1000, 1).run(),
                  lambda: require_initial_states(scene)):  # fmt: skip
        with pytest.raises(InputError, match="a scene with effects needs"):
            start()


# Draws are work, too -----------------------------------------------------------------------------

ENERGETIC = st.builds(
    lambda width, share, field, mass, radius: (
        width, {"field": field, "mass_ratio": mass, "radius_ratio": radius}, share,
    ),
    decades(0.2, 10), SHARES, decades(0.1, 30), decades(1e-2, 1e2), decades(0.05, 20),
)  # fmt: skip


@settings(max_examples=60)
@given(ENERGETIC)
@example((1.5, {"field": 1.5}, 0.97))  # where draws are most of the work
def test_draws_are_within_the_price_of_a_budget(drawn):
    """Any budget has at most 64 proposals of a start for each of its events, or one block.

    Without strips all of it is spent, on events or on proposals.
    """
    width, effects, share = drawn
    try:
        scene = scene_of(width, 1.0, effects, share)
        require_initial_states(scene)
        components = runs.DynamicsRun(scene, dict.fromkeys(scene.events, 1e-3), 10**9, 1).components
    except InputError:
        return
    spent = 0
    for name, run in components.items():
        starts = run.budget / run.block_events * REPLICAS
        if name == "all":
            chance = exact.free_fraction(scene)
        else:
            chance = strip.acceptance(scene, name, strip.choose_strip(scene, name))
        assert chance >= exact.MIN_FRACTION
        spent += max(run.budget, starts / chance / strip.PROPOSALS_PER_EVENT)
    assert (len(components) == 1) * 0.99 <= spent / 10**9 <= 1.01


def test_a_strip_is_no_longer_than_its_events_allow():
    """A large disc that just fits between two walls hits them all the time."""
    scene = Box(
        0.2015647165811781, 10.778181887736503,
        depth=0.3495539972883679, mass_ratio=109.0, radius_ratio=2.417163684327618,
    ).scene(0.041694469802592275)  # fmt: skip
    found = strip.choose_strip(scene, "vertical_hop")
    assert 2 * found.time * exact.event_rate(scene) <= strip.EVENTS_PER_PATH


@pytest.mark.parametrize("discs", [2, 3])
def test_an_engine_has_the_functions_that_are_declared(discs):
    """With these parameters, in this order."""
    engine = find_engine(Box(1.5, 1.0, discs=discs).scene(0.1))
    declared = dict(re.findall(r"``(\w+)``: .*\n\n((?: +- .*\n)+)", Engine.__doc__))
    assert (*declared,) == Engine._fields
    for module, functions in declared.items():
        for name, named in re.findall(r"- ``(\w+)\((.*)\)``", functions):
            _, *parameters = inspect.signature(getattr(getattr(engine, module), name)).parameters
            assert ", ".join(parameters).startswith(named), name
