"""A whole build: all is there, the same bytes come out again, and a wrong formula is found."""

import csv
from hashlib import sha256

import pytest
from checkout import fresh

from twodiscs.figures.catalogue import FIGURES

#: What holds wall-clock seconds, or the date.
TIMED = (
    "cost.csv",
    "forecast.csv",
    "figures/accuracy_cost",
    "report",
    "provenance.json",
    "benchmarks/",
    "logs/",
    "points/cost/",
)


def test_everything_that_is_called_for_is_built(complete):
    results = complete.results()
    tables = ("grid", "theory", "volume", "areas", "mean_times", "hop_histogram", "check", "cost")
    assert {f"six/{name}.csv" for name in (*tables, "trajectory")} <= set(results)
    assert {f"six/figures/{name}.{kind}" for name in FIGURES for kind in ("pdf", "png")} <= set(
        results
    )
    walls = {name for name in results if name.startswith("walls/") and name.endswith(".csv")}
    assert walls == {f"walls/{n}.csv" for n in ("grid", "theory", "mean_times", "check", "cost")}
    assert {"check.passed", "paper.pdf", "report.html", "configuration.json"} <= set(results)
    may_be_empty = ("logs/", ".compiled/")
    assert [n for n, text in results.items() if not text and not n.startswith(may_be_empty)] == []


def test_report_holds_every_figure_and_table_and_asks_for_nothing_from_outside(complete):
    page = (complete.path / "results" / "report-workflow.html").read_text()
    for name, entry in FIGURES.items():
        assert f"results/six/figures/{name}.png" in page
        assert entry.category in page
    for name in ("volume", "areas", "mean_times", "hop_histogram", "check"):
        assert f"results/six/{name}.csv" in page
    assert "results/paper.pdf" in page
    front = (complete.path / "results" / "report.html").read_text()
    assert 'src="http' not in page + front


@pytest.mark.slow
def test_another_run_on_one_core_gives_the_same_bytes(complete, tmp_path_factory):
    again = fresh(tmp_path_factory.mktemp("again") / "checkout")
    tables = [f"results/six/{name}.csv" for name in ("grid", "areas", "mean_times", "trajectory")]
    again.snakemake("--cores", "1", "check", "volume", "hop_histogram", *tables)
    first, second = complete.results(), again.results()
    names = {name for name in second if not any(mark in name for mark in TIMED)}
    assert {"check.passed", "six/check.csv", "six/figures/hop_histogram.pdf"} <= names
    assert [name for name in sorted(names) if first[name] != second[name]] == []


def test_a_formula_off_by_one_percent_fails_the_check_and_is_named(built):
    wrong = '"exact": 1.01 * x if q == "disc_collision_time" else x}'
    built.replace("src/twodiscs/theory/exact.py", '"exact": x}', wrong)
    # Points are as they were: exact values are made again, and what is compared with them.
    again = "--rerun-triggers", "mtime", "--forcerun", "theory"
    run = built.snakemake("--cores", "2", *again, "--", "check", passes=False)
    assert run.returncode != 0
    said = run.stdout + run.stderr
    assert "mean_time of disc_collision_time at radius 0.2 by dynamics" in said
    assert "Traceback" not in said
    with open(built.path / "results" / "six" / "check.csv", newline="") as file:
        failed = [row["quantity"] for row in csv.DictReader(file) if row["passed"] == "false"]
    assert "disc_collision_time" in failed
    assert not (built.path / "results" / "check.passed").exists()


def test_what_is_deleted_comes_back(built):
    lost = "six/figures/volume.pdf", "paper.pdf", "six/mean_times.csv"
    for name in lost:
        (built.path / "results" / name).unlink()
    made = {
        ("figure", ("scene=six", "figure=volume")),
        ("paper", ()),
        ("table", ("scene=six", "table=mean_times")),
    }
    assert made <= {*built.jobs(*(f"results/{name}" for name in lost))}


def test_a_deleted_point_comes_back_with_what_was_made_of_it(built):
    (built.path / "results/six/points/monte_carlo/0.2.json").unlink()
    (built.path / "results/six/points/cost/dynamics-0.3.json").unlink()
    bundle = ("scene=six", "bundle=0000")
    assert {("monte_carlo", bundle), ("dynamics", bundle)} <= {*built.jobs()}


def test_what_is_damaged_is_made_again(built):
    point = built.path / "results/six/points/dynamics/0.2.json"
    point.write_text(point.read_text().replace("1", "2", 1))
    drawn = built.path / "results/six/figures/volume.pdf"
    drawn.write_bytes(drawn.read_bytes()[:1000])
    jobs = built.jobs("check", "results/six/figures/volume.pdf")
    assert ("dynamics", ("scene=six", "bundle=0000")) in jobs
    assert ("figure", ("scene=six", "figure=volume")) in jobs


def test_a_crate_names_every_file_that_is_called_for_and_says_what_it_is(built):
    rocrate = pytest.importorskip(
        "rocrate.rocrate", reason="rocrate, of the extra workflow, is not installed"
    )
    others = ("logs/", ".compiled/", "benchmarks/", ".record/", "points/")
    called = {name for name in built.results() if not any(one in name for one in others)}
    built.snakemake("--cores", "1", "crate")
    crate = rocrate.ROCrate(built.path / "results")
    files = {one.id: one for one in crate.data_entities if not one.id.startswith("_workflow/")}
    assert set(files) == called
    for name, one in files.items():
        assert one["sha256"] == sha256((built.path / "results" / name).read_bytes()).hexdigest()
        assert one["description"] != crate.get("_workflow/workflow/rules/points.smk")["description"]
    assert built.jobs("crate") == []
