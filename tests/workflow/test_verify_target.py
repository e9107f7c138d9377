"""Verification as a target: one job, always, that builds nothing and says what differs."""

import os
import subprocess
import sys

from twodiscs.points.digests import read_json, write_json


def test_verification_is_one_job_whatever_there_is(unbuilt):
    assert unbuilt.jobs("verify") == [("configuration", ()), ("verify", ())]


def test_results_out_of_date_are_verified_as_they_are(built):
    built.edit("src/twodiscs/dynamics/counting.py", "\nREMARK = 1\n")
    (built.path / "results" / "six" / "theory.csv").unlink()
    assert built.jobs("verify") == [("verify", ())]


def test_the_manifest_tells_what_is_there(complete):
    results = complete.path / "results"
    names = [line.split()[1] for line in (results / "manifest.sha256").read_text().splitlines()]
    assert {"errata.csv", "six/areas.csv", "walls/check.csv", "six/figures/volume.pdf"} <= set(
        names
    )
    assert not {"six/cost.csv", "accuracy_cost.csv", "figures/accuracy_cost.pdf"} & set(names)
    assert sorted(names) == names


def test_what_differs_is_said_and_nothing_is_built(built):
    written = subprocess.run(
        [sys.executable, "-m", "twodiscs_paper.pipeline.results.verify", "--write"],
        cwd=built.path,
        env=os.environ | {"PYTHONPATH": str(built.path / "src")},
        check=False,
    )
    assert written.returncode == 0
    path = built.path / "results" / "six" / "points" / "dynamics" / "0.2.json"
    point = read_json(path)
    point["counts"]["vertical_hop"] += 1
    write_json(path, point)
    before = built.results()
    run = built.snakemake("--cores", "1", "verify", passes=False)
    assert run.returncode == 1
    found = point["counts"]["vertical_hop"]
    said = (
        "six/points/dynamics, radius 0.2: counts vertical_hop is "
        f"{found}, expected {found - 1}\ndifferences: 1\n"
    )
    assert said in run.stdout + run.stderr
    log = "logs/verify.log"
    after = built.results()
    assert after.pop(log).decode() == said
    before.pop(log, None)
    assert after == before
