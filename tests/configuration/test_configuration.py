"""The configuration: its requests, the parameters of each job, one sentence for each mistake."""

import math
import re
import subprocess
import sys
from copy import deepcopy
from itertools import pairwise
from pathlib import Path

import jsonschema
import pytest
import yaml
from snakemake.utils import update_config

from twodiscs.model import checks
from twodiscs.model.box import Box
from twodiscs.model.effects import EFFECTS
from twodiscs.model.events import AXIS, EVENTS, HOPS
from twodiscs.model.radii import stream_seed
from twodiscs.model.scene import Scene
from twodiscs_paper.catalogue import STUDIES
from twodiscs_paper.configuration import load, schema
from twodiscs_paper.configuration.load import read
from twodiscs_paper.configuration.request import STAGES, Quantities

ROOT = Path(__file__).resolve().parents[2]
PLAIN = {"scenes": [{"name": "one", "box": {"width": 1.5, "height": 1}}]}


def one(**keys):
    """The only scene of a configuration: a 1.5 × 1 box with these keys."""
    (request,) = load.load({"scenes": [PLAIN["scenes"][0] | keys]}).scenes
    return request


# Files of the repository


def test_the_default_configuration():
    configuration = load.load(read(ROOT / "config/config.yaml"))
    assert configuration.results == "results"
    assert [request.name for request in configuration.scenes] == ["paper", "long"]
    paper, long = configuration.scenes
    assert paper.box == Box(1.5, 1.0)
    assert len(paper.radii) >= 48
    assert paper.radii[0] == 0.01
    assert {0.05, 0.1, 0.2, 0.24, 0.3, 0.38} <= set(paper.radii)
    assert not {0.25, 0.375, paper.box.largest_radius} & set(paper.radii)
    assert paper.event_budget == 2 * 10**9
    assert paper.dynamics["accuracy"] == dict.fromkeys(EVENTS, 3e-4)
    assert long.box == Box(3.0, 1.0)
    assert len(long.radii) < 20
    assert configuration.scene("long") is long
    with pytest.raises(ValueError, match="name must be one of paper, long, not 'short'"):
        configuration.scene("short")


def test_the_draft_is_a_quick_look_at_the_same_scenes():
    # As --configfile does: the draft's lists replace, its blocks are merged.
    merged = read(ROOT / "config/config.yaml")
    update_config(merged, read(ROOT / "config/draft.yaml"))
    draft = load.load(merged)
    full = load.load(read(ROOT / "config/config.yaml"))
    assert draft.results == "results/draft"
    assert draft.seed == full.seed
    for quick, slow in zip(draft.scenes, full.scenes, strict=True):
        assert (quick.name, quick.box) == (slow.name, slow.box)
        assert quick.quantities.names == slow.quantities.names
        assert len(quick.radii) <= 10
        assert quick.dynamics["accuracy"] == dict.fromkeys(EVENTS, 1e-2)


# The schema


def keys_of(node, path=""):
    for name, child in node.get("properties", {}).items():
        yield f"{path}.{name}", child, name in node.get("required", [])
        yield from keys_of(child, f"{path}.{name}")
        yield from keys_of(child.get("items", {}), f"{path}.{name}[]")


@pytest.mark.parametrize(("path", "node", "required"), list(keys_of(schema.schema())))
def test_every_key_is_documented(path, node, required):
    assert node["description"].endswith(".")
    assert node["allowed"]
    assert required or "default" in node or "computed" in node
    if "number" in node.get("type", []) and 1 not in map(node.get, ("maximum", "exclusiveMaximum")):
        assert node["unit"]


def test_the_schema_is_one_and_agrees_with_the_code():
    jsonschema.Draft202012Validator.check_schema(schema.schema())
    definitions = schema.schema()["$defs"]
    assert tuple(definitions["events"]["items"]["enum"]) == EVENTS
    assert definitions["length"]["minimum"] == checks.SHORTEST
    assert definitions["length"]["maximum"] == checks.LONGEST
    properties = schema.schema()["properties"]["scenes"]["items"]["properties"]
    assert tuple(properties["accuracy"]["properties"]) == ("default", *EVENTS)
    assert tuple(properties["watch"]["properties"]) == tuple(Quantities.__dataclass_fields__)
    assert "|".join(load.PRESETS) in definitions["precision"]["pattern"]


def test_every_effect_is_a_key_with_its_meaning_range_and_default():
    blocks = schema.schema()["properties"]["scenes"]["items"]["properties"]
    keys = {"box": {"width", "height"}, "effects": set()}
    for name, effect in EFFECTS.items():
        place = "box" if effect.of_box else "effects"
        keys[place].add(name)
        node = blocks[place]["properties"][name]
        assert effect.meaning[1:] in node["description"]
        if effect.is_number:
            assert node["maximum"] == effect.high
            assert node["minimum"] in (effect.low, effect.default)
            assert node.get("default") == effect.default
    assert {place: {*blocks[place]["properties"]} for place in keys} == keys


