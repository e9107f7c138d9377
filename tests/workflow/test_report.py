"""The report in a browser: all is shown, and from nowhere else.

Skipped where no Chromium is installed.
"""

import csv
import html
import json
import re
import subprocess

import pytest
from browser import ABSENT, BROWSER

from twodiscs.figures.catalogue import ANIMATION, FIGURES
from twodiscs_paper.catalogue import STUDY_FIGURES

pytestmark = pytest.mark.skipif(BROWSER is None, reason=ABSENT)

#: Before anything of the report: whatever asks for more than the page itself holds is refused, and
#: whatever goes wrong is written down.
BEFORE = """
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; img-src data:;
  frame-src data:; script-src 'unsafe-inline' 'unsafe-eval'; style-src 'unsafe-inline'">
<script>
var problems = [];
console.error = (...words) => problems.push(words.join(" "));
addEventListener("error", e => problems.push(e.message || e.target.outerHTML), true);
addEventListener("unhandledrejection", e => problems.push(String(e.reason)));
addEventListener("securitypolicyviolation", e => problems.push("refused: " + e.blockedURI));
</script>
"""

#: After it: what was seen is left as the only text of the page.
AFTER = """
<script>
LOOK
look().catch(error => ({problems: [...problems, String(error)]})).then(seen => {
    document.documentElement.innerHTML = "<pre>";
    document.querySelector("pre").textContent = JSON.stringify(seen);
});
</script>
"""

#: Look at the report: where every part of it is.
LOOK_AT_FRONT = """
async function look() {
    await new Promise(done => addEventListener("load", done));
    const all = selector => [...document.querySelectorAll(selector)];
    const place = element => element.getBoundingClientRect();
    return {
        problems,
        title: document.title,
        heading: document.querySelector("h1").innerText,
        verdict: document.querySelector(".verdict").innerText,
        rows: all("#agreement tr").map(row => [...row.cells].map(cell => cell.innerText)),
        figures: all("figure").map(figure => {
            const [image, caption] = ["img", "figcaption"].map(tag => figure.querySelector(tag));
            return {loaded: image.naturalWidth, title: caption.querySelector("strong").innerText,
                    key: figure.className == "key", alt: image.alt, caption: caption.innerText,
                    beneath: place(caption).top >= place(image).bottom, shown: place(image).width};
        }),
        thumbnails: all(".thumbnails img").map(image => [image.naturalWidth, image.alt]),
        sections: all("section h2").map(heading => heading.innerText),
        paused: (() => {
            const [button, picture] = ["button", "picture"].map(
                tag => document.querySelector(`#animation ${tag}`));
            const seen = [button.innerText];
            button.click();
            return [...seen, button.innerText, picture.querySelector("source").media];
        })(),
        tops: ["h1", ".verdict", "#agreement", "#animation", ".key", ".files", "#made"].map(
            selector => place(document.querySelector(selector)).top),
        opening: place(document.querySelector("#animation img")).bottom,
        wider: document.documentElement.scrollWidth - innerWidth,
        hidden: place(document.querySelector("#agreement")).right - innerWidth,
        smallest: Math.min(...all("p, td, th, figcaption, li").map(
            element => parseFloat(getComputedStyle(element).fontSize))),
        links: all("a").map(link => link.getAttribute("href")),
        anchors: all("a[href^='#']").map(link => place(document.querySelector(link.hash)).top),
        opened: all("details[open] > summary").length,
        numbers: all(".numbers").map(table => [...table.tBodies].map(body => body.rows.length)),
        last: document.querySelector("main").lastElementChild.id,
    };
}
"""


def look_at(report, folder, look, width=1400):
    """Return what the script ``look`` sees of a ``report`` in a browser, as a dict."""
    before, mark, after = report.read_text(encoding="utf-8").partition("<head>")
    body, end, rest = after.rpartition("</body>")
    assert mark
    assert end
    page = folder / "report.html"
    looked = AFTER.replace("LOOK", look)
    page.write_text(f"{before}{mark}{BEFORE}{body}{looked}{end}{rest}", encoding="utf-8")
    run = subprocess.run(
        [
            *(BROWSER, "--headless", "--no-sandbox", "--disable-gpu"),
            f"--window-size={width},1000",
            *(f"--user-data-dir={folder / 'profile'}", "--virtual-time-budget=1000000"),
            *("--dump-dom", page.as_uri()),
        ],
        capture_output=True,
        text=True,
        encoding="utf-8",
        timeout=120,
    )
    assert run.returncode == 0, run.stderr
    found = re.fullmatch(r".*<pre>(.*)</pre>.*", run.stdout, re.DOTALL)
    assert found, run.stdout[-1000:]
    return json.loads(html.unescape(found[1]))


