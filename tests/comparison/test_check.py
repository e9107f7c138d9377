"""The check must fail when something is wrong, and hardly ever otherwise."""

import math

import numpy as np
import pytest
from fabricated import BOX, RADII, Laws, command, scenes, store, theory_rows

from twodiscs.cli import check as cli_check
from twodiscs.cli import tables as cli_tables
from twodiscs.comparison import check, rows, scores, tables
from twodiscs.model.events import EVENTS
from twodiscs.model.scene import Scene
from twodiscs.theory import exact

SCENE = Scene(**BOX, radius=0.2)
SAMPLES = 10**12  # at 0.36 a sample in 300 000 is a hit of a shell


@pytest.fixture(scope="module")
def laws():
    return [Laws(scene) for scene in scenes()]


@pytest.fixture(scope="module")
def points(laws):
    rng = np.random.default_rng(1)
    return {
        "monte_carlo": [law.monte_carlo(rng, SAMPLES) for law in laws],
        "dynamics": [law.dynamics(rng) for law in laws],
        "intervals": [law.intervals(rng) for law in laws[:4]],
    }


def table_of(points, exact, alarm=scores.FALSE_ALARM):
    rows = check.comparisons(
        SCENE,
        rows.volume_rows(exact, points["monte_carlo"]),
        rows.area_rows(SCENE, exact, points["monte_carlo"]),
        rows.mean_time_rows(SCENE, exact, points["dynamics"]),
        rows.histogram_rows(exact, points["intervals"]),
        points["dynamics"],
    )
    return check.check_rows(rows, alarm)


@pytest.fixture
def exact():
    return rows.exact_values(theory_rows())


def failed(rows):
    return {
        (row["comparison"], row["quantity"], row["radius"])
        for row in rows
        if row["passed"] is False
    }


# When all is right ----------------------------------------------------------------------------


def test_all_that_was_measured_is_compared(points, exact):
    rows = table_of(points, exact)
    assert all(row["passed"] for row in rows)
    by_name = {}
    for row in rows:
        by_name.setdefault(row["comparison"], []).append(row)
    n = len(RADII)
    assert {name: len(found) for name, found in by_name.items()} == {
        "volume": n,
        "area": 6 * n,
        "mean_time": 6 * n,
        "hop_interval": 4,
        "sum_rule": n,
        "z_mean": 15,
        "z_spread": 15,
    }
    at_a_radius = rows[:-30]
    assert [row["radius"] for row in at_a_radius] == sorted(row["radius"] for row in at_a_radius)
    assert {row["bound"] for row in at_a_radius} == {
        scores.bonferroni_bound(len(at_a_radius), 5e-4)
    }
    assert {row["bound"] for row in rows[-30:]} == {scores.bonferroni_bound(30, 5e-4)}
    for row in rows:
        assert row["p"] == scores.two_sided_p(row["z"])
    for row in by_name["sum_rule"]:
        assert row["estimate"] == pytest.approx(1, abs=6 * row["stderr"])


def test_false_alarms_are_as_rare_as_stated(laws, exact, monkeypatch):
    # A large probability, so that alarms can be counted. Bonferroni's is an upper bound; where most
    # tests are continuous and nearly independent it is not far from the truth.
    alarm, trials, radii = 0.2, 400, RADII[1:6]
    shells = {
        (law.scene.radius, event): law.parts[f"{event}_area"]
        for law in laws
        for event in EVENTS[:5]
    }

    def shell_expectation(scene, event, epsilon):
        probability, measure, _ = shells[scene.radius, event]
        return probability * measure

    monkeypatch.setattr(comparison, "shell_expectation", shell_expectation)
    rng = np.random.default_rng(2)
    chosen = [law for law in laws if law.scene.radius in radii]
    alarms = 0
    for _ in range(trials):
        found = {
            "monte_carlo": [law.monte_carlo(rng, 10**7) for law in chosen],
            "dynamics": [law.dynamics(rng, replicas=128, relative=1e-2) for law in chosen],
            "intervals": [law.intervals(rng) for law in chosen[:3]],
        }
        alarms += bool(failed(table_of(found, exact, alarm)))
    spread = math.sqrt(trials * alarm * (1 - alarm))
    assert trials * alarm * 0.5 - 5 * spread < alarms < trials * alarm + 5 * spread
    assert alarms > 0


# When something is wrong ----------------------------------------------------------------------