def test_reading_a_configuration_needs_no_numerical_package():
    code = (
        "import sys; from twodiscs_paper.configuration import load;"
        "load.load(load.read('config/config.yaml'));"
        "print({'numpy', 'pandas', 'numba', 'scipy', 'matplotlib'} & set(sys.modules))"
    )
    command = [sys.executable, "-c", code]
    shown = subprocess.run(command, capture_output=True, check=True, cwd=ROOT, text=True).stdout
    assert shown.strip() == "set()"


# Defaults and forms


@pytest.mark.parametrize(
    ("width", "height"), [(1.5, 1), (3e6, 1e6), (1, 1), (2, 1), (1e-6, 3e-6), (7, 16), (1, 500)]
)
def test_a_name_and_a_box_are_enough(width, height):
    box = {"width": width, "height": height}
    assert one(box=box).quantities.names == {f"{event}_time" for event in EVENTS}
    request = one(box=box, watch=True)
    assert len(request.radii) == 24
    parts = (f"{event}_{part}" for event in EVENTS for part in ("area", "time"))
    assert request.quantities.names == {"volume", "hop_histogram", "trajectory", *parts}
    assert len(request.quantities.hop_histogram) == 4
    assert all(Scene(width, height, r).vertical_hops for r in request.quantities.hop_histogram)
    assert Scene(width, height, request.quantities.trajectory).regime == "all-hops"
    assert request.dynamics["accuracy"] == dict.fromkeys(EVENTS, 3e-4)
    assert request.event_budget == 2 * 10**9


def test_a_watch_block_is_everything_that_is_watched():
    request = one(watch={"mean_times": ["top_wall", "right_wall"]})
    assert request.quantities == Quantities(False, (), ("right_wall", "top_wall"), (), None)
    assert request.quantities.names == {"right_wall_time", "top_wall_time"}
    assert request.keys["monte_carlo"] == request.keys["intervals"] == {}
    assert tuple(request.keys["dynamics"].values()) == request.radii
    assert request.exact_radii("theory") == request.exact_radii("grid") == [*request.radii]
    assert "hop" not in repr(request.arguments("dynamics", request.radii[0]))
    assert request.tables == ("grid", "theory", "mean_times", "check", "cost")


def test_what_is_false_is_off():
    watch = {"volume": True, "areas": False, "hop_histogram": False, "trajectory": False}
    request = one(watch=watch)
    assert request.quantities.names == {"volume"}
    assert request.keys["dynamics"] == {}
    assert request.arguments("monte_carlo", 0.01)["quantities"] == ["volume"]
    assert request.tables == ("grid", "theory", "volume", "check", "cost")
    thicker = one(watch=watch, monte_carlo={"shell": 0.1})
    assert thicker.arguments("monte_carlo", 0.01) == request.arguments("monte_carlo", 0.01)


def test_hop_histograms_have_three_forms():
    assert one(watch={"hop_histogram": True}).quantities.hop_histogram == (
        0.0375,
        0.112,
        0.188,
        0.262,
    )
    listed = one(watch={"hop_histogram": [0.2, 0.1]})
    assert listed.quantities.hop_histogram == (0.1, 0.2)
    assert listed.histogram == {
        "event": "vertical_hop", "event_budget": 10**11, "intervals": 10**6
    }  # fmt: skip
    block = one(watch={"hop_histogram": {"event": "horizontal_hop", "intervals": "1e4"}})
    assert block.quantities.hop_histogram == (0.025, 0.075, 0.125, 0.175)
    asked = block.arguments("intervals", 0.025)
    assert (asked["event"], asked["intervals"]) == ("horizontal_hop", 10**4)


def test_accuracy_has_three_forms():
    def asked(accuracy):
        return one(accuracy=accuracy).dynamics["accuracy"]

    assert asked("1e-3") == dict.fromkeys(EVENTS, 1e-3)
    assert asked("reference") == dict.fromkeys(EVENTS, 1e-4)
    mixed = asked({"default": "draft", "top_wall": 0.5})
    assert mixed == dict.fromkeys(EVENTS, 1e-2) | {"top_wall": 0.5}
    assert asked({"top_wall": 1})["any_wall"] == 3e-4


def test_numbers_have_one_form():
    mapping = deepcopy(PLAIN)
    load.load(mapping)
    assert mapping == PLAIN  # which stays as it was
    forms = [
        {"radii": [0.2, 0.1], "event_budget": "2e6", "accuracy": "1e-3"},
        {"radii": ["2e-1", 0.1], "event_budget": 2e6, "accuracy": 0.001},
        {"radii": [0.1, "0.2"], "event_budget": 2000000, "accuracy": "1.0E-3"},
    ]
    boxes = [{"width": 1.5, "height": 1}, {"width": "1.5", "height": 1.0}]
    requests = [one(box=box, **form) for box in boxes for form in forms]
    assert len({repr(request) for request in requests}) == 1
    assert requests[0].keys["dynamics"] == {"0.1": 0.1, "0.2": 0.2}
    assert type(requests[0].box.height) is float
    assert type(requests[0].event_budget) is int


