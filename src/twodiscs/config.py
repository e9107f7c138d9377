"""From the configuration file to the scenes: what to compute, how accurately, with which seeds.

Quick to import, for the Snakefile reads it: no numerical package but for effects. What a file may
say, its units and its defaults stand in ``config.schema.yaml`` and nowhere else; ``python -m
twodiscs.config`` prints that as the page config/README.md.
"""

import math
import re
import reprlib
from collections.abc import Mapping
from copy import deepcopy
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cache, partial
from pathlib import Path

import yaml

from twodiscs import grid, parameters
from twodiscs.scene import EFFECTS, EVENTS, HOPS, largest_radius

#: Relative standard errors of the mean times, by name.
PRESETS = {"draft": 1e-2, "paper": 3e-4, "reference": 1e-4}

#: Radii of the default hop histograms, over the radius at which the hop becomes blocked.
HISTOGRAM_FRACTIONS = (0.1, 0.3, 0.5, 0.7)

#: Radius of the default trajectory over the shorter side: both hops are open, one of them is rare.
TRAJECTORY_FRACTION = 0.24

#: The same for a scene with effects, over the radius at which the first hop becomes blocked: in a
#: field it is rare long before.
BELOW_THRESHOLD = 0.5

#: The default grid of a scene with effects ends at this fraction of its largest radius.
LAST_FRACTION = 0.9

#: The least share of the prism, in which both centres keep to their ranges, that must be free of
#: overlaps in a scene with effects: starts are drawn from the prism by rejection.
LEAST_SHARE = 1e-4

#: What is built once and is about the first scene without effects, and what the manuscript reads.
ABOUT_PLAIN = ("errata", "stability", "tails", "distributions", "thresholds", "paper")
READ_BY_PAPER = (
    *("errata", "accuracy_cost", "stability", "tails", "distributions", "thresholds"),
    "effects",
)

_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")


class ConfigError(ValueError):
    """A mistake in a configuration, told in one sentence."""


@dataclass(frozen=True)
class Watch:
    """What a scene computes and measures; an empty tuple, ``False`` or ``None`` means not at all.

    ``areas`` and ``mean_times`` hold events in the order of ``EVENTS``, ``hop_histogram`` ascending
    radii, ``trajectory`` a radius.
    """

    volume: bool
    areas: tuple
    mean_times: tuple
    hop_histogram: tuple
    trajectory: float | None

    @property
    def quantities(self):
        """Everything watched, as a set of names: those of theory.csv, and the two others.

        Such as {"volume", "right_wall_area", "right_wall_time", "hop_histogram", "trajectory"}.
        """
        names = {f"{event}_area" for event in self.areas}
        names |= {f"{event}_time" for event in self.mean_times}
        names |= {n for n in ("volume", "hop_histogram", "trajectory") if getattr(self, n)}
        return frozenset(names)


