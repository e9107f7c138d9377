"""Without these tests pages about the workflow could differ from rules, keys and names."""

import re
import subprocess
import sys

import pages
import pytest
from checkout import REPOSITORY

import twodiscs


@pytest.mark.parametrize("page", ["config/schema.json", "src/twodiscs/__init__.py"])
def test_pages_made_from_declarations_are_up_to_date(page):
    text = (REPOSITORY / page).read_text(encoding="utf-8")
    assert text == pages.pages(REPOSITORY)[page], "python docs/make/pages.py"


def test_the_reference_has_every_public_name():
    page = (REPOSITORY / "docs" / "reference.md").read_text(encoding="utf-8")
    assert sorted(re.findall(r"^\* `td\.(\w+)`$", page, re.M)) == sorted(twodiscs.__all__)


def test_the_drawing_of_the_rules_is_the_graph_of_snakemake():
    command = [sys.executable, "-m", "snakemake", "--rulegraph", "--forceall", "--nolock", "all"]
    done = subprocess.run(command, cwd=REPOSITORY, capture_output=True, text=True, check=True)
    names = dict(re.findall(r'(\d+)\[label = "(\w+)"', done.stdout))
    edges = re.findall(r"(\d+) -> (\d+)", done.stdout)
    read = {(names[source], names[target]) for source, target in edges if source != target}
    read = {arrow for arrow in read if not {"code", "all"} & {*arrow}}
    page = (REPOSITORY / "docs" / "pipeline.md").read_text(encoding="utf-8")
    drawn = {*re.findall(r"^    (\w+) --> (\w+)$", page, re.MULTILINE)}
    assert drawn <= read
    assert {rule for arrow in drawn for rule in arrow} == {*names.values()} - {"code", "all"}
    joined = {*drawn}
    while longer := {(a, d) for a, b in joined for c, d in drawn if b == c} - joined:
        joined |= longer
    assert read <= joined