def test_included_radii_do_not_move_the_others():
    block = {"smallest": 0.01, "count": 12}
    plain = one(radii=block)
    more = one(radii=block | {"include": [0.123, plain.radii[3]]})
    assert more.radii == tuple(sorted({*plain.radii, 0.123}))


# Parameters of jobs


def jobs(request):
    """The parameters of every job of a scene, beside the box, by job."""
    every = {(table,): request.exact_radii(table) for table in ("theory", "grid")}
    every["trajectory",] = {
        "radius": request.quantities.trajectory,
        "seed": request.trajectory_seed,
    }
    return every | {
        (stage, key): request.arguments(stage, key)
        for stage in STAGES
        for key in request.keys[stage]
    }


BASE = {"radii": [0.1, 0.2], "watch": dict.fromkeys(Quantities.__dataclass_fields__, True)}


def edited(**keys):
    return jobs(one(**{**BASE, **keys}))


@pytest.mark.parametrize(
    ("edit", "concerned"),
    [
        ({"accuracy": 1e-2}, {"dynamics"}),
        ({"event_budget": 10}, {"dynamics"}),
        ({"monte_carlo": {"samples": 10}}, {"monte_carlo"}),
        ({"monte_carlo": {"shell": 0.1}}, {"monte_carlo"}),
        ({"watch": BASE["watch"] | {"mean_times": ["any_wall"]}}, {"dynamics"}),
        ({"watch": BASE["watch"] | {"areas": ["any_wall"]}}, {"monte_carlo"}),
        ({"watch": BASE["watch"] | {"volume": False}}, {"monte_carlo"}),
        ({"watch": BASE["watch"] | {"trajectory": 0.2}}, {"trajectory"}),
        ({"watch": BASE["watch"] | {"hop_histogram": {"intervals": 9}}}, {"intervals"}),
    ],
)
def test_an_edit_concerns_the_jobs_that_depend_on_it(edit, concerned):
    before, after = edited(), edited(**edit)
    assert before.keys() == after.keys()
    assert {job[0] for job in before if repr(before[job]) != repr(after[job])} == concerned


def test_another_radius_is_one_more_job_of_each_method():
    before, after = edited(), edited(radii=[0.1, 0.15, 0.2])
    assert after.keys() - before.keys() == {("monte_carlo", "0.15"), ("dynamics", "0.15")}
    changed = {job[0] for job in before if repr(before[job]) != repr(after[job])}
    assert changed == {"theory", "grid"}


def test_seeds_differ_between_scenes_methods_and_radii_and_follow_the_root():
    every = []
    for seed in (1, 2):
        mapping = {"seed": seed, "scenes": [PLAIN["scenes"][0] | BASE | {"name": n} for n in "ab"]}
        for request in load.load(mapping).scenes:
            every += [p["seed"] for job, p in jobs(request).items() if "seed" in p]
    assert len(set(every)) == len(every) == 2 * 2 * (2 + 2 + 4 + 1)
    assert one(watch=True).trajectory_seed == stream_seed(1908, "one", "trajectory", "0.24")
    # theory.csv also holds the radii of the histograms, whose exact means are compared.
    assert edited()["theory",] == [0.0375, 0.1, 0.112, 0.188, 0.2, 0.262]


# Effects

#: The events that have a place with walls along x or y only.
ALONG = {axis: tuple(e for e in EVENTS if AXIS.get(e, axis) == axis) for axis in "xy"}

#: Quantities of a scene, the events that exist in it, and the radii of its hop histograms.
CALLS = [
    ({"radius_ratio": 0.5, "mass_ratio": 2}, EVENTS, (0.05, 0.15, 0.25, 0.35)),
    ({"periodic": ["x"]}, ALONG["y"], (0.0375, 0.112, 0.188, 0.262)),
    ({"periodic": ["y"]}, ALONG["x"], (0.025, 0.075, 0.125, 0.175)),
    ({"periodic": ["y", "x"]}, ("disc_collision",), ()),
    ({"field": 1}, EVENTS, (0.0375, 0.112, 0.188, 0.262)),
    ({"moment_of_inertia": 0.5}, EVENTS, ()),
]  # fmt: skip


@pytest.mark.parametrize(("effects", "events", "histograms"), CALLS)
def test_everything_is_what_has_a_place(effects, events, histograms):
    request = one(effects=effects, watch=True)
    assert request.quantities.areas == request.quantities.mean_times == events
    assert request.quantities.hop_histogram == histograms
    assert request.histogram["event"] == next((e for e in events if e in HOPS), None)
    assert (request.quantities.trajectory is None) == (effects == {"periodic": ["y", "x"]})
    named = {name: "".join(sorted(v)) if isinstance(v, list) else v for name, v in effects.items()}
    for radius in request.radii + request.quantities.hop_histogram:
        assert request.box.scene(radius) == Scene(1.5, 1, radius, **named)
    assert request.box.scene(0.1).effects == request.effects
    asked = one(effects=effects, watch={"areas": True, "mean_times": True})
    assert asked.quantities.areas == asked.quantities.mean_times == events


