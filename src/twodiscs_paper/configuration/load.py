"""From a configuration file to a ``Configuration``, or to one sentence about a mistake.

The Snakefile imports this, so it must be quick: only effects need a numerical package.
"""

import math
import re
import sys
from collections.abc import Mapping
from copy import deepcopy
from difflib import get_close_matches
from pathlib import Path

import yaml

from twodiscs.model import checks
from twodiscs.model.box import Box
from twodiscs.model.checks import PRESETS, InputError, decimal_hint, format_number
from twodiscs.model.events import EVENTS, HOPS
from twodiscs.model.radii import even_radii, radii
from twodiscs.theory.exact import events_per_interval, free_fraction, least_free_fraction
from twodiscs_paper.catalogue import STUDIES
from twodiscs_paper.configuration.request import Configuration, Quantities, SceneRequest
from twodiscs_paper.configuration.schema import schema

#: Radii of the default hop histograms, over the radius at which the hop becomes blocked.
HISTOGRAM_FRACTIONS = (0.1, 0.3, 0.5, 0.7)

#: Radius of the default trajectory over the shorter side: both hops are open, one hop is rare.
TRAJECTORY_FRACTION = 0.24

#: The radius of the default trajectory of a scene with effects, over the radius at which the first
#: hop becomes blocked. In a field this hop is rare far below that radius.
BELOW_THRESHOLD = 0.5

#: The default grid of a scene with effects ends at this fraction of its largest radius.
LAST_FRACTION = 0.9

#: The range of sides that the study of stability can take: lengths end at 1e-60 and 1e60.
LOW, HIGH = 1e-40, 1e40

#: The fewest intervals of a hop that are recorded.
LEAST_INTERVALS = 2**16

_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")

#: Limits far above any configuration: bytes of a file, letters of one value, blocks within blocks,
#: and values with every alias written out.
BYTES, LETTERS, DEPTH, VALUES = 1_000_000, 1000, 32, 50_000

#: The tags of numbers in YAML, and the form of a decimal number. YAML 1.1 also has octal, binary
#: and sexagesimal numbers: 010 is 8 and 1:30 is 90.
NUMBERS = {f"tag:yaml.org,2002:{kind}" for kind in ("int", "float")}
PLAIN = re.compile(
    r"[-+]?(0|[1-9]\d*|\d*\.\d+|\d+\.\d*)([eE][-+]?\d+)?|[-+]?\.(inf|nan)", re.IGNORECASE
)


class ConfigError(InputError):
    """Mistakes in a configuration, one sentence and one line for each."""


def read(path):
    """Return the mapping in the YAML file ``path``.

    Raises ``ConfigError`` with file and line if the text is no YAML, or if a key is given twice,
    because YAML would silently take the last value. The same error names a file that cannot be
    read, exceeds the limits of this module, or holds no mapping.
    """
    try:
        with open(path, "rb") as file:
            content = file.read(BYTES + 1)
    except OSError as error:
        raise ConfigError(f"{path}: {error.strerror}") from None
    if len(content) > BYTES:
        raise ConfigError(f"{path} must be a file of at most {BYTES} bytes")
    try:
        mapping = yaml.load(content.decode(), _StrictLoader)
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        byte = content[error.start]
        raise ConfigError(f"{path}, line {line}: must be UTF-8, not the byte {byte:#x}") from None
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        raise ConfigError(f"{path}, line {mark.line + 1}: {error.problem}") from None
    except (yaml.YAMLError, ArithmeticError, ValueError) as error:
        raise ConfigError(f"{path}: {' '.join(str(error).split())}") from None
    if not isinstance(mapping, dict):
        raise ConfigError(f"{path}: must hold {schema()['allowed']}, not {describe(mapping)}")
    return mapping


def or_exit(function, *arguments):
    """Return ``function(*arguments)``, or end the program with the sentence of a mistake."""
    try:
        return function(*arguments)
    except ConfigError as error:
        sys.exit("\n".join(f"Configuration: {sentence}" for sentence in str(error).split("\n")))


def describe(value):
    """Return a short text of a ``value`` for a sentence."""
    return "empty" if value is None else checks.quote(value)


