"""The sources of the site: the pages of docs, and those that are made from declarations.

    python docs/make/website.py build/docs
    sphinx-build build/docs build/site

SOURCE in the environment is the address below which the files of the repository are published.
Without it, links to files that are no pages are plain text.
"""

import io
import os
import re
import shutil
from base64 import b64decode
from functools import partial
from pathlib import Path

import nbformat
from pages import described_table, described_tables, every_table
from pictures import PANELS

import twodiscs
from twodiscs.arguments import Parser, run
from twodiscs.comparison import check
from twodiscs.comparison.measured.result import Result
from twodiscs.figures.kit import style
from twodiscs.figures.kit.captions import Shown
from twodiscs.model.box import Box
from twodiscs_paper.catalogue import STUDIES, STUDY_FIGURES
from twodiscs_paper.pipeline.documents import captions, explorer
from twodiscs_paper.pipeline.jobs.figure import ENTRIES, draw_figure
from twodiscs_paper.pipeline.jobs.study import read_tables

ROOT = Path(__file__).resolve().parents[2]
EXPECTED = ROOT / "paper" / "expected"

#: Files that are pages of the site under other names.
PAGES = {
    "README.md": "index.md",
    "CHANGELOG.md": "changes.md",
    "CONTRIBUTING.md": "contributing.md",
    "config/README.md": "configuration.md",
    "results/README.md": "files.md",
}

#: The box of the pictures, that of the scene whose tables are expected.
BOX = Box(1.5, 1.0)
SCENE = {"name": "paper", "width": BOX.width, "height": BOX.height}


#: The pages by their titles' places in the site.
CONTENTS = {
    "Use it": "start recipes python gallery explorer glossary",
    "What is known": "results physics passages engine scaling",
    "The pipeline": "pipeline running reading-check add-a-box cluster configuration files tables",
    "Reference": "reference",
    "Development": (
        "contributing architecture data add-an-effect add-a-figure add-a-study site changes"
    ),
}


# Links --------------------------------------------------------------------------------------------


def relinked(text, folder):
    """Return the text of a page in ``folder`` of the repository as a page of the site."""
    text = re.sub(r'(<img src=")docs/', r"\1", text)
    return re.sub(r"(!?)\[([^\]]*)\]\(([^)#\s]*)(#[^)]*)?\)", partial(_link, folder), text)


def _link(folder, link):
    picture, words, target, anchor = link.groups(default="")
    if not target or "://" in target:
        return link[0]
    path = os.path.relpath(ROOT / folder / target, ROOT)
    page = PAGES.get(path, path.removeprefix("docs/") if path.startswith("docs/") else None)
    if page and page.endswith((".md", ".png", ".gif", ".svg")):
        return f"{picture}[{words}]({page}{anchor})"
    source = os.environ.get("SOURCE")
    return f"[{words}]({source}/{path}{anchor})" if source else words


# Pages that are made ------------------------------------------------------------------------------


def contents(title, names):
    """Return a part of the table of contents, hidden in its page."""
    lines = "\n".join(names)
    caption = f":caption: {title}\n" if title else ""
    return f"\n```{{toctree}}\n:hidden:\n{caption}\n{lines}\n```\n"


def notebook(path):
    """Return (a notebook as Markdown, {name: picture})."""
    parts, pictures = [], {}
    for cell in nbformat.read(path, as_version=4).cells:
        code = cell.cell_type == "code"
        parts.append(f"```python\n{cell.source}\n```" if code else cell.source)
        for output in cell.get("outputs", []):
            data = output.get("data", {})
            if "image/png" in data:
                name = f"tutorial-{len(pictures) + 1}.png"
                pictures[name] = b64decode(data["image/png"])
                parts.append(f"![The figure that this draws]({name})")
            else:
                parts.append(f"```text\n{output.get('text') or data.get('text/plain')}\n```")
    return "\n\n".join(parts), pictures


def reference(text):
    """Return the page of all public names with their signatures and docstrings."""
    return re.sub(r"^\* `td\.(\w+)`\n", _described, text, flags=re.MULTILINE)


def _described(line):
    name, value = line[1], getattr(twodiscs, line[1])
    if isinstance(value, type):
        kind = "autoexception" if issubclass(value, Exception) else "autoclass"
        lines = [":members:"]
        if issubclass(value, Result):
            lines += [":inherited-members: Mapping, Sequence"]
    elif callable(value):
        kind, lines = "autofunction", []
    else:
        kind, names = "py:data", ", ".join(f"``{key}``" for key in value)
        lines = ["", f"The names that are known, in their order: {names}."]
    below = "".join(f"\n   {one}".rstrip(" ") for one in lines)
    return f"### td.{name}\n\n```{{eval-rst}}\n.. {kind}:: twodiscs.{name}{below}\n```\n\n"


#: Tables of which only some rows are expected: Python draws the figures of these.
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
    result = RESULTS[ENTRIES[name].tables]
    if name == "animation":
        return f'td.animate({result}, "animation.gif")'
    return f'td.plot({result}, figure="{name}")'