@dataclass(frozen=True)
class SceneRequest:
    """One scene of the configuration, checked and with every default filled in.

    ``effects`` are those of the ``Scene``, {name: value}, without those that are absent; ``radii``
    ascend, and ``accuracy`` is {event: relative standard error} for the watched mean times. Each
    ``…_parameters`` method returns what one job depends on and nothing else, as a dict of plain
    Python values with sorted keys, so that an edit reruns the jobs it concerns and no other; with
    effects they have an entry of that name besides. A job for one radius is named by its key; the
    jobs that exist are ``monte_carlo_keys``, ``dynamics_keys`` and ``intervals_keys``.
    """

    name: str
    width: float
    height: float
    effects: dict
    radii: tuple
    watch: Watch
    accuracy: dict
    event_budget: int
    monte_carlo_samples: int
    shell_fraction: float
    histogram_event: str
    histogram_samples: int
    seed: int

    @property
    def keys(self):
        """The text keys of ``radii``."""
        return tuple(map(grid.key, self.radii))

    @property
    def monte_carlo_keys(self):
        """Keys of the radii at which volume or areas are sampled; empty if neither is watched."""
        return self.keys if self.watch.volume or self.watch.areas else ()

    @property
    def dynamics_keys(self):
        """Keys of the radii at which mean times are simulated; empty if none is watched."""
        return self.keys if self.watch.mean_times else ()

    @property
    def intervals_keys(self):
        """Keys of the radii of the hop histograms."""
        return tuple(map(grid.key, self.watch.hop_histogram))

    def scene(self, radius):
        """Return the ``Scene`` at a ``radius``; raise ``ValueError`` where there is none."""
        return parameters.scene(self.box_parameters(), radius)

    def box_parameters(self):
        """Return height, width."""
        return self._sorted()

    def scene_parameters(self):
        """Return the box and the scene's radii: height, radii, width."""
        return self._sorted(radii=list(self.radii))

    def theory_parameters(self):
        """Return height, radii (the scene's and those of its hop histograms), width."""
        return self._sorted(radii=sorted({*self.radii, *self.watch.hop_histogram}))

    def monte_carlo_parameters(self, key):
        """Return areas, height, radius, samples, seed, shell, volume, width.

        ``areas`` lists events and ``volume`` is a bool; ``shell`` is None where no area is watched.
        """
        return self._sorted(
            areas=list(self.watch.areas),
            radius=self._radius(key, self.monte_carlo_keys),
            samples=self.monte_carlo_samples,
            seed=grid.stream_seed(self.seed, self.name, "monte_carlo", key),
            shell=self.shell_fraction if self.watch.areas else None,
            volume=self.watch.volume,
        )

    def dynamics_parameters(self, key):
        """Return accuracy, event_budget, height, radius, seed, width.

        ``accuracy`` is {event: relative standard error}, and its events are those to watch.
        """
        return self._sorted(
            accuracy=dict(sorted(self.accuracy.items())),
            event_budget=self.event_budget,
            radius=self._radius(key, self.dynamics_keys),
            seed=grid.stream_seed(self.seed, self.name, "dynamics", key),
        )

    def intervals_parameters(self, key):
        """Return event (the hop), height, intervals (their number), radius, seed, width."""
        return self._sorted(
            event=self.histogram_event,
            intervals=self.histogram_samples,
            radius=self._radius(key, self.intervals_keys),
            seed=grid.stream_seed(self.seed, self.name, "intervals", key),
        )

    def trajectory_parameters(self):
        """Return height, radius, seed, width; raise ``ValueError`` if no trajectory is watched."""
        radius = self.watch.trajectory
        if radius is None:
            raise ValueError(f"scene {self.name} watches no trajectory")
        return self._sorted(
            radius=radius,
            seed=grid.stream_seed(self.seed, self.name, "trajectory", grid.key(radius)),
        )

    def kernels_parameters(self, method):
        """Return what the kernels of a ``method`` depend on, as all of its jobs do too.

        That is height, width and for monte_carlo areas and volume, for dynamics mean_times, for
        intervals event.
        """
        watched = {
            "monte_carlo": {"areas": list(self.watch.areas), "volume": self.watch.volume},
            "dynamics": {"mean_times": list(self.watch.mean_times)},
            "intervals": {"event": self.histogram_event},
        }
        return self._sorted(**watched[method])

    def _sorted(self, **more):
        box = {"height": self.height, "width": self.width}
        return dict(sorted((box | parameters.described(self.effects) | more).items()))

    def _radius(self, key, keys):
        if key not in keys:
            raise ValueError(f"key must be one of {', '.join(keys) or 'none'}, not {key!r}")
        return float(key)


@dataclass(frozen=True)
class Configuration:
    """A whole configuration: the folder of results, the root seed and the scenes in their order.

    ``accuracy_cost_seconds`` is the processor time for the comparison of methods, and ``shared``
    names what is built once, in the order of the schema, with all that the manuscript reads.
    """

    results: str
    seed: int
    accuracy_cost_seconds: float
    shared: tuple
    scenes: tuple

    @property
    def main(self):
        """The first scene without effects, or None."""
        return next((scene for scene in self.scenes if not scene.effects), None)

    def scene(self, name):
        """Return the scene called ``name``, or raise ``ValueError``."""
        for scene in self.scenes:
            if scene.name == name:
                return scene
        names = ", ".join(scene.name for scene in self.scenes)
        raise ValueError(f"name must be one of {names}, not {name!r}")


