"""Exact numbers: rates, components and copies.

Without these tests rates could ignore the parts that confine events, or numbers keep what a caller
changed.
"""

import pytest

from twodiscs.model.events import EVENT_AXES, WALLS
from twodiscs.model.scene import Scene
from twodiscs.theory import exact

PAPER = (1.5, 1.0)


# Regimes ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("scene", "right", "top"),
    [
        *((Scene(*PAPER, r), *shares) for r, *shares in ((0.2, 1, 1), (0.3, 0.5, 1))),
        *((Scene(*PAPER, r), 0.5, 0.5) for r in (0.375, 0.38)),
        # A large disc may hit a wall with the small one in the corner behind it.
        (Scene(1.5, 0.66, 0.3, radius_ratio=0.2), 1, 1),
    ],
    ids=repr,
)
def test_rates_average_over_all_components_and_times_over_those_that_meet(scene, right, top):
    share = {wall: {"x": right, "y": top}[EVENT_AXES[wall]] for wall in WALLS}
    for event, time in exact.mean_times(scene).items():
        if time is not None:
            assert time * exact.rate(scene, event) == pytest.approx(share.get(event, 1), rel=1e-15)


def test_results_can_be_changed_without_changing_the_next():
    scene = Scene(*PAPER, 0.3)
    exact.areas(scene)["top_wall"] = 0
    assert exact.areas(scene)["top_wall"] > 0


@pytest.mark.parametrize(
    "scene", [Scene(*PAPER, 0.3), Scene(*PAPER, 0.2, periodic="x", field=0.4)], ids=repr
)
def test_events_are_wall_hits_and_collisions(scene):
    """Half of the walls are confined to one part of configuration space: rates do not care."""
    wall, collision = (exact.mean_times(scene)[e] for e in ("any_wall", "disc_collision"))
    assert exact.event_rate(scene) == pytest.approx(1 / wall + 1 / collision, rel=1e-15)
    torus = Scene(*PAPER, 0.2, periodic="xy")
    assert exact.event_rate(torus) == exact.rate(torus, "disc_collision")
