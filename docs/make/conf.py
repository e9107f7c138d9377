"""The settings of Sphinx for the site, see website.py."""

from latex2mathml.converter import convert

import twodiscs

project = "Two discs in a box"
author = copyright = "the twodiscs authors"
release = version = twodiscs.__version__
extensions = ["myst_parser", "numpydoc", "sphinx.ext.autodoc"]

html_theme = "furo"
html_title = f"{project} {release}"
html_extra_path = ["extra"]
html_static_path = ["static"]
html_css_files = ["site.css"]
html_copy_source = False
html_math_renderer = "mathml"
pygments_dark_style = "monokai"
smartquotes = False

myst_enable_extensions = ["html_image"]
myst_fence_as_directive = ["math"]
myst_heading_anchors = 4

numpydoc_show_class_members = False


def formula(translator, node):
    """Write a block of LaTeX as MathML, which a browser shows without a script."""
    from docutils import nodes

    translator.body.append(f"<div>{convert(node.astext(), display='block')}</div>")
    raise nodes.SkipNode


def is_internal(app, what, name, obj, skip, options):
    """Leave out what is not declared for others: members that do not say what they return."""
    function = getattr(obj, "fget", getattr(obj, "func", obj))
    returns = getattr(function, "__annotations__", {"return": None})
    return skip or (callable(function) and "return" not in returns)


def setup(app):
    app.connect("autodoc-skip-member", is_internal)
    app.add_html_math_renderer(
        "mathml", inline_renderers=(formula, None), block_renderers=(formula, None)
    )