def test_default_radii_keep_to_what_there_is():
    """Equal steps to 0.9 of the largest; thresholds of hops follow from the energy too."""
    channel = one(effects={"periodic": ["x"]}, radii={"smallest": 0.05, "count": 5})
    largest = Scene(1.5, 1, 0.1, periodic="x").largest_radius
    steps = [b - a for a, b in pairwise(channel.radii)]
    assert channel.radii[0] == 0.05
    assert channel.radii[-1] == pytest.approx(0.9 * largest, rel=0.01)
    assert max(steps) == pytest.approx(min(steps), rel=0.1)
    # With g = 2 two discs one above the other have the energy up to r = 1/(4g).
    strong = one(effects={"field": 2}, watch={"hop_histogram": {"event": "horizontal_hop"}})
    assert strong.quantities.hop_histogram == (0.0125, 0.0375, 0.0625, 0.0875)
    assert one(effects={"field": 2}, watch=True).quantities.trajectory == 0.0625
    # The larger disc has a hundredth of the side.
    assert one(effects={"radius_ratio": 4}).radii[0] == 0.0025
    assert len(one(radii={"count": 1}, effects={"field": 1}).radii) == 1
    include = one(effects={"field": 1}, radii={"count": 4, "include": [0.123]}).radii
    assert len(include) == 5


def test_balls_are_discs_with_a_depth():
    request = one(box={"width": 1.5, "height": 1, "depth": "1.2"}, effects={"periodic": ["z"]})
    assert request.effects == {"depth": 1.2, "periodic": "z"}
    assert request.box.scene(0.1) == Scene(1.5, 1, 0.1, depth=1.2, periodic="z")
    assert request.quantities.mean_times == EVENTS


@pytest.mark.parametrize(
    "effects",
    [{}, {"radius_ratio": 1, "mass_ratio": "1.0", "periodic": [], "field": 0}, {"field": 0.0}],
)
def test_effects_that_are_absent_leave_no_trace(effects):
    assert one(effects=effects) == one()
    assert one(effects=effects).effects == {}


# Files that are built once


def test_what_is_built_once():
    known = schema.schema()["properties"]["shared"]["items"]["enum"]
    assert load.load(PLAIN).shared == ("report",)
    assert load.load(read(ROOT / "config/config.yaml")).shared == tuple(known)
    assert load.load(PLAIN | {"shared": []}).shared == ()
    assert load.load(PLAIN | {"shared": ["report", "errata"]}).shared == ("errata", "report")
    # The manuscript adds the studies that it reads.
    paper = load.load(PLAIN | {"shared": ["paper"]}).shared
    left = {name for name, study in STUDIES.items() if not study.shared} | {"report"}
    assert paper == tuple(name for name in known if name not in left)
    assert {"errata", "effects", "paper"} < {*paper}
    assert not [name for name, study in STUDIES.items() if study.shared != (name in known)]


def test_what_is_about_a_plain_scene_needs_one():
    plain = PLAIN["scenes"][0] | {"name": "plain"}
    field = PLAIN["scenes"][0] | {"name": "field", "effects": {"field": 1}}
    assert load.load({"scenes": [field, plain]}).main.name == "plain"
    alone = load.load({"scenes": [field]})
    assert alone.main is None
    assert alone.shared == ("report",)
    with pytest.raises(load.ConfigError, match="shared must leave out 'tails' if every scene"):
        load.load({"scenes": [field], "shared": ["report", "tails"]})


# Mistakes: a whole file, a line at its top or in its only scene, and the sentence that it gets.
# "…" stands for any text. There is one for each word of a node of the schema; NaN, true and nothing
# at all are refused in one place, whatever the key.

