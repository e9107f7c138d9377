"""Mistakes in a configuration: each gets a sentence with the key, its value, what is allowed."""

import math
import re
from copy import deepcopy

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from twodiscs_paper.configuration import schema
from twodiscs_paper.configuration.load import ConfigError, load, read
from twodiscs_paper.configuration.model import Model

GOOD = {"scenes": [{"name": "one", "box": {"width": 1.5, "height": 1}}]}


def top(line):
    """Return a configuration with a ``line`` above a scene without mistakes."""
    return f"{line}\nscenes: [{{name: one, box: {{width: 1.5, height: 1}}}}]\n"


def scene(*lines):
    """Return a configuration with ``lines`` in its only scene."""
    block = {"name": "name: one", "box": "box: {width: 1.5, height: 1}"}
    block |= {line.split(":")[0]: line for line in lines}
    return "scenes:\n  - " + "\n    ".join(block.values()) + "\n"


TOP_KEYS = "results, seed, shard_events, accuracy_cost, shared, scenes"

#: Configurations, and the sentence about each. "…" stands for any text, FILE for the path.
MISTAKES = [
    # A file that cannot be read
    ("", f"FILE: must hold a block of the keys {TOP_KEYS}, not empty"),
    ("- 1", f"FILE: must hold a block of the keys {TOP_KEYS}, not [1]"),
    ("seed: 1\nseed: 2", "FILE, line 2: the key 'seed' is given a second time"),
    ("scenes:\n- box: {width: 1, width: 2}", "FILE, line 2: the key 'width' is given a second …"),
    ("results: here\nscenes: [", "FILE, line 2: …"),
    ("\tscenes: 1", "FILE, line 1: found character '\\t' that cannot start any token"),
    ("? [a]\n: 1", "FILE, line 1: found unhashable key"),
    ("a: \x07", "FILE: unacceptable character …"),
    ("a: 1\nb: 2001-13-41", "FILE: month must be in 1..12"),
    ("a: !!bool x", "FILE: 'x'"),
    ('a: "\\Uffffffff"', "FILE: …"),
    ("a: *b", "FILE, line 1: found undefined alias 'b'"),
    ("a: " + "[" * 5000, "FILE: maximum recursion depth exceeded…"),
    ("# caf\xe9\na: \udce9", "FILE: must be UTF-8, which has no byte 0xe9 here"),
    # Numbers that YAML reads in another base than ten
    ("seed: 010", "FILE, line 1: 010 must be a decimal number or text in quotes: YAML reads 8"),
    ("a: 1\nseed: 1:30", "FILE, line 2: 1:30 must be a decimal number …: YAML reads 90"),
    ("seed: 0b11", "FILE, line 1: 0b11 must be a decimal number …: YAML reads 3"),
    ("seed: 0x1F", "FILE, line 1: 0x1F must be a decimal number …: YAML reads 31"),
    ("seed: -1_5", "FILE, line 1: -1_5 must be a decimal number …: YAML reads -15"),
    ("accuracy: 1:30.5", "FILE, line 1: 1:30.5 must be a decimal number …: YAML reads 90.5"),
    ("scenes: [{radii: [0.1, 1_0.5]}]", "FILE, line 1: 1_0.5 must be …: YAML reads 10.5"),
    ("010: 1", "FILE, line 1: 010 must be a decimal number …: YAML reads 8"),
    (top("seed: '010'"), "seed must be an integer …, not '010'"),
    # The top level
    ("results: here", "the configuration needs the key 'scenes'"),
    ("scenes: []", "scenes must be a non-empty list of scenes, not []"),
    ("scenes: [a]", "scenes[0] must be a block of keys, at least name and box, not 'a'"),
    ("scenes: &a [*a]", "scenes[0] must be a block of keys, at least name and box, not [[[...]]]"),
    ("scenes: [{box: {width: 1, height: 1}}]", "scenes[0] needs the key 'name'"),
    ("scene: []", "the configuration has an unknown key 'scene'; did you mean 'scenes'?"),
    (top("sceness: []"), "the configuration has an unknown key 'sceness'; its keys are results, …"),
    (top("zz: 1"), f"the configuration has an unknown key 'zz'; its keys are {TOP_KEYS}"),
    (top("1: 2"), "the configuration has an unknown key 1; …"),
    (top("null: 2"), "the configuration has an unknown key empty; its keys are results, …"),
    (top("accuracy: 1"), "the configuration has an unknown key 'accuracy'; it belongs in a scene"),
    (top("seed: -1"), "seed must be an integer from 0 to 2^63 - 1, not -1"),
    (top("seed: 1e19"), "seed must be an integer …, not '1e19'"),
    (top("results: ../elsewhere"), "results must be a path, …, not '../elsewhere'"),
    (top(f"results: {'a' * 201}"), "results must be a path, 200 characters …, not 'aaa…aaa'"),
    (top("results: src"), "results must be … outside the folders of the sources, not 'src'"),
    (top("results: '{scene}'"), "results must be a path, …, not '{scene}'"),
    (top("results: out/"), "results must be a path, … without a slash at its end, …, not 'out/'"),
    (top("shared: [paper, paper]"), "shared must be a list of different …, not ['paper', 'paper']"),
    (top("shared: [papers]"), "shared[0] must be one of …, not 'papers'; did you mean 'paper'?"),
    # Name, box, number of discs
    (scene(f"name: {'a' * 101}"), "scenes[0].name must be …, 100 at most, …, not 'aaa…aaa'"),
    (scene("name: a/b"), "scenes[0].name must be a name of small letters…, not 'a/b'"),
    (scene('name: "a\\n"'), "scenes[0].name must be a name …, not 'a\\n'"),
    (scene("name: figures"), "scenes[0].name must be … none of all, benchmarks, …, not 'figures'"),
    (
        scene("box: [1.5, 1]"),
        "scenes[0].box must be a block {width: …, height: …}, …, not [1.5, 1]",
    ),
    (scene("box: {width: 1.5}"), "scenes[0].box needs the key 'height'"),
    (scene("width: 1"), "scenes[0] has an unknown key 'width'; it belongs in 'box'"),
    (scene("field: 1"), "scenes[0] has an unknown key 'field'; it belongs in 'effects'"),
    (scene("box: {discs: 3}"), "scenes[0].box has an unknown key 'discs'; it belongs in a scene"),
    (
        scene("box: {width: 1,5, height: 1}"),
        "scenes[0].box has an unknown key 5; decimals have a point",
    ),
    (
        scene("box: {width: 1.5, heigth: 1}"),
        "scenes[0].box has an unknown key 'heigth'; did you mean 'height'?",
    ),
    (
        scene("box: {width: 1.5, height: '1,2'}"),
        "scenes[0].box.height must be a positive length …, not '1,2'; decimals follow a point, 1.2",
    ),
    (scene("box: {width: 1.5, height: tall}"), "scenes[0].box.height must be …, not 'tall'"),
    (
        scene("box: {width: 1, height: 1, depth: 1}", "effects: {moment_of_inertia: 0.4}"),
        "scenes[0].effects: moment_of_inertia must be left out in a box with a depth …, not 0.4",
    ),
    (scene("discs: 1"), "scenes[0].discs must be an integer from 2 to 1024, not 1"),
    (scene("discs: 1025"), "scenes[0].discs must be an integer from 2 to 1024, not 1025"),
    (scene("discs: 2.5"), "scenes[0].discs must be an integer from 2 to 1024, not 2.5"),
    (scene("discs: true"), "scenes[0].discs must be an integer from 2 to 1024, not True"),
    (scene("discs: 3", "radii: [0.31]"), "scenes[0].radii: radius 0.31 does not fit: 3 discs…"),
    (
        scene("discs: 65", "radii: [0.01]", "watch: {volume: true}"),
        "scenes[0].watch.volume must be false for more than 64 discs, …",
    ),
    (
        scene("discs: 65", "radii: [0.01]", "watch: {areas: [any_wall]}"),
        "scenes[0].watch.areas must be false for more than 64 discs, …",
    ),
    # Radii
    (scene("radii: []"), "scenes[0].radii must be a non-empty list of radii, or a block …, not []"),
    (scene("radii: [0.5]"), "scenes[0].radii: radius 0.5 does not fit: … below 0.38397459621556…"),
    (scene("radii: [0.1, a]"), "scenes[0].radii[1] must be a positive length …, not 'a'"),
    (scene("radii: [0.1, 0.2, 1e-1]"), "scenes[0].radii must hold every radius once, but …"),
    (scene("radius: [0.1]"), "scenes[0] has an unknown key 'radius'; did you mean 'radii'?"),
    (scene("radii: {smallest: 0.4}"), "scenes[0].radii.smallest: radius 0.4 does not fit: …"),
    (scene("radii: {smallest: 0.25}"), "scenes[0].radii: smallest must not be 0.25, at which a …"),
    (
        scene("radii: {step: 1}"),
        "scenes[0].radii has an unknown key 'step'; its keys are smallest, count, include",
    ),
    # Quantities
    (scene("watch: false"), "scenes[0].watch must ask for at least one of volume, …"),
    (scene("watch: {}"), "scenes[0].watch must ask for at least one of volume, …"),
    (scene("watch: {volumes: true}"), "scenes[0].watch has an unknown key 'volumes'; did you …"),
    (
        scene("watch: {areas: [wall]}"),
        "scenes[0].watch.areas[0] must be one of …, not 'wall'; did you mean '…wall'?",
    ),
    (
        scene("watch: {areas: [any_wall, any_wall]}"),
        "scenes[0].watch.areas must be … list of different events, …",
    ),
    (
        scene("watch: {hop_histogram: [0.1, 0.38]}"),
        "scenes[0].watch.hop_histogram must keep to radii below 0.375, where vertical_hop is …",
    ),
    (
        scene("watch: {hop_histogram: {radii: [0.24999999], event: horizontal_hop}}"),
        "scenes[0].watch.hop_histogram must keep to … at 0.24999999 each one takes 3.9e+14 events",
    ),
    (
        scene("watch: {hop_histogram: {radii: [0.1], event_budget: 1e5}}"),
        "scenes[0].watch.hop_histogram must keep to … 65536 intervals fit into …, 100000; at 0.1 …",
    ),
    (scene("watch: {trajectory: 0.5}"), "scenes[0].watch.trajectory: radius 0.5 does not fit: …"),
    (
        scene(
            "discs: 3",
            "radii: [0.1]",
            "watch: {hop_histogram: {event: horizontal_hop, radii: [0.26]}}",
        ),
        "scenes[0].watch.hop_histogram must keep to radii below 0.25, where horizontal_hop is …",
    ),
    # Effects
    (
        scene("effects: {samples: 3}"),
        "scenes[0].effects has an unknown key 'samples'; it belongs in 'monte_carlo'",
    ),
    (
        scene("effects: {periodic: [x, x]}"),
        "scenes[0].effects.periodic must be a list …, not [… 'x']",
    ),
    (scene("effects: {periodic: [w]}"), "scenes[0].effects.periodic[0] must be an axis …, not 'w'"),
    (
        scene("effects: {periodic: [z]}"),
        "scenes[0].effects: periodic must be … (z needs a depth), …",
    ),
    (
        scene("effects: {field: 1e-70}"),
        "scenes[0].effects: field must lie between 1e-60 and 1e60, …",
    ),
    (scene("effects: {field: 1, periodic: [y]}"), "scenes[0].effects: field must be 0 if y is …"),
    (
        scene("discs: 3", "effects: {field: 1}"),
        "scenes[0].effects: field must be left out with 3 …",
    ),
    (
        scene("effects: {periodic: [x]}", "watch: {mean_times: [vertical_hop, horizontal_hop]}"),
        "scenes[0].watch.mean_times must hold events of this scene, "
        "vertical_hop, disc_collision, top_wall, any_wall, not 'horizontal_hop'",
    ),
    (
        scene("effects: {periodic: [x]}", "watch: {hop_histogram: {event: horizontal_hop}}"),
        "scenes[0].watch.hop_histogram.event must be a hop of this scene, such as vertical_hop, …",
    ),
    (
        scene("effects: {periodic: [x, y]}", "watch: {hop_histogram: true}"),
        "scenes[0].watch.hop_histogram must be false, because on these periodic axes discs …",
    ),
    (
        scene("effects: {periodic: [x, y]}", "watch: {trajectory: 0.1}"),
        "scenes[0].watch.trajectory must be false, because on these periodic axes discs …",
    ),
    (
        scene("effects: {moment_of_inertia: 0.5}", "watch: {hop_histogram: [0.1]}"),
        "scenes[0].watch.hop_histogram must be false, because rough discs in a box are not …",
    ),
    (
        scene(
            "effects: {field: 2}", "watch: {hop_histogram: {event: horizontal_hop, radii: [0.2]}}"
        ),
        "scenes[0].watch.hop_histogram must keep to radii below 0.125, where horizontal_hop is …",
    ),
    (
        scene("effects: {field: 100}", "radii: [0.38]"),
        "scenes[0].radii: field 100.0 is too strong at radius 0.38: …",
    ),
    (
        scene("effects: {field: 1, mass_ratio: 2}", "radii: [0.378]"),
        "scenes[0].radii: unequal discs in a field need room and energy to pass each other …",
    ),
    (
        scene("effects: {field: 1}", "radii: [0.1, 0.378]"),
        "scenes[0].radii: with field 1.0, radius 0.378 leaves the discs …e-05 of all positions, …",
    ),
    (
        scene("effects: {radius_ratio: 2}", "radii: {smallest: 0.24}"),
        "scenes[0].radii: smallest must be below 0.225…, not 0.24",
    ),
    # Accuracy and cost
    (
        scene("accuracy: papper"),
        "scenes[0].accuracy must be … a preset (draft, paper, reference), …, not 'papper'; "
        "did you mean 'paper'?",
    ),
    (
        scene("accuracy: {rihgt_wall: 1}"),
        "scenes[0].accuracy has an unknown key 'rihgt_wall'; did you mean 'right_wall'?",
    ),
    (
        scene("event_budget: 2.5"),
        "scenes[0].event_budget must be an integer from 1 to 1e15, not 2.5",
    ),
    (
        scene("monte_carlo: 1e8"),
        "scenes[0].monte_carlo must be a block of the keys samples, shell, not '1e8'",
    ),
    (scene("montecarlo: {}"), "scenes[0] has an unknown key 'montecarlo'; did you mean 'monte_…'?"),
]


