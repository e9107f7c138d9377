"""Bad input: every public function raises an error whose one sentence says why."""

import itertools
import math
import os
import re
import subprocess
import sys
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import twodiscs as td
from twodiscs import arguments
from twodiscs.comparison import scores
from twodiscs.dynamics import counting, intervals, trajectory
from twodiscs.model import checks, effects, radii
from twodiscs.model.box import Box
from twodiscs.model.checks import InputError
from twodiscs.model.events import EVENTS
from twodiscs.model.scene import Scene
from twodiscs.points import estimates
from twodiscs.points.base import read_json
from twodiscs.sampling import montecarlo
from twodiscs.theory import exact, laws, virial
from twodiscs_paper.configuration import load

BOX = Box(1.5, 1.0)
PAPER = BOX.scene(0.2)
NAN, INF = math.nan, math.inf
POINT = {"scene": PAPER, "quantities": ["volume"], "samples": 1, "shell": 0.02, "seed": 1}

#: Public functions with arguments that are right.
CALLS = [
    (Scene, {"width": 1.5, "height": 1.0, "radius": 0.2}),
    (PAPER.with_radius, {"radius": 0.1}),
    (PAPER.is_possible, {"event": "any_wall"}),
    (Box, {"width": 1.5, "height": 1.0, "effects": {"field": 0.1}}),
    (BOX.scene, {"radius": 0.2}),
    (BOX.threshold, {"event": "any_wall"}),
    (checks.check_length, {"name": "side", "value": 1.0}),
    (radii.radii, {"width": 1.5, "height": 1.0, "smallest": 0.01, "count": 8}),
    (radii.even_radii, {"smallest": 0.1, "largest": 0.2, "count": 8}),
    (radii.stream_seed, {"seed": 1, "scene": "paper", "method": "dynamics", "key": "0.2"}),
    *((f, {"scene": PAPER}) for f in (exact.volume, exact.areas, exact.mean_times, exact.exact)),
    *((f, {"scene": PAPER}) for f in (exact.event_rate, laws.closed_form)),
    (counting.replica_duration, {"scene": PAPER}),
    *((f, {"scene": PAPER, "event": "any_wall"}) for f in (exact.rate, laws.threshold_time)),
    (exact.shell_expectation, {"scene": PAPER, "event": "top_wall", "epsilon": 0.01}),
    (laws.small_radius_time, {"box": BOX, "event": "any_wall", "radius": 0.1}),
    (laws.leading_law, {"box": BOX, "event": "any_wall"}),
    (laws.density_at_zero, {"scene": PAPER, "hop": "vertical_hop"}),
    (laws.tail_constant, {"scene": PAPER, "event": "vertical_hop"}),
    (montecarlo.sample_point, POINT),
    (montecarlo.conditioned_point, POINT),
    (montecarlo.shell_thickness, {"scene": PAPER, "event": "top_wall", "fraction": 0.02}),
    (counting.count_events, {"scene": PAPER, "target": {"any_wall": 0.1}, "budget": 1, "seed": 1}),
    (intervals.hop_intervals, {"scene": PAPER, "event": "vertical_hop", "intervals": 1, "seed": 1}),
    (trajectory.trajectory, {"scene": PAPER, "seed": 1}),
    (estimates.Estimate, {"value": 1.0, "stderr": 0.1, "n": 10}),
    (estimates.normal_quantile, {"confidence": 0.95}),
    (estimates.binomial_estimate, {"hits": 1, "samples": 10, "measure": 1.0}),
    (estimates.effective_count, {"total": 10, "squares": 20, "replicas": 10}),
    (estimates.mean_time, {"total": 10, "squares": 20, "replicas": 10, "duration": 1.0}),
    (estimates.mean_time_bound, {"replicas": 10, "duration": 1.0, "confidence": 0.95}),
    (estimates.mean_of, {"values": [1.0, 2.0]}),
    (virial.weights, {"scene": PAPER}),
    (scores.student_deviate, {"t": 1.0, "degrees": 10}),
    (scores.binomial_z, {"hits": 1, "samples": 10, "probability": 0.1}),
    (
        scores.mean_time_z,
        {"total": 10, "squares": 20, "replicas": 10, "duration": 1.0, "exact": 1.0},
    ),
    (scores.bonferroni_bound, {"comparisons": 10, "alarm": 0.1}),
    (scores.z_mean, {"z": [1.0]}),
    (scores.z_spread, {"z": [1.0]}),
]  # fmt: skip

#: Wrong values for each of these arguments, one of each kind.
LENGTH = [-1.0, 0.0, INF, 1e-61, 1e61, "1", True]
RADIUS = [*LENGTH, 0.4, BOX.largest_radius]
REAL = [INF, "1", None, True]
POSITIVE = [*REAL[:2], 0.0, -1.0]
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
NUMBERS = [[], [NAN], ["1"], [None]]
WRONG = (
    dict.fromkeys(("width", "height", "value", "epsilon"), LENGTH)
    | {"radius": RADIUS, "smallest": RADIUS, "largest": [*LENGTH, 0.1], "effects": EFFECTS}
    | dict.fromkeys(("count", "samples", "intervals", "budget", "n"), COUNT)
    | dict.fromkeys(("replicas", "degrees", "comparisons"), COUNT)
    | {"seed": INTEGER, "hits": [*INTEGER, 11], "total": [*INTEGER, 21], "squares": [*INTEGER, 9]}
    | dict.fromkeys(("shell", "fraction", "confidence", "alarm"), PART)
    | dict.fromkeys(("measure", "duration", "exact"), POSITIVE)
    | {"stderr": [*REAL, -0.1], "t": REAL, "probability": [*REAL, 1.1], "target": TARGET}
    | {"scene": [1.0, "scene", (1.5, 1.0, 0.2), Scene], "method": EVENT, "event": EVENT}
    | {"hop": [*EVENT, "any_wall"], "quantities": [[], ["mass"], [None], ["any_wall"]]}
    | {"values": [[], [1.0], [NAN, 1.0]], "z": NUMBERS}
)

