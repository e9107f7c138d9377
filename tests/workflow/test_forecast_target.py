"""The forecast: printed and written whenever it is asked for, and compared with the time spent."""

import csv

import pytest


@pytest.mark.slow
def test_a_forecast_and_what_becomes_of_it(built):
    run = built.snakemake("--cores", "2", "forecast")
    lines = [line.split() for line in run.stdout.splitlines()]
    assert ["scene", "stage", "jobs", "events", "one", "core", "2", "cores"] in lines
    assert {"six", "walls", "all"} <= {line[0] for line in lines if line}
    path = built.path / "results" / "forecast.csv"
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    assert {row["cores"] for row in rows} == {"2"}

    # It is made again of another configuration, or by force.
    assert built.jobs("forecast") == []
    rerun = {job for job, _ in built.jobs()}
    assert rerun == {"table", "paper", "report", "provenance"}
    assert {w for job, w in built.jobs() if job == "table"} == {
        ("scene=six", "table=cost"),
        ("scene=walls", "table=cost"),
    }

    built.snakemake("--cores", "2", "results/six/cost.csv")
    with open(built.path / "results" / "six" / "cost.csv", newline="") as file:
        costs = list(csv.DictReader(file))
    assert costs[-1]["stage"] == "total"
    assert all(float(row["ratio"]) > 0 for row in costs)
    forecast = sum(float(row["forecast_seconds"]) for row in costs[:-1])
    assert abs(float(costs[-1]["forecast_seconds"]) - forecast) < 1e-9
