"""The tables of long runs, against their counts and a build.

Without these tests tables of long runs could differ from their counts, or from the build.

A dozen scores are held to five standard errors: a false alarm in fewer than 1e-5 of all seeds.
"""

import math

import numpy as np
import pandas as pd
import pytest
import yaml
from factory import EXPECTED, LONG_RUNS, deviation, empty, of

import twodiscs as td
from twodiscs.dynamics.two.hop_clusters import HOPS_PER_BLOCK
from twodiscs.points.base import read_json
from twodiscs_paper.pipeline.results.verify import long_run_tables
from twodiscs_paper.studies.more_discs import tori
from twodiscs_paper.studies.more_discs.study import ToriTable
from twodiscs_paper.studies.passages import brownian, measure
from twodiscs_paper.studies.passages.parts import in_the_limit, long_files, long_run, with_friction
from twodiscs_paper.studies.passages.study import BrownianTable, PassagesTable
from twodiscs_paper.studies.tails import measure as tails
from twodiscs_paper.studies.tails.study import TailsTable


def kept(name, table):
    """Return (configuration, rows, counts or None) of a long run."""
    folder = LONG_RUNS / name
    configuration = yaml.safe_load((folder / "config.yaml").read_text(encoding="utf-8"))
    counts = next((read_json(path) for path in folder.glob("*.json")), None)
    return configuration, table.read(folder / f"{table.name()}.csv"), counts