@pytest.mark.parametrize(("text", "sentence"), MISTAKES)
def test_a_mistake_gets_a_sentence(tmp_path, text, sentence):
    path = tmp_path / "bad.yaml"
    in_scene = sentence.startswith("scenes[0]") and "name: one" in text
    expected = sentence.replace("FILE", str(path)) + (" (scene 'one')" if in_scene else "")
    pattern = re.escape(expected).replace("…", ".*")
    found = refusal(path, text)
    assert re.fullmatch(pattern, found), found


def refusal(path, text):
    """Return the only sentence about the mistakes in a ``text``."""
    path.write_text(text, encoding="utf-8", errors="surrogateescape")
    with pytest.raises(ConfigError) as caught:
        load(read(path))
    assert "\n" not in str(caught.value)
    return str(caught.value)


def test_all_mistakes_are_told_together():
    other = {"name": "two", "box": {"width": 1, "height": 1}}
    bad = {"seeed": 1, "shard_events": 3, "scenes": [GOOD["scenes"][0] | {"accuracy": 7}]}
    with pytest.raises(ConfigError) as caught:
        load(bad)
    unknown, *others = str(caught.value).split("\n")
    assert unknown == "the configuration has an unknown key 'seeed'; did you mean 'seed'?"
    assert [s.partition(" must")[0] for s in others] == ["shard_events", "scenes[0].accuracy"]
    bad = {"scenes": [other | {"radii": [9]}, other | {"watch": False}]}
    with pytest.raises(ConfigError) as caught:
        load(bad)
    first, name, watch = str(caught.value).split("\n")
    assert first.startswith("scenes[0].radii: radius 9.0 does not fit")
    assert name == "scenes[1].name must differ from every other scene's, not 'two'"
    assert watch.startswith("scenes[1].watch must ask for at least one of ")
    assert watch.endswith(" (scene 'two')")


