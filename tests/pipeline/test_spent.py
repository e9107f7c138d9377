"""The times of the jobs of a build, from the files that Snakemake writes."""

import pytest

from twodiscs.model.checks import InputError
from twodiscs_paper.pipeline.results.spent import main, spent

HEAD = "s\th:m:s\tmax_rss\tmax_vms\tcpu_time\n"


def test_jobs_of_a_kind_are_added_up(tmp_path):
    jobs = {
        "one/dynamics/0.1": (2.0, 50, 1.5), "one/dynamics/1e-05": (3.0, 70, 2.5),
        "two/dynamics/0.1_all-0-9": (1.0, 60, 1.0), "check": (0.5, "NA", "NA"),
    }  # fmt: skip
    for name, (seconds, memory, processor) in jobs.items():
        path = tmp_path / "benchmarks" / f"{name}.tsv"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"{HEAD}{seconds}\t0:00:01\t{memory}\t9\t{processor}\n")
    table = spent(tmp_path)
    assert [*table.index] == ["dynamics", "check"]
    assert [*table.loc["dynamics"]] == [3, 6.0, 5.0, 70.0]
    assert [*table.loc["check"]][:3] == [1, 0.5, 0.0]


def test_memory_is_printed_with_its_unit(tmp_path, monkeypatch, capsys):
    (tmp_path / "benchmarks").mkdir()
    (tmp_path / "benchmarks" / "check.tsv").write_text(f"{HEAD}2.0\t0:00:02\t50.2\t9\t1.5\n")
    monkeypatch.setattr("sys.argv", ["spent", str(tmp_path)])
    main()
    head, _, *rows = capsys.readouterr().out.splitlines()
    assert head.split() == ["jobs", "seconds", "processor", "memory", "(MiB)"]
    assert [row.split() for row in rows] == [
        ["check", "1", "2.0", "1.5", "50.2"],
        ["all", "1", "2.0", "1.5", "50.2"],
    ]


def test_a_folder_without_measurements_is_refused(tmp_path):
    with pytest.raises(InputError, match=r"must be a folder of results, with benchmarks/\*\.tsv"):
        spent(tmp_path)
