"""Bad input: one sentence with the key, the value and what is allowed, from the face and the shell.

Without these tests a check could be lost, or end in a traceback; ``configuration/test_mistakes.py``
has the sentences about configurations.
"""

import itertools
import math
import os
import re
import subprocess
import sys
from fractions import Fraction
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from commands import command
from hypothesis import given, settings
from hypothesis import strategies as st

import twodiscs as td
from twodiscs import arguments, cli
from twodiscs.dynamics import runs, trajectory
from twodiscs.model import checks, effects
from twodiscs.model.box import Box, even_radii, radii, stream_seed
from twodiscs.model.checks import InputError
from twodiscs.model.events import HOPS
from twodiscs.model.scene import Scene
from twodiscs.points import estimates
from twodiscs.points.base import read_json
from twodiscs.sampling import montecarlo
from twodiscs.sampling.starts import components
from twodiscs.theory import exact, laws, virial

BOX = Box(1.5, 1.0)
PAPER = BOX.scene(0.2)
RING, FIELD = Scene(1.5, 1.0, 0.2, periodic="x"), Scene(1.5, 1.0, 0.2, field=0.4)
NAN, INF = math.nan, math.inf
POINT = {"scene": PAPER, "quantities": ["volume"], "samples": 1, "shell": 0.02, "seed": 1}
COUNTED, NAMED = {"events": ["any_wall"], "budget": 1}, {"seed": 1, "name": "a"}
START = dict(zip(components(PAPER), (-0.5, 0.0, 0.5, 0.0, 1.0, 0.0, 0.0, 0.0), strict=True))


def x1(start, now):
    return now["x1"]


#: Public functions with arguments that are right.
CALLS = [
    (Scene, {"width": 1.5, "height": 1.0, "radius": 0.2}),
    (PAPER.with_radius, {"radius": 0.1}),
    (PAPER.is_possible, {"event": "any_wall"}),
    (Box, {"width": 1.5, "height": 1.0, "effects": {"field": 0.1}}),
    (BOX.scene, {"radius": 0.2}),
    (BOX.threshold, {"event": "any_wall"}),
    (partial(checks.check_length, "side"), {"value": 1.0}),
    (radii, {"width": 1.5, "height": 1.0, "smallest": 0.01, "count": 8}),
    (even_radii, {"smallest": 0.1, "largest": 0.2, "count": 8}),
    (stream_seed, {"seed": 1, "scene": "paper", "method": "dynamics", "key": "0.2"}),
    *((f, {"scene": PAPER}) for f in (exact.volume, exact.areas, exact.mean_times, exact.exact)),
    *((f, {"scene": PAPER}) for f in (exact.event_rate, laws.closed_form)),
    (runs.replica_duration, {"scene": PAPER}),
    *((f, {"scene": PAPER, "event": "any_wall"}) for f in (exact.rate, laws.threshold_time)),
    (exact.shell_expectation, {"scene": PAPER, "event": "top_wall", "epsilon": 0.01}),
    (laws.small_radius_time, {"box": BOX, "event": "any_wall", "radius": 0.1}),
    (laws.leading_law, {"box": BOX, "event": "any_wall"}),
    (laws.density_at_zero, {"scene": PAPER, "hop": "vertical_hop"}),
    (laws.tail_constant, {"scene": PAPER, "event": "vertical_hop"}),
    (montecarlo.sample_point, POINT),
    (montecarlo.conditioned_point, POINT),
    (montecarlo.shell_thickness, {"scene": PAPER, "event": "top_wall", "fraction": 0.02}),
    (runs.count_events, {"scene": PAPER, "target": {"any_wall": 0.1}, "budget": 1, "seed": 1}),
    (runs.hop_intervals, {"scene": PAPER, "event": "vertical_hop", "intervals": 1, "seed": 1}),
    (trajectory.followed, {"scene": PAPER, "seed": 1}),
    (estimates.normal_quantile, {"confidence": 0.95}),
    (virial.weights, {"scene": PAPER}),
    (td.exact_table, {"width": 1.5, "height": 1.0, "radii": [0.2]}),
    (td.scan, {"width": 1.5, "height": 1.0, "radii": [0.2], "error": 0.5, **COUNTED}),
    (td.simulate, {"scene": PAPER, "error": 0.5, **COUNTED, **NAMED}),
    (td.sample, POINT | NAMED),
    (td.intervals, {"scene": PAPER, "hop": "vertical_hop", "number": 1, **NAMED}),
    (td.transmission, {"scene": PAPER, "hop": "vertical_hop", "hops": 1, **NAMED}),
    (td.starts, {"scene": PAPER, "number": 1, **NAMED}),
    (td.trajectory, {"scene": PAPER, "start": [*START.values()], "duration": 1.0, **NAMED}),
    (td.observe, {"scene": PAPER, "function": x1, "times": [1], "replicas": 1, **NAMED}),
    (td.diffusion, {"scene": RING, "times": [1], "replicas": 1, **NAMED}),
    (td.plot, {"result": PAPER, "path": None}),
]  # fmt: skip