FILES = {
    "": ": must hold a block of the keys results, seed, shard_events, "
    "accuracy_cost, shared, scenes, "
    "not empty",
    "- 1": ": must hold a block of the keys results, seed, shard_events, "
    "accuracy_cost, shared, scenes, "
    "not [1]",
    "seed: 1\nseed: 2": ", line 2: the key 'seed' is given a second time",
    "scenes:\n- box: {width: 1, height: 1, width: 2}": ", line 2: the key 'width' is given a sec…",
    "results: here\nscenes: [": ", line 2: …",
    "\tscenes: 1": ", line 1: found character '\\t' that cannot start any token",
    "? [a]\n: 1": ", line 1: found unhashable key",
    "a: \x07": ": unacceptable character …",
    "a: 1\nb: 2001-13-41": ", line 2: '2001-13-41' cannot be read: month must be in 1..12",
    "a: !!bool x": ", line 1: 'x' cannot be read: …",
    'a: "\\Uffffffff"': ": …",
    "\na: " + "9" * 5000: ", line 2: a value must have at most 1000 letters",
    "a: &a [1, *a]": ", line 1: an alias must not stand within its own anchor",
    "a: &a {b: *a}": ", line 1: an alias must not stand within its own anchor",
    "a: *b": ", line 1: found undefined alias 'b'",
    "a: " + "[" * 1000: ", line 1: there must be at most 32 blocks within blocks",
    "a0: &a0 [1]\n"
    + "".join(
        f"a{i + 1}: &a{i + 1} [{', '.join([f'*a{i}'] * 9)}]\n" for i in range(30)
    ): ", line 6: there must be at most 50000 values, aliases written out",
    " " * 1_000_001: " must be a file of at most 1000000 bytes",
    "# caf\xe9\na: \udce9": ", line 2: must be UTF-8, not the byte 0xe9",
}

LINES = {
    "results: here": "the configuration needs the key 'scenes'",
    "scenes: []": "scenes must be a non-empty list of scenes, not []",
    "scenes: [a]": "scenes[0] must be a block of keys, at least name and box, not 'a'",
    "scenes: [{box: {width: 1, height: 1}}]": "scenes[0] needs the key 'name'",
    "scene: []": "the configuration has an unknown key 'scene'; did you mean 'scenes'?",
    "sceness: []": "the configuration has an unknown key 'sceness'; its keys are results, …",
    "zz: 1": (
        "the configuration has an unknown key 'zz'; its keys are results, seed, "
        "shard_events, accuracy_cost, "
        "shared, scenes"
    ),
    "1: 2": "the configuration has an unknown key 1; …",
    "accuracy: 1": "the configuration has an unknown key 'accuracy'; it belongs in a scene",
    "seed: -1": "seed must be an integer from 0 to 2^63 - 1, not -1",
    "seed: 1e19": "seed must be an integer …, not 10000000000000000000",
    "results: ../elsewhere": "results must be a path, …, not '../elsewhere'",
    "results: " + "a" * 201: "results must be a path, 200 characters at most, …, not 'aaa…aaa'",
    "results: src": "results must be a path, … outside the folders of the sources, not 'src'",
    "results: '{scene}'": "results must be a path, …, not '{scene}'",
    "results: out/": "results must be a path, … without a slash at its end, …, not 'out/'",
    "shared: [paper, paper]": "shared must be a list of different names …, not ['paper', 'paper']",
    "shared: [papers]": "shared[0] must be one of …, not 'papers'; did you mean 'paper'?",
}

SCENES = {
    "name: " + "a" * 101: ".name must be a name of small letters…, 100 at most, …, not 'aaa…aaa'",
    "name: a/b": ".name must be a name of small letters…, not 'a/b'",
    'name: "a\\n"': ".name must be a name …, not 'a\\n'",
    "name: figures": ".name must be … none of all, benchmarks, …, not 'figures'",
    "box: [1.5, 1]": ".box must be a block {width: …, height: …}, …, not [1.5, 1]",
    "box: {width: 1.5}": ".box needs the key 'height'",
    "width: 1": " has an unknown key 'width'; it belongs in 'box'",
    "field: 1": " has an unknown key 'field'; it belongs in 'effects'",
    "box: {discs: 3}": ".box has an unknown key 'discs'; it belongs in a scene",
    "effects: {samples: 3}": ".effects has an unknown key 'samples'; it belongs in 'monte_carlo'",
    "box: {width: 1,5, height: 1}": ".box has an unknown key 5; decimals have a point",
    "box: {width: 1.5, heigth: 1}": ".box has an unknown key 'heigth'; did you mean 'height'?",
    "box: {width: 1.5, height: '1,2'}": ".box.height must be a positive length …, not '1,2'; "
    "decimals follow a point, 1.2",
    "box: {width: 1.5, height: tall}": ".box.height must be a positive length …, not 'tall'",
    "radii: []": ".radii must be a non-empty list of radii, or a block …, not []",
    "radii: [0.5]": ".radii: radius 0.5 does not fit: … need a radius below 0.38397459621556…",
    "radii: [0.1, 0.2, 1e-1]": ".radii must hold every radius once, but holds 0.1 twice",
    "radius: [0.1]": " has an unknown key 'radius'; did you mean 'radii'?",
    "radii: {smallest: 0.4}": ".radii.smallest: radius 0.4 does not fit: …",
    "radii: {smallest: 0.25}": ".radii: smallest must not be 0.25, at which a hop becomes blocked",
    "radii: {step: 1}": ".radii has an unknown key 'step'; its keys are smallest, count, include",
    "watch: false": ".watch must ask for at least one of volume, …, not for nothing",
    "watch: {}": ".watch must ask for at least one of volume, …, not for nothing",
    "watch: {volumes: true}": ".watch has an unknown key 'volumes'; did you mean 'volume'?",
    "watch: {areas: [wall]}": ".watch.areas[0] must be one of …, not 'wall'; did you mean '…wall'?",
    "watch: {areas: [any_wall, any_wall]}": ".watch.areas must be … list of different events, …",
    "watch: {hop_histogram: [0.1, 0.38]}": (
        ".watch.hop_histogram must keep to radii below 0.375, where vertical_hop is possible, "
        "not 0.38"
    ),
    "watch: {trajectory: 0.5}": ".watch.trajectory: radius 0.5 does not fit: …",
    "effects: {periodic: [x, x]}": ".effects.periodic must be a list of …, not ['x', 'x']",
    "effects: {periodic: [w]}": ".effects.periodic[0] must be an axis (x, y, z), not 'w'",
    "effects: {periodic: [z]}": ".effects: periodic must be … axes x and y (z needs a depth), …",
    "effects: {field: 1e-70}": ".effects: field must lie between 1e-60 and 1e60, not 1e-70",
    "effects: {field: 1, periodic: [y]}": ".effects: field must be 0 if y is periodic, …",
    "accuracy: papper": ".accuracy must be … a preset (draft, paper, reference), …, not 'papper'",
    "accuracy: {rihgt_wall: 1}": ".accuracy has an unknown key 'rihgt_wall'; did you mean …?",
    "event_budget: 2.5": ".event_budget must be an integer from 1 to 1e15, not 2.5",
    "monte_carlo: 1e8": ".monte_carlo must be a block of the keys samples, shell, not '1e8'",
    "montecarlo: {}": " has an unknown key 'montecarlo'; did you mean 'monte_carlo'?",
}


