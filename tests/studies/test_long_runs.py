"""Without these tests tables of long runs could differ from their counts, or from the build.

A dozen scores are held to five standard errors: a false alarm in fewer than 1e-5 of all seeds.
"""

import math
from pathlib import Path

import pytest
import yaml

from twodiscs.dynamics.two.passages import HOPS_OF_BLOCK
from twodiscs.model.box import Box
from twodiscs.points.base import read_json
from twodiscs.sampling.many import insertions
from twodiscs.theory.virial import rates
from twodiscs_paper.studies.passages import measure as passages
from twodiscs_paper.studies.passages.study import Passages
from twodiscs_paper.studies.tails import measure as tails
from twodiscs_paper.studies.tails.study import Tails

PAPER = Path(__file__).resolve().parents[2] / "paper"


def kept(name, table):
    """Return (configuration, rows) of a long run."""
    folder = PAPER / "long_run" / name
    configuration = yaml.safe_load((folder / "config.yaml").read_text(encoding="utf-8"))
    return configuration, table.read(folder / f"{table.name()}.csv")


def of(rows, **where):
    """Return those of ``rows`` that have these values."""
    return [row for row in rows if where.items() <= row.items()]


def assert_same(made, found):
    """Assert that rows are the same, numbers to twelve digits."""
    assert len(made) == len(found)
    for one, other in zip(made, found, strict=True):
        for column, value in other.items():
            if isinstance(value, float):
                value = pytest.approx(value, rel=1e-12)
            assert one.get(column) == value, column


def deviation(one, other):
    """Return by how many standard errors two rows differ."""
    error = math.hypot(one["stderr"], other["stderr"])
    return abs(one["estimate"] - other["estimate"]) / error


