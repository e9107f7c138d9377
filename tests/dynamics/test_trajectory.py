"""One trajectory, event by event.

Without these tests a trajectory could leave its periodic cell, begin elsewhere or be too long.
"""

import math
from itertools import product

import pytest
from effect_scenes import ALL, PAPER, SCENES
from marks import slow

from twodiscs import Box, InputError, Scene
from twodiscs.analysis.tables import TrajectoryTable
from twodiscs.dynamics import paths, rows
from twodiscs.dynamics.many import many_paths
from twodiscs.dynamics.many.many_rates import expected_event_rate
from twodiscs.sampling.initial_states import components
from twodiscs.theory.exact import event_rate, mean_times


def follow(*given, **named):
    """Return the rows of a trajectory as a list."""
    return [*paths.follow_trajectory(*given, **named).events()]


@pytest.mark.parametrize("radius", [0.2, 0.3, 0.3749, 0.38])
def test_a_trajectory_shows_some_hops_and_is_not_too_long(radius):
    """Eight mean times of the rarest hop that is open, or 6000 events, to a factor of √2."""
    scene = PAPER.with_radius(radius)
    rows = TrajectoryTable.rows(Box(1.5, 1.0), radius, seed=3)
    assert rows != TrajectoryTable.rows(Box(1.5, 1.0), radius, seed=4)
    hops = [mean_times(scene)[hop] for hop in ("vertical_hop", "horizontal_hop")]
    eight = 8 * max((time for time in hops if time), default=math.inf)
    expected = min(eight, 6000 / event_rate(scene))
    ratio = rows[-1]["time"] / expected
    assert 1 / math.sqrt(2) <= ratio * (1 + 1e-12) <= 1.001 * math.sqrt(2)


MANY = Scene(1.5, 1.0, 0.15, periodic="x", discs=3)
#: With another kernel each.
GIVEN = [*map(SCENES.get, ("torus", "combination", "rough")), MANY]


def test_a_trajectory_of_more_discs_has_some_1500_events():
    """Or as many rows as there is room for, if most of them are kicks."""
    ratio = follow(MANY, seed=3)[-1][0] * expected_event_rate(MANY) / 1500
    rows = many_paths.usual_duration(Scene(1.5, 1.0, 0.1, discs=3, friction=1e5)) * 1e5 / 2**13
    assert 1 / math.sqrt(2) <= min(ratio, rows) <= max(ratio, rows) <= math.sqrt(2)


@pytest.mark.parametrize("scene", [*GIVEN, slow(ALL)], ids=repr)
def test_a_trajectory_goes_on_from_its_end(scene):
    """The start that is given comes back, cells and all, and the motion is that of the whole path.

    Between images of the discs only roundings differ; they grow by far less than 1e6 in 1.
    """
    path = follow(scene, 5, None, 40.0)
    start = tuple(map(float, path[-1][4]))
    whole = follow(scene, 5, path[0][4], 41.0)
    rows = follow(scene, 5, start, 1.0)
    assert tuple(map(float, rows[0][4])) == start
    assert rows[-1][4] == pytest.approx(whole[-1][4], abs=1e-9)


@pytest.mark.parametrize("name", ["rough", "combination"])
def test_a_row_has_the_disc_of_its_wall_or_both_discs(name):
    for _, event, *discs, _ in follow(SCENES[name], 5, None, 40.0):
        pair = (1, 2) if event.endswith(("hop", "collision")) else (None, None)
        assert (*discs,) == ((int(event[-1]), None) if event.startswith("wall") else pair)


@pytest.mark.parametrize(("disc", "axis", "ratio"), [*product((0, 1), (0, 1), (0.5, 2.0))])
def test_each_disc_may_start_at_its_own_walls_and_not_beyond(disc, axis, ratio):
    """All energy is in the spin of this disc, whose mass is 1 or 2."""
    effects = {"radius_ratio": ratio, "mass_ratio": 2.0, "moment_of_inertia": 0.5}
    scene, state = Scene(1.5, 1.0, 0.1, **effects), [0.0] * 10
    state[8 + disc] = (math.sqrt(2), 1.0)[disc]
    for side in (-1, 1):
        state[2 * disc + axis] = side * (scene.sides[axis] / 2 - scene.radii[disc])
        assert paths.check_start(scene, state) == tuple(state)
        state[2 * disc + axis] += side * 1e-6
        with pytest.raises(InputError, match=f"^start must have disc {disc + 1} inside the box"):
            paths.check_start(scene, state)


@pytest.mark.parametrize(
    "scene",
    [Scene(1.5, 1.0, 0.2, friction=1.0), MANY, slow(Scene(6.0, 4.0, 0.2, discs=20, friction=0.1))],
    ids=repr,
)
def test_rows_do_not_depend_on_how_many_are_made_at_a_time(scene, monkeypatch):
    whole, told = paths.follow_trajectory(scene, 5, None, 200.0), []
    monkeypatch.setattr(rows, "CHUNK_NUMBERS", 1)
    parts = paths.follow_trajectory(scene, 5, None, 200.0, lambda *now: told.append(now))
    for one, other in zip(whole, parts, strict=True):
        assert one.tobytes() == other.tobytes()
    assert told[-1] == (whole.times[-1], 200.0)
    assert told == sorted(told)
    assert len(told) > 4
    assert whole.times.size > 4 * (64 + rows.CHUNK_PADDING)


@pytest.mark.parametrize("fall", [{"v1": 1e-9}, {"y1": -0.3 + 2**-54}], ids=repr)
def test_rows_of_a_start_that_is_given_are_counted(fall, monkeypatch):
    """A disc that hardly bounces has more of them than are due, and fills no memory."""
    monkeypatch.setattr(paths, "MOST_PATH_EVENTS", 1e5)
    names = components(scene := Scene(1.5, 1.0, 0.2, field=0.5))
    start = dict(zip(names, (-0.4, -0.3, 0.4, 0.1, 0.0, 0.0, 0.6**0.5, 0.0), strict=True)) | fall
    with pytest.raises(InputError, match="where 1e5 events have happened and fill") as caught:
        follow(scene, 1, start, 3.0)
    most = float(str(caught.value).split(",")[0].split()[-1])
    number = paths.follow_trajectory(scene, 1, start, most).times.size
    assert number == pytest.approx(1e5, rel=0.02)
    monkeypatch.setattr(paths, "MOST_PATH_EVENTS", number)
    assert paths.follow_trajectory(scene, 1, start, most).times.size == number