#: Lines that go together.
TOGETHER = {
    ("box: {width: 1, height: 1, depth: 1}", "effects: {moment_of_inertia: 0.4}"): (
        ".effects: moment_of_inertia must be left out in a box with a depth …, not 0.4"
    ),
    ("effects: {periodic: [x]}", "watch: {mean_times: [vertical_hop, horizontal_hop]}"): (
        ".watch.mean_times must hold events of this scene, "
        f"{', '.join(ALONG['y'])}, not 'horizontal_hop'"
    ),
    ("effects: {periodic: [x]}", "watch: {hop_histogram: {event: horizontal_hop}}"): (
        ".watch.hop_histogram.event must be a hop of this scene, such as vertical_hop, not "
        "'horizontal_hop'"
    ),
    ("effects: {periodic: [x, y]}", "watch: {hop_histogram: true}"): (
        ".watch.hop_histogram must be false, because on these periodic axes discs cannot hop"
    ),
    ("effects: {periodic: [x, y]}", "watch: {trajectory: 0.1}"): (
        ".watch.trajectory must be false, because on these periodic axes discs cannot hop"
    ),
    ("effects: {moment_of_inertia: 0.5}", "watch: {hop_histogram: [0.1]}"): (
        ".watch.hop_histogram must be false, because rough discs in a box are not ergodic and "
        "their intervals have no exact mean; watch mean_times instead"
    ),
    ("effects: {field: 2}", "watch: {hop_histogram: {event: horizontal_hop, radii: [0.2]}}"): (
        ".watch.hop_histogram must keep to radii below 0.125, where horizontal_hop is possible, "
        "not 0.2"
    ),
    ("effects: {field: 100}", "radii: [0.38]"): (
        ".radii: field 100.0 is too strong at radius 0.38: …"
    ),
    ("effects: {field: 1, mass_ratio: 2}", "radii: [0.378]"): (
        ".radii: unequal discs in a field need room and energy to pass each other …"
    ),
    ("effects: {field: 1}", "radii: [0.1, 0.378]"): (
        ".radii: with field 1.0, radius 0.378 leaves the discs …e-05 of all positions, "
        "and at least 0.0001 is needed"
    ),
    ("effects: {radius_ratio: 2}", "radii: {smallest: 0.24}"): (
        ".radii: smallest must be below 0.225…, not 0.24"
    ),
}


def refusal(path, text):
    path.write_text(text, encoding="utf-8", errors="surrogateescape")
    with pytest.raises(load.ConfigError) as caught:
        load.load(read(path))
    sentence = str(caught.value)
    assert "\n" not in sentence
    return sentence


def agrees(sentence, expected):
    pattern = re.escape(expected).replace("…", ".*")
    assert re.fullmatch(pattern, sentence), sentence
    return True


def with_value(path, value):
    """Return a configuration with a ``value`` at a ``path`` such as .scenes[].box.width."""
    found = {"scenes": [deepcopy(PLAIN["scenes"][0])]}
    *blocks, last = path.lstrip(".").split(".")
    block = found
    for name in blocks:
        block = block[name.rstrip("[]")][0] if name.endswith("[]") else block.setdefault(name, {})
    block[last] = value
    return found


