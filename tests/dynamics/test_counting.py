"""Counts of events in the ensemble, and when a run ends.

Without these tests counts of the ensemble could miss an event, or end before or after they know
enough.
"""

from itertools import product

import numpy as np
import pytest
from dynamics.rates import check_rates
from effect_scenes import ALL, PAPER, SCENES
from marks import slow

from twodiscs.dynamics import runs
from twodiscs.dynamics.ensemble import nearest_power_of_two
from twodiscs.dynamics.law import WALL_X1, WALL_X2, WALL_Y1, WALL_Y2
from twodiscs.dynamics.two import event_counts
from twodiscs.model.events import DECLARED_EVENTS, EVENT_AXES, EVENTS, HOPS, WALLS
from twodiscs.model.scene import Box

#: A radius in each regime, both sides of the thresholds, where the discs hardly fit; other boxes.
RADII = (0.01, 0.05, 0.2, 0.24, 0.2499, 0.2501, 0.3, 0.36, 0.376, 0.38, 0.3839)
BOXES = [Box(*sides) for sides in ((3.0, 1.0), (1.0, 1.5), (1.0, 1.0), (2.0, 1.0))]
PLAIN = [PAPER.with_radius(radius) for radius in RADII]
PLAIN += [box.scene(share * box.largest_radius) for box in BOXES for share in (0.1, 0.55, 0.99)]


#: Walls with all that symmetry makes equal. The kernels of three take seconds to compile.
EFFECTS = [SCENES["combination"], *(slow(s) for s in (SCENES["field"], SCENES["unequal"], ALL))]


@pytest.mark.parametrize("scene", [*PLAIN, *EFFECTS], ids=repr)
def test_counts_have_the_exact_rates(scene):
    check_rates(scene, seed=1, blocks=16)


@pytest.mark.parametrize("event", [*HOPS, *WALLS])
@pytest.mark.parametrize(("identical", "field"), [*product((True, None), (None, 0.4))])
def test_an_event_is_seen_by_its_disc_its_axis_and_its_side(event, identical, field):
    """Symmetry makes walls equal: of identical discs, and of both sides but for y in a field."""
    codes, axis = (WALL_X1, WALL_Y1, WALL_X2, WALL_Y2), "xy".index(EVENT_AXES[event])
    for (number, code), side in product(enumerate(codes), (-1, 1)):
        before, after = [0.1, 0.1, 0.0, 0.0], [-0.3 * side] * 4
        after[number] = 0.3 * side  # with the other disc on the other side
        due = number % 2 == axis
        if event in HOPS:
            due &= after[axis] < after[axis + 2]
        else:
            due &= number < 2 or identical is True
            due &= axis == 0 or not field or side == DECLARED_EVENTS[event].side
        assert event_counts.DETECTORS[event](code, before, after, identical, field) == due


def test_an_error_begins_with_the_first_count():
    """One count in four replicas has the relative error √((1/4 − 1/16)/4)/(1/4)."""
    errors = runs.relative_errors(np.array([1, 0]), np.diag([1, 0]), 4)
    assert errors.tolist() == [pytest.approx(np.sqrt(3) / 2), np.inf]


def test_packed_counts_do_not_run_over():
    """A lane sees an event once in a pass at most, and a field has eight bits."""
    assert event_counts.SWEEPS_PER_UNPACKING < 2**8


def test_any_duration_is_unbiased():
    """The mean count is rate × T for every T, even when almost all replicas see nothing."""
    for duration in (0.05, 0.5, 5.0):
        check_rates(PAPER, seed=4, blocks=40, duration=duration)


def test_what_is_not_watched_is_not_detected():
    """With all events, with collisions, with the walls of rough discs; any wall is a sum."""
    everything, bare, walls = (
        dict(zip(EVENTS, event_counts.run_blocks(s, events, 7, 0, 1, 32.0)[0], strict=True))
        for s, events in ((PAPER, EVENTS), (PAPER, EVENTS[2:3]), (SCENES["rough"], ("right_wall",)))
    )
    assert bare["disc_collision"] == everything["disc_collision"]
    assert not any(bare[event] for event in (*HOPS, *WALLS))
    assert [walls[hop] for hop in HOPS] == [0, 0]
    assert min(walls[event] for event in (*WALLS, "disc_collision")) > 0


def test_a_blocked_hop_is_not_waited_for():
    scene = PAPER.with_radius(0.3)
    point = runs.DynamicsRun(scene, {"horizontal_hop": 1e-9, "right_wall": 0.1}, 10**9, 1).run()
    assert point.counts["horizontal_hop"] == 0
    assert [*point.components["all"]["sums"]] == [(0, 32)]


@pytest.mark.parametrize(
    ("value", "power"),
    [(1.0, 1.0), (1.41, 1.0), (1.42, 2.0), (3.0, 4.0), (0.7, 0.5), (0.71, 1.0), (1e-9, 2.0**-30)],
)
def test_the_nearest_power_of_two_is_so_on_a_logarithmic_scale(value, power):
    assert nearest_power_of_two(value) == power