#: Wrong values for each of these arguments, one of each kind.
LENGTH = [-1.0, 0.0, INF, 1e-61, 1e61, "1", True]
RADIUS = [*LENGTH, 0.4, BOX.largest_radius]
COUNT = [0, 1.5, 2**64, "1", True]
INTEGER = [-1, 1.5, "1", True]
PART = [0.0, 1.0, -0.1, "0.1", True]
EVENT = ["", "hop", b"any_wall", PAPER]
EFFECTS = [
    "field", {"gravity": 1}, {1: 2}, {"field": -1.0}, {"periodic": "xx"}, {"radius_ratio": 1e9},
    {"field": 1.0, "periodic": "y"}, {"periodic": "xy", "moment_of_inertia": 0.4},
]  # fmt: skip
TARGET = [
    {},
    "any_wall",
    {"hop": 0.1},
    {None: 0.1},
    *({"any_wall": p} for p in PART if repr(p) != "1.0"),
]
WRONG = (
    dict.fromkeys(("width", "height", "value", "epsilon"), LENGTH)
    | {"radius": RADIUS, "smallest": RADIUS, "largest": [*LENGTH, 0.1], "effects": EFFECTS}
    | dict.fromkeys(("count", "samples", "intervals", "budget", "replicas"), COUNT)
    | dict.fromkeys(("shell", "fraction", "confidence"), PART)
    | {"seed": INTEGER, "target": TARGET}
    | {"scene": [1.0, "scene", (1.5, 1.0, 0.2), Scene], "method": EVENT, "event": EVENT}
    | {"hop": [*EVENT, "any_wall"], "quantities": [[], ["mass"], [None], ["any_wall"]]}
    | {"hops": COUNT, "number": COUNT, "duration": [INF, "1", 0.0, -1.0]}
    | {"error": [0.0, 1.1, -0.5, True, "rough", {}, {"hop": 0.1}], "name": [3, b"a"]}
    | {"events": [["hop"], {"any_wall": 0.1}, b"any_wall", 5], "radii": [[], [0.9], [None]]}
    | {"start": [[], [1.0] * 8, "x", [None] * 8], "times": [[-1], [1, 1], [1e9], [INF]]}
    | {"function": [1, lambda start, now: None, lambda start, now: "x1"], "path": [3.5, "a.txt"]}
    | {"result": [1, "scene", [PAPER, 1], {}]}
)

#: Right values that are wrong elsewhere: the limit of no radius, any text for the name of a scene.
RIGHT = {
    (laws.small_radius_time, "radius"): [0.0],
    (stream_seed, "scene"): ["scene"],
}

#: No argument may be such a thing, or hold it where it is a list.
JUNK = st.one_of(st.just(NAN), st.complex_numbers(), st.binary(max_size=3), st.builds(object))
LISTS = {"quantities"}

#: The possible names of the wrong part of an argument with several parts.
INSIDE = {
    "value": ["side"],
    "effects": effects.EFFECTS,
    "largest": ["smallest"],
    "quantities": ["quantity"],
    "target": ["event"],
    "error": ["event"],
    "events": ["event"],
    "radii": ["radius"],
}


def refused(function, good, name, value):
    with pytest.raises(InputError, match=r"\w") as caught:
        function(**good | {name: value})
    sentence = str(caught.value)
    assert "\n" not in sentence
    assert 10 < len(sentence) < 300
    assert re.search(r"must|does not fit|has no|is blocked|name", sentence), sentence
    assert any(word in sentence for word in (name, *INSIDE.get(name, ()))), sentence


@pytest.mark.parametrize(("function", "good"), CALLS)
def test_what_is_right_is_taken_and_a_mistake_of_each_kind_refused(function, good):
    function(**good)
    for name in good.keys() & WRONG.keys():
        for value in WRONG[name]:
            if value not in RIGHT.get((function, name), []):
                refused(function, good, name, value)