def _step(index):
    """Return the part of a path that stands for ``index``: a key, or a number in a list."""
    if isinstance(index, yaml.ScalarNode):
        return f".{index.value}"
    return "" if index is None else f"[{index}]"


def _mistake(problem, node):
    return yaml.MarkedYAMLError(problem=problem, problem_mark=node.start_mark)


class _StrictLoader(yaml.SafeLoader):
    """The usual YAML, within limits; a key given twice is a mistake."""

    def __init__(self, stream):
        super().__init__(stream)
        self.path, self.names, self.sizes, self.total = [], [], {}, 0

    def compose_node(self, parent, index):
        # Values are counted as they are composed: an alias counts as much as its anchor.
        if len(self.path) > DEPTH:
            raise _mistake(f"there must be at most {DEPTH} blocks within blocks", parent)
        if self.check_event(yaml.AliasEvent):
            node = super().compose_node(parent, index)
            if node not in self.sizes:
                raise _mistake("an alias must not stand within its own anchor", node)
        else:
            self.path.append(0)
            self.names.append(_step(index))
            node = super().compose_node(parent, index)
            self.names.pop()
            self.sizes[node] = self.path.pop() + 1
        if isinstance(node, yaml.ScalarNode) and len(node.value) > LETTERS:
            raise _mistake(f"a value must have at most {LETTERS} letters", node)
        if node.tag in NUMBERS and not PLAIN.fullmatch(node.value):
            where = "".join([*self.names, _step(index)]).lstrip(".") or "the file"
            asked = f"{where} must be a decimal number, or text in quotes, not {node.value:.40}"
            raise _mistake(f"{asked}: YAML reads {self.construct_object(node)!r}", node)
        if self.path:
            self.path[-1] += self.sizes[node]
        self.total += 1
        if max(self.total, self.sizes[node]) > VALUES:
            raise _mistake(f"there must be at most {VALUES} values, aliases written out", node)
        return node

    def compose_mapping_node(self, anchor):
        node = super().compose_mapping_node(anchor)
        keys = set()
        for key, _ in node.value:
            if isinstance(key, yaml.ScalarNode):
                if key.value in keys:
                    raise _mistake(f"the key {key.value!r} is given a second time", key)
                keys.add(key.value)
        return node

    def construct_object(self, node, deep=False):
        try:
            return super().construct_object(node, deep)
        except yaml.YAMLError:
            raise
        except Exception as error:  # of many kinds, from int(), float() and datetime
            raise _mistake(f"{node.value!r:.40} cannot be read: {error}", node) from None


def load(mapping):
    """Return the ``Configuration`` of a mapping, as YAML gives it.

    Numbers may be text such as "2e9", which YAML does not take for a number. Raises ``ConfigError``
    with one sentence that names the key, the allowed values, the given value and the scene. If
    there are several mistakes, each has a line.
    """
    try:
        return _load(mapping)
    except ConfigError as error:
        sentences = (_with_scene(sentence, mapping) for sentence in str(error).split("\n"))
        raise ConfigError(*sentences) from None


def _with_scene(sentence, mapping):
    """Return a ``sentence`` on a mistake with the name of its scene, if it is in one."""
    match = re.match(r"scenes\[(\d+)\](?!\.name)", sentence)
    block = mapping["scenes"][int(match[1])] if match else None
    name = block.get("name") if isinstance(block, Mapping) else None
    return f"{sentence} (scene {describe(name)})" if name else sentence


def check_results(results, home):
    """Raise ``ConfigError`` unless ``results`` may be a folder beside the sources at ``home``."""
    node, path = schema()["properties"]["results"], Path(results).resolve()
    home = Path(home).resolve()
    inside = path.is_relative_to(home)
    a_file = any(folder.exists() and not folder.is_dir() for folder in (path, *path.parents))
    if a_file or (inside and not re.match(node["pattern"], path.relative_to(home).as_posix())):
        raise ConfigError(f"results must be {node['allowed']}, not {results!r}")


