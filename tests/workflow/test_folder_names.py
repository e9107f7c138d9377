"""Folders with blanks and dollars in their names: shell lines quote every path."""

import yaml
from checkout import fresh
from test_anywhere import TINY


def test_a_folder_with_a_blank_and_a_command_in_its_name(tmp_path):
    """Everything is built there, and no shell reads the name as a command."""
    checkout = fresh(tmp_path / "a b $(touch X) 'c'")
    checkout.configuration.write_text(yaml.safe_dump(TINY))
    checkout.snakemake("--cores", "2")
    checkout.snakemake("--cores", "2", "crate", "audit")
    assert {"report.html", "report-workflow.html", "errata.csv"} <= {*checkout.results()}
    assert checkout.jobs() == []
    assert not [*tmp_path.rglob("X")]


def test_every_path_in_a_shell_line_is_quoted(unbuilt):
    """Of jobs that take longer: what their lines are, from a folder with such a name."""
    place = fresh(unbuilt.path.parent / "a b $(touch X)")
    targets = "all", "explorer", "benchmark", "crate", "effects", "long_runs"
    lines = place.snakemake("--dry-run", "--forceall", "--printshellcmds", "--", *targets).stdout
    shells = [line for line in lines.splitlines() if "Shell command:" in line]
    assert len(shells) > 50
    for line in shells:
        outside = "".join(line.split("'")[::2])
        assert "touch X" not in outside