@given(st.sampled_from(CALLS), st.data())
@settings(max_examples=500, deadline=None)
def test_junk_is_refused(call, data):
    function, good = call
    name, value = data.draw(st.sampled_from(sorted(good.keys() & WRONG.keys()))), data.draw(JUNK)
    refused(function, good, name, [value] if name in LISTS else value)


@pytest.mark.parametrize("kind", [int, np.float64, np.float32, Fraction, np.int64])
def test_other_kinds_of_numbers_are_taken(kind):
    assert Scene(kind(4), kind(3), 0.5) == Scene(4.0, 3.0, 0.5)


@pytest.mark.parametrize("sides", [(1.5, 1.0), (1.0, 1.0), (2.0, 1.0), (3.0, 1.0), (1.0, 7.0)])
def test_beyond_the_largest_radius_there_is_no_scene(sides):
    box = Box(*sides)
    for more in (1e-15, 1e-9, 1.0):
        radius = box.largest_radius * (1 + more)
        assert not box.fits(radius)
        named = re.escape(f"radius {radius!r} does not fit")
        with pytest.raises(InputError, match=rf"{named}.*below {box.largest_radius!r}"):
            box.scene(radius)


#: Calls of the face, and what their sentences say.
SENTENCES = [
    *(
        (lambda values=values: Scene(**{"width": 1.5, "height": 1.0, "radius": 0.1} | values), said)
        for values, said in (
            ({"discs": 1}, "discs must be an integer from 2 to 1024, not 1"),
            ({"discs": 1025}, "discs must be an integer from 2 to 1024, not 1025"),
            ({"discs": 3.0}, "discs must be an integer of at least 2, not 3.0"),
            ({"discs": True}, "discs must be an integer of at least 2, not True"),
            ({"discs": 3, "field": 1.0}, "field must be left out with 3 discs"),
            ({"discs": 3, "depth": 1.0}, "depth must be left out with 3 discs"),
            (
                {"discs": 3, "moment_of_inertia": 0.5, "periodic": "xy"},
                "moment_of_inertia must be left out in a box without walls",
            ),
            ({"discs": 3, "periodic": "xy"}, "periodic must be left out or x for more than two"),
            ({"discs": 3, "periodic": "y"}, "periodic must be left out or x for more than two"),
            ({"discs": 3, "radius": 0.31}, "radius 0.31 does not fit: 3 discs in a box of 1.5 × 1"),
            ({"discs": 4, "radius": 0.376, "periodic": "x"}, "radius 0.376 does not fit"),
            ({"discs": 20, "radius": 0.2}, "20 discs in a box of 1.5 × 1.0 need a "),
            ({"discs": 64, "width": 1e5}, "width and height must be in a unit of length in which"),
            ({"width": 0.2, "radius": 1.5}, "radius 1.5 does not fit"),
            ({"field": -1}, "field must be a positive, finite number, or 0, not -1.0"),
            ({"periodic": "x,y"}, "periodic must be some of the axes x and y (z needs a depth), "),
            ({"gravity": 1}, "unexpected keyword argument 'gravity'"),
            ({"n_discs": 3}, "'n_discs'; did you mean discs?"),
            *(
                ({name: np.array([0.1, 0.2])}, f"{name} must be ")
                for name in ("discs", "width", "radius", "field", "periodic")
            ),
        )
    ),
    (lambda: Scene(1.5, 1.0, 0.1, discs=3, periodic="x").turned(), "periodic must be left out or"),
    (lambda: Scene(1.5, 1.0, 0.2, 1.0), "positional arguments but 5 were given"),
    (lambda: Scene(1.5, 1.0), "missing 1 required positional argument: 'radius'"),
    (lambda: Box(1.5), "missing 1 required positional argument: 'height'"),
    (lambda: Box.of(3), "scene must be a Scene, not 3"),
    (lambda: exact.rate("any_wall", PAPER), "scene must be a Scene, not 'any_wall'"),
    (lambda: td.simulate(PAPER, evnets=["any_wall"]), "'evnets'; did you mean events?"),
    (lambda: td.simulate(PAPER, 0.5, 7), "simulate() takes from 1 to 2 positional arguments"),
    (lambda: td.simulate(), "missing 1 required positional argument: 'scene'"),
    (lambda: td.simulate(PAPER, scene=PAPER), "got multiple values for argument 'scene'"),
    (lambda: td.load("a", "b"), "load() takes 1 positional argument but 2 were given"),
    (lambda: td.scan(1.5, 1, [0.1], gravity=1), "gravity is no effect; effects must be some of "),
    (lambda: td.scan(1.5, 1, []), "radii must have at least one radius"),
    (lambda: td.scan(1.5, 1, [0.2, 0.2]), "radii must differ, because one radius has the same "),
    (lambda: td.simulate(PAPER, events="any wall"), "; did you mean any_wall?"),
    (
        lambda: td.simulate(PAPER, events={"any_wall": 1e-9}),
        "events must be some of vertical_hop, ",
    ),
    (lambda: td.simulate(PAPER, 0.5, progress=1), "progress must be True, False or None, not 1"),
    (lambda: td.simulate(PAPER, 0.1, duration=10), "error and duration must not both be given"),
    (lambda: td.simulate(PAPER, duration=1e9, budget=1e6), "duration must be below "),
    (lambda: td.simulate(RING, events="right_wall"), "the periodic axis x has no walls"),
    (lambda: td.simulate(RING, events="horizontal_hop"), "x two discs have no order that a hop "),
    (lambda: td.sample(PAPER, 1e6, quantities="any_wall"), "did you mean any_wall_area?"),
    (lambda: td.sample(PAPER, 1).save("\0"), "path must be a file to write, not '\\x00': it has a"),
    (lambda: td.load_result("\0"), "path must be the path of a file, not '\\x00'"),
    (lambda: td.load("src"), "folder must hold tables of results, but 'src' has none"),
    (lambda: td.load("nothere"), "tables of results, but 'nothere' does not exist"),
    *(
        (partial(call, path), "path must be a file to write, not")
        for call, path in (
            (partial(td.plot, BOX), "no/a.png"),
            (partial(td.animate, td.trajectory(PAPER)), "no/a.gif"),
            (td.sample(PAPER, 1).save, "no/a.json"),
        )
    ),
    # States
    *(
        (lambda given=given: td.trajectory(PAPER, start=[*(START | given).values()]), said)
        for given, said in (
            ({"x1": 0.2}, "have the discs apart, with 0.4 or more between their centres, not 0.3"),
            ({"x1": -0.6}, "disc 1 inside the box, with x1 between -0.55 and 0.55, not -0.6"),
            ({"y2": 0.31}, "disc 2 inside the box, with y2 between -0.3 and 0.3, not 0.31"),
            ({"u1": 2.0}, "start must have a total energy of 0.5, not 2.0"),
            ({"v2": NAN}, "start must be the numbers x1, y1, x2, y2, u1, v1, u2, v2, not "),
        )
    ),
    *(
        (
            lambda given=given: td.observe(
                **{"scene": PAPER, "function": x1, "times": [1]} | given
            ),
            said,
        )
        for given, said in (
            ({"times": {1: 0, 0: 0}}, "times must be ascending numbers from 0 on, not [1, 0]"),
            ({"times": [1e9]}, "where 1e7 events are due, not 1e9"),
            ({"function": 1}, "function must take two arrays of states, not be 1"),
            ({"function": lambda a, b: 1.0}, "function must return a real number, or the same"),
            ({"function": lambda a, b: None}, "4096 replicas, not None: is its return missing?"),
            ({"function": lambda a, b: b}, "an array with the fields x1, y1, x2, y2, u1, v1"),
            ({"function": lambda a, b: [b["x1"], [0.0]]}, "4096 replicas, not [array("),
            ({"function": lambda a, b: b["x1"].astype(str)}, "of shape (4096,) and kind <U"),
            ({"function": lambda a, b: b["x1"] + 1j}, "real and imaginary part as two columns"),
        )
    ),
    (lambda: td.trajectory(PAPER).states_at([1e9]), "times must be numbers from 0.0 to "),
    (
        lambda: td.trajectory(PAPER, duration=3)[["time", "x1"]].states_at([1]),
        "rows and lacks y1, x2, y2, u1, v1, u2, v2",
    ),
    # Figures
    (lambda: td.plot(td.sample(PAPER, 1), figure="mean_times"), "figure must be one of volume, "),
    (lambda: td.plot([td.sample(PAPER, 1), 1]), "result must be a scene, a trajectory, results"),
    (
        lambda: td.plot([td.intervals(PAPER, hop, 1) for hop in HOPS]),
        "one kind of hop, not horizontal_hop and vertical_hop",
    ),
    (lambda: td.plot(FIELD), "scene must be two plain discs for a drawing, but it has field"),
    (lambda: td.plot(Box(1.5, 1.0, discs=3)), "for a drawing, but it has discs 3"),
    (lambda: td.animate(PAPER, "a.gif"), "trajectory must be a result of trajectory()"),
    (lambda: td.animate(td.trajectory(PAPER, 0.01), "a.gif"), "trajectory must last two frames"),
]


