"""N discs through a scene: rows of tables, comparisons, and the other methods and programs."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
import scalar_many
from factory import POINTS

import twodiscs as td
from twodiscs.comparison.measurements import Measurements
from twodiscs.comparison.scene_tables import SCENE_TABLES, Check, Theory
from twodiscs.dynamics import runs
from twodiscs.dynamics.ensemble import REPLICAS
from twodiscs.dynamics.many import engine
from twodiscs.figures.motion import colours
from twodiscs.model.box import Box
from twodiscs.model.checks import InputError
from twodiscs.model.events import EVENTS, WALLS
from twodiscs.model.scene import Scene
from twodiscs.points import estimates
from twodiscs.points.base import content_of, with_arrays
from twodiscs.sampling import montecarlo, starts
from twodiscs.theory import exact

#: With an exact value, and without; between walls, and on a ring.
SCENES = {
    "three": Scene(1.5, 1.0, 0.15, discs=3),
    "three, dense": Scene(1.5, 1.0, 0.26, discs=3),
    "eight in a channel": Scene(3.5, 0.6, 0.18, discs=8),
    "four, upright": Scene(0.6, 1.6, 0.18, discs=4),
    "four": Scene(1.5, 1.0, 0.12, discs=4),
    "four on a ring": Scene(1.5, 1.0, 0.15, periodic="x", discs=4),
}

KNOWN = ("three", "three, dense", "eight in a channel", "four, upright")


def test_what_is_known_is_told_from_what_is_impossible():
    for name, scene in SCENES.items():
        areas, times = exact.areas(scene), exact.mean_times(scene)
        for event in EVENTS:
            possible = scene.is_possible(event)
            assert (areas[event] == 0.0) == (not possible)
            assert (areas[event] is None) == (possible and name not in KNOWN)
            assert (times[event] is None) == (not possible or name not in KNOWN)
        assert (exact.volume(scene) is None) == (name not in KNOWN)


def test_rates_are_those_of_area_and_volume():
    scene = SCENES["three"]
    areas, volume = exact.areas(scene), exact.volume(scene)
    for event in EVENTS:
        sides = 2 if event.endswith("hop") else 1
        # c_6/2 = 8/(15π)
        rate = sides * 8 / (15 * math.pi) * areas[event] / volume
        assert exact.rate(scene, event) == pytest.approx(rate, rel=1e-14)
    assert areas["any_wall"] == pytest.approx(6 * (areas["right_wall"] + areas["top_wall"]))


#: Those whose rows are of another kind: exact, not known, on a ring, in a channel.
QUICK = ("three", "four", "four on a ring", "eight in a channel")


@pytest.fixture(
    scope="module",
    params=[pytest.param(n, marks=[] if n in QUICK else pytest.mark.slow) for n in SCENES],
)
def measured(request):
    """A scene, its points as they come back from files, and the rows of its check."""
    scene = SCENES[request.param]
    target = dict.fromkeys(scene.events, 5e-3)
    quantities = ["volume", *(f"{event}_area" for event in scene.events)]
    points = {
        "dynamics": [runs.count_events(scene, target, 2 * 10**7, 3)],
        "monte_carlo": [montecarlo.SamplingRun(scene, quantities, 400_000, 0.02, 4).run()],
    }
    box = Box.of(scene)
    for stage, some in points.items():
        contents = [content_of(stage, {}, {}, point.parts) for point in some]
        points[stage] = [
            POINTS[stage].of(scene.radius, with_arrays(content["parts"]))
            for content in json.loads(json.dumps(contents))
        ]
    theory = Theory.rows(box, [scene.radius])
    return request.param, scene, points, Check.rows(box, theory, points)


def test_nothing_fails(measured):
    name, scene, _, rows = measured
    assert [row for row in rows if row["passed"] is False] == []
    compared = {(row["comparison"], row["quantity"]) for row in rows if row["z"] is not None}
    assert (("sum_rule", "mean_times") in compared) == (not scene.periodic)
    for event in scene.events:
        kind = "mean_time" if name in KNOWN or not scene.is_possible(event) else "flux"
        assert (kind, f"{event}_time") in compared
    assert any(kind == "flux" for kind, _ in compared) == (name not in KNOWN)


def test_rows_say_what_was_seen_where_nothing_is_known(measured, tmp_path):
    name, scene, points, _ = measured
    theory = Theory.rows(Box.of(scene), [scene.radius])
    rows = SCENE_TABLES["mean_times"].rows(Box.of(scene), theory, points)
    for row in rows:
        assert (row["status"] == "impossible") == (not scene.is_possible(row["event"]))
        assert (row["exact"] is None) == (name not in KNOWN or row["status"] == "impossible")
        assert (row["z"] is None) == (name not in KNOWN and row["status"] != "impossible")
    volume = SCENE_TABLES["volume"].rows(theory, points)
    areas = SCENE_TABLES["areas"].rows(Box.of(scene), theory, points)
    assert {row["quantity"] for row in areas} == {f"{event}_area" for event in scene.events}
    for table, found in (("mean_times", rows), ("volume", volume), ("areas", areas)):
        SCENE_TABLES[table].write(tmp_path / f"{table}.csv", found)
        assert SCENE_TABLES[table].read(tmp_path / f"{table}.csv") == found
    assert (
        "not known" in str(Measurements("simulate", scene, rows, {}, points["dynamics"][0]))
        or name in KNOWN
    )


def test_a_wrong_rate_is_found_without_an_exact_value(measured):
    """A tenth of the collisions missing: the virial theorem and the flux say so."""
    name, scene, points, _ = measured
    if scene.periodic or name in KNOWN:
        pytest.skip("of scenes between walls without an exact value")
    point = points["dynamics"][0]
    point = replace(point, duration=1.1 * point.duration)
    theory = Theory.rows(Box.of(scene), [scene.radius])
    rows = Check.rows(Box.of(scene), theory, points | {"dynamics": [point]})
    failed = {row["comparison"] for row in rows if row["passed"] is False}
    assert {"sum_rule", "flux"} <= failed


def test_hits_of_all_walls_are_those_of_the_axes():
    sums, products = runs.run_blocks(SCENES["three"], EVENTS, 1, 0, 1, 8.0)
    right, top, all_walls = (EVENTS.index(e) for e in ("right_wall", "top_wall", "any_wall"))
    assert sums[all_walls] == sums[right] + sums[top]
    assert products[all_walls, all_walls] == (
        products[right, right] + 2 * products[right, top] + products[top, top]
    )
    counts = {event: int(sums[EVENTS.index(event)]) for event in EVENTS}
    # All hits of an axis are counted as those of either wall of it.
    again = [wall for wall in WALLS if wall not in ("right_wall", "top_wall")]
    assert estimates.sums_of_others(counts) == {"any_wall", *again}


def test_expected_rates_are_near_what_is_counted():
    for name in ("four", "four on a ring"):
        scene = SCENES[name]
        duration = runs.replica_duration(scene)
        sums, _ = runs.run_blocks(scene, scene.events, 8, 0, 2, duration)
        for event, rate in engine.expected_rates(scene).items():
            seen = sums[EVENTS.index(event)] / duration / 2 / REPLICAS
            assert rate == pytest.approx(seen, rel=0.05), (name, event)


def test_a_sample_has_what_is_asked_for():
    found = td.sample(SCENES["four"], 20_000, quantities=["right_wall_area", "any_wall_area"])
    assert [*found] == ["right_wall_area", "any_wall_area"]
    assert found["any_wall_area"].exact is None
    assert found["any_wall_area"].unit == "length⁷"


# A trajectory -----------------------------------------------------------------------------------


def test_a_trajectory_is_made_of_straight_lines_and_keeps_to_the_box(tmp_path):
    scene = SCENES["three, dense"]
    frame = td.trajectory(scene, seed=2, duration=20.0)
    places = frame[[f"{q}{d}" for d in (1, 2, 3) for q in "xy"]].to_numpy().reshape(-1, 3, 2)
    reach = np.array([scene.width, scene.height]) / 2 - scene.radius
    assert (np.abs(places) <= reach * (1 + 1e-12)).all()
    for i, j in ((0, 1), (0, 2), (1, 2)):
        apart = np.hypot(*(places[:, i] - places[:, j]).T)
        assert apart.min() >= scene.contact_distance * (1 - 1e-12)
    for row, at in zip(frame.itertuples(), places, strict=True):
        if row.event == "disc_collision":
            i, j = int(row.first) - 1, int(row.second) - 1
            assert np.hypot(*(at[i] - at[j])) == pytest.approx(scene.contact_distance, rel=1e-12)
        elif row.event == "vertical_hop":
            i, j = int(row.first) - 1, int(row.second) - 1
            assert at[i, 1] == pytest.approx(at[j, 1], abs=1e-12)
        elif row.event.startswith("wall"):
            k = "xy".index(row.event[-2])
            assert abs(at[int(row.first) - 1, k]) == pytest.approx(reach[k], rel=1e-12)
    # The energy is 1/2 in every flight, and it lasts as long as was asked for.
    steps, times = np.diff(places, axis=0), np.diff(frame["time"])
    speeds = (steps[times > 1e-6] / times[times > 1e-6][:, None, None]) ** 2
    assert speeds.sum(axis=(1, 2)) == pytest.approx(1, rel=1e-6)
    assert frame["time"].iloc[-1] == 20.0
    rate = exact.event_rate(scene)
    assert (~frame["event"].str.endswith("hop")).sum() == pytest.approx(20 * rate, rel=0.5)
    td.animate(frame, tmp_path / "three.gif")
    td.plot(frame, tmp_path / "three.png")
    assert (tmp_path / "three.gif").stat().st_size > 10_000


def test_a_trajectory_on_a_ring_goes_on_beyond_the_cell(tmp_path):
    scene = SCENES["four on a ring"]
    frame = td.trajectory(scene, seed=3, duration=300.0)
    walls = {f"wall_y{disc}" for disc in range(1, 5)}
    assert set(frame["event"]) == {"start", "vertical_hop", "disc_collision", "end"} | walls
    x, y, u = (frame[[f"{q}{d}" for d in range(1, 5)]].to_numpy() for q in "xyu")
    assert np.ptp(x) > 2 * scene.width
    # Places go on as velocities say, and the centre of mass stays where it is.
    steps = np.diff(frame["time"])[:, None] * u[:-1]
    assert np.diff(x, axis=0) == pytest.approx(steps, abs=1e-12)
    assert np.ptp(x.sum(axis=1)) < 1e-11
    dx = x[:, :, None] - x[:, None]
    apart = np.hypot(dx - scene.width * np.round(dx / scene.width), y[:, :, None] - y[:, None])
    assert apart[:, *np.triu_indices(4, 1)].min() >= scene.contact_distance * (1 - 1e-12)
    for row, k in zip(frame.itertuples(), range(len(frame)), strict=True):
        if row.event == "disc_collision":
            at = apart[k, int(row.first) - 1, int(row.second) - 1]
            assert at == pytest.approx(scene.contact_distance, rel=1e-12)
        elif row.event == "vertical_hop":
            assert y[k, int(row.first) - 1] == pytest.approx(y[k, int(row.second) - 1], abs=1e-12)
    # States between rows, and the same trajectory from any image of a disc.
    early = frame["time"].searchsorted(5.0)
    between = frame["time"].to_numpy()[: early + 1] + 1e-3
    states = frame.states_at(between)
    row = frame["time"].searchsorted(between, side="right") - 1
    then = x[row, 1] + u[row, 1] * (between - frame["time"].to_numpy()[row])
    assert states["x2"] == pytest.approx(then, abs=1e-12)
    start = frame.states_at(0.0)[0].copy()
    start["x2"] += 3 * scene.width
    moved = td.trajectory(scene, start=start, duration=5.0)
    assert moved["event"].tolist()[:-1] == frame["event"].tolist()[: len(moved) - 1]
    start["x1"], start["x2"], start["y2"] = 0.7, -0.7, start["y1"]
    with pytest.raises(InputError, match="start must have the discs apart"):
        td.trajectory(scene, start=start)
    back = moved["x2"].to_numpy()[:early] - 3 * scene.width
    assert back == pytest.approx(x[:early, 1], abs=1e-9)
    td.plot(frame, tmp_path / "ring.png")


@pytest.mark.parametrize("name", SCENES)
def test_a_trajectory_is_that_of_another_program(name):
    """From the same state, for some sixteen events, in which roundings of 1e-16 stay small."""
    scene = SCENES[name]
    n, ring = scene.discs, scene.width if scene.periodic else 0.0
    box = scene.range_x / 2, scene.range_y / 2, scene.contact_distance, ring
    duration = engine.duration_of(scene, 16)
    for state in starts.states(scene, 20, 11).T:
        frame = td.trajectory(scene, start=state, duration=1.1 * duration)
        parts = [np.array(part) for part in state.reshape(4, n)]
        scalar_many.run(*parts, *box, 1, duration, np.zeros(n), 0.0)
        at_end = frame.states_at(1.1 * duration)[0]
        for row, part in zip("xyuv", parts, strict=True):
            found = np.array([at_end[f"{row}{disc}"] for disc in range(1, n + 1)])
            if ring and row == "x":
                found = found - ring * np.round((found - part) / ring)
            assert found == pytest.approx(part, abs=1e-6)


def test_the_table_of_a_trajectory_has_columns_for_every_disc(tmp_path):
    table, box = SCENE_TABLES["trajectory"], Box(1.5, 1.0, discs=4)
    rows = table.rows(box, 0.1, 1)
    table.write(tmp_path / "trajectory.csv", rows)
    assert table.read(tmp_path / "trajectory.csv") == rows
    assert {"x4", "y4", "first", "second"} <= rows[0].keys()
    frame = td.load(tmp_path)["trajectory"]
    assert frame.attrs["meanings"]["x4"] == "disc 4, from the centre of the box"
    assert frame.attrs["units"]["y3"] == "length"


def test_a_trajectory_goes_on_from_a_state():
    scene = SCENES["four"]
    start = starts.records(scene, 1, 7)[0]
    first = td.trajectory(scene, start=start, duration=1.0)
    assert first["x3"].iloc[0] == start["x3"]
    for change, message in (
        ({"x2": 5.0}, "start must have disc 2 inside the box"),
        ({"x2": start["x1"], "y2": start["y1"]}, "start must have the discs apart"),
        ({"u1": 3.0}, "start must have a total energy of 0.5"),
    ):
        changed = {name: start[name] for name in start.dtype.names} | change
        with pytest.raises(InputError, match=message):
            td.trajectory(scene, start=[*changed.values()], duration=1.0)
    with pytest.raises(InputError, match="start must be the numbers x1, x2, x3, x4, y1"):
        td.trajectory(scene, start=[0.0] * 8)


def test_colours_follow_the_order_along_the_longer_side():
    box = Box(1.5, 1.0, discs=3)
    a, b, c = colours(box, {"x1": 0.5, "x2": -0.5, "x3": 0.0})
    assert colours(box, {"x1": -1.0, "x2": 0.0, "x3": 1.0}) == [b, c, a]


# Observables ------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["three", "four on a ring"])
def test_what_is_observed_are_trajectories(name):
    """The states of a replica are those of the trajectory from its start, beyond the cell too."""
    scene, times, kept = SCENES[name], [1.0, 3.0], []

    def seen(start, now):
        kept.append((start[:100].copy(), now[:100].copy()))
        return now["x1"] - start["x1"]

    td.observe(scene, seen, times, 10)
    gone = 0
    for time, (starts_of, states) in zip(times, kept, strict=True):
        for start, now in zip(starts_of, states, strict=True):
            path = td.trajectory(scene, start=start, duration=3.0)
            (state,) = path.states_at([time])
            assert [*state] == pytest.approx([*now], abs=1e-5)
            gone += any(abs(now[f"x{k}"]) > scene.width / 2 for k in range(1, scene.discs + 1))
    assert bool(gone) == bool(scene.periodic)


@pytest.mark.parametrize(
    "scene",
    [
        SCENES["three"],
        SCENES["four on a ring"],
        Scene(1.5, 1.0, 0.24, discs=4),  # its states are drawn by chains
    ],
    ids=repr,
)
def test_averages_stay_and_have_honest_errors(scene):
    """Five sigma: ⟨v²⟩ of D components is 1/D, and what places are on average does not change."""
    first = {}

    def seen(start, now):
        energy = sum(now[f"{q}{disc}"] ** 2 for disc in range(1, scene.discs + 1) for q in "uv")
        first.setdefault("y1", start["y1"])
        nearest = abs(now["y1"] - now["y2"]) - abs(start["y1"] - start["y2"])
        walls = now["y1"] ** 2 - start["y1"] ** 2
        return np.stack([energy, now["v1"] ** 2, nearest, walls], axis=1)

    found = td.observe(scene, seen, [0.0, 0.7, 4.0], 4096, seed=5)
    components = scene.velocity_components
    assert found.mean[:, 0] == pytest.approx(1, abs=1e-11)
    assert (np.abs(found.mean[:, 1] - 1 / components) < 5 * found.stderr[:, 1]).all()
    assert (np.abs(found.mean[:, 2:]) <= 5 * found.stderr[:, 2:]).all()
    # ⟨v⁴⟩ = 3/(D (D + 2)); the error of an error from 4096 states is some per cent.
    spread = 3 / (components * (components + 2)) - 1 / components**2
    assert found.stderr[0, 1] == pytest.approx(math.sqrt(spread / 4096), rel=0.1)
    # Replicas are independent: so are neighbours.
    assert abs(np.corrcoef(first["y1"][1:], first["y1"][:-1])[0, 1]) < 5 / math.sqrt(4095)
    again = td.observe(scene, seen, [0.0, 0.7, 4.0], 4096, seed=5, cores=2)
    assert np.array_equal(again.mean, found.mean)


# Intervals -------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["three", "four"])
def test_intervals_have_a_result_a_table_and_a_figure(name, tmp_path):
    scene, hop = SCENES[name], "vertical_hop"
    found = td.intervals(scene, hop, 1e5, seed=2, name=name)
    known = name in KNOWN
    assert (found.mean.exact is not None) == (found.mean.z is not None) == known
    assert found.mean.status == "sampled"
    assert ("not known" in str(found.mean)) == (not known)
    assert found.intervals == sum(found.counts) + found.overflow >= 10**5
    first, second = found.density[:2]
    assert found.at_zero.value == pytest.approx((3 * first - second) / 2, rel=1e-12)
    assert (found.at_zero.status, found.at_zero.exact) == ("extrapolated", None)
    more = found.more(3e5)
    assert more.rows == td.intervals(scene, hop, 3e5, seed=2, name=name).rows
    found.save(tmp_path / "found.json")
    assert td.load_result(tmp_path / "found.json").rows == found.rows
    td.plot(more, tmp_path / "intervals.png")
    table = SCENE_TABLES["hop_histogram"]
    table.write(tmp_path / "hop_histogram.csv", more.rows)
    assert table.read(tmp_path / "hop_histogram.csv") == more.rows


@pytest.mark.parametrize("name", ["three", "four"])
def test_the_mean_interval_is_compared_where_it_is_known(name):
    scene, box = SCENES[name], Box.of(SCENES[name])
    point = runs.hop_intervals(scene, "vertical_hop", 10**5, 6)
    theory = Theory.rows(box, [scene.radius])
    (row,) = (
        row
        for row in Check.rows(box, theory, {"intervals": [point]})
        if row["comparison"] == "hop_interval"
    )
    if name in KNOWN:
        assert row["passed"] is row["independent"] is True
    else:
        assert (row["status"], row["z"], row["passed"]) == ("counted", None, None)


# Error messages ----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda s: exact.shell_expectation(s, "vertical_hop", 0.01), "discs must be 2 for shells"),
        (lambda s: td.plot(s), "scene must be two plain discs for a drawing, but it has discs 3"),
    ],
)
def test_what_is_of_two_discs_is_refused_in_a_sentence(call, message):
    with pytest.raises(InputError, match=message):
        call(SCENES["three"])


def test_the_exact_table_of_more_discs():
    frame = td.exact_table(3.5, 0.6, [0.1, 0.18], discs=8)
    assert math.isnan(frame["volume"][0.1])
    assert frame["volume"][0.18] == exact.volume(SCENES["eight in a channel"])
    assert frame["ergodic_components"].tolist() == [1, math.factorial(8)]


def test_parts_of_configuration_space_may_be_more_than_64_bits_hold(tmp_path):
    table, parts = SCENE_TABLES["grid"], [1, math.factorial(64)]
    table.write(tmp_path / "grid.csv", table.rows(Box(40.0, 0.6, discs=64), [0.1, 0.2]))
    assert td.load(tmp_path)["grid"]["ergodic_components"].tolist() == parts