def target(name):
    """Return the target that builds a figure: its study, if it belongs to one, or its own name."""
    return next((study.name for study in STUDIES.values() if name in study.figures), name)


def picture(name):
    """Return a small picture of a figure of the expected tables, None without all of them.

    The figures of ``FEW_ROWS`` are drawn by Python.
    """
    entry, folders = ENTRIES[name], (EXPECTED / "paper", EXPECTED)
    wanted = (*entry.tables, *entry.main_tables)
    found = {n: f / f"{n}.csv" for n in wanted for f in folders if (f / f"{n}.csv").exists()}
    if name == "animation" or set(found) != set(wanted):
        return None
    image = io.BytesIO()
    with style.context():
        if FEW_ROWS & set(wanted):
            figure = eval(in_python(name), {"td": twodiscs})
        else:
            figure = draw_figure(
                name, read_tables([f"{n}={path}" for n, path in found.items()]), BOX
            )
        figure.savefig(image, format="png", dpi=100, facecolor="white")
    return image.getvalue()


def gallery(pictures):
    """Return the page of all figures; ``pictures`` are the files of those that are drawn."""
    lines = [
        "# Gallery",
        "Every figure of the pipeline, drawn for a box of 1.5 × 1. "
        "In Python, start with `import twodiscs as td`; `figure=` takes the name of a figure.",
    ]
    for name, entry in ENTRIES.items():
        lines.append(f"## {entry.title}")
        if name in pictures:
            lines.append(f"![{entry.title}]({pictures[name]})")
            if pictures[name].removesuffix(".png") in PANELS:
                lines.append("This is one panel of the figure. The build draws all of them.")
        own = FEW_ROWS & {*entry.tables}
        caption = entry.caption(Shown(BOX)) if own else captions.caption(entry, EXPECTED, SCENE)
        lines.append(caption.replace("|", "\\|").replace("<", "&lt;"))
        lines.append(f"```text\nsnakemake --cores 2 {target(name)}\n```")
        if line := in_python(name):
            lines.append(f"```python\n{line}\n```")
    return "\n\n".join(lines) + "\n"


def live_explorer():
    """Return the explorer with the points that are expected."""
    tables = (EXPECTED / "paper").glob("*.csv")
    return explorer.explorer((ROOT / "workflow/explorer").iterdir(), tables, [SCENE], seed=1908)


EXPLORER = """\
# The explorer

<a href="explorer-page.html">A page of its own</a> has more room. `snakemake explorer` writes the
same page for your own boxes, with the points of your build if there is one.

<iframe src="explorer-page.html" title="The explorer"
    style="width: 100%; height: 90rem; border: 0"></iframe>
"""


def made():
    """Return {name: text or bytes} of all sources of the site."""
    files = {
        "conf.py": (ROOT / "docs" / "make" / "conf.py").read_bytes(),
        "static/site.css": ".highlight, table.docutils { clear: both; }\n",
    }
    for path in (ROOT / "docs").iterdir():
        if path.suffix == ".md":
            files[path.name] = path.read_text(encoding="utf-8")
        elif path.suffix in (".png", ".gif", ".svg"):
            # Twice: what stands in HTML is not known to Sphinx.
            files[path.name] = files[f"extra/{path.name}"] = path.read_bytes()
    files["python.md"], shown = notebook(ROOT / "docs" / "tutorial.ipynb")
    files |= {name: relinked(text, "docs") for name, text in files.items() if name.endswith(".md")}
    files["reference.md"] = reference(files["reference.md"])
    for path, name in PAGES.items():
        text = (ROOT / path).read_text(encoding="utf-8")
        files[name] = relinked(text, os.path.dirname(path))
    for title, names in CONTENTS.items():
        files["index.md"] += contents(title, names.split())
    tables = every_table()
    files["tables.md"] = "# The columns of the tables\n\n"
    files["tables.md"] += described_tables("[{0}.csv](tables/{0}.md)")
    files["tables.md"] += contents("", (f"tables/{name}" for name in tables))
    for name, table in tables.items():
        more = f"\n## How to read it\n\n{check.__doc__}" if name == "check" else ""
        files[f"tables/{name}.md"] = described_table(name, table) + more
    pictures = {f"gallery/{name}.png": image for name in ENTRIES if (image := picture(name))}
    shown |= pictures
    places = {figure: f"{name}.png" for name, (figure, *_) in PANELS.items()}
    places |= {Path(name).stem: name for name in pictures} | {"animation": "animation.gif"}
    files["gallery.md"] = gallery(places)
    files["explorer.md"] = EXPLORER
    files["extra/explorer-page.html"] = live_explorer()
    return files | shown


def main():
    parser = Parser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=Path, help="where the sources go; it is made anew")
    folder = parser.parse_args().folder
    shutil.rmtree(folder, ignore_errors=True)
    for name, content in made().items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        data = content.encode() if isinstance(content, str) else content
        (folder / name).write_bytes(data)


if __name__ == "__main__":
    run(main)
