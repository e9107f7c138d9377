"""A whole build: its files, its verdict, and a repetition.

Without these tests a build could miss files, differ if repeated, or pass if it is wrong.
"""

import json
import re
import subprocess

import pytest
from checkout import fresh

import twodiscs as td
from twodiscs.analysis.tables import TrajectoryTable
from twodiscs.figures.scene_figures import FIGURES

#: Files with seconds; a point has its processor time beside its content.
TIMED = "cost.csv", "benchmarks/", "logs/", "points/"

#: The figures of the scene ``full``, whose only area is that of the vertical hop.
DRAWN = FIGURES.keys() - {"horizontal_hop_area", "collision_area", "wall_area"}


def test_everything_that_is_called_for_is_built(complete):
    results = complete.results()
    assert {"check.passed", "tails.csv", "report.html", "configuration.json"} <= set(results)
    assert [n for n, text in results.items() if not text and not n.startswith("logs/")] == []
    assert not any((complete.path / "results" / name).stat().st_mode & 0o111 for name in results)
    path = TrajectoryTable.read(complete.path / "results/full/trajectory.csv")
    states = td.trajectory(td.Scene(1.5, 1.0, 0.24), duration=9, seed=7, name="full")
    assert [row["x1"] for row in path[:20]] == [*states["x1"][:20]]
    # The last lines are the verdict and the report.
    verdict = (complete.path / "results/check.passed").read_text().splitlines()
    lines = [r"^results/check\.passed, of 20.*:", *(re.escape(f"  {line}") for line in verdict)]
    lines += [re.escape(f"The report is {complete.path}/results/report.html")]
    assert re.search("\n".join(lines), complete.path.with_suffix(".done").read_text(), re.MULTILINE)


def test_the_scheduler_looks_for_jobs_when_a_job_ends_and_at_no_other_time(complete):
    said = complete.path.with_suffix(".done").read_text()
    assert 1 < said.count("Ready jobs: ") <= said.count("Finished jobid: ") + 1


def test_every_file_is_made_by_a_rule(complete):
    """Each may be asked for by its path."""
    assert complete.jobs("--", *[f"results/{name}" for name in complete.results()]) == []


def test_the_manifest_is_one_of_sha256sum(complete):
    """It has every table and figure without run times."""
    results = complete.path / "results"
    subprocess.run(["sha256sum", "--check", "--quiet", "manifest.sha256"], cwd=results, check=True)
    names = [line.split()[1] for line in (results / "manifest.sha256").read_text().splitlines()]
    assert {"errata.csv", "full/areas.csv", "walls/check.csv", "full/figures/volume.pdf"} < {*names}
    assert not {"full/cost.csv", "effects_cost.csv", "figures/effects.pdf"} & {*names}
    assert sorted(names) == names


@pytest.mark.slow
def test_on_one_core_the_bytes_are_the_same(complete, tmp_path_factory):
    again = fresh(tmp_path_factory.mktemp("again") / "checkout")
    tables = [f"results/full/{name}.csv" for name in ("grid", "areas", "mean_times", "trajectory")]
    again.snakemake("--cores", "1", "check", "volume", "hop_histogram", *tables)
    first, second = complete.results(), again.results()
    names = {name for name in second if not any(mark in name for mark in TIMED)}
    assert {"check.passed", "full/check.csv", "full/figures/hop_histogram.pdf"} <= names
    assert [name for name in sorted(names) if first[name] != second[name]] == []


def test_a_formula_off_by_one_percent_fails_the_check_and_is_named(built):
    right = "theory.mean_times(point.scene)[event]"
    wrong = f'{right} if event != "disc_collision" else 1.01 * {right}'
    built.replace(
        "src/twodiscs/analysis/tables.py",
        f"scene, exact = point.scene, {right}",
        f"scene, exact = point.scene, {wrong}",
    )
    # Points do not change: tables are made again, and all comparisons with them.
    run = built.twodiscs_run("config/config.yaml", "check", "--cores", "2", passes=False)
    failed = "error: full: comparison mean_time, quantity disc_collision_time"
    assert f"{failed}, method dynamics, radius 0.2 has z" in run.stderr
    assert "Traceback" not in run.stderr
    assert not (built.path / "results" / "check.passed").exists()


def test_verify_builds_nothing_and_names_what_differs(built):
    built.snakemake("--cores", "1", "renew")
    (built.path / "results/full/theory.csv").unlink()
    path = built.path / "results/full/points/dynamics/0.2.json"
    content = json.loads(path.read_text())
    (blocks, (counts, _)), *_ = content["parts"]["all"]["sums"].items()
    counts[0] += 1
    path.write_text(json.dumps(content))
    before = built.results()
    run = built.snakemake("--cores", "1", "verify", passes=False)
    log = (built.path / "results/logs/verify.log").read_text().splitlines()
    assert log[:-1] == [
        "full/theory.csv: is missing",
        f"full/points/dynamics/0.2.json: parts all sums {blocks} 0 0 is {counts[0]}, expected "
        f"{counts[0] - 1}",
    ]
    assert log[-1].endswith("files, 2 differ")
    assert log[0] in run.stdout + run.stderr
    changed = {name for name, text in built.results().items() if before.get(name) != text}
    assert all("verify" in name for name in changed)


def test_what_only_looks_changes_nothing_and_lint_is_clean_and_every_rule_says_what_it_does(built):
    def everything():
        paths = (path for path in built.path.rglob("*") if path.is_file())
        return {path: path.read_bytes() for path in paths if not {"log", "iocache"} & {*path.parts}}

    (built.path / "results/full/points/dynamics/0.2.json").unlink()
    before = everything()
    built.snakemake("--dry-run", "--forceall")
    built.snakemake("--lint")
    listed = built.snakemake("--list-rules").stdout.splitlines()
    assert everything() == before
    assert len(listed) > 40
    assert [line for line in listed if "(" not in line] == []


@pytest.mark.slow
def test_manuscript_and_explorer_are_made_when_asked_for(built):
    assert "explorer.html" not in built.results()
    built.configure(lambda mapping: mapping.update(shared=["paper", "report"]))
    built.snakemake("--cores", "2", "all", "explorer")
    results = built.results()
    assert results["paper.pdf"].startswith(b"%PDF")
    names = {"paper_numbers.csv", "passages.csv", "parts/passages/in_the_limit.csv"}
    assert names | {f"full/figures/{name}.pdf" for name in DRAWN} < {*results}
    assert b'href="paper.pdf"' in results["report.html"]
    assert b'"dynamics": [[' in results["explorer.html"]
    assert built.jobs("all", "explorer") == []
