"""What Sphinx is told of the site, see website.py."""

from latex2mathml.converter import convert

import twodiscs

project = "Two discs in a box"
author = copyright = "the twodiscs authors"
release = version = twodiscs.__version__
extensions = ["myst_parser", "numpydoc", "sphinx.ext.autodoc"]

html_theme = "furo"
html_title = f"{project} {release}"
html_extra_path = ["extra"]
html_copy_source = False
html_math_renderer = "mathml"
pygments_dark_style = "monokai"

myst_enable_extensions = ["html_image"]
myst_fence_as_directive = ["math"]
myst_heading_anchors = 4

numpydoc_show_class_members = False


def formula(translator, node):
    """Write a block of LaTeX as MathML, which a browser shows without a script."""
    from docutils import nodes

    translator.body.append(f"<div>{convert(node.astext(), display='block')}</div>")
    raise nodes.SkipNode


def setup(app):
    app.add_html_math_renderer(
        "mathml", inline_renderers=(formula, None), block_renderers=(formula, None)
    )
