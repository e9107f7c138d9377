"""The tutorial: what it shows is what its code prints.

Without these tests the tutorial could show what its blocks of Python do not print.
"""

import pytest
import tutorial
from checkout import REPOSITORY
from test_examples import same

nbformat = pytest.importorskip("nbformat", reason="nbformat reads and writes notebooks")

PAGE, NOTEBOOK = REPOSITORY / "docs" / "python.md", REPOSITORY / "docs" / "tutorial.ipynb"

RENEW = "python docs/make/tutorial.py"


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tmp_path_factory.mktemp("tutorial"))
        return tutorial.tutorial(PAGE.read_text(encoding="utf-8"))


def test_the_page_shows_what_its_blocks_print(made):
    assert same(PAGE.read_text(encoding="utf-8"), made[0]), RENEW


def test_the_notebook_is_the_page(made):
    kept = nbformat.read(NOTEBOOK, as_version=4)
    assert [cell.source for cell in kept.cells] == [cell.source for cell in made[1].cells], RENEW
    for old, new in zip(kept.cells, made[1].cells, strict=True):
        for before, after in zip(old.get("outputs", []), new.get("outputs", []), strict=True):
            assert before.output_type == after.output_type
            assert same(text_of(before), text_of(after))


def text_of(output):
    return output.get("text") or output.data.get("text/plain", "")
