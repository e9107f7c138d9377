"""A sentence for each mistake in a configuration: the key, its value, and what is allowed."""

from collections.abc import Mapping
from dataclasses import dataclass

from twodiscs.model import checks
from twodiscs.model.checks import InputError
from twodiscs.model.formats import SYNONYMS, decimal_hint, did_you_mean
from twodiscs_paper.configuration.model import RESERVED_NAMES
from twodiscs_paper.configuration.schema import keys

#: Pydantic's errors about a key: it is unknown or no text, or it is missing.
UNKNOWN_KEY = ("extra_forbidden", "invalid_key")
ABOUT_KEY = (*UNKNOWN_KEY, "missing")


class ConfigError(InputError):
    """Mistakes in a configuration, one sentence and one line for each."""


def describe(value):
    """Return a short text of a ``value`` for a sentence."""
    return "empty" if value is None else checks.quote(value)


@dataclass(frozen=True)
class _Mistake:
    """An error of pydantic: the ``steps`` to its place, its node of the schema, and its value.

    If a ``key`` is unknown or missing, these are of the block.
    """

    kind: str
    steps: tuple
    key: object
    node: dict
    value: object

    @classmethod
    def of(cls, error, mapping):
        kind, location, key = error["type"], error["loc"], None
        if kind in ABOUT_KEY:
            *location, key = location
        if kind == "invalid_key":  # its place has the key as text
            key = error["input"]
        steps, node, value = [], keys(), mapping
        for step in location:
            known = node.get("properties", ()) if isinstance(value, Mapping) else ()
            if isinstance(value, list) and isinstance(step, int):
                node = node["items"]
            elif step in known and step in value:
                node = known[step]
            else:
                continue  # the name of a form that pydantic tried, such as a list
            steps.append(step)
            value = value[step]
        return cls(kind, tuple(steps), key, node, value)

    def follows_from(self, other):
        """Whether the mistake ``other`` explains this one.

        A value with several forms has an error of each form. Those of its items and keys say more.
        """
        if self.kind == "missing":  # maybe the unknown key is this one, misspelt
            return other.kind in UNKNOWN_KEY and other.steps == self.steps
        inside = other.steps[: len(self.steps)] == self.steps
        deeper = len(other.steps) > len(self.steps) or other.kind in ABOUT_KEY
        return self.kind not in ABOUT_KEY and inside and deeper

    def sentence(self):
        """Return the sentence, without the name of the scene."""
        steps = (f"[{step}]" if isinstance(step, int) else f".{step}" for step in self.steps)
        path = "".join(steps).lstrip(".") or "the configuration"
        if self.kind == "missing":
            return f"{path} needs the key {self.key!r}"
        if self.kind in UNKNOWN_KEY:
            return f"{path} has an unknown key {describe(self.key)}{self.hint_about_key()}"
        if self.steps[-1:] == ("name",) and self.value in RESERVED_NAMES:
            what = "the name of a target, a folder of results or a device of Windows"
            return f"{path} must not be {describe(self.value)}, {what}"
        near = did_you_mean(self.value, self.node.get("enum", ()))
        hint = near or decimal_hint(self.value)
        if isinstance(self.value, Mapping) and self.node.get("type") == "array":
            hint = "; a dash begins each item"
        return f"{path} must be {self.node['allowed']}, not {describe(self.value)}{hint}"

    def hint_about_key(self):
        """Return where an unknown key belongs, or which known key is near."""
        known, meant = list(self.node["properties"]), SYNONYMS.get(self.key, self.key)
        homes = [home for key, home in _homes(keys(), "the configuration") if key == meant]
        if homes and meant not in known:
            return f"; {'it' if meant == self.key else meant} belongs in {homes[0]}"
        if self.value[self.key] is None and not isinstance(self.key, str):  # of {width: 1,5}
            return "; decimals have a point"
        free = [key for key in known if key not in self.value]
        return did_you_mean(self.key, free) or f"; its keys are {', '.join(known)}"


def sentences(errors, mapping):
    """Yield a sentence for each of the ``errors`` that pydantic found in a ``mapping``."""
    found = [_Mistake.of(error, mapping) for error in errors]
    found.sort(key=lambda mistake: mistake.kind not in UNKNOWN_KEY)
    told = set()
    for mistake in found:
        place = mistake.steps, mistake.key
        if place not in told and not any(mistake.follows_from(other) for other in found):
            told.add(place)
            yield mistake.sentence() + scene_name(mapping, mistake.steps)


def scene_name(mapping, steps):
    """Return the name of the scene at ``steps`` in brackets, "" if it has no name."""
    if len(steps) < 2 or steps[0] != "scenes" or steps[2:] == ("name",):
        return ""
    scene = mapping["scenes"][steps[1]]
    name = scene.get("name") if isinstance(scene, Mapping) else None
    return f" (scene {describe(name)})" if name else ""


def _homes(node, home):
    """Yield (key, the block that it belongs in) for every key beneath a node of the schema."""
    for key, child in node.get("properties", {}).items():
        yield key, home
        yield from _homes(child, repr(key))
    if "items" in node:
        yield from _homes(node["items"], "a scene")
