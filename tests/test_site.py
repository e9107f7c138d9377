"""The site: built without a warning, its links lead somewhere, and its lines of Python run."""

import json
import re
import subprocess
import sys

import pytest
import website
from checkout import REPOSITORY

import twodiscs as td
from twodiscs_paper.catalogue import TABLES
from twodiscs_paper.pipeline.jobs.build import TARGETS
from twodiscs_paper.pipeline.jobs.figure import ENTRIES

pytest.importorskip("sphinx", reason="Sphinx builds the site")


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The folder of the site, as ``make docs`` builds it."""
    folder = tmp_path_factory.mktemp("site")
    make = [sys.executable, "docs/make/website.py", folder / "docs"]
    build = [sys.executable, "-m", "sphinx", "--fail-on-warning", "--keep-going", "--quiet"]
    for command in (make, [*build, folder / "docs", folder / "site"]):
        done = subprocess.run(command, cwd=REPOSITORY, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
    return folder / "site"


@pytest.mark.slow
def test_links_and_pictures_lead_somewhere_on_this_machine(site):
    pages = [*site.rglob("*.html")]
    assert len(pages) > 50
    for page in pages:
        text = page.read_text(encoding="utf-8")
        for target in re.findall(r'(?:href|src)="([^"#?]+)', text):
            if not re.match("https://|data:", target):
                assert (page.parent / target).exists(), (page.name, target)
        assert not re.search(r'<(?:script|link|img|iframe)[^>]*"https?://', text), page.name


def listed(pages):
    """Return the numbers of pages of a word, which are one or a list, as a list."""
    return pages if isinstance(pages, list) else [pages]


@pytest.mark.slow
@pytest.mark.parametrize("word", ["pressure", "gravity", "ctrl", "cite"])
def test_the_search_knows(site, word):
    text = (site / "searchindex.js").read_text(encoding="utf-8")
    index = json.loads(text.removeprefix("Search.setIndex(").removesuffix(")"))
    recipes, stem = index["docnames"].index("recipes"), word[:6]
    words = [*index["terms"].items(), *index["titleterms"].items()]
    assert any(recipes in listed(pages) for found, pages in words if found.startswith(stem))


@pytest.mark.slow
def test_every_public_name_is_described(site):
    text = (site / "reference.html").read_text(encoding="utf-8")
    assert [name for name in td.__all__ if f'id="twodiscs.{name}"' not in text] == []


@pytest.mark.slow
def test_every_table_has_a_page_and_every_figure_a_place(site):
    assert [name for name in TABLES if not (site / f"tables/{name}.html").exists()] == []
    gallery = (site / "gallery.html").read_text(encoding="utf-8")
    for name, entry in ENTRIES.items():
        assert entry.title in gallery
        assert f"snakemake --cores 2 {website.target(name)}\n" in gallery
    assert gallery.count("<img") > 20


# The lines of the gallery -------------------------------------------------------------------------


def test_the_lines_of_the_gallery_are_targets():
    assert {website.target(name) for name in ENTRIES} <= {*TARGETS}
    assert website.target("friction") == "passages"


def test_the_lines_of_the_gallery_draw_their_figures(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    lines = {name: line for name in ENTRIES if (line := website.in_python(name))}
    assert len(lines) > 15
    made = {text: eval(text) for text in website.RESULTS.values()}
    for line in lines.values():
        (text,) = (text for text in made if text in line)
        figure = eval(line.replace(text, "result"), {"td": td, "result": made[text]})
        assert figure is None or figure.axes
    assert (tmp_path / "animation.gif").exists()


# Links --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("link", "folder", "there", "without"),
    [
        ("[a](physics.md#b)", "docs", "[a](physics.md#b)", "[a](physics.md#b)"),
        ("[a](docs/physics.md)", "", "[a](physics.md)", "[a](physics.md)"),
        ("[a](../README.md)", "docs", "[a](index.md)", "[a](index.md)"),
        ("[a](../src/x.py)", "docs", "[a](https://b/src/x.py)", "a"),
        ("[a](https://c)", "docs", "[a](https://c)", "[a](https://c)"),
        ("[a](#b)", "docs", "[a](#b)", "[a](#b)"),
    ],
)
def test_links_lead_to_pages_or_to_the_repository(link, folder, there, without, monkeypatch):
    monkeypatch.delenv("SOURCE", raising=False)
    assert website.relinked(link, folder) == without
    monkeypatch.setenv("SOURCE", "https://b")
    assert website.relinked(link, folder) == there
