"""The report has every figure, agrees with its tables, fits a narrow window and asks no network.

Skipped where no Chromium is installed.
"""

import re

import pandas as pd
import pytest
from browser import ABSENT, BROWSER, browser

from twodiscs.figures.scene_figures import ANIMATION, FIGURES
from twodiscs_paper.catalogue import STUDY_FIGURES

pytestmark = pytest.mark.skipif(BROWSER is None, reason=ABSENT)

#: Look at the report: where every part of it is.
LOOK = """
(() => {
    const all = selector => [...document.querySelectorAll(selector)];
    const place = element => element.getBoundingClientRect();
    const [button, picture] = ["button", "picture"].map(
        tag => document.querySelector(`#animation ${tag}`));
    const labels = [button.innerText];
    button.click();
    return {
        title: document.title,
        verdict: document.querySelector(".verdict").innerText,
        rows: all("#agreement tr").map(row => [...row.cells].map(cell => cell.innerText)),
        figures: all("figure").map(figure => {
            const [image, caption] = ["img", "figcaption"].map(tag => figure.querySelector(tag));
            return {loaded: image.naturalWidth, title: caption.querySelector("strong").innerText,
                    key: figure.className == "key", alt: image.alt, caption: caption.innerText,
                    beneath: place(caption).top >= place(image).bottom, shown: place(image).width};
        }),
        thumbnails: all(".thumbnails img").map(image => [image.naturalWidth, image.alt.length]),
        sections: all("section h2").map(heading => heading.innerText),
        paused: [...labels, button.innerText, picture.querySelector("source").media],
        right: document.documentElement.scrollWidth,
        cut: place(document.querySelector("#agreement")).right
             - place(document.querySelector("#agreement").parentNode).right,
        links: all("a").map(link => link.getAttribute("href")),
        anchors: all("a[href^='#']").map(link => place(document.querySelector(link.hash)).top),
        numbers: all(".numbers").map(table => [...table.tBodies].map(body => body.rows.length)),
    };
})()
"""


@pytest.fixture(scope="module", params=[(768, "dark"), (390, "light")])
def front(request, complete, tmp_path_factory):
    """A browser shows the report in the narrowest window with usual tables, and in a narrow one."""
    address, (width, scheme) = (complete.path / "results" / "report.html").as_uri(), request.param
    with browser(tmp_path_factory.mktemp("browser")) as page:
        page.open(address, width=width, scheme=scheme)
        seen = page.look(LOOK)
        assert page.problems == []
        return seen | {"width": width, "violations": page.violations()}


def plain(text):
    """Return ``text`` with one blank between words."""
    return " ".join(text.split())


def test_the_report_opens_on_verdict_and_agreement(front, complete):
    assert front["title"] == "Two discs in a box"
    results = complete.path / "results"
    tables = [pd.read_csv(results / name / "check.csv") for name in ("full", "walls")]
    compared = [rows.dropna(subset="passed") for rows in tables]
    largest = [rows["z"].abs().max() for rows in compared]
    single = [rows["independent"].sum() for rows in compared]
    for said in (
        f"All {sum(map(len, compared))} comparisons with the exact theory passed, {sum(single)} of",
        f"largest deviation is {max(largest):.3g} standard",
    ):
        assert said in plain(front["verdict"])
    full, walls = front["rows"][1:]
    counts = [str(len(compared[0])), str(single[0])]
    assert full[:5] == ["1.5 × 1 (scene “full”)", "2", *counts, f"{largest[0]:.3g}"]
    assert walls[:2] == ["3 × 1 (scene “walls”)", "1"]
    cost = pd.read_csv(results / "full/cost.csv").set_index("stage")
    events = f"{cost.loc['dynamics', 'events'].sum():.1e}"
    assert full[5] == "{} × 10{}".format(*re.fullmatch(r"(.*)e\+0?(.*)", events).groups())


def test_key_figures_have_their_captions_beneath_them_and_the_rest_are_thumbnails(front, complete):
    assert front["figures"][0]["title"] == f"{ANIMATION.title}."
    key = [figure for figure in front["figures"] if figure["key"]]
    titles = {f"{entry.title}.": entry for entry in (FIGURES | STUDY_FIGURES).values()}
    assert len({figure["title"] for figure in key}) == 2 + 2 + 2  # of full, walls, all
    for figure in front["figures"]:
        # Nearly as wide as a column of a journal in its natural size, or as the window.
        assert min(figure["loaded"], figure["shown"]) > 300
        assert figure["beneath"]
    for figure in key:
        text = titles[figure["title"]].caption().replace("_", "")
        assert text in plain(figure["caption"]) or "scene “walls”" in figure["caption"]
        assert len(figure["alt"]) > 20
    results = complete.path / "results"
    drawn = [*results.glob("*/figures/*.png"), *results.glob("figures/*.png")]
    assert len(front["thumbnails"]) + len(front["figures"]) == len(drawn)
    assert all(width > 100 and letters > 20 for width, letters in front["thumbnails"])
    assert front["paused"] == ["Pause", "Play", "all"]


def test_every_section_is_there_and_nothing_is_wider_than_the_window(front):
    scenes = ["How accurate, how long", "Box 1.5 × 1 (scene “full”)", "Box 3 × 1 (scene “walls”)"]
    assert front["sections"] == [*scenes, "Studies, over all scenes", "How it was made"]
    assert front["right"] <= front["width"]
    assert front["cut"] <= 0


def test_keyboards_and_readers_of_screens_reach_everything(front):
    assert front["violations"] == []


def test_it_has_all_mean_times_and_its_links_lead_to_files_and_sections(front, complete):
    # Six events at each of two radii, two at one.
    assert front["numbers"] == [[1 + 6] * 2, [1 + 2]]
    assert front["anchors"] == sorted(front["anchors"])
    assert len(front["anchors"]) == 6  # accuracy, mean times, two scenes, studies, how it was made
    files = {link for link in front["links"] if not link.startswith("#")}
    assert [link for link in files if not (complete.path / "results" / link).is_file()] == []
    assert {"full/check.csv", "tails.csv", "full/figures/volume.pdf"} <= files
