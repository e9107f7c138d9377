"""The schema of a configuration for editors, and the tables of its keys, from the model."""

import ast
import inspect
from functools import cache
from itertools import pairwise

from twodiscs_paper.configuration import model


@cache
def schema():
    """Return the JSON schema, which has the words of the model: allowed, unit, otherwise.

    The text below a key is its description. Pydantic's ``use_attribute_docstrings`` would search
    for these texts at each import of the model, a tenth of the time of a dry run.
    """
    found, texts = model.Model.model_json_schema(), _texts()
    for node in (found, *found["$defs"].values()):
        for name, child in node["properties"].items():
            child.setdefault("description", texts.get((node["title"], name)))
    return found


def _texts():
    """Return {(block, key): the text below the key}; some blocks add keys to a class _Block."""
    classes = (n for n in ast.parse(inspect.getsource(model)).body if isinstance(n, ast.ClassDef))
    return {
        (block.name.lstrip("_"), key.target.id): inspect.cleandoc(text.value.value)
        for block in classes
        for key, text in pairwise(block.body)
        if isinstance(key, ast.AnnAssign) and isinstance(text, ast.Expr)
    }


@cache
def keys():
    """Return the schema as one tree, in which every node has ``allowed``.

    A node that has several forms, such as a list or a block, has the items and keys of all of them.
    """
    return _tree(schema())


def _tree(node):
    """Return a node without references, with the nodes beneath it."""
    found = {}
    for form in node.get("anyOf", [node] if "$ref" in node else []):
        if "$ref" in form:
            form = schema()["$defs"][form["$ref"].rpartition("/")[2]]
        found |= _tree(form)
    found |= node
    if "properties" in node:
        found["properties"] = {name: _tree(child) for name, child in node["properties"].items()}
        found.setdefault("allowed", f"a block of the keys {', '.join(node['properties'])}")
    if "items" in node:
        found["items"] = _tree(node["items"])
    return found


def described_keys():
    """Return the tables of all keys, in Markdown."""
    return "\n".join(_section(keys(), "")) + "\n"


def _section(node, path):
    lines = ["", f"## {f'`{path}`' if path else 'Top level'}", ""]
    lines += ["| key | meaning | may be | unit | default |", "|---|---|---|---|---|"]
    below = []
    for name, child in node["properties"].items():
        default = (
            "none: the key is required" if name in node.get("required", ()) else _default(child)
        )
        unit = child.get("unit", "–")
        meaning = " ".join(child["description"].split())
        cells = (f"`{name}`", meaning, child["allowed"], unit, default)
        lines.append(f"| {' | '.join(cells)} |")
        inner = f"{path}.{name}".lstrip(".")
        if "properties" in child:
            below += _section(child, inner)
        if "properties" in child.get("items", {}):
            below += _section(child["items"], f"{inner}[]")
    return lines + below


def _default(node):
    """Return the default of a key that is not required, as text."""
    if "otherwise" in node:
        return node["otherwise"]
    if "default" in node:
        value = node["default"]
        text = f"{value:g}" if isinstance(value, float) else str(value)
        return f"`{text.lower() if isinstance(value, bool) else text}`"
    return "the defaults of its keys"
