"""Pages about the workflow, against rules, keys and names.

Without these tests pages about the workflow could differ from rules, keys and names.
"""

import re

import pages
import pytest
from checkout import REPOSITORY

import twodiscs


@pytest.mark.parametrize("page", ["config/schema.json", "src/twodiscs/__init__.pyi"])
def test_pages_made_from_declarations_are_up_to_date(page):
    text = (REPOSITORY / page).read_text(encoding="utf-8")
    assert text == pages.pages(REPOSITORY)[page], "python docs/make/pages.py"


def test_the_reference_has_every_public_name():
    page = (REPOSITORY / "docs" / "reference.md").read_text(encoding="utf-8")
    assert sorted(re.findall(r"^\* `td\.(\w+)`$", page, re.M)) == sorted(twodiscs.__all__)
