"""The schema of the configuration, and the page config/README.md that is made from it.

``schema.yaml`` declares the keys and their values. This module fills in all that follows from the
declarations of events, effects and studies.
"""

from functools import cache
from pathlib import Path

import yaml

from twodiscs.model.checks import format_number
from twodiscs.model.effects import EFFECTS
from twodiscs.model.events import EVENTS, HOPS
from twodiscs_paper.catalogue import STUDIES

#: The documents that are built once, beside the studies.
DOCUMENTS = ("paper", "report")


@cache
def schema():
    """Return the schema of the configuration."""
    text = Path(__file__).with_name("schema.yaml").read_text(encoding="utf-8")
    schema = yaml.safe_load(text)
    definitions = schema["$defs"]
    _choice(definitions["event"], EVENTS)

    top = schema["properties"]
    studies = [study.name for study in STUDIES.values() if study.shared]
    once = (*studies, *DOCUMENTS)
    _choice(top["shared"]["items"], once)
    top["shared"]["allowed"] = f"a list of different names among {', '.join(once)}"
    plain = ", ".join(f"`{name}`" for name in studies if STUDIES[name].about_plain)
    text = top["shared"]["description"].replace("ABOUT_PLAIN", f"{plain} and `paper`")
    top["shared"]["description"] = text
    scene = top["scenes"]["items"]["properties"]
    _choice(scene["watch"]["properties"]["hop_histogram"]["properties"]["event"], HOPS)
    for name, effect in EFFECTS.items():
        properties = scene["box" if effect.of_box else "effects"]["properties"]
        properties[name] = _effect(effect) | properties.pop(name, {})
    scene["accuracy"]["properties"] |= dict.fromkeys(EVENTS, definitions["event_precision"])
    _fill(schema)
    return schema


def _choice(node, names):
    node.update(enum=list(names), allowed=f"one of {', '.join(names)}")


def _effect(effect):
    """Return the schema of one effect."""
    text = effect.meaning[0].upper() + effect.meaning[1:]
    node = {"description": " ".join(filter(None, (f"{text}.", effect.more)))}
    if effect.unit:
        node["unit"] = effect.unit
    if not effect.is_number:
        return node
    kind = "ratio" if effect.name.endswith("_ratio") else "length" if effect.of_box else "number"
    allowed = (
        f"a {kind} between {format_number(effect.low, 'g')} and {format_number(effect.high, 'g')}"
    )
    low = effect.low
    if effect.default is None:
        node["computed"] = "none"
    else:
        node["default"] = effect.default
        if effect.default < low:
            low, allowed = effect.default, f"{effect.default:g}, or {allowed}"
    return node | {"allowed": allowed, "type": "number", "minimum": low, "maximum": effect.high}


def _fill(node):
    """Fill in ``allowed`` of every block below a node that does not have it."""
    for key, child in node.get("properties", {}).items():
        _fill(child)
        if "allowed" not in child and "properties" in child:
            child["allowed"] = f"a block of the keys {', '.join(child['properties'])}"
        if "allowed" not in child:
            raise TypeError(f"schema.yaml must say what {key} may hold, as `allowed`")
    if "items" in node:
        _fill(node["items"])


def document():
    """Return the page config/README.md, in Markdown."""
    lines = [
        f"# {schema()['title']}",
        "",
        schema()["description"],
        "",
        "This page is made by `python docs/make/pages.py`.",
    ]
    lines += _section(schema(), "")
    return "\n".join(lines) + "\n"


def _section(node, path):
    lines = ["", f"## {f'`{path}`' if path else 'Top level'}", ""]
    lines += ["| key | meaning | may be | unit | default |", "|---|---|---|---|---|"]
    below = []
    for key, child in node["properties"].items():
        unit = child.get("unit", "–")
        default = child.get("computed") or _default(child, key in node.get("required", []))
        lines.append(
            f"| `{key}` | {child['description']} | {child['allowed']} | {unit} | {default} |"
        )
        key_path = f"{path}.{key}".lstrip(".")
        for inner, suffix in ((child, ""), (child.get("items", {}), "[]")):
            if "properties" in inner:
                below += _section(inner, key_path + suffix)
    return lines + below


def _default(node, required):
    if required:
        return "none: the key is required"
    value = node["default"]
    if value == {}:
        return "the defaults of its keys"
    if isinstance(value, float) and value.is_integer():
        value = int(value)
    return f"`{str(value).lower() if isinstance(value, bool) else value}`"
