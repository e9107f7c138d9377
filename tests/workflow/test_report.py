"""The report in a browser: everything is in it, is shown, and comes from nowhere else.

Skipped where no Chromium is installed.
"""

import html
import json
import re
import shutil
import subprocess

import pytest

from twodiscs.figures.catalogue import ANIMATION, FIGURES
from twodiscs.studies.catalogue import STUDY_FIGURES

BROWSERS = ("chromium", "chromium-browser", "google-chrome")
BROWSER = next(filter(None, map(shutil.which, BROWSERS)), None)
pytestmark = pytest.mark.skipif(BROWSER is None, reason=f"none of {', '.join(BROWSERS)}")

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

#: After it: look at the graph, at every result, at one figure in its place; leave what was seen.
AFTER = """
<script>
async function until(condition) {
    while (!condition()) await new Promise(done => setTimeout(done, 50));
}

async function look() {
    const seen = {problems, categories, results: {}};
    await until(() => document.querySelector("#rulegraph canvas"));
    const graph = document.querySelector("#rulegraph canvas");
    const pixels = graph.getContext("2d").getImageData(0, 0, graph.width, graph.height).data;
    seen.drawn = pixels.filter((_, i) => i % 4 == 3).some(alpha => alpha > 0);
    seen.rules = rulegraph_spec.data[0].values.map(node => node.rule);
    seen.welcome = document.querySelector("#app .prose").innerText;

    const text = document.createElement("div");
    for (const [path, {caption, data_uri, labels, mime_type}] of Object.entries(results)) {
        text.innerHTML = caption;
        seen.results[path] = {caption: text.innerText, labels, mime_type};
        if (mime_type.startsWith("image/")) {
            const image = new Image();
            image.src = data_uri;
            await new Promise((done, fail) => Object.assign(image, {onload: done, onerror: fail}));
            seen.results[path].width = image.naturalWidth;
        }
    }

    const [path, figure] = Object.entries(results).find(([path]) => path.endsWith("PLACED"));
    app.setView({navbarMode: "resultinfo", resultPath: path, content: "img",
                 contentPath: figure.data_uri});
    const shown = () => document.querySelector("#app > div > div img");
    await until(() => shown() && shown().complete);
    const {left, right, top, bottom} = shown().getBoundingClientRect();
    seen.placed = {left, top, right: innerWidth - right, bottom: innerHeight - bottom,
                   caption: document.querySelector("#app nav").innerText};
    return seen;
}

look().catch(error => ({problems: [...problems, String(error)]})).then(seen => {
    document.documentElement.innerHTML = "<pre>";
    document.querySelector("pre").textContent = JSON.stringify(seen);
});
</script>
"""

#: The tallest figure, which has to be made smaller.
PLACED = "six/figures/mean_hop_time.png"


def look_at(report, folder):
    """Return what a browser sees of a ``report``, as a dict."""
    before, mark, after = report.read_text(encoding="utf-8").partition("<head>")
    body, end, rest = after.rpartition("</body>")
    assert mark
    assert end
    page = folder / "report.html"
    looked = AFTER.replace("PLACED", PLACED)
    page.write_text(f"{before}{mark}{BEFORE}{body}{looked}{end}{rest}", encoding="utf-8")
    run = subprocess.run(
        [
            *(BROWSER, "--headless", "--no-sandbox", "--disable-gpu", "--window-size=1400,1000"),
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


@pytest.fixture(scope="module")
def seen(complete, tmp_path_factory):
    """What a browser sees of the report on everything."""
    return look_at(complete.path / "results" / "report.html", tmp_path_factory.mktemp("browser"))


def plain(text):
    """Return ``text`` with one blank between words."""
    return " ".join(text.split())


def test_nothing_goes_wrong_and_nothing_is_asked_for(seen):
    assert seen["problems"] == []


def test_every_figure_is_shown_with_its_caption_and_category(seen, complete):
    drawn = {
        path.relative_to(complete.path).as_posix()
        for path in (complete.path / "results").glob("**/figures/*.png")
    }
    shown = {path for path, found in seen["results"].items() if found["mime_type"] == "image/png"}
    assert shown == drawn
    entries = FIGURES | STUDY_FIGURES | {"animation": ANIMATION}
    for path in shown:
        _, *scene, _, name = path.removesuffix(".png").split("/")
        entry, found = entries[name], seen["results"][path]
        more = f" Scene {scene[0]}." if scene else ""
        assert plain(found["caption"]) == plain(entry.full_caption()) + more
        assert found["labels"] == entry.labels
        assert found["width"] > 300
        assert path in seen["categories"][entry.category][scene[0] if scene else "all scenes"]


def test_every_table_and_the_manuscript_are_there(seen, complete):
    made = (complete.path / "results").glob("**/*.csv")
    unseen = {"grid.csv", "theory.csv", "trajectory.csv", "forecast.csv"}
    tables = {p.relative_to(complete.path).as_posix() for p in made if p.name not in unseen}
    held = {path for paths in seen["categories"]["Tables"].values() for path in paths}
    assert held == tables
    assert all(seen["results"][path]["caption"] for path in held)
    assert seen["categories"]["Manuscript"] == {"Other": ["results/paper.pdf"]}


def test_the_graph_of_the_workflow_is_drawn(seen):
    assert seen["drawn"]
    stages = {"monte_carlo", "dynamics", "intervals", "table", "check", "figure", "animate"}
    assert stages <= set(seen["rules"])


def test_the_first_page_says_what_it_is_about(seen):
    welcome = plain(seen["welcome"])
    assert "Two discs in a box" in welcome
    assert "Scenes: six (1.5 × 1.0), walls (3.0 × 1.0)." in welcome


def test_a_tall_figure_fits_the_window_beside_its_caption(seen):
    place = seen["placed"]
    assert min(place[side] for side in ("left", "top", "right", "bottom")) >= 0
    assert place["left"] > 300
    assert plain(FIGURES["mean_hop_time"].full_caption()) in plain(place["caption"])