def load(mapping):
    """Return the ``Configuration`` that a mapping, as YAML gives it, asks for.

    Numbers may be text such as "2e9", which YAML does not take for a number. Raises ``ConfigError``
    with one sentence that names the key, what it may hold and what it holds.
    """
    if not isinstance(mapping, Mapping):
        raise ConfigError(f"the configuration must be {schema()['allowed']}, not {_shown(mapping)}")
    settled = _settled(mapping, schema(), "")
    _validate(settled)
    _fill_defaults(settled, schema())
    scenes = tuple(
        _scene(block, f"scenes[{i}]", settled["seed"]) for i, block in enumerate(settled["scenes"])
    )
    names = [scene.name for scene in scenes]
    for i, name in enumerate(names):
        if name in names[:i]:
            raise ConfigError(
                f"scenes[{i}].name must differ from every other scene's, not {name!r}"
            )
    seconds = settled["accuracy_cost"]["seconds"]
    shared = _shared(settled.get("shared"), all(scene.effects for scene in scenes))
    return Configuration(settled["results"], settled["seed"], seconds, shared, scenes)


def read(path):
    """Return the mapping in the YAML file ``path``.

    Raises ``ConfigError`` where YAML itself would keep silent about a key given twice (the last one
    would win), and for a file that holds no mapping; ``OSError`` for one that cannot be read.
    """
    with open(path, encoding="utf-8") as file:
        try:
            mapping = yaml.load(file, _StrictLoader)
        except yaml.MarkedYAMLError as error:
            line = error.problem_mark.line + 1
            raise ConfigError(f"{path}, line {line}: {error.problem}") from None
        except (yaml.YAMLError, UnicodeDecodeError) as error:
            raise ConfigError(f"{path}: {' '.join(str(error).split())}") from None
    if not isinstance(mapping, dict):
        raise ConfigError(f"{path}: must hold {schema()['allowed']}, not {_shown(mapping)}")
    return mapping


class _StrictLoader(yaml.SafeLoader):
    """YAML as usual, but a key given twice is a mistake."""

    def compose_mapping_node(self, anchor):
        node = super().compose_mapping_node(anchor)
        seen = set()
        for key, _ in node.value:
            if isinstance(key, yaml.ScalarNode):
                if key.value in seen:
                    problem = f"the key {key.value!r} is given a second time"
                    raise yaml.MarkedYAMLError(problem=problem, problem_mark=key.start_mark)
                seen.add(key.value)
        return node


@cache
def schema():
    """Return the schema of the configuration."""
    text = Path(__file__).with_name("config.schema.yaml").read_text(encoding="utf-8")
    return yaml.safe_load(text)


def _types(node):
    types = node.get("type", [])
    return [types] if isinstance(types, str) else types


def _settled(value, node, path):
    """Copy ``value`` with every number in one form: float, or int where an integer is asked."""
    if isinstance(value, Mapping):
        known = node.get("properties", {})
        return {k: _settled(v, known.get(k, {}), f"{path}.{k}") for k, v in value.items()}
    if isinstance(value, list | tuple):
        items = node.get("items", {})
        return [_settled(v, items, f"{path}[{i}]") for i, v in enumerate(value)]
    types = _types(node)
    if isinstance(value, bool) or not {"number", "integer"} & set(types):
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
    if errors:
        raise ConfigError(_sentence(errors[0]))


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
        hint = _nearest(unknown, known) or f"; its keys are {', '.join(known)}"
        return f"{path} has an unknown key {unknown!r}{hint}"
    hint = _nearest(value, node.get("enum", ()))
    return f"{path} must be {node['allowed']}, not {_shown(value)}{hint}"


def _nearest(word, known):
    near = get_close_matches(str(word), known, n=1)
    return f"; did you mean {near[0]!r}?" if near else ""


def _shown(value):
    return "empty" if value is None else reprlib.repr(value)


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


