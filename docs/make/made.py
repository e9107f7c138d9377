"""The parts of the site that are made from declarations, while Sphinx reads the pages.

``PAGES`` has a function for each page that is completed: it takes the text of the page and the
folder of the site, into which pictures go, and returns the whole text.
"""

import re
from base64 import b64decode
from html import escape
from io import BytesIO
from pathlib import Path

import nbformat
from pictures import BOX, PANELS, SCENE, draw

import twodiscs
from twodiscs.figures import style
from twodiscs.measure.result import Result
from twodiscs.model.scene import Box
from twodiscs_paper.catalogue import ALL_FIGURES, STUDIES, STUDY_FIGURES, TABLES
from twodiscs_paper.configuration.schema import described_keys
from twodiscs_paper.pipeline.documents import explorer
from twodiscs_paper.pipeline.documents.manuscript import PaperNumbersTable
from twodiscs_paper.pipeline.documents.report import SENTENCE

ROOT = Path(__file__).resolve().parents[2]
EXPECTED = ROOT / "paper" / "expected"
PAPER = {"name": SCENE, "width": BOX.width, "height": BOX.height, "effects": {}}


#: The part of the site's first page that README.md has not. Other pages have these pictures too.
FRONT = """## See it

<iframe src="explorer-page.html" title="The explorer" loading="lazy"
    style="width: 100%; height: 54rem; border: 0"></iframe>

<p><img src="_images/mean_hop_time.png" width="32%" alt="Mean time between hops against the radius">
<img src="_images/tails.png" width="32%" alt="Probability of an interval longer than t">
<img src="_images/passages.png" width="32%" alt="The fraction of hops that are passages"></p>

[The explorer](docs/explorer.md), [the results](docs/results.md) and [the gallery](docs/gallery.md)
have more.

"""


def front(text, site):
    """Return the first page with the explorer, figures, and the contents that its margin shows."""
    before, heading, after = text.partition("## From Python\n")
    contents = Path(__file__).with_name("contents.md").read_text(encoding="utf-8")
    return before + FRONT + heading + after + contents


def tutorial(text, site):
    """Return the tutorial with the figures of its notebook below the lines that draw them."""
    notebook = nbformat.read(ROOT / "docs" / "tutorial.ipynb", as_version=4)
    cells = iter([cell for cell in notebook.cells if cell.cell_type == "code"])

    def with_figure(block):
        cell, lines = next(cells), block[0]
        for output in cell.outputs:
            if png := output.get("data", {}).get("image/png"):
                name = f"tutorial-{cell.execution_count}.png"
                lines += shown(b64decode(png), name, "A figure", site)
        return lines

    return re.sub(r"^```python\n.*?^```\n", with_figure, text, flags=re.DOTALL | re.MULTILINE)


def shown(png, name, alt, site):
    """Write a picture into the folder of the site; return the line that shows it in a page."""
    Path(site, name).write_bytes(png)
    return f'\n<p><img src="../{name}" alt="{escape(alt)}" loading="lazy"></p>\n'


def reference(text, site):
    """Return the list of all public names with their signatures and docstrings."""
    return re.sub(r"^\* `td\.(\w+)`\n", _described, text, flags=re.MULTILINE)


def _described(line):
    name, value = line[1], getattr(twodiscs, line[1])
    if isinstance(value, type):
        own = ":members:\n   :inherited-members: Mapping, Sequence"
        kind, below = "autoclass", own if issubclass(value, Result | Box) else ":members:"
    elif callable(value):
        kind, below = "autofunction", ""
    else:
        names = ", ".join(f"``{key}``" for key in value)
        kind, below = "py:data", f"\n   The names that are known, in their order: {names}."
    return f"### td.{name}\n\n```{{eval-rst}}\n.. {kind}:: twodiscs.{name}\n   {below}\n```\n\n"


# Tables -------------------------------------------------------------------------------------------