def possible_radii(event):
    return {scene.radius for scene in scenes() if scene.is_possible(event)}


@pytest.mark.parametrize("event", EVENTS)
@pytest.mark.parametrize("factor", [0.99, 1.01])
def test_a_mean_time_off_by_one_percent_is_named(points, exact, event, factor):
    for radius in possible_radii(event):
        exact[radius, f"{event}_time"] *= factor
    found = failed(table_of(points, exact))
    wrong = {("mean_time", f"{event}_time", radius) for radius in possible_radii(event)}
    assert wrong <= found
    assert {quantity for _, quantity, _ in found - wrong} <= {
        f"{event}_time",
        "vertical_hop_interval" if event == "vertical_hop" else None,
    }


@pytest.mark.parametrize("event", EVENTS[:5])
def test_an_area_off_by_one_percent_is_named(points, exact, event, monkeypatch):
    def shell_expectation(scene, name, epsilon):
        return exact.shell_expectation(scene, name, epsilon) * (1.01 if name == event else 1)

    monkeypatch.setattr(comparison, "shell_expectation", shell_expectation)
    found = failed(table_of(points, exact))
    radii = possible_radii(event) if event in EVENTS[:2] else set(RADII)
    assert {("area", f"{event}_area", radius) for radius in radii} <= found
    walls = {"right_wall", "top_wall"}
    also = {"any_wall_area"} if event in walls else set()
    assert {quantity for _, quantity, _ in found} <= {f"{event}_area"} | also


def test_a_volume_off_by_one_percent_is_named(points, exact):
    for radius in RADII:
        exact[radius, "volume"] *= 1.01
    found = failed(table_of(points, exact))
    assert {("volume", "volume", radius) for radius in RADII} <= found
    assert {quantity for _, quantity, _ in found} == {"volume"}


def test_one_point_off_by_one_percent_is_named(points, exact):
    exact[0.3, "disc_collision_time"] *= 1.01
    assert ("mean_time", "disc_collision_time", 0.3) in failed(table_of(points, exact))


def test_the_sum_rule_sees_collisions_that_were_missed(laws, exact):
    law = Laws(laws[2].scene)
    law.times["disc_collision"] *= 1.01
    point = law.dynamics(np.random.default_rng(3))
    found = table_of({"monte_carlo": [], "dynamics": [point], "intervals": []}, exact)
    assert ("sum_rule", "mean_times", 0.2) in failed(found)


def test_what_is_blocked_must_not_be_seen(points, exact):
    point = next(p for p in points["dynamics"] if p["radius"] == 0.38)
    seen = {
        **point,
        "counts": {**point["counts"], "vertical_hop": 1},
        "products": {**point["products"], "vertical_hop*vertical_hop": 1},
    }
    rows = table_of({**points, "dynamics": [seen]}, exact)
    assert failed(rows) == {("mean_time", "vertical_hop_time", 0.38)}


def test_what_is_due_must_be_seen(points, exact):
    def silenced(point):
        event = "vertical_hop"
        return {
            **point,
            "counts": {**point["counts"], event: 0},
            "products": {k: 0 if event in k else v for k, v in point["products"].items()},
        }

    dynamics = [silenced(point) for point in points["dynamics"]]
    radii = possible_radii("vertical_hop")
    assert failed(table_of({**points, "dynamics": dynamics}, exact)) == {
        ("mean_time", "vertical_hop_time", radius) for radius in radii
    }
    monte_carlo = [
        {**p, "quantities": {**p["quantities"], "volume": {**p["quantities"]["volume"], "hits": 0}}}
        for p in points["monte_carlo"]
    ]
    assert ("volume", "volume", 0.38) in failed(
        table_of({**points, "monte_carlo": monte_carlo}, exact)
    )


def errors_times(factor, point):
    """Return the point with all errors changed by ``factor``, and the means kept."""
    products = dict(point["products"])
    for event, total in point["counts"].items():
        n, key = point["eligible"][event], f"{event}*{event}"
        spread = n * products[key] - total**2
        products[key] = (total**2 + round(factor**2 * spread)) // n + 1
    return {**point, "products": products}