#: Right values that are wrong elsewhere: any finite value, any text for the name of a scene.
RIGHT = {
    (estimates.Estimate, "value"): [-1.0, 0.0, 1e-61, 1e61],
    (estimates.Estimate, "stderr"): [None],
    (laws.small_radius_time, "radius"): [0.0],
    (radii.stream_seed, "scene"): ["scene"],
}

#: No argument may be such a thing, or hold it where it is a list.
JUNK = st.one_of(st.just(NAN), st.complex_numbers(), st.binary(max_size=3), st.builds(object))
LISTS = {"quantities", "z"}

#: The possible names of the wrong part of an argument with several parts.
INSIDE = {
    "value": ["side"],
    "values": ["value"],
    "effects": effects.EFFECTS,
    "largest": ["smallest"],
    "quantities": ["quantity"],
    "replicas": ["n"],
    "target": ["event"],
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
    if name != "values":  # of estimates.mean_of, which takes what numpy takes
        refused(function, good, name, [value] if name in LISTS else value)


def test_swapped_arguments_are_refused():
    for function in (exact.rate, laws.threshold_time):
        with pytest.raises(InputError, match="scene must be a Scene, not 'any_wall'"):
            function("any_wall", PAPER)
    with pytest.raises(InputError, match="does not fit"):
        Scene(0.2, 1.0, 1.5)


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


@pytest.mark.parametrize("mapping", [{}, {"scenes": []}, {"scenes": [{}]}])
def test_a_configuration_that_makes_no_sense(mapping):
    with pytest.raises(InputError, match=r"\w"):
        load.load(mapping)


# The face ---------------------------------------------------------------------------------------


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


@pytest.mark.parametrize("events", [{"vertical_hop": 1e-9}, {}, b"vertical_hop", 5])
def test_events_with_numbers_are_refused(events):
    """The relative errors of events are a mapping; ``events`` would ignore the numbers of one."""
    with pytest.raises(InputError, match=r"^events must be some of vertical_hop, "):
        td.simulate(PAPER, error=0.5, events=events)
    with pytest.raises(InputError, match=r"^quantities must be some of volume, "):
        td.sample(PAPER, 10, quantities=events)


def test_errors_of_events_are_a_mapping():
    found = td.simulate(PAPER, error={"any_wall": 0.5}, events=None, budget=1)
    assert [*found.settings["events"]] == ["any_wall"]


def test_a_null_character_makes_no_path(tmp_path):
    with pytest.raises(InputError, match=r"^path must be the path of a file, not '\\x00'$"):
        td.load_result("\0")
    with pytest.raises(
        InputError, match=r"^path must be a file to write, not '\\x00': it has a null"
    ):
        td.sample(PAPER, 1).save("\0")


@pytest.mark.parametrize("name", ["discs", "width", "radius", "field", "periodic"])
def test_arrays_are_no_numbers(name):
    with pytest.raises(InputError, match=rf"^{name} must be .*, not array\(\[0\.1, 0\.2\]\)$"):
        td.Scene(**{"width": 1.5, "height": 1.0, "radius": 0.2} | {name: np.array([0.1, 0.2])})


def test_a_result_as_deep_as_no_result_is_refused(tmp_path):
    path = tmp_path / "deep.json"
    path.write_text("[" * 10**5, encoding="utf-8")
    with pytest.raises(InputError, match="path must be a file that save"):
        td.load_result(path)
    with pytest.raises(InputError, match="is not what its job wrote"):
        read_json(path)


# One sentence for each mistake ------------------------------------------------------------------

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


#: Scenes 1.5 × 1 with a radius of 0.1, and the start of the sentence.
SCENES = [
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
    ({"discs": 3, "periodic": "xy"}, "periodic must be left out or x for more than two discs"),
    ({"discs": 3, "periodic": "y"}, "periodic must be left out or x for more than two discs"),
    ({"discs": 3, "radius": 0.31}, "radius 0.31 does not fit: 3 discs in a box of 1.5 × 1.0"),
    ({"discs": 4, "radius": 0.4}, "radius 0.4 does not fit: 4 discs"),
    ({"discs": 4, "radius": 0.376, "periodic": "x"}, "radius 0.376 does not fit"),
    ({"discs": 64, "width": 1e5}, "width and height must be in a unit of length in which"),
]


@pytest.mark.parametrize(("values", "sentence"), SCENES)
def test_a_scene_that_cannot_be_is_refused(values, sentence):
    with pytest.raises(InputError, match=f"^{re.escape(sentence)}"):
        Scene(**{"width": 1.5, "height": 1.0, "radius": 0.1} | values)


def test_a_ring_is_not_turned():
    with pytest.raises(InputError, match="periodic must be left out or x"):
        Scene(1.5, 1.0, 0.1, discs=3, periodic="x").turned()


# Jobs -------------------------------------------------------------------------------------------


def test_exact_numbers_of_nonsense_are_refused():
    words = ("--width", "nan", "--height", "1", "--radius", "0.2")
    program = [sys.executable, "-m", "twodiscs.cli", "exact", *words, "--json"]
    run = subprocess.run(program, capture_output=True, text=True)
    assert (run.returncode, run.stdout) == (2, "")
    assert run.stderr.startswith("error: ")
    assert run.stderr.count("\n") == 1


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


def test_every_event_has_an_exact_answer():
    assert set(exact.mean_times(PAPER)) == set(EVENTS)