@pytest.mark.parametrize(("call", "said"), SENTENCES, ids=[said for _, said in SENTENCES])
def test_a_mistake_in_a_call_is_one_sentence(call, said, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "src").mkdir()
    with pytest.raises(InputError) as caught:
        call()
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)
    assert isinstance(caught.value, TypeError) == bool(
        re.search("argument|mean (events|discs)", said)
    )
    assert [path.name for path in tmp_path.iterdir()] == ["src"]


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize(("time", "replica"), [(0.25, 3), (1.5, 4099)])
def test_what_a_function_returns_is_finite_or_its_time_and_replica_are_named(value, time, replica):
    calls = itertools.count()

    def seen(start, now):
        block, step = divmod(next(calls), 2)
        values = np.stack([now["x1"], now["x2"]], axis=1)
        if (block, (0.25, 1.5)[step]) == (replica // len(now), time):
            values[replica % len(now), 1] = value
        return values

    asked = f"function must return finite numbers, not {value} at the time {time} of the replica"
    with pytest.raises(InputError, match=f"^{re.escape(f'{asked} {replica}')}$"):
        td.observe(PAPER, seen, [0.25, 1.5], replicas=5000)


def test_errors_of_events_are_a_mapping():
    found = td.simulate(PAPER, error={"any_wall": 0.5}, events=None, budget=1)
    assert [*found.settings["events"]] == ["any_wall"]


def test_a_result_as_deep_as_no_result_is_refused(tmp_path):
    path = tmp_path / "deep.json"
    path.write_text("[" * 10**5, encoding="utf-8")
    with pytest.raises(InputError, match="path must be a file that save"):
        td.load_result(path)
    with pytest.raises(InputError, match="is not what its job wrote"):
        read_json(path)


# Plain arguments --------------------------------------------------------------------------------

#: Plain arguments: {check: (arguments after the name "x", what follows "x must " in the sentence)}.
CHECKED = [
    (checks.check_number, (2.0, 0.1, 1.0), "lie between 0.1 and 1.0, not 2.0"),
    (checks.check_number, (0, 0.1, 1.0, "ratio"), "be a positive, finite ratio, not 0.0"),
    (checks.check_length, ("1",), "be a positive number, not '1'"),
    (
        checks.check_length,
        ("0,3",),
        "be a positive number, not '0,3'; decimals follow a point, 0.3",
    ),
    (checks.check_length, (1e61,), "lie between 1e-60 and 1e60, not 1e61"),
    (checks.check_integer, (1.0,), "be an integer of at least 1, not 1.0"),
    (checks.check_integer, (True,), "be an integer of at least 1, not True"),
    (checks.check_integer, (0,), "be an integer from 1 to 2^63 - 1, not 0"),
    (checks.check_integer, (2**63,), f"be an integer from 1 to 2^63 - 1, not {2**63}"),
    (checks.check_integer, (6, 2, 5), "be an integer from 2 to 5, not 6"),
    (checks.check_fraction, ("0.5",), "be a number between 0 and 1, not '0.5'"),
    (checks.check_fraction, (True,), "be a number between 0 and 1, not True"),
    *(
        (checks.check_fraction, (bad,), f"lie between 0 and 1, ends excluded, not {bad!r}")
        for bad in (0, 1.0, -0.5, NAN, INF)
    ),
    *(
        (
            checks.check_error,
            (bad,),
            f"be a number above 0 and at most 1, or one of draft, paper, reference, not {bad!r}",
        )
        for bad in (0, 1.1, -0.5, True, "rough", None, [1])
    ),
    (checks.check_choice, ("c", ("a", "b")), "be one of a, b, not 'c'"),
    (checks.check_ascending, ("12",), "be a sequence of numbers, not '12'"),
    (checks.check_ascending, (1.0,), "be a sequence of numbers, not 1.0"),
    (checks.check_ascending, ([],), "ascend and must not be empty, not []"),
    (checks.check_ascending, ([2, 1],), "ascend and must not be empty, not [2.0, 1.0]"),
    (checks.check_ascending, ([1, 1],), "ascend and must not be empty, not [1.0, 1.0]"),
    (checks.check_ascending, ([0, 1],), "be a positive, finite number, not 0.0"),
]


@pytest.mark.parametrize(("check", "arguments", "sentence"), CHECKED)
def test_a_plain_argument_is_named_with_what_is_allowed(check, arguments, sentence):
    with pytest.raises(InputError, match=f"^x must {re.escape(sentence)}$"):
        check("x", *arguments)


# The shell --------------------------------------------------------------------------------------

SIDES = ["--width", "1.5", "--height", "1"]
WORDS = [*SIDES, "--radius", "0.1"]

MISTAKES = [
    (["exact", *SIDES, "--radius", "0.5"], "radius 0.5 does not fit"),
    (["exact", *SIDES, "--radius", "x"], "argument --radius: must be a number, not 'x'"),
    (["exact", *SIDES, "--radius", "0,2"], "not '0,2'; decimals follow a point, 0.2"),
    (["exact", *SIDES], "the following arguments are required: --radius"),
    (["exact", *SIDES, "--radious", "1"], "unrecognized arguments: --radious; did you mean --radi"),
    (["exact", *WORDS, "--rad", "2"], "unrecognized arguments: --rad 2"),
    (["exact", *WORDS, "--mass_ratio=2"], "=2; did you mean --mass-ratio?"),
    (["exact", *WORDS, "--height", "1e99"], "height must lie between"),
    (["exact", *WORDS, "--width", "nan"], "width must be"),
    (["exact", *WORDS, "--mass-ratio", "two"], "argument --mass-ratio: must be a number"),
    (["exact", *WORDS, "volume"], "unrecognized arguments: volume"),
    (["simulate", *WORDS, "--error", "rough"], "must be a number or one of draft, paper"),
    (["simulate", *WORDS, "--error", "2"], "error must be a number above 0 and at most 1"),
    (["simulate", *WORDS, "--budget", "1.5"], "--budget: must be "),
    (["simulate", *WORDS, "--events", "hop"], "event must be one of vertical_hop"),
    (["sample", *WORDS, "--quantities", "mass"], "quantity must be one of volume"),
    (["sample", *WORDS, "--samples", "-1"], "samples must be"),
    (["sample", *WORDS, "--shell", "1"], "shell must"),
    (["sample", *WORDS, "--seed", "x"], "argument --seed: must be"),
    (["trajectory", *WORDS, "--start", "1", "2"], "start must be the numbers x1"),
    (["trajectory", *WORDS, "--duration", "inf"], "duration must be"),
    (["run", "my.yaml", "--core", "2"], "unrecognized arguments: --core"),
]


@pytest.mark.parametrize(("words", "said"), MISTAKES, ids=[said for _, said in MISTAKES])
def test_a_mistake_on_the_command_line_is_one_sentence(monkeypatch, capsys, words, said):
    assert command(monkeypatch, cli, *words) == 2
    shown = capsys.readouterr()
    assert shown.out == ""
    assert shown.err.startswith("error: ")
    assert said in shown.err
    assert shown.err.count("\n") == 1


# The process --------------------------------------------------------------------------------------


@pytest.mark.parametrize("wrong", ["optimized", "another file of the name"])
def test_what_the_workflow_cannot_run_with_is_one_sentence(tmp_path, wrong):
    sources = str(Path(checks.__file__).parents[2])
    environment = os.environ | {"PYTHONPATH": sources, "PYTHONOPTIMIZE": "2"}
    said = "PYTHONOPTIMIZE=2 must not be set: it removes docstrings, which the pages show\n"
    if wrong != "optimized":
        (tmp_path / "twodiscs.py").write_text("raise SystemExit('imported by mistake')\n")
        path = os.pathsep.join((str(tmp_path), sources))
        environment = os.environ | {"PYTHONPATH": path}
        said = (
            f"{tmp_path / 'twodiscs.py'} hides the package twodiscs: give this file another name\n"
        )
    program = [sys.executable, "-c", "import twodiscs_paper.pipeline.cost"]
    run = subprocess.run(program, capture_output=True, text=True, env=environment, cwd=tmp_path)
    assert (run.returncode, run.stdout, run.stderr) == (1, "", said)


@pytest.mark.parametrize("error", [ValueError, KeyError, TypeError, ZeroDivisionError])
def test_a_mistake_in_the_program_keeps_its_traceback(error):
    def mistaken():
        raise error("colour")

    with pytest.raises(error, match="colour"):
        arguments.run(mistaken)
