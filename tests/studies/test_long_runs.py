"""Without these tests tables of long runs could differ from their counts, or from the build.

A dozen scores are held to five standard errors: a false alarm in fewer than 1e-5 of all seeds.
"""

import math
from functools import partial
from pathlib import Path

import pytest
import yaml

from twodiscs.comparison.transmission import by_clusters, of_clusters, plateau
from twodiscs.dynamics.many.passages import cluster_sizes
from twodiscs.dynamics.two.passages import HOPS_OF_BLOCK
from twodiscs.model.box import Box
from twodiscs.points.base import read_json
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


def test_files_diffuse_by_passages_if_hops_are_rare():
    """D = κ ν ℓ² at δ = 1/32 and D < ν ℓ², smooth and with friction, as the paper has it.

    κ of 128 discs is that of the same motion. κ of short files is that of hops that are drawn on
    their surface, from other states and by another kernel.
    """
    rows = of(kept_files()[3], distance=1 / 32)
    files = {(row["discs"], row["friction"]) for row in rows}
    assert len(files) == 4
    for discs, friction in files:
        own = of(rows, discs=discs, friction=friction)
        (moves,), (hops,) = (of(own, quantity=name) for name in ("diffusion", "rate"))
        kappa = of(own, quantity="coefficient")[-1]
        value, error = kappa["estimate"], kappa["stderr"]
        if discs < 10:
            scene, unit = passages.file_of(Box(1.5, 1.0), discs, 5)
            gap = 8 * unit
            sizes, _ = cluster_sizes(scene, "horizontal_hop", gap, 48, 5)
            law = partial(of_clusters, others=2)
            drawn = plateau(by_clusters(sizes), gap, 2 / hops["estimate"], law)
            value, error = drawn.value, drawn.stderr
        both = math.hypot(error, moves["stderr"])
        assert abs(value - moves["estimate"]) < 5 * both < 1 - value


@pytest.mark.parametrize(
    ("name", "table", "quantity", "keys", "fewest"),
    [
        ("passages", Passages, "coefficient", ("distance", "friction", "moment_of_inertia"), 11),
        ("tails", Tails, "survival", ("radius", "method"), 10),
        # The same streams: the radii of the build are among those of the long run.
        ("displacements", Passages, "displacement", ("radius", "friction", "discs"), 21),
    ],
)
def test_long_runs_agree_with_the_build(name, table, quantity, keys, fewest):
    _, found = kept(name, table)
    rows = of(table.read(PAPER / "expected" / f"{table.name()}.csv"), quantity=quantity)
    expected = [row for row in rows if row.get("scene", "paper") == "paper"]
    compared = 0
    for row in of(found, quantity=quantity):
        for other in of(expected, **{key: row[key] for key in ("event", *keys)}):
            if other["time"] == pytest.approx(row["time"]) and other["stderr"]:
                assert deviation(row, other) < 5
                compared += 1
    assert compared >= fewest


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
