"""The site: built without a warning, its links lead somewhere, and its lines of Python run."""

import json
import re
import subprocess
import sys

import made
import pytest
from checkout import REPOSITORY

import twodiscs as td
from twodiscs_paper.catalogue import ENTRIES, TABLES
from twodiscs_paper.pipeline.build import TARGETS

pytest.importorskip("sphinx", reason="Sphinx builds the site")


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The folder of the site, as ``make docs`` builds it."""
    folder = tmp_path_factory.mktemp("site")
    command = [
        *(sys.executable, "-m", "sphinx", "--conf-dir", "docs/make", "--doctree-dir", folder),
        *("--fail-on-warning", "--keep-going", "--quiet", ".", folder / "site"),
    ]
    done = subprocess.run(command, cwd=REPOSITORY, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return folder / "site"


@pytest.mark.slow
def test_links_and_pictures_lead_somewhere_on_this_machine(site):
    pages = [*site.rglob("*.html")]
    assert len(pages) > 30
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
    recipes, stem = index["docnames"].index("docs/recipes"), word[:6]
    words = [*index["terms"].items(), *index["titleterms"].items()]
    assert any(recipes in listed(pages) for found, pages in words if found.startswith(stem))


@pytest.mark.slow
def test_every_public_name_is_described(site):
    text = (site / "docs/reference.html").read_text(encoding="utf-8")
    assert [name for name in td.__all__ if f'id="twodiscs.{name}"' not in text] == []


@pytest.mark.slow
def test_every_table_and_every_figure_has_a_place(site):
    results = (site / "results/README.html").read_text(encoding="utf-8")
    assert [name for name in TABLES if f"<h3>{name}.csv<" not in results] == []
    gallery = (site / "docs/gallery.html").read_text(encoding="utf-8")
    for name, entry in ENTRIES.items():
        assert entry.title in gallery
        assert f"snakemake --cores 2 {made.target(name)}\n" in gallery
    assert gallery.count("<img") > 20


@pytest.mark.slow
def test_pages_are_complete(site):
    """The first page, the margin, the tutorial with its figures, the explorer."""
    assert (site / "index.html").read_bytes() == (site / "README.html").read_bytes()
    assert 'href="docs/recipes.html"' in (site / "index.html").read_text(encoding="utf-8")
    assert (site / "docs/python.html").read_text(encoding="utf-8").count("../tutorial-") > 1
    assert "<iframe" in (site / "docs/explorer.html").read_text(encoding="utf-8")


# The lines of the gallery -------------------------------------------------------------------------


def test_the_lines_of_the_gallery_are_targets():
    assert {made.target(name) for name in ENTRIES} <= {*TARGETS}
    assert made.target("friction") == "passages"


def test_the_lines_of_the_gallery_draw_their_figures(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    lines = {name: line for name in ENTRIES if (line := made.in_python(name))}
    assert len(lines) > 15
    results = {text: eval(text) for text in made.RESULTS.values()}
    for line in lines.values():
        (text,) = (text for text in results if text in line)
        figure = eval(line.replace(text, "result"), {"td": td, "result": results[text]})
        assert figure is None or figure.axes
    assert (tmp_path / "animation.gif").exists()