def test_counts_are_of_all_blocks_and_points_of_their_configuration():
    configuration, _, counts = kept("passages", PassagesTable)
    for one in configuration["thresholds"]:
        for count in counts[one["name"]]:
            blocks = -(-one["hops"] // HOPS_PER_BLOCK)
            assert sum(hops for _, hops in count["sizes"]) == blocks * HOPS_PER_BLOCK
    configuration, _, counts = kept("files", PassagesTable)
    for one, count in zip(configuration["files"], counts["files"], strict=True):
        assert len(count) == len(configuration["seeds"]) * one["replicas"]
    configuration, _, counts = kept("brownian", BrownianTable)
    for kind in ("crossings", "passages"):
        for point, due in zip(counts[kind], brownian.points(configuration[kind]), strict=True):
            assert (point["program"], point["step"], point["halvings"]) == due[:3]
            assert len(point["seeds"]) == len(configuration["seeds"]) == 2
            for seed in point["seeds"]:
                assert (seed.get("pairs") or sum(n for _, n in seed["sizes"])) == due[3]
    configuration, _, counts = kept("tori", ToriTable)
    made = [(point, start) for point in configuration["points"] for start in point["starts"]]
    for (point, start), count in zip(made, counts["counts"], strict=True):
        assert count["start"] == start
        assert all(count[name] == point[name] for name in ("discs", "aspect", "packing"))
        assert 0.5 < count["sum"] / point["events"] < 2


@pytest.mark.parametrize("name", ["far", "passages", "files", "brownian", "tori"])
def test_a_table_is_that_of_its_counts(name, monkeypatch):
    """``snakemake renew`` writes these rows. The largest radii of tori take seconds."""
    monkeypatch.setattr("twodiscs.model.many_geometry.largest_known_radius", lambda *box: 1.0)
    (found,) = (one for one in long_run_tables(LONG_RUNS) if one[0].parent.name == name)
    path, table, rows = found
    found = pd.DataFrame([empty(table, **row) for row in rows])
    pd.testing.assert_frame_equal(found, pd.DataFrame(table.read(path)), rtol=1e-9, atol=0)


@pytest.mark.parametrize(
    "table", [PassagesTable, TailsTable, BrownianTable, ToriTable], ids=lambda table: table.name()
)
def test_the_parameters_of_a_long_run_are_those_of_a_part(table, monkeypatch):
    configuration, *_ = kept(table.name(), table)
    monkeypatch.setitem(measure.PARTS, "long_run", lambda thresholds, limit: (thresholds, limit))
    monkeypatch.setattr(tails, "long_run", lambda *given: given)
    for module in (brownian, tori):
        monkeypatch.setattr(module, "counted", lambda *given: given)
        monkeypatch.setattr(module, "rows", lambda counted: counted)
    due = [value for name, value in configuration.items() if name != "part"]
    assert [*table.part(**configuration)] == due


def test_hops_of_a_disc_within_any_time_have_the_diffusion_of_its_order():
    """The sum is D/(ν ℓ²) from the first time on, with half of the error, by either seed."""
    configuration, rows, counts = kept("files", PassagesTable)
    summed = of(rows, discs=128, method="all_hops")
    assert len(summed) == 12
    for row in summed:
        own = {key: row[key] for key in ("discs", "radius", "friction")}
        (moves,) = of(rows, quantity="diffusion", **own)
        assert abs(row["z"]) < 5
        assert row["stderr"] < 0.75 * moves["stderr"]
    for one, count in zip(configuration["files"], counts["files"], strict=True):
        halves = count[: one["replicas"]], count[one["replicas"] :]
        made = [[*long_files.file_rows(one, configuration, half)] for half in halves]
        assert all(deviation(*pair) < 5 for pair in zip(*made, strict=True))


def test_tori_have_the_published_pressures_where_they_are_in_equilibrium():
    """Two starts agree, or the discs are so dilute that one start is enough.

    256 discs at packing fractions to 0.4 have an error of 3e-4 or less, and 1/N counts there. The
    pressures of 1953 are too low in between, where those of 2022 at the same N are met.
    """
    _, found, _ = kept("tori", ToriTable)
    rows = [row for row in found if row["reference"]]
    settled = [row for row in rows if abs(row["starts_z"] or 0.0) <= 3]
    assert {row["reference"] for row in settled} == {"virial", "li-2022", "metropolis-1953"}
    assert len(settled) >= 0.8 * len(rows)
    old = of(settled, reference="metropolis-1953")
    assert max(abs(row["z"]) for row in settled if row not in old) < 3.5
    assert all(abs(r["z"]) < 3.5 for r in old if not 0.6 < r["packing_fraction"] < 0.7)
    assert all(row["z"] > 3 for row in old if 0.6 < row["packing_fraction"] < 0.7)
    for row in of(rows, reference="virial"):
        if row["packing_fraction"] < 0.45:
            infinite, _ = tori.virial_series(row["packing_fraction"], math.inf)
            assert row["stderr"] < 3e-4
            assert infinite - row["estimate"] > 10 * row["stderr"]


def test_both_starts_of_a_small_torus_have_one_pressure():
    point = {"discs": 72, "aspect": "1:1", "packing": 0.65, "events": 2e5, "replicas": 8}
    row = [*tori.rows(tori.counted(3, [point | {"starts": ["rows", "compressed"]}]))][-1]
    assert (row["start"], row["reference"]) == ("both", "li-2022")
    assert max(abs(row["z"]), abs(row["starts_z"])) < 5
    assert row["stderr"] < 0.03


def test_a_compressed_liquid_has_no_overlap():
    """Its nearest discs hardly touch, as those of its chains."""
    scene = tori.torus(72, 0.7, "1:sqrt(3)/2")
    states = tori.from_liquid(scene, 2, 1)
    assert tori.many_initial_states.states(scene, 2, 1)[144:].tolist() == states[144:].tolist()
    for x, y in states[:144].T.reshape(2, 2, 72):
        apart = x[:, None] - x, y[:, None] - y
        apart = [
            d - side * np.round(d / side)
            for d, side in zip(apart, (scene.width, scene.height), strict=True)
        ]
        nearest = np.sort(np.hypot(*apart), axis=0)[1]
        assert 1 <= nearest.min() < 1.01


def test_counts_of_a_file_are_those_of_its_motion(monkeypatch):
    """Hops within times of the end of the run do not count; each seed has its own stream."""
    unit, given = math.sqrt(7), []
    places = np.array(
        [[0.1, 1.0, 2.0, 2.9], [1.1, 1.0, 2.0, 2.9], [1.1, 1.0, 2.0, 2.9], [0.9, 1.0, 2.0, 2.9]]
    )
    log = places[:, :, None], unit * np.array([1.0, 4.5]), np.array([1, 1])
    monkeypatch.setattr(long_files.file, "logged", lambda *these: given.append(these) or [log])
    run = {"name": "a", "width": 1.5, "height": 1.0, "seeds": [1, 2], "step": 2.0, "records": 3}
    run |= {"sums": [1.0, 4.0], "lags": [1, 2]}
    one = {"discs": 4, "halvings": 3, "replicas": 5, "friction": 2.0}
    assert long_files.file_counts(one, run) == 2 * [[2, [0, -2], [0, 0], 2, [4, 4]]]
    (scene, step, number, replicas, stream, rate), (*_, other, _) = given
    assert (scene.width, scene.discs, scene.periodic) == (3.0, 4, "x")
    assert (number, replicas) == (3, 5)
    assert (step, rate) == pytest.approx((2 * unit, 2 / unit))
    assert stream != other


@pytest.mark.parametrize(
    ("name", "table", "quantity", "keys", "fewest"),
    [
        ("passages", PassagesTable, "coefficient", "distance friction moment_of_inertia", 24),
        ("tails", TailsTable, "survival", "radius method", 10),
        # The same streams: the radii of the build are among those of the long run.
        ("displacements", PassagesTable, "displacement", "radius friction discs", 21),
    ],
)
def test_long_runs_agree_with_the_build(name, table, quantity, keys, fewest):
    _, found, _ = kept(name, table)
    rows = of(table.read(EXPECTED / f"{table.name()}.csv"), quantity=quantity)
    expected = of(rows, scene="paper") or rows
    compared = 0
    for row in of(found, quantity=quantity):
        for other in of(expected, **{key: row[key] for key in ("event", *keys.split())}):
            if other["time"] == pytest.approx(row["time"]) and other["stderr"]:
                assert deviation(row, other) < 5
                compared += 1
    assert compared >= fewest


def test_seeds_and_methods_of_brownian_steps_agree():
    _, found, _ = kept("brownian", BrownianTable)
    judged = [row["seeds_z"] for row in found if row["seeds_z"] is not None]
    judged += [row["z"] for row in found if row["z"] is not None and row["program"] != "kicked"]
    assert len(judged) > 100
    # Hundreds of scores: one beyond 4.9 in 10^4 of such runs.
    assert max(map(abs, judged)) < 5


def test_reflected_discs_have_the_exponents_of_both_theories():
    """A neck of 8 steps and more, and one of 1/8 and less, have theirs from each seed."""
    _, found, _ = kept("brownian", BrownianTable)
    fits = of(found, program="reflected", method="crossings", quantity="exponent")
    long, short = ([r for r in fits if (r["neck"] > 1) == is_long] for is_long in (True, False))
    assert {row["seed"] for row in long} == {row["seed"] for row in short} == {None, 1, 2}
    assert max(row["stderr"] for row in fits) < 0.03
    assert all(abs(row["estimate"] + 1.5) < 5 * row["stderr"] for row in long)
    # 1 − κ ∝ ε^½ for short necks: half of it is left at the widest one.
    assert all(-2 < row["estimate"] < -1.95 for row in short)


def test_rejected_steps_have_their_law_without_a_parameter():
    """κ in necks of 8 steps or more."""
    _, found, _ = kept("brownian", BrownianTable)
    rows = [
        row
        for row in of(found, method="crossings", quantity="coefficient")
        if row["program"] in brownian.MOVE_WIDTHS and row["neck"] >= 8 and row["room"] <= 1 / 16
    ]
    assert len(rows) == 8
    assert all(abs(row["estimate"] - row["diffusive"]) < 5 * row["stderr"] for row in rows)


def test_kicks_in_a_narrow_neck_have_the_law_of_friction():
    """A short run agrees with the long one, and both with the law within half a per cent."""
    configuration, rows, _ = kept("passages", PassagesTable)
    found = of(rows, method="limit", quantity="coefficient")
    assert [row["friction"] for row in found] == configuration["limit"]["scaled"]
    assert all(abs(row["estimate"] / row["reference"] - 1) < 0.005 for row in found)
    assert all(row["stderr"] < 0.002 * row["estimate"] for row in found)
    (second,) = of(rows, quantity="scaling_second")
    assert abs(second["estimate"] - with_friction.SECOND) < second["stderr"]
    counts = in_the_limit.kicked_counts([0.3, 1.0], 8, 5)
    for row in [*in_the_limit.kicked_rows([0.3, 1.0], counts)][:2]:
        (long,) = of(found, friction=row["friction"])
        assert deviation(row, long) < 5


def test_a_small_run_counts_every_hop_once():
    one = {"name": "small", "width": 1.5, "height": 1.0, "hop": "horizontal_hop", "seed": 1}
    one |= {"first": 7, "last": 7, "hops": 2 * HOPS_PER_BLOCK - 1, "pauses": [1, 2]}
    counts = long_run.cluster_counts(one)
    assert [sum(hops for _, hops in count["sizes"]) for count in counts] == [2 * HOPS_PER_BLOCK] * 2
    assert counts[1]["events"] > counts[0]["events"]


def test_a_falling_tail_is_compared_with_its_law_from_1000_mean_times_on():
    one = {"width": 1.5, "height": 1.0, "event": "vertical_hop", "seed": 1}
    falling = one | {"radius": 0.1, "times": [50, 1000, 2000], "samples": 2}
    rows = tails.long_run(falling, one | {"radius": 0.3, "times": [1], "replicas": 10, "runs": 1})
    _, late, later = survival = of(rows, quantity="survival", radius=0.1)
    assert late["time"] == 1000 * td.mean_times(td.Scene(1.5, 1.0, 0.1))["vertical_hop_time"]
    follow = [tails.approach_power(survival, late), *map(tails.approach, (late, later))]
    assert rows[3:7] == [*follow, tails.mean_approach([late, later])]


def test_errors_of_joined_runs_are_those_of_as_many_replicas():
    one = {"width": 1.5, "height": 1.0, "event": "vertical_hop", "radius": 0.3, "times": [2, 4]}
    falling = one | {"radius": 0.1, "times": [5], "samples": 1, "seed": 1}

    def counted(**given):
        return of(tails.long_run(falling, one | given), radius=0.3)

    mean = td.mean_times(td.Scene(1.5, 1.0, 0.3))["vertical_hop_time"]
    many = counted(replicas=500, runs=16, seed=5)
    single = counted(replicas=8000, runs=1, seed=50)
    assert [row["quantity"] for row in many] == ["survival", "survival", "rate"]
    assert [row["time"] for row in many[:2]] == [2 * mean, 4 * mean]
    for joined, alone in zip(many, single, strict=True):
        assert deviation(joined, alone) < 5
        # An error of 8000 replicas is itself known to some per cent.
        assert joined["stderr"] == pytest.approx(alone["stderr"], rel=0.25)