def keys_of(node, path=""):
    """Yield (path, node of the schema) of every key beneath a node."""
    for name, child in node.get("properties", {}).items():
        yield f"{path}.{name}", child
        yield from keys_of(child, f"{path}.{name}")
        yield from keys_of(child.get("items", {}), f"{path}.{name}[]")


def with_value(path, value):
    """Return a configuration with a ``value`` at a ``path`` such as .scenes[].box.width."""
    found = deepcopy(GOOD)
    *blocks, last = path.lstrip(".").split(".")
    block = found
    for name in blocks:
        block = block[name.rstrip("[]")][0] if name.endswith("[]") else block.setdefault(name, {})
    block[last] = value
    return found


def limits(node, names):
    """Return the limits of the range of a node that have these names."""
    forms = [node, *node.get("anyOf", ())]
    return [form[name] for form in forms for name in names if name in form]


def beyond(node):
    """Return numbers outside the range of a node."""
    below = (limit - max(1, limit) for limit in limits(node, ["minimum"]))
    above = (limit + max(1, limit) for limit in limits(node, ["maximum"]))
    return [*below, *above, *limits(node, ["exclusiveMinimum", "exclusiveMaximum"])]


@pytest.mark.parametrize(("path", "node"), list(keys_of(schema.keys())))
def test_the_ends_of_a_range_are_in_it(path, node):
    for value in limits(node, ["minimum", "maximum"]):
        Model.model_validate(with_value(path, value))