def tables(text, site):
    """Return the page about results with all columns of all tables."""
    return text + "".join(map(described_table, [*TABLES.values(), PaperNumbersTable]))


def described_table(table):
    """Return the description of a table, its columns among it, as Markdown."""
    rows = (
        f"| `{column}` | {kind.unit or '–'} | {_plain(kind.meaning)} |\n"
        for column, kind in table.columns.items()
    )
    head = f"\n### {table.name()}.csv\n\n{_plain(table.meaning())}\n\n"
    return head + "| column | unit | meaning |\n|---|---|---|\n" + "".join(rows)


def _plain(text):
    """Return ``text`` with what Markdown would take for a column or a tag escaped."""
    return text.replace("|", "\\|").replace("<", "&lt;")


# The gallery --------------------------------------------------------------------------------------

#: Tables of which only some rows are expected: they give no figure.
FEW_ROWS = {"hop_histogram", "trajectory"}

#: The results that Python draws, by the tables that a figure reads.
RESULTS = {
    (): "td.Box(1.5, 1.0)",
    ("mean_times",): "td.scan(1.5, 1.0, [0.1, 0.2], error=0.05, budget=1e6)",
    ("volume",): "[td.sample(td.Scene(1.5, 1.0, r), 1e5) for r in (0.1, 0.2)]",
    ("areas",): "[td.sample(td.Scene(1.5, 1.0, r), 1e5) for r in (0.1, 0.2)]",
    ("trajectory",): "td.trajectory(td.Scene(1.5, 1.0, 0.2), seed=1)",
    ("hop_histogram",): 'td.intervals(td.Scene(1.5, 1.0, 0.2), "vertical_hop", 1e5)',
}


def in_python(name):
    """Return the line of Python that draws a figure, None for those of studies."""
    if name in STUDY_FIGURES:
        return None
    result = RESULTS[ALL_FIGURES[name].tables]
    if name == "animation":
        return f'td.animate({result}, "animation.gif")'
    return f'td.plot({result}, figure="{name}")'


def target(name):
    """Return the target that builds a figure: its study, if it belongs to one, or its own name."""
    return next((study.name for study in STUDIES.values() if name in study.figures), name)


def picture(name, alt, site):
    """Return the lines that show a figure: drawn, or one panel of it from ``docs``, or none."""
    panels = {figure: f"{panel}.png" for panel, (figure, *_) in PANELS.items()}
    if FEW_ROWS.isdisjoint(ALL_FIGURES[name].tables):
        with style.context():
            if figure := draw(name, EXPECTED):
                png = BytesIO()
                figure.savefig(png, dpi=100, facecolor="white")
                return shown(png.getvalue(), f"{name}.png", alt, site)
    if name == "animation":
        return f"![{alt}](animation.gif)"
    if name in panels:
        return f"![{alt}]({panels[name]})\n\nThis is one panel of the figure."
    return "[The tutorial](python.md) shows such a figure."


def gallery(text, site):
    """Return the page of all figures, each with its caption and the lines that draw it."""
    for name, entry in ALL_FIGURES.items():
        caption = _plain(entry.caption(BOX))
        alt = SENTENCE.match(entry.caption(BOX))[0]
        text += f"\n## {entry.title}\n\n{picture(name, alt, site)}\n\n{caption}\n"
        text += f"\n```text\nsnakemake --cores 2 {target(name)}\n```\n"
        if line := in_python(name):
            text += f"\n```python\n{line}\n```\n"
    return text


def live_explorer():
    """Return the explorer with the points that are expected."""
    expected = (EXPECTED / "paper").glob("*.csv")
    return explorer.explorer((ROOT / "workflow/explorer").iterdir(), expected, [PAPER], seed=1908)


PAGES = {
    "README": front,
    "docs/python": tutorial,
    "docs/reference": reference,
    "docs/gallery": gallery,
    "config/README": lambda text, site: text + described_keys(),
    "results/README": tables,
}