def _load(mapping):
    if not isinstance(mapping, Mapping):
        raise ConfigError(
            f"the configuration must be {schema()['allowed']}, not {describe(mapping)}"
        )
    settled = _settled(mapping, schema(), "")
    _validate(settled)
    _fill_defaults(settled, schema())
    common = {name: settled[name] for name in ("seed", "shard_events")}
    scenes = tuple(
        _scene(block, f"scenes[{i}]", common) for i, block in enumerate(settled["scenes"])
    )
    names = [scene.name for scene in scenes]
    for i, name in enumerate(names):
        if name in names[:i]:
            raise ConfigError(
                f"scenes[{i}].name must differ from every other scene's, not {name!r}"
            )
    shared = _shared(settled["shared"], all(scene.effects for scene in scenes))
    configuration = Configuration(
        settled["results"], settled["seed"], shared, scenes, settled["accuracy_cost"]
    )
    main = configuration.main
    if "stability" in shared and not all(LOW <= side <= HIGH for side in main.box.sides):
        raise ConfigError(
            f"shared must leave out 'stability' unless the sides of the scene {main.name!r} "
            f"lie between {format_number(LOW, 'g')} and {format_number(HIGH, 'g')}, because it "
            "uses much smaller radii"
        )
    return configuration


def _settled(value, node, path):
    """Return a copy of ``value``, each number a float, or an int if the schema asks for one."""
    if isinstance(value, Mapping):
        known = node.get("properties", {})
        return {k: _settled(v, known.get(k, {}), f"{path}.{k}") for k, v in value.items()}
    if isinstance(value, list | tuple):
        items = node.get("items", {})
        return [_settled(v, items, f"{path}[{i}]") for i, v in enumerate(value)]
    types = node.get("type", [])
    types = {types} if isinstance(types, str) else {*types}
    if isinstance(value, bool) or not {"number", "integer"} & types:
        return value
    if isinstance(value, str) and _NUMBER.fullmatch(value):
        value = float(value) if re.search(r"[.eE]", value) else int(value)
    if isinstance(value, float) and math.isnan(value):
        # A comparison with NaN is never true, so no limit of the schema would catch it.
        raise ConfigError(f"{path.lstrip('.')} must be {node['allowed']}, not nan")
    if "integer" in types:
        return int(value) if isinstance(value, float) and value.is_integer() else value
    try:
        return float(value) if isinstance(value, int) else value
    except OverflowError:
        return value


def _validate(settled):
    from jsonschema import Draft202012Validator

    errors = list(Draft202012Validator(schema()).iter_errors(settled))
    # A misspelt key often explains a missing one, so it goes first.
    errors.sort(key=lambda error: error.validator != "additionalProperties")
    # Only the first mistake of each block or value is reported: others may follow from it.
    first = {tuple(error.absolute_path): error for error in reversed(errors)}
    if first:
        raise ConfigError(*map(_sentence, reversed(first.values())))


def _sentence(error):
    steps = (f"[{step}]" if isinstance(step, int) else f".{step}" for step in error.absolute_path)
    path = "".join(steps).lstrip(".") or "the configuration"
    node, value = error.schema, error.instance
    if error.validator == "required":
        missing = next(key for key in error.validator_value if key not in value)
        return f"{path} needs the key {missing!r}"
    if error.validator == "additionalProperties":
        known = list(node["properties"])
        unknown = next(key for key in value if key not in known)
        homes = [home for key, home in _keys(schema(), "the configuration") if key == unknown]
        if homes:
            hint = f"; it belongs in {homes[0]}"
        elif value[unknown] is None and not isinstance(unknown, str):  # of {width: 1,5}
            hint = "; decimals have a point"
        else:
            free = [key for key in known if key not in value]
            hint = _nearest(unknown, free) or f"; its keys are {', '.join(known)}"
        return f"{path} has an unknown key {describe(unknown)}{hint}"
    hint = _nearest(value, node.get("enum", ())) or decimal_hint(value)
    return f"{path} must be {node['allowed']}, not {describe(value)}{hint}"