@pytest.mark.parametrize(("path", "node"), list(keys_of(schema.keys())))
def test_every_key_refuses_other_kinds_and_values_out_of_range(path, node):
    for value in (None, math.nan, {"colour": 1}, [["a"]], -1e300, *beyond(node)):
        with pytest.raises(ConfigError, match=r" must |unknown key|needs the key") as caught:
            load(with_value(path, value))
        sentence = str(caught.value)
        assert sentence.startswith(path.lstrip(".").replace("[]", "[0]")), sentence
        assert "\n" not in sentence
        assert len(sentence) < 500


FULL = {
    **{"results": "a", "seed": 1, "shard_events": 1e9, "shared": ["report"]},
    "accuracy_cost": {"seconds": 1},
    "scenes": [
        {
            "name": "one",
            "box": {"width": 1.5, "height": 1},
            "effects": {"periodic": "x", "mass_ratio": 2},
            "radii": {"smallest": 0.1, "count": 2, "include": [0.2]},
            "watch": {
                "areas": ["any_wall"],
                "mean_times": True,
                "hop_histogram": {"radii": [0.1], "event": "vertical_hop"},
                "trajectory": 0.1,
            },
            "accuracy": {"default": "draft", "any_wall": 0.1},
            "monte_carlo": {"samples": 1},
        }
    ],
}