@pytest.mark.parametrize(("factor", "sign"), [(1 / 3, 1), (3.0, -1)])
def test_errors_of_the_wrong_size_show_in_the_spread(factor, sign):
    radii = tuple(np.linspace(0.05, 0.23, 40))
    rng = np.random.default_rng(4)
    exact = rows.exact_values(theory_rows(radii))
    dynamics = [
        errors_times(factor, Laws(scene).dynamics(rng, 128, 5e-3, ("right_wall", "any_wall")))
        for scene in scenes(radii)
    ]
    rows = table_of({"monte_carlo": [], "dynamics": dynamics, "intervals": []}, exact)
    found = failed(rows)
    assert {(name, quantity) for name, quantity, radius in found if radius is None} >= {
        ("z_spread", "right_wall_time"),
        ("z_spread", "any_wall_time"),
    }
    assert not any(name == "z_mean" for name, _, _ in found)
    for row in rows:
        if row["comparison"] == "z_spread":
            assert math.copysign(1, row["z"]) == sign


def test_a_common_shift_below_one_error_shows_in_the_mean():
    radii = tuple(np.linspace(0.05, 0.23, 40))
    rng = np.random.default_rng(5)
    exact = rows.exact_values(theory_rows(radii))
    dynamics = [
        Laws(scene).dynamics(rng, 1024, 3e-4, ("disc_collision",)) for scene in scenes(radii)
    ]
    for radius in radii:
        exact[radius, "disc_collision_time"] *= 1 + 1.6e-4  # ¾ of an error
    rows = table_of({"monte_carlo": [], "dynamics": dynamics, "intervals": []}, exact)
    assert failed(rows) == {("z_mean", "disc_collision_time", None)}


def test_what_cannot_be_compared_is_there_and_not_passed(laws, exact):
    rng = np.random.default_rng(6)
    interval = {**laws[1].intervals(rng), "chains": 50}
    dynamics = laws[1].dynamics(rng, replicas=64, relative=1e-2)
    rows = table_of({"monte_carlo": [], "dynamics": [dynamics], "intervals": [interval]}, exact)
    untested = [row for row in rows if row["passed"] is None]
    assert {row["comparison"] for row in untested} == {"hop_interval", "sum_rule"}
    for row in untested:
        assert row["status"] == "too-few"
        assert row["z"] is row["p"] is row["bound"] is row["test"] is None
    assert {row["status"] for row in rows if row["comparison"] == "mean_time"} == {"too-few"}


# Command line ---------------------------------------------------------------------------------


def write_check(folder, monkeypatch, points, rows):
    folder.mkdir()
    tables.write(folder / "theory.csv", "theory", rows)
    keys = [repr(radius) for radius in RADII]
    paths = []
    for kind, found in points.items():
        paths += store(folder / kind, dict(zip(keys, found, strict=False)))
    status = command(
        monkeypatch, cli_tables, "check", "--scene", BOX, "--theory", folder / "theory.csv",
        "--points", *paths, "--output", folder / "check.csv",
    )  # fmt: skip
    assert status == 0
    return folder / "check.csv"


def test_check_passes_and_fails_from_end_to_end(tmp_path, monkeypatch, capsys, points):
    good = write_check(tmp_path / "good", monkeypatch, points, theory_rows())
    perturbed = theory_rows()
    for row in perturbed:
        if row["quantity"] == "top_wall_time" and row["radius"] in (0.1, 0.3):
            row["exact"] *= 0.99
    bad = write_check(tmp_path / "bad", monkeypatch, points, perturbed)

    out = tmp_path / "check.passed"
    assert command(monkeypatch, cli_check, good, "--output", out) == 0
    text = out.read_text()
    assert text == capsys.readouterr().out
    assert text.startswith("good: 132 comparisons passed, largest |z| ")
    assert text.count("\n") == 1

    out.unlink()
    assert command(monkeypatch, cli_check, good, bad, "--output", out) == 1
    lines = capsys.readouterr().err.splitlines()
    assert not out.exists()
    assert any(
        line.startswith("bad: mean_time of top_wall_time at radius 0.1 by dyn") for line in lines
    )
    assert any(
        line.startswith("bad: mean_time of top_wall_time at radius 0.3 by dyn") for line in lines
    )
    assert all("top_wall_time" in line for line in lines)


def test_check_of_what_is_no_table(tmp_path, monkeypatch, capsys):
    (tmp_path / "check.csv").write_text("radius\n")
    for path in ("check.csv", "absent.csv"):
        assert command(monkeypatch, cli_check, tmp_path / path, "--output", tmp_path / "out") == 2
        error = capsys.readouterr().err
        assert path in error
        assert error.count("\n") == 1
    assert not (tmp_path / "out").exists()