def _keys(node, home):
    """Yield (key, the block that it belongs in) for every key beneath a node of the schema."""
    for key, child in node.get("properties", {}).items():
        yield key, home
        yield from _keys(child, repr(key))
    if "items" in node:
        yield from _keys(node["items"], "a scene")


def _nearest(word, known):
    near = get_close_matches(str(word)[:100], known, n=1)
    return f"; did you mean {near[0]!r}?" if near else ""


def _fill_defaults(value, node):
    if isinstance(value, dict):
        for key, below in node.get("properties", {}).items():
            if "default" in below:
                value.setdefault(key, deepcopy(below["default"]))
            if key in value:
                _fill_defaults(value[key], below)
    elif isinstance(value, list):
        for item in value:
            _fill_defaults(item, node.get("items", {}))


def _scene(block, path, common):
    box = _box(block, path)
    radii = _radii(block["radii"], box, f"{path}.radii")
    scene = box.scene(radii[0])
    wanted, many = block["watch"], "discs" in box.calls_for
    if isinstance(wanted, bool):
        wanted = dict.fromkeys(Quantities.__dataclass_fields__, wanted)
        wanted["trajectory"] &= bool(_hops(scene))
        wanted["hop_histogram"] &= bool(_hops(scene)) and _is_ergodic(scene) and not many
    histogram = _histogram(wanted["hop_histogram"], box, scene, f"{path}.watch.hop_histogram")
    quantities = Quantities(
        volume=wanted["volume"],
        areas=_events(wanted["areas"], scene, f"{path}.watch.areas"),
        mean_times=_events(wanted["mean_times"], scene, f"{path}.watch.mean_times"),
        hop_histogram=histogram.pop("radii"),
        trajectory=_trajectory(wanted["trajectory"], box, scene, f"{path}.watch.trajectory"),
    )
    if not quantities.names:
        known = ", ".join(Quantities.__dataclass_fields__)
        raise ConfigError(f"{path}.watch must ask for at least one of {known}, not for nothing")
    if quantities.mean_times:
        try:
            box.scene(radii[-1]).require_followable()
        except InputError as error:
            raise ConfigError(f"{path}.radii: {error}") from None
    for radius in () if many else quantities.hop_histogram:
        events = events_per_interval(box.scene(radius), histogram["event"])
        if events * LEAST_INTERVALS > histogram["event_budget"]:
            raise ConfigError(
                f"{path}.watch.hop_histogram must keep to radii at which {LEAST_INTERVALS} "
                f"intervals fit into its event_budget, "
                f"{format_number(histogram['event_budget'], 'g')}; at {radius!r} each one takes "
                f"{events:.2g} events"
            )
    accuracy = block["accuracy"]
    if not isinstance(accuracy, dict):
        accuracy = {"default": accuracy}
    asked = {event: accuracy.get(event, accuracy["default"]) for event in quantities.mean_times}
    return SceneRequest(
        name=block["name"],
        box=box,
        radii=radii,
        quantities=quantities,
        monte_carlo=block["monte_carlo"],
        dynamics={
            "accuracy": {event: PRESETS.get(asked[event], asked[event]) for event in sorted(asked)},
            "event_budget": block["event_budget"],
        },
        histogram=histogram,
        **common,
    )


def _box(block, path):
    """Return the ``Box`` of a scene, or raise ``ConfigError`` if its effects exclude each other."""
    try:
        return Box.configured(block["box"], block["effects"], block["discs"])
    except InputError as error:
        raise ConfigError(f"{path}.effects: {error}") from None


def _radii(asked, box, path):
    if isinstance(asked, list):
        return _checked(asked, box, path)
    usual = _short(box.shortest / max(1, box.effects.get("radius_ratio", 1)) / 100)
    smallest = asked.get("smallest", usual)
    _checked([smallest], box, f"{path}.smallest")
    include = _checked(asked.get("include", []), box, f"{path}.include")
    try:
        if not box.is_plain:
            generated = even_radii(smallest, LAST_FRACTION * box.last_radius, asked["count"])
        else:
            generated = radii(box.width, box.height, smallest, asked["count"])
    except InputError as error:
        raise ConfigError(f"{path}: {error}") from None
    return _checked(tuple({*generated, *include}), box, path)