#: Pixels: a screen, and the narrowest window of this browser.
@pytest.fixture(scope="module", params=[1280, 500])
def front(request, complete, tmp_path_factory):
    """What a browser sees of the report, in a wide window and in a narrow one."""
    page, folder = complete.path / "results" / "report.html", tmp_path_factory.mktemp("browser")
    return look_at(page, folder, LOOK_AT_FRONT, request.param) | {"width": request.param}


def rows(complete, table):
    """Return the rows of a table of results as {column: text}."""
    with open(complete.path / "results" / table, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def plain(text):
    """Return ``text`` with one blank between words."""
    return " ".join(text.split())


def test_nothing_goes_wrong_and_nothing_is_asked_for(front):
    assert front["problems"] == []


def test_the_report_opens_on_verdict_agreement_and_animation(front, complete):
    assert front["title"] == front["heading"] == "Two discs in a box"
    tables = {name: rows(complete, f"{name}/check.csv") for name in ("full", "walls")}
    compared = {n: [r for r in some if r["passed"]] for n, some in tables.items()}
    largest = {n: max(abs(float(r["z"])) for r in some) for n, some in compared.items()}
    total = sum(map(len, compared.values()))
    single = {n: sum(r["independent"] == "true" for r in some) for n, some in compared.items()}
    said = f"All {total} comparisons with the exact theory passed, {sum(single.values())} of them"
    assert said in plain(front["verdict"])
    said = f"largest deviation is {max(largest.values()):.3g} standard"
    assert said in plain(front["verdict"])
    full, walls = front["rows"][1:]
    counts = [str(len(compared["full"])), str(single["full"])]
    assert full[:5] == ["full, 1.5 × 1", "3", *counts, f"{largest['full']:.3g}"]
    assert walls[:2] == ["walls, 3 × 1", "1"]
    events = sum(
        int(r["events"]) for r in rows(complete, "full/cost.csv") if r["stage"] == "dynamics"
    )
    assert full[5] == "{} × 10{}".format(*re.fullmatch(r"(.*)e\+0?(.*)", f"{events:.1e}").groups())


def test_key_figures_have_their_captions_beneath_them(front, complete):
    first, *others = front["figures"]
    assert first["title"] == f"{ANIMATION.title}."
    key = [figure for figure in others if figure["key"]]
    titles = {f"{entry.title}.": entry for entry in (FIGURES | STUDY_FIGURES).values()}
    assert (
        len({figure["title"] for figure in key}) == 2 + 2 + 3
    )  # of the scenes full, walls, of all
    for figure in front["figures"]:
        assert figure["loaded"] > 300
        assert figure["beneath"]
        # Nearly as wide as a column of a journal in its natural size, or as the window.
        assert figure["shown"] > 300
    for figure in key:
        text = titles[figure["title"]].caption()
        if "Scene walls" not in figure["caption"]:
            assert text.replace("_", "") in plain(figure["caption"])
        # Who does not see the picture hears what it shows.
        assert figure["alt"].startswith(figure["title"])
        assert len(figure["alt"]) > len(figure["title"]) + 20


def test_a_section_a_scene_and_thumbnails_of_the_rest(front, complete):
    scenes = ["How accurate, how long", "Scene full", "Scene walls"]
    assert front["sections"] == [*scenes, "Studies, over all scenes", "How it was made"]
    drawn = {*(complete.path / "results").glob("*/figures/*.png")}
    drawn |= {*(complete.path / "results" / "figures").glob("*.png")}
    assert len(front["thumbnails"]) + len(front["figures"]) == len(drawn)
    assert all(width > 100 and len(text) > 20 for width, text in front["thumbnails"])
    assert {"full/figures/volume.pdf", "full/figures/volume.png"} <= {*front["links"]}


def test_the_animation_can_be_paused(front):
    assert front["paused"] == ["Pause", "Play", "all"]


def test_it_begins_with_all_mean_times_and_its_contents(front, complete):
    # Six events at each of three radii, two at one.
    assert front["numbers"] == [[1 + 6] * 3, [1 + 2]]
    assert front["opened"] == 4  # in each scene, and as many on accuracy
    assert front["anchors"] == sorted(front["anchors"])
    assert len(front["anchors"]) == 6  # accuracy, mean times, two scenes, studies, how it was made


def test_the_order_is_the_same_in_any_window_and_nothing_is_wider_than_it(front):
    heading, verdict, table, movie, *rest = front["tops"]
    assert heading < verdict < table
    assert max(table, movie) < rest[0]
    assert rest == sorted(rest)
    assert front["last"] == "made"
    assert front["wider"] <= 0
    assert front["hidden"] <= 0, "the table of agreement has to be pushed aside"
    assert front["smallest"] >= 13
    if front["width"] > 1000:
        assert front["opening"] < 1000, "the animation is in the first window"


def test_links_of_the_report_lead_to_files(front, complete):
    results = complete.path / "results"
    files = {link for link in front["links"] if not link.startswith("#")}
    assert [link for link in files if not (results / link).is_file()] == []
    assert {"full/check.csv", "tails.csv"} <= files