def test_the_table_of_passages_is_that_of_its_counts():
    configuration, found = kept("passages", Passages)
    counts = read_json(PAPER / "long_run" / "passages" / "clusters.json")
    made = [
        row
        for one in configuration["thresholds"]
        for row in passages.cluster_rows(one, counts[one["name"]])
    ]
    assert_same(made, found)
    for one in configuration["thresholds"]:
        for count in counts[one["name"]]:
            blocks = -(-one["hops"] // HOPS_OF_BLOCK)
            assert sum(hops for _, hops in count["sizes"]) == blocks * HOPS_OF_BLOCK


@pytest.mark.parametrize(("name", "table"), [("passages", Passages), ("tails", Tails)])
def test_the_parameters_of_a_long_run_are_those_of_a_part(name, table, monkeypatch):
    configuration, _ = kept(name, table)
    given = []
    monkeypatch.setitem(passages.PARTS, "long_run", lambda thresholds: given.append(thresholds))
    monkeypatch.setattr(tails, "long_run", lambda weighted, counted: given.append(counted))
    table.part(**configuration)
    assert given == [configuration.get("thresholds", configuration.get("counted"))]


def kept_files():
    """Return (run, files, counts, rows) of the long run of files."""
    configuration, found = kept("files", Passages)
    run = {name: value for name, value in configuration.items() if name not in ("part", "files")}
    counts = read_json(PAPER / "long_run" / "files" / "counts.json")["files"]
    return run, configuration["files"], counts, found


def test_the_table_of_files_is_that_of_its_counts():
    run, files, counts, found = kept_files()
    made = [
        row
        for one, count in zip(files, counts, strict=True)
        for row in passages.file_rows(one, run, count)
    ]
    assert_same(made, found)
    assert [len(count) for count in counts] == [one["replicas"] for one in files]


#: Hops of a disc per h over the thermal speed at δ = 1/8, by another program: {N: (value, error)}.
HOPS = {
    4: (0.1352, 0.0022), 8: (0.1729, 0.0025), 16: (0.1872, 0.0028), 32: (0.1935, 0.0025),
    64: (0.1962, 0.0031), 128: (0.1990, 0.0019),
}  # fmt: skip


def test_hops_of_a_disc_come_more_often_in_a_longer_file():
    """Those of another program within three errors: six have a false alarm in 2 % of the seeds."""
    found = {}
    for row in of(kept_files()[3], quantity="rate", distance=1 / 8):
        unit = math.sqrt(2 * row["discs"] - 1)
        found[row["discs"]] = unit * row["estimate"], unit * row["stderr"]
    assert found.keys() == HOPS.keys()
    for discs, (due, spread) in HOPS.items():
        value, error = found[discs]
        assert abs(value - due) < 3 * math.hypot(error, spread), discs
    values = [found[discs] for discs in sorted(found)]
    assert values == sorted(values)


def test_files_diffuse_by_passages_if_hops_are_rare():
    """D = κ ν ℓ² in files at δ = 1/32, smooth ones and one with friction, and D < ν ℓ²."""
    rows = of(kept_files()[3], distance=1 / 32)
    files = {(row["discs"], row["friction"]) for row in rows}
    assert len(files) == 4
    for discs, friction in files:
        own = of(rows, discs=discs, friction=friction)
        (moves,) = of(own, quantity="diffusion")
        kappa = of(own, quantity="coefficient")[2:]
        assert len(kappa) == 3  # a pause of 2, 4 and 8 has the same κ
        for one in kappa:
            assert deviation(one, moves) < 5
            assert one["stderr"] < 0.01 * one["estimate"]
        assert moves["estimate"] + 5 * moves["stderr"] < 1


@pytest.mark.parametrize("discs", [4, 8])
def test_hops_of_short_files_are_those_of_monte_carlo(discs):
    """At two distances; closer to the threshold insertions find too few hops."""
    for halvings in (3, 4):
        where = {"quantity": "rate", "discs": discs, "distance": 2.0**-halvings}
        (found,) = of(kept_files()[3], **where)
        scene, _ = passages.file_of(Box(1.5, 1.0), discs, halvings)
        value, error = (
            2 / discs * rates(scene, part)["horizontal_hop"]  # two discs take part in a hop
            for part in insertions.sample(scene, 2**17, 4)
        )
        assert abs(found["estimate"] - value) < 5 * math.hypot(found["stderr"], error)
        assert error < 0.05 * value


def test_displacements_of_the_build_are_among_those_of_the_long_run():
    """They have the same streams; open files have D by the longer run within five errors."""
    _, found = kept("displacements", Passages)
    own = of(Passages.read(PAPER / "expected" / "passages.csv"), discs=128)
    radii = {row["radius"] for row in own}
    same = [row for row in found if row["friction"] and row["radius"] in radii]
    assert radii == {0.27, 0.28, 0.3}
    for radius in radii:
        assert_same(of(own, radius=radius), of(same, radius=radius))
    compared = 0
    for row in of(found, quantity="diffusion"):
        for other in of(kept_files()[3], quantity="diffusion", discs=128, distance=row["distance"]):
            if bool(other["friction"]) == bool(row["friction"]):
                assert deviation(row, other) < 5
                compared += 1
    assert compared == 3


@pytest.mark.parametrize(
    ("name", "table", "quantity", "keys", "fewest"),
    [
        ("passages", Passages, "coefficient", ("distance", "moment_of_inertia", "time"), 4),
        ("tails", Tails, "survival", ("radius", "method"), 10),
    ],
)
def test_long_runs_agree_with_the_build(name, table, quantity, keys, fewest):
    _, found = kept(name, table)
    rows = of(table.read(PAPER / "expected" / f"{name}.csv"), quantity=quantity)
    expected = [row for row in rows if row.get("scene", "paper") == "paper"]
    compared = 0
    for row in of(found, quantity=quantity):
        for other in of(expected, **{key: row[key] for key in ("event", *keys)}):
            if other["time"] == pytest.approx(row["time"]) and other["stderr"]:
                assert deviation(row, other) < 5
                compared += 1
    assert compared >= fewest


def test_later_hops_undo_passages():
    """A pause twice as long, from the same states."""
    once, twice = of(kept("passages", Passages)[1], scene="pause", quantity="coefficient")
    assert twice["time"] == 2 * once["time"]
    assert twice["estimate"] < once["estimate"]


def test_a_small_run_counts_every_hop_once():
    one = {
        "name": "small", "width": 1.5, "height": 1.0, "hop": "horizontal_hop",
        "first": 7, "last": 7, "hops": 2 * HOPS_OF_BLOCK - 1, "seed": 1, "pauses": [1, 2],
    }  # fmt: skip
    counts = passages.cluster_counts(one)
    assert [sum(hops for _, hops in count["sizes"]) for count in counts] == [2 * HOPS_OF_BLOCK] * 2
    assert counts[1]["events"] > counts[0]["events"]
    assert [row["quantity"] for row in passages.cluster_rows(one, counts)] == [
        "coefficient", "passage_time", "coefficient", "passage_time",
    ]  # fmt: skip


def test_the_rows_of_tails_follow_from_the_probabilities():
    configuration, found = kept("tails", Tails)
    replicas = configuration["counted"]["replicas"] * configuration["counted"]["runs"]
    counted = of(found, quantity="survival", method="counted")
    times = [round(row["time"] / row["exact_mean"]) for row in counted]
    assert times == configuration["counted"]["times"]
    for row in counted:
        number = row["estimate"] * 8 * replicas
        assert number == pytest.approx(round(number), abs=1e-3)
    rates = of(found, quantity="rate")
    for row, early, late in zip(rates, counted[:-1], counted[1:], strict=True):
        ratio = math.log(early["estimate"] / late["estimate"])
        assert row["estimate"] == pytest.approx(ratio / (late["time"] - early["time"]))
    weighted = of(found, quantity="survival", method="weighted")
    for row, one in zip(of(found, quantity="approach"), weighted, strict=True):
        excess = one["estimate"] / one["law"] - 1
        assert row["estimate"] == pytest.approx(excess * (one["time"] / one["exact_mean"]) ** 0.5)


def test_errors_of_joined_runs_are_those_of_as_many_replicas():
    one = {"width": 1.5, "height": 1.0, "event": "vertical_hop", "radius": 0.3, "times": [2, 4]}
    falling = one | {"radius": 0.1, "times": [5], "samples": 1, "seed": 1}

    def counted(**given):
        rows = tails.long_run(falling, one | given)
        return of(rows, radius=0.3)

    many = counted(replicas=500, runs=16, seed=5)
    single = counted(replicas=8000, runs=1, seed=50)
    assert [row["quantity"] for row in many] == ["survival", "survival", "rate"]
    for joined, alone in zip(many, single, strict=True):
        assert deviation(joined, alone) < 5
        # An error of 8000 replicas is itself known to some per cent.
        assert joined["stderr"] == pytest.approx(alone["stderr"], rel=0.25)