def _scene(block, path, seed):
    place = _place(block, path)
    radii = _radii(block["radii"], place, f"{path}.radii")
    scene = parameters.scene(place, radii[0])
    watched = block.get("watch")
    if watched is None:
        watched = dict.fromkeys(Watch.__dataclass_fields__, True)
        watched["trajectory"] = bool(_hops(scene))
        watched["hop_histogram"] = bool(_hops(scene)) and _is_smooth(scene)
    histogram = _histogram(watched["hop_histogram"], place, scene, f"{path}.watch.hop_histogram")
    watch = Watch(
        volume=watched["volume"],
        areas=_events(watched["areas"], scene, f"{path}.watch.areas"),
        mean_times=_events(watched["mean_times"], scene, f"{path}.watch.mean_times"),
        hop_histogram=histogram["radii"],
        trajectory=_trajectory(watched["trajectory"], place, scene, f"{path}.watch.trajectory"),
    )
    if not watch.quantities:
        known = ", ".join(Watch.__dataclass_fields__)
        raise ConfigError(f"{path}.watch must ask for at least one of {known}, not for nothing")
    accuracy = block["accuracy"]
    if not isinstance(accuracy, dict):
        accuracy = {"default": accuracy}
    precisions = {event: accuracy.get(event, accuracy["default"]) for event in watch.mean_times}
    return SceneRequest(
        name=block["name"],
        width=place["width"],
        height=place["height"],
        effects=place.get("effects", {}),
        radii=radii,
        watch=watch,
        accuracy={event: PRESETS.get(value, value) for event, value in precisions.items()},
        event_budget=block["event_budget"],
        monte_carlo_samples=block["monte_carlo"]["samples"],
        shell_fraction=block["monte_carlo"]["shell"],
        histogram_event=histogram["event"],
        histogram_samples=histogram["intervals"],
        seed=seed,
    )


def _place(block, path):
    """Return the parameters of a scene's box and effects, which are checked to go together."""
    box, named = dict(block["box"]), dict(block["effects"])
    named["periodic"] = "".join(sorted(named["periodic"]))
    if "depth" in box:
        named["depth"] = box.pop("depth")
    named = {name: value for name, value in named.items() if value != EFFECTS[name]}
    place = box | parameters.described(named)
    if named:
        tiny = 1e-6 * min(_sides(place)) / max(1, named.get("radius_ratio", 1))
        try:
            parameters.scene(place, tiny)
        except ValueError as error:
            raise ConfigError(f"{path}.effects: {error}") from None
    return place


def _sides(place):
    effects = place.get("effects", {})
    return [place["width"], place["height"], *(effects[n] for n in ("depth",) if n in effects)]


def _end(place, holds=lambda scene: True):
    """Return the radius from which on there is no scene with effects or it no longer ``holds``."""
    return grid.end(partial(parameters.scene, place), min(_sides(place)) / 2, holds)


def _radii(asked, place, path):
    if isinstance(asked, list):
        return _checked(asked, place, path)
    smallest = asked.get("smallest", _smallest(place))
    _checked([smallest], place, f"{path}.smallest")
    include = _checked(asked.get("include", []), place, f"{path}.include")
    try:
        if "effects" in place:
            generated = grid.even_radii(smallest, LAST_FRACTION * _end(place), asked["count"])
        else:
            generated = grid.radii(place["width"], place["height"], smallest, asked["count"])
    except ValueError as error:
        raise ConfigError(f"{path}: {error}") from None
    return _checked(tuple({*generated, *include}), place, path)


def _smallest(place):
    ratio = place.get("effects", {}).get("radius_ratio", 1)
    return _short(min(_sides(place)) / max(1, ratio) / 100)


def _hops(scene):
    return [hop for hop in HOPS if hop in scene.events]


def _is_smooth(scene):
    return scene.moment_of_inertia is None


def _histogram(asked, place, scene, path):
    """Return the histogram's radii (a tuple, empty if it is off), event and number of intervals."""
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
    if not _is_smooth(scene):
        raise ConfigError(
            f"{path} must be false, for rough discs in a box are not ergodic and their intervals "
            "have no exact mean; watch mean_times instead"
        )
    if not hops:
        raise ConfigError(f"{path} must be false, for on periodic axes hops have no place")
    if event not in hops:
        raise ConfigError(
            f"{path}.event must have a place in the scene, as {hops[0]} has, not {event!r}"
        )
    threshold = _threshold(place, event)
    default = [_short(fraction * threshold) for fraction in HISTOGRAM_FRACTIONS]
    radii = _checked(asked.get("radii", default), place, path)
    for radius in radii:
        if not parameters.scene(place, radius).is_possible(event):
            raise ConfigError(
                f"{path} must keep to radii below {threshold!r}, where {event} is possible, "
                f"not {radius!r}"
            )
    return {**asked, "radii": radii, "event": event}


