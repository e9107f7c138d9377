"""The site: links, contents and the gallery.

Without these tests links could be dead, entries without a place, and lines of the gallery wrong.
"""

import re
from itertools import product

import made
import pytest
from browser import ABSENT, BROWSER, browser
from checkout import REPOSITORY
from commands import python

import twodiscs as td
from twodiscs_paper.catalogue import ALL_FIGURES, TABLES

pytest.importorskip("sphinx", reason="Sphinx builds the site")

#: Pixels of a window of a desk, a tablet and a telephone.
WIDTHS = 1280, 768, 390


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The folder of the site, as ``make docs`` builds it."""
    folder = tmp_path_factory.mktemp("site")
    options = "--conf-dir", "docs/make", "--fail-on-warning", "--keep-going", "--quiet"
    places = "--doctree-dir", folder / "doctrees", ".", folder / "site"
    done = python("-m", "sphinx", *options, *places, cwd=REPOSITORY)
    assert done.returncode == 0, done.stderr
    return folder / "site"


@pytest.mark.slow
@pytest.mark.skipif(BROWSER is None, reason=ABSENT)
def test_keyboards_and_readers_of_screens_reach_every_page(site, tmp_path):
    with browser(tmp_path) as page:
        for path, width, scheme in product(site.rglob("*.html"), WIDTHS, ("light", "dark")):
            page.open(path.as_uri(), width=width, scheme=scheme)
            assert page.violations() == [], (path.name, width, scheme)
        page.open((site / "index.html").as_uri())
        page.look("document.querySelector('iframe').scrollIntoView()")
        page.until("document.querySelector('iframe').clientHeight > 1200")


@pytest.mark.slow
def test_the_site_is_complete(site):
    """Its links, pictures, and what declarations make."""
    pages = {p.relative_to(site).as_posix(): p.read_text("utf-8") for p in site.rglob("*.html")}
    for name, text in pages.items():
        for target in re.findall(r'(?:href|src)="([^"#?]+)', text):
            if not re.match("https://|data:", target):
                assert ((site / name).parent / target).exists(), (name, target)
        assert not re.search(r'<(?:script|link|img|iframe)[^>]*"https?://', text), name
    assert [n for n in td.__all__ if f'id="twodiscs.{n}"' not in pages["docs/reference.html"]] == []
    assert [n for n in TABLES if f"<h3>{n}.csv<" not in pages["results/README.html"]] == []
    gallery = pages["docs/gallery.html"]
    assert [n for n in ALL_FIGURES if f"--cores 2 {made.target(n)}\n" not in gallery] == []
    assert "gravit" in (site / "searchindex.js").read_text(encoding="utf-8")


@pytest.mark.slow
def test_the_lines_of_the_gallery_draw_their_figures(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    lines = {name: line for name in ALL_FIGURES if (line := made.in_python(name))}
    assert len(lines) > 15
    results = {text: eval(text) for text in made.RESULTS.values()}
    for line in lines.values():
        (text,) = (text for text in results if text in line)
        figure = eval(line.replace(text, "result"), {"td": td, "result": results[text]})
        assert figure is None or figure.axes
    assert (tmp_path / "animation.gif").exists()