@pytest.mark.parametrize(("path", "node", "required"), list(keys_of(schema.schema())))
def test_every_key_refuses_what_is_of_no_kind_or_out_of_range(path, node, required):
    mistakes = [None, math.nan, {"colour": 1}, [["a"]], -1e300]
    if {"number", "integer"} & {*node.get("type", [])} or node.get("type") in ("number", "integer"):
        ends = {"minimum": -1, "maximum": +1, "exclusiveMinimum": 0, "exclusiveMaximum": 0}
        mistakes += [
            node[end] + beyond * max(1, node[end]) for end, beyond in ends.items() if end in node
        ]
    for value in mistakes:
        with pytest.raises(load.ConfigError, match=r" must |unknown key|needs the key") as caught:
            load.load(with_value(path, value))
        sentence = str(caught.value)
        assert sentence.startswith(path.lstrip(".").replace("[]", "[0]")), sentence
        assert "\n" not in sentence
        assert len(sentence) < 500


@pytest.mark.parametrize(("text", "expected"), FILES.items())
def test_a_bad_file_gets_a_sentence(tmp_path, text, expected):
    path = tmp_path / "bad.yaml"
    assert agrees(refusal(path, text), f"{path}{expected}")


@pytest.mark.parametrize(("line", "expected"), LINES.items())
def test_a_bad_line_at_the_top_gets_a_sentence(tmp_path, line, expected):
    good = "scenes: [{name: one, box: {width: 1.5, height: 1}}]\n"
    alone = line.startswith(("scene:", "scenes:")) or "needs" in expected
    sentence = refusal(tmp_path / "bad.yaml", line if alone else good + line)
    assert agrees(sentence, expected)


@pytest.mark.parametrize(("line", "expected"), SCENES.items())
def test_a_bad_line_in_a_scene_gets_a_sentence(tmp_path, line, expected):
    lines = {"name": "name: one", "box": "box: {width: 1.5, height: 1}"}
    lines[line.split(":")[0]] = line
    block = "\n    ".join(lines.values())
    sentence = refusal(tmp_path / "bad.yaml", f"scenes:\n  - {block}\n")
    named = "" if line.startswith("name:") else " (scene 'one')"
    assert agrees(sentence, f"scenes[0]{expected}{named}")


@pytest.mark.parametrize(("lines", "expected"), TOGETHER.items())
def test_effects_that_make_no_sense_get_a_sentence(tmp_path, lines, expected):
    block = {"name": "name: one", "box": "box: {width: 1.5, height: 1}"}
    block |= {line.split(":")[0]: line for line in lines}
    text = "scenes:\n  - " + "\n    ".join(block.values()) + "\n"
    assert agrees(refusal(tmp_path / "bad.yaml", text), f"scenes[0]{expected} (scene 'one')")


def nested(value, depth):
    """Return YAML of a list in a list …, six of them in each."""
    return value if depth == 0 else f"[{', '.join([nested(value, depth - 1)] * 6)}]"


@pytest.mark.parametrize(
    "text",
    [
        f"seed: {nested('a' * 30, 5)}\nscenes: [{{name: one, box: {{width: 1, height: 1}}}}]",
        f"scenes: [{{name: {nested('a' * 30, 5)}, box: {{width: 1, height: 1}}}}]",
        nested("a", 5),
        "a: *" + "b" * 70_000,
        "a: !" + "b" * 70_000 + " 1",
        "? " + "a" * 1000 + "\n: 1",
    ],
    ids="{:.30}".format,
)
def test_sentences_have_an_end(tmp_path, text):
    """However much there is to quote."""
    assert len(refusal(tmp_path / "bad.yaml", text)) < 1100


def test_two_scenes_of_one_name_are_refused():
    with pytest.raises(load.ConfigError, match=r"scenes\[1\].name must differ .*, not 'one'"):
        load.load({"scenes": PLAIN["scenes"] * 2})


@pytest.mark.parametrize("bad", [None, [], "scenes", 1])
def test_a_configuration_that_is_no_mapping_is_refused(bad):
    with pytest.raises(load.ConfigError, match="the configuration must be a block of the keys"):
        load.load(bad)


def test_numbers_beyond_a_float_are_refused():
    with pytest.raises(load.ConfigError, match=r"box\.width must be a positive length"):
        one(box={"width": 10**400, "height": 1})
    with pytest.raises(load.ConfigError, match="event_budget must be an integer"):
        one(event_budget=math.inf)


