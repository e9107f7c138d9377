"""The settings of Sphinx for the site: the pages are read where they are in the repository.

    sphinx-build --conf-dir docs/make . build/site

``made.py`` has what is added to some pages while they are read.
"""

import os
import sys
from pathlib import Path
from shutil import copyfile

from latex2mathml.converter import convert

sys.path.insert(0, str(Path(__file__).parent))
import made

import twodiscs

project = "Two discs in a box"
author = copyright = "the twodiscs authors"
release = version = twodiscs.__version__
extensions = ["myst_parser", "numpydoc", "sphinx.ext.autodoc", "sphinxcontrib.mermaid"]

root_doc = "README"
include_patterns = ["*.md", "docs/*.md", "*/README.md", "paper/*/README.md", "paper/*/*/README.md"]
exclude_patterns = [".*", "build", "src", "tests", "workflow", "results/[!R]*"]

html_theme = "furo"
html_title = f"{project} {release}"
html_css_files, html_js_files = ["site.css"], [("site.js", {"defer": "defer"})]
html_static_path = ["site.css", "site.js"]
html_copy_source = False
html_math_renderer = "mathml"
pygments_dark_style = "monokai"
smartquotes = False

myst_enable_extensions = ["html_image"]
myst_fence_as_directive = ["math", "mermaid"]
myst_heading_anchors = 4
# A picture for those who pass the address on; it needs the address of the site.
html_baseurl = os.environ.get("SITE_URL", "")
myst_html_meta = {
    "description": "Exact times between hops and collisions of two hard discs in a box",
    "property=og:title": project,
    "property=og:image": f"{html_baseurl}/_images/mean_hop_time.png",
}

# The script that draws diagrams is a part of the site, see docs.yml. Without it a page shows their
# text: no page asks another server for anything.
if (made.ROOT / "build/mermaid").is_dir():
    html_static_path = [*html_static_path, "../../build/mermaid"]
mermaid_use_local = "mermaid.esm.min.mjs"
mermaid_fullscreen = False
mermaid_height = "auto"

numpydoc_show_class_members = False


def formula(translator, node):
    """Write a block of LaTeX as MathML, which a browser shows without a script.

    Formulas with a ``\\qquad`` between them stand beside each other, on a narrow screen beneath.
    """
    from docutils import nodes

    parts = [convert(part, display="block") for part in node.astext().split(r"\qquad")]
    formulas = "".join(f"<div>{part}</div>" for part in parts)
    translator.body.append(f'<div class="formulas">{formulas}</div>')
    raise nodes.SkipNode


def is_internal(app, what, name, obj, skip, options):
    """Leave out what is not declared for others: members that do not say what they return."""
    function = getattr(obj, "fget", getattr(obj, "func", obj))
    returns = getattr(function, "__annotations__", {"return": None})
    return skip or (callable(function) and "return" not in returns)


def complete(app, page, source):
    """Add to the text of a page what is made from declarations."""
    if page in made.PAGES:
        source[0] = made.PAGES[page](source[0], app.outdir)


def finish(app, error):
    """Write the page with which a browser begins, and the explorer."""
    if not error:
        copyfile(app.outdir / "README.html", app.outdir / "index.html")
        (app.outdir / "explorer-page.html").write_text(made.live_explorer(), encoding="utf-8")


def setup(app):
    app.connect("source-read", complete)
    app.connect("build-finished", finish)
    app.connect("autodoc-skip-member", is_internal)
    app.add_html_math_renderer(
        "mathml", inline_renderers=(formula, None), block_renderers=(formula, None)
    )