def _hops(scene):
    return [hop for hop in HOPS if hop in scene.events]


def _is_ergodic(scene):
    return scene.moment_of_inertia is None or scene.friction > 0


def _histogram(asked, box, scene, path):
    """Return the histogram's block with its radii (a tuple, empty if it is off) and event."""
    if isinstance(asked, bool):
        asked = {} if asked else {"radii": []}
    elif isinstance(asked, list):
        asked = {"radii": asked}
    keys = schema()["properties"]["scenes"]["items"]["properties"]["watch"]["properties"]
    _fill_defaults(asked, keys["hop_histogram"])
    hops = _hops(scene)
    event = asked.get("event", next(iter(hops), None))
    if asked.get("radii") == []:
        return {**asked, "radii": (), "event": event}
    if not _is_ergodic(scene):
        raise ConfigError(
            f"{path} must be false, because rough discs in a box are not ergodic and their "
            "intervals have no exact mean; watch mean_times instead"
        )
    if not hops:
        raise ConfigError(f"{path} must be false, because on these periodic axes discs cannot hop")
    if event not in hops:
        raise ConfigError(
            f"{path}.event must be a hop of this scene, such as {hops[0]}, not {event!r}"
        )
    threshold = box.threshold(event)
    default = [_short(fraction * threshold) for fraction in HISTOGRAM_FRACTIONS]
    radii = _checked(asked.get("radii", default), box, path)
    for radius in radii:
        if not box.scene(radius).is_possible(event):
            raise ConfigError(
                f"{path} must keep to radii below {threshold!r}, where {event} is possible, "
                f"not {radius!r}"
            )
    return {**asked, "radii": radii, "event": event}


def _trajectory(asked, box, scene, path):
    if asked is False:
        return None
    if not _hops(scene):
        raise ConfigError(f"{path} must be false, because on these periodic axes discs cannot hop")
    if asked is not True:
        radius = asked
    elif not box.is_plain:
        radius = _short(BELOW_THRESHOLD * min(map(box.threshold, _hops(scene))))
    else:
        radius = _short(TRAJECTORY_FRACTION * box.shortest)
    return _checked([radius], box, path)[0]


def _events(asked, scene, path):
    """Return the requested events in the order of ``EVENTS``, if the scene has all of them."""
    if isinstance(asked, bool):
        return scene.events if asked else ()
    for event in asked:
        if event not in scene.events:
            raise ConfigError(
                f"{path} must hold events of this scene, {', '.join(scene.events)}, not {event!r}"
            )
    return tuple(event for event in EVENTS if event in asked)


def _checked(radii, box, path):
    """Return radii as an ascending tuple if all of them fit and none appears twice."""
    found = set()
    for radius in radii:
        try:
            scene = box.scene(radius)
        except InputError as error:
            raise ConfigError(f"{path}: {error}") from None
        least = least_free_fraction(scene)
        if least and (share := free_fraction(scene)) < least:
            raise ConfigError(
                f"{path}: with {_effects_of(box)}, radius {radius!r} leaves the discs "
                f"{share:.1g} of all positions, and at least {least:g} is needed"
            )
        if radius in found:
            raise ConfigError(f"{path} must hold every radius once, but holds {radius!r} twice")
        found.add(radius)
    return tuple(sorted(radii))


def _effects_of(box):
    return ", ".join(f"{name} {value}" for name, value in box.effects.items())


def _shared(asked, all_have_effects):
    """Return the names of ``shared`` with all that the manuscript reads, in the schema's order."""
    known = schema()["properties"]["shared"]["items"]["enum"]
    studies = [study.name for study in STUDIES.values() if study.shared]
    about_plain = {name for name in studies if STUDIES[name].about_plain} | {"paper"}
    for name in asked:
        if all_have_effects and name in about_plain:
            raise ConfigError(
                f"shared must leave out {name!r} if every scene has effects, because it is about "
                "a scene without effects"
            )
    wanted = {*asked, *(studies if "paper" in asked else ())}
    return tuple(name for name in known if name in wanted)


def _short(value):
    return float(f"{value:.3g}")