def _threshold(place, hop):
    """Return the radius at which a hop becomes blocked, or the discs jam before."""
    if "effects" in place:
        return _end(place, lambda scene: scene.is_possible(hop))
    box = place["width"], place["height"]
    return min(box[0 if hop == "vertical_hop" else 1] / 4, largest_radius(*box))


def _trajectory(asked, place, scene, path):
    if asked is False:
        return None
    if not _hops(scene):
        raise ConfigError(f"{path} must be false, for on periodic axes hops have no place")
    if asked is not True:
        radius = asked
    elif "effects" in place:
        radius = _short(BELOW_THRESHOLD * min(_threshold(place, hop) for hop in _hops(scene)))
    else:
        radius = _short(TRAJECTORY_FRACTION * min(_sides(place)))
    return _checked([radius], place, path)[0]


def _events(asked, scene, path):
    """Return the events asked for in the order of ``EVENTS``, if all have a place in the scene."""
    if isinstance(asked, bool):
        return scene.events if asked else ()
    for event in asked:
        if event not in scene.events:
            raise ConfigError(
                f"{path} must keep to what has a place in the scene, {', '.join(scene.events)}, "
                f"not {event!r}"
            )
    return tuple(event for event in EVENTS if event in asked)


def _checked(radii, place, path):
    """Return ``radii`` as an ascending tuple if all of them fit and none appears twice."""
    for i, radius in enumerate(radii):
        try:
            scene = parameters.scene(place, radius)
        except ValueError as error:
            raise ConfigError(f"{path}: {error}") from None
        if scene.has_effects and (share := _free_share(scene)) < LEAST_SHARE:
            raise ConfigError(
                f"{path}: radius {radius!r} leaves the discs {share:.1g} of the prism of all "
                f"places, and a scene with effects needs more room, {LEAST_SHARE:g} of it"
            )
        if radius in radii[:i]:
            raise ConfigError(f"{path} must hold every radius once, but holds {radius!r} twice")
    return tuple(sorted(radii))


def _free_share(scene):
    """Return the share of the prism in which the discs are free, weighted in a field."""
    # Numerical packages are imported here, for nothing else needs them.
    from twodiscs import rates

    ranges = (
        scene.side(axis) - (0 if axis in scene.periodic else 2 * radius)
        for axis in scene.axes
        for radius in scene.radii
    )
    return rates.volume(scene) / math.prod(ranges)


def _shared(asked, all_have_effects):
    """Return the names of what is built once, in the order of the schema."""
    known = schema()["properties"]["shared"]["items"]["enum"]
    if asked is None:
        asked = [name for name in known if not (all_have_effects and name in ABOUT_PLAIN)]
    for name in asked:
        if all_have_effects and name in ABOUT_PLAIN:
            raise ConfigError(
                f"shared must leave out {name!r} where every scene has effects, for it is about a "
                "scene without them"
            )
    wanted = {*asked, *(READ_BY_PAPER if "paper" in asked else ())}
    return tuple(name for name in known if name in wanted)


def _short(value):
    return float(f"{value:.3g}")


def document():
    """Return the page config/README.md, in Markdown."""
    lines = [
        f"# {schema()['title']}",
        "",
        schema()["description"],
        "",
        "This page is made from `src/twodiscs/config.schema.yaml` by"
        " `python -m twodiscs.config > config/README.md`.",
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
        place = f"{path}.{key}".lstrip(".")
        for inner, suffix in ((child, ""), (child.get("items", {}), "[]")):
            if "properties" in inner:
                below += _section(inner, place + suffix)
    return lines + below


def _default(node, required):
    if required:
        return "none: the key is required"
    value = node["default"]
    if value == {}:
        return "the defaults of its keys"
    return f"`{str(value).lower() if isinstance(value, bool) else value}`"


if __name__ == "__main__":
    print(document(), end="")