def places(value, steps=()):
    """Yield the keys and numbers on the way to each value in a configuration."""
    yield steps
    if isinstance(value, dict | list):
        for step, item in value.items() if isinstance(value, dict) else enumerate(value):
            yield from places(item, (*steps, step))


def changed(value, changes, steps=()):
    """Return a configuration with the ``changes``, {place: value}."""
    if steps in changes:
        return changes[steps]
    if isinstance(value, dict):
        return {key: changed(item, changes, (*steps, key)) for key, item in value.items()}
    if isinstance(value, list):
        return [changed(item, changes, (*steps, i)) for i, item in enumerate(value)]
    return value


JUNK = st.one_of(
    st.sampled_from([None, True, False, "", "x", "1e3", "010", "draft", [], [[]], {}, b"x"]),
    st.sampled_from([0, -1, 65, 1e-70, 1e70, 10**400, math.nan, math.inf, [0.1, 0.1], [None]]),
    st.sampled_from([{5: None}, {None: 1}, {(1, 2): 3}, {"bool": 1}, {"Grid": 1}, {"radii": [1]}]),
)


@given(st.dictionaries(st.sampled_from([*places(FULL)]), JUNK, min_size=1, max_size=4))
@settings(max_examples=300, deadline=None)
def test_any_value_anywhere_is_taken_or_gets_a_sentence(changes):
    try:
        load(changed(FULL, changes))
    except ConfigError as error:
        for sentence in str(error).split("\n"):
            assert re.match(r"the configuration |[a-z_]+", sentence), sentence
            assert re.search(r" must | needs |unknown key|: ", sentence), sentence


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
        "seed: " + "9" * 5000,
        "\n".join(f"a{i + 1}: &a{i + 1} [{', '.join([f'*a{i}'] * 9)}]" for i in range(30)).replace(
            "*a0", "1"
        ),
    ],
    ids="{:.30}".format,
)
def test_sentences_have_an_end(tmp_path, text):
    """They quote the first part of a long value."""
    path = tmp_path / "bad.yaml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ConfigError) as caught:
        load(read(path))
    assert all(len(sentence) < 1100 for sentence in str(caught.value).split("\n"))


@pytest.mark.parametrize("text", ["0", "-7", "+.5", "1.", "1e6", "2.5E-01", "1.e+3", "'010'"])
def test_numbers_that_everyone_reads_in_one_way_are_taken(tmp_path, text):
    (tmp_path / "a.yaml").write_text(f"a: [{text}]\n", encoding="utf-8")
    (value,) = read(tmp_path / "a.yaml")["a"]
    assert float(value) == float(text.strip("'"))


def test_an_override_of_a_merged_block_is_no_duplicate(tmp_path):
    text = """
    deep: [&b {<<: &a {count: 1}, count: 2}]
    c: {<<: *b, smallest: 3}
    """
    path = tmp_path / "merged.yaml"
    path.write_text(text, encoding="utf-8")
    assert read(path) == yaml.safe_load(text)


def test_a_missing_file_says_so(tmp_path):
    with pytest.raises(ConfigError, match=r"none\.yaml: No such file or directory"):
        read(tmp_path / "none.yaml")
