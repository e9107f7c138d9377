"""The Snakefiles: their format, what Snakemake's linter says of them, and the pages about them."""

import re
import subprocess
import sys

from checkout import REPOSITORY

from twodiscs.comparison import tables
from twodiscs.figures.catalogue import FIGURES


def test_snakefiles_are_formatted():
    run = subprocess.run(
        [sys.executable, "-m", "snakefmt", "--check", "Snakefile", "workflow"],
        cwd=REPOSITORY,
        capture_output=True,
        text=True,
    )
    assert run.returncode == 0, run.stderr


def test_linter_only_misses_a_container(unbuilt):
    run = unbuilt.snakemake("--lint", passes=False)
    titles = set(re.findall(r"^    \* (.+):$", run.stdout + run.stderr, flags=re.MULTILINE))
    # requirements.lock is the environment.
    assert titles == {"Specify a conda environment or container for each rule."}


def test_every_rule_keeps_a_log_and_a_benchmark():
    for path in sorted((REPOSITORY / "workflow" / "rules").glob("*.smk")):
        for rule in re.split(r"^rule ", path.read_text(), flags=re.MULTILINE)[1:]:
            if "\n    shell:\n" not in rule:
                continue
            assert "\n    log:\n" in rule, rule
            assert "\n    benchmark:\n" in rule, rule


def test_results_page_describes_the_tables():
    page = (REPOSITORY / "results" / "README.md").read_text()
    assert page.endswith(tables.documentation()), "its end must be tables.documentation()"


def test_readme_lists_every_target():
    page = (REPOSITORY / "README.md").read_text()
    assert [
        name for name in ("all", "check", "paper", "report", *FIGURES) if f"`{name}`" not in page
    ] == []