def test_results_are_a_folder_that_holds_no_sources(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("docs", "out"):
        (tmp_path / name).mkdir()
    (tmp_path / "README.md").write_text("text")
    for good in ("out", "out/new", "results", f"{tmp_path}/out"):
        load.check_results(good, tmp_path)
    for bad in ("README.md", "README.md/new", f"{tmp_path}/docs", f"{tmp_path}/docs/new"):
        with pytest.raises(load.ConfigError, match=f"results must be .*, not '{bad}'"):
            load.check_results(bad, tmp_path)


def test_a_missing_file_says_so(tmp_path):
    with pytest.raises(load.ConfigError, match=r"none\.yaml: No such file or directory"):
        read(tmp_path / "none.yaml")


def test_an_override_of_a_shared_block_is_no_duplicate(tmp_path):
    text = """
    deep: [&b {<<: &a {count: 1}, count: 2}]
    c: {<<: *b, smallest: 3}
    """
    path = tmp_path / "shared.yaml"
    path.write_text(text, encoding="utf-8")
    assert read(path) == yaml.safe_load(text)


def test_a_histogram_that_would_not_end_is_refused():
    watch = {"hop_histogram": {"radii": [0.24999999], "event": "horizontal_hop"}}
    with pytest.raises(load.ConfigError, match=r"at 0.24999999 each one takes 3.9e\+14 events"):
        one(watch=watch)
    watch["hop_histogram"]["radii"] = [0.249]
    assert one(watch=watch).quantities.hop_histogram == (0.249,)


def test_the_fewest_intervals_are_a_block():
    from twodiscs.dynamics import intervals

    assert load.LEAST_INTERVALS == intervals.CHAINS * intervals.RETURNS


def test_radii_too_close_to_the_largest_are_refused_for_dynamics_alone():
    largest = Box(1.5, 1.0).largest_radius
    close, far = largest * (1 - 3e-14), largest * (1 - 1.01e-12)
    with pytest.raises(load.ConfigError, match=rf"{close!r} must not exceed 0\.3839745962\d+ for"):
        one(radii=[close])
    assert one(radii=[far]).radii == (far,)
    assert one(radii=[close], watch={"volume": True}).radii == (close,)


def test_stability_needs_sides_that_leave_room_below():
    scene = {"name": "a", "box": {"width": 1e-50, "height": 1e-50}, "watch": {"volume": True}}
    with pytest.raises(load.ConfigError, match="shared must leave out 'stability' unless"):
        load.load({"scenes": [scene], "shared": ["stability"]})
    assert load.load({"scenes": [scene], "shared": ["errata"]}).main.name == "a"


# More discs than two


def test_two_discs_are_the_default_and_leave_no_trace():
    assert one(discs=2) == one()
    assert repr(one(discs=2)) == repr(one())
    assert one().box.discs == 2


def test_more_discs_are_a_scene_of_their_own():
    request = one(discs=3, radii=[0.1, 0.2], watch=True)
    assert request.box == Box(1.5, 1.0, discs=3)
    assert request.effects == {"discs": 3}
    assert request.quantities.mean_times == EVENTS
    assert request.quantities.hop_histogram == ()
    assert request.quantities.trajectory == 0.125  # half of h/4
    assert one(discs=3).radii[-1] == pytest.approx(0.9 * request.box.largest_radius, rel=0.02)
    ring = one(discs=3, radii=[0.1], effects={"periodic": "x"}, watch=True)
    assert ring.quantities.trajectory == 0.143  # half of the largest radius
    histogram = one(discs=3, radii=[0.1], watch={"hop_histogram": {"event": "horizontal_hop"}})
    assert histogram.quantities.hop_histogram == (0.025, 0.075, 0.125, 0.175)
    configuration = load.load({"scenes": [PLAIN["scenes"][0] | {"discs": 3, "radii": [0.1]}]})
    assert configuration.plain == ()


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"discs": 1}, "discs must be an integer from 2 to 1024, not 1"),
        ({"discs": 1025}, "discs must be an integer from 2 to 1024, not 1025"),
        ({"discs": 2.5}, "discs must be an integer from 2 to 1024, not 2.5"),
        ({"discs": True}, "discs must be an integer from 2 to 1024, not True"),
        ({"discs": 3, "radii": [0.31]}, "radii: radius 0.31 does not fit: 3 discs"),
        ({"discs": 3, "effects": {"field": 1}}, "effects: field must be left out with 3 discs"),
        (
            {
                "discs": 3,
                "radii": [0.1],
                "watch": {"hop_histogram": {"event": "horizontal_hop", "radii": [0.26]}},
            },
            "watch.hop_histogram must keep to radii below 0.25, where horizontal_hop is possible",
        ),
    ],
)
def test_what_more_discs_cannot_have_is_refused(keys, message):
    with pytest.raises(load.ConfigError, match=re.escape(f"scenes[0].{message}")):
        one(**keys)


def test_all_mistakes_of_keys_and_values_are_told_at_once():
    bad = {"seeed": 1, "shard_events": 3, "scenes": [PLAIN["scenes"][0] | {"accuracy": 7}]}
    with pytest.raises(load.ConfigError) as caught:
        load.load(bad)
    said = str(caught.value).split("\n")
    assert said[0] == "the configuration has an unknown key 'seeed'; did you mean 'seed'?"
    assert [s.partition(" must")[0] for s in said[1:]] == ["shard_events", "scenes[0].accuracy"]
