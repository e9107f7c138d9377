"""What makes no sense is refused: by every public function, in one sentence that says why."""

import json
import math
import re
import subprocess
import sys
from fractions import Fraction

import numpy as np
import pytest
from fabricated import command

from twodiscs.comparison import estimates, scores
from twodiscs.dynamics import counting, intervals, trajectory
from twodiscs.model import checks, effects, radii
from twodiscs.model.box import Box
from twodiscs.model.checks import InputError
from twodiscs.model.events import EVENTS
from twodiscs.model.scene import Scene
from twodiscs.pipeline import arguments, jobs
from twodiscs.pipeline.configuration import load
from twodiscs.sampling import montecarlo
from twodiscs.theory import exact, laws, tails

BOX = Box(1.5, 1.0)
PAPER = BOX.scene(0.2)
NAN, INF = math.nan, math.inf

LENGTHS = [
    NAN, INF, -INF, -1.0, 0.0, -0.0, 0, "1", "", b"1", True, None, [1.0], 1j, 1e-61, 1e61, 10**400,
]  # fmt: skip
RADII = [*LENGTHS, 0.5, 0.4, BOX.largest_radius, 1e3]
SCENES = [None, 1.0, NAN, "scene", (1.5, 1.0, 0.2), {"width": 1.5}, Scene]
NAMES = [None, 1.0, NAN, "", "hop", "vertical hop", b"any_wall", PAPER]
SEEDS = [-1, 1.5, NAN, INF, "1", True, None, 2**64]
COUNTS = [0, -1, 1.5, 1.0, NAN, INF, "1", True, None, 2**64]
INTEGERS = [-1, 1.5, NAN, INF, "1", True, None]
SHARES = [0.0, 1.0, -0.1, 1.1, NAN, INF, "0.1", True, None]
REALS = [NAN, INF, -INF, "1", None, True]
POSITIVE = [*REALS, 0.0, -1.0]
SUM = ("disc_collision", "right_wall", "top_wall")

EFFECTS = [
    1, None, "field", [], ["field"], {"gravity": 1}, {1: 2}, {"field": -1.0}, {"field": "1"},
    {"field": False},
    {"periodic": "xx"}, {"periodic": "z"}, {"periodic": 1}, {"mass_ratio": 0},
    {"radius_ratio": 1e9}, {"moment_of_inertia": 2.0}, {"depth": 1e50},
    {"field": 1.0, "periodic": "y"}, {"periodic": "xy", "moment_of_inertia": 0.4},
    {"depth": 1.0, "moment_of_inertia": 0.4},
]  # fmt: skip

#: Function, arguments that are right, and for each argument what is wrong.
CALLS = [
    (Scene, {"width": 1.5, "height": 1.0, "radius": 0.2},
     {"width": LENGTHS, "height": LENGTHS, "radius": RADII}),
    (PAPER.with_radius, {"radius": 0.1}, {"radius": RADII}),
    (PAPER.is_possible, {"event": "any_wall"}, {"event": NAMES}),
    (checks.length, {"name": "side", "value": 1.0}, {"value": LENGTHS}),
    (Box, {"width": 1.5, "height": 1.0, "effects": {"field": 0.1}},
     {"width": LENGTHS, "height": LENGTHS, "effects": EFFECTS}),
    (BOX.scene, {"radius": 0.2}, {"radius": RADII}),
    (BOX.fits, {"radius": 0.2}, {"radius": LENGTHS}),
    (BOX.threshold, {"event": "any_wall"}, {"event": NAMES}),
    (radii.key, {"radius": 0.2}, {"radius": LENGTHS}),
    (radii.radii, {"width": 1.5, "height": 1.0, "smallest": 0.01, "count": 8},
     {"width": LENGTHS, "height": LENGTHS, "smallest": [*RADII, 0.25], "count": COUNTS}),
    (radii.even_radii, {"smallest": 0.1, "largest": 0.2, "count": 8},
     {"smallest": [*LENGTHS, 0.2, 0.3], "largest": [*LENGTHS, 0.1], "count": COUNTS}),
    (radii.stream_seed, {"seed": 1, "scene": "paper", "method": "dynamics", "key": "0.2"},
     {"seed": [-1, 1.5, NAN, "1", True, None], "method": NAMES}),
    (exact.volume, {"scene": PAPER}, {"scene": SCENES}),
    (exact.areas, {"scene": PAPER}, {"scene": SCENES}),
    (exact.mean_times, {"scene": PAPER}, {"scene": SCENES}),
    (exact.exact, {"scene": PAPER}, {"scene": SCENES}),
    (exact.event_rate, {"scene": PAPER}, {"scene": SCENES}),
    (laws.closed_form, {"scene": PAPER}, {"scene": SCENES}),
    (exact.rate, {"scene": PAPER, "event": "any_wall"}, {"scene": SCENES, "event": NAMES}),
    (laws.threshold_time, {"scene": PAPER, "event": "any_wall"},
     {"scene": SCENES, "event": NAMES}),
    (exact.shell_expectation, {"scene": PAPER, "event": "top_wall", "epsilon": 0.01},
     {"scene": SCENES, "event": [*NAMES, "any_wall"], "epsilon": [*LENGTHS, 0.21]}),
    (laws.small_radius_time, {"box": BOX, "event": "any_wall", "radius": 0.1},
     {"event": NAMES, "radius": [r for r in RADII if isinstance(r, bool) or r != 0]}),
    (laws.leading_law, {"box": BOX, "event": "any_wall"}, {"event": NAMES}),
    (tails.density_at_zero, {"scene": PAPER, "hop": "vertical_hop"},
     {"scene": SCENES, "hop": [*NAMES, "any_wall"]}),
    (tails.tail_constant, {"scene": PAPER, "event": "vertical_hop"},
     {"scene": SCENES, "event": [*NAMES, "any_wall"]}),
    (montecarlo.sample_point,
     {"scene": PAPER, "quantities": ["volume"], "samples": 1, "shell": 0.02, "seed": 1},
     {"scene": SCENES, "quantities": [[], ["mass"], [None], ["any_wall"]], "samples": COUNTS,
      "shell": SHARES, "seed": SEEDS}),
    (montecarlo.conditioned_point,
     {"scene": PAPER, "quantities": ["volume"], "samples": 1, "shell": 0.02, "seed": 1},
     {"scene": SCENES, "quantities": [[], ["mass"], [None], ["any_wall"]], "samples": COUNTS,
      "shell": SHARES, "seed": SEEDS}),
    (montecarlo.shell_thickness, {"scene": PAPER, "event": "top_wall", "fraction": 0.02},
     {"scene": SCENES, "event": NAMES, "fraction": SHARES}),
    (counting.count_events, {"scene": PAPER, "target": {"any_wall": 0.1}, "budget": 1, "seed": 1},
     {"scene": SCENES, "budget": COUNTS, "seed": SEEDS,
      "target": [{}, None, "any_wall", 0.1, {"hop": 0.1}, {None: 0.1},
                  *({"any_wall": share} for share in SHARES)]}),
    (intervals.hop_intervals,
     {"scene": PAPER, "event": "vertical_hop", "intervals": 1, "seed": 1},
     {"scene": SCENES, "event": [*NAMES, "any_wall"], "intervals": COUNTS, "seed": SEEDS}),
    (trajectory.trajectory, {"scene": PAPER, "seed": 1}, {"scene": SCENES, "seed": SEEDS}),
    (counting.replica_duration, {"scene": PAPER}, {"scene": SCENES}),
    (estimates.Estimate, {"value": 1.0, "stderr": 0.1, "n": 10},
     {"value": REALS, "stderr": [*REALS, -0.1], "n": COUNTS}),
    (estimates.normal_quantile, {"confidence": 0.95}, {"confidence": SHARES}),
    (scores.student_deviate, {"t": 1.0, "degrees": 10}, {"t": REALS, "degrees": COUNTS}),
    (estimates.binomial_estimate, {"hits": 1, "samples": 10, "measure": 1.0},
     {"hits": [*INTEGERS, 11], "samples": COUNTS, "measure": POSITIVE}),
    (scores.binomial_z, {"hits": 1, "samples": 10, "probability": 0.1},
     {"hits": [*INTEGERS, 11], "samples": COUNTS,
      "probability": [*REALS, -0.1, 1.1]}),
    (estimates.effective_count, {"total": 10, "squares": 20, "replicas": 10},
     {"total": [*INTEGERS, 21], "squares": [*INTEGERS, 9], "replicas": COUNTS}),
    (estimates.mean_time, {"total": 10, "squares": 20, "replicas": 10, "duration": 1.0},
     {"total": [*INTEGERS, 21], "squares": [*INTEGERS, 9], "replicas": [*COUNTS, 1],
      "duration": POSITIVE}),
    (scores.mean_time_z,
     {"total": 10, "squares": 20, "replicas": 10, "duration": 1.0, "exact": 1.0},
     {"total": INTEGERS, "squares": [*INTEGERS, 9], "replicas": COUNTS, "duration": POSITIVE,
      "exact": [x for x in POSITIVE if x is not None]}),
    (estimates.mean_time_bound, {"replicas": 10, "duration": 1.0, "confidence": 0.95},
     {"replicas": COUNTS, "duration": POSITIVE, "confidence": SHARES}),
    (estimates.sum_rule,
     {"scene": PAPER, "duration": 1.0, "replicas": 5,
      "counts": dict.fromkeys(SUM, 1), "products": {f"{a}*{b}": 1 for a in SUM for b in SUM}},
     {"duration": POSITIVE}),
    (estimates.mean_of, {"values": [1.0, 2.0]}, {"values": [[], [1.0], [NAN, 1.0]]}),
    (scores.bonferroni_bound, {"comparisons": 10, "alarm": 0.1},
     {"comparisons": COUNTS, "alarm": SHARES}),
    (scores.z_mean, {"z": [1.0]}, {"z": [[], [NAN], ["1"], [None]]}),
    (scores.z_spread, {"z": [1.0]}, {"z": [[], [NAN], ["1"], [None]]}),
]  # fmt: skip

#: Where an argument holds several things, how a sentence may name the one that is wrong.
INSIDE = {
    "value": ["side"],
    "values": ["value"],
    "effects": effects.EFFECTS,
    "largest": ["smallest"],
    "quantities": ["quantity"],
    "target": ["event"],
}

SWEEP = [
    pytest.param(function, good, name, value, id=f"{function.__qualname__}-{name}-{value!r:.20}")
    for function, good, wrong in CALLS
    for name, values in wrong.items()
    for value in values
]


@pytest.mark.parametrize(("function", "good"), [(f, good) for f, good, _ in CALLS])
def test_what_is_right_is_taken(function, good):
    function(**good)


@pytest.mark.parametrize(("function", "good", "name", "value"), SWEEP)
def test_what_is_wrong_is_refused(function, good, name, value):
    with pytest.raises(InputError, match=r"\w") as caught:
        function(**good | {name: value})
    sentence = str(caught.value)
    assert "\n" not in sentence
    assert 10 < len(sentence) < 300
    assert re.search(r"must|does not fit|has no|is blocked|name", sentence), sentence
    assert any(word in sentence for word in (name, *INSIDE.get(name, ()))), sentence


def test_swapped_arguments_are_refused():
    for function in (exact.rate, laws.threshold_time):
        with pytest.raises(InputError, match="scene must be a Scene, not 'any_wall'"):
            function("any_wall", PAPER)
    with pytest.raises(InputError, match="scene must be a Scene"):
        montecarlo.sample_point(["volume"], PAPER, 1, 0.02, 1)
    with pytest.raises(InputError, match="scene must be a Scene"):
        counting.count_events({"any_wall": 0.1}, PAPER, 10, 1)
    with pytest.raises(InputError, match="does not fit"):
        Scene(0.2, 1.0, 1.5)


@pytest.mark.parametrize("kind", [int, np.float64, np.float32, Fraction, np.int64])
def test_other_kinds_of_numbers_are_taken(kind):
    assert Scene(kind(4), kind(3), 0.5) == Scene(4.0, 3.0, 0.5)


@pytest.mark.parametrize("radius", [0.4, 0.5, 0.75, 1.0, 10.0])
def test_a_radius_that_does_not_fit_is_named_with_the_largest_one(radius):
    with pytest.raises(InputError, match=rf"radius {radius!r} does not fit.*0\.38397"):
        Scene(1.5, 1.0, radius)


@pytest.mark.parametrize("sides", [(1.5, 1.0), (1.0, 1.0), (2.0, 1.0), (3.0, 1.0), (1.0, 7.0)])
def test_beyond_the_largest_radius_there_is_no_scene(sides):
    box = Box(*sides)
    for more in (1e-15, 1e-9):
        radius = box.largest_radius * (1 + more)
        assert not box.fits(radius)
        with pytest.raises(InputError, match="does not fit"):
            box.scene(radius)


@pytest.mark.parametrize("mapping", [None, [], "paper", 1, {}, {"scenes": []}, {"scenes": [{}]}])
def test_a_configuration_that_makes_no_sense(mapping):
    with pytest.raises(InputError, match=r"\w"):
        load.load(mapping)


# Jobs -------------------------------------------------------------------------------------------

PLACE = {"box": BOX.parameters(), "radius": 0.2, "seed": 1}
EXACT = {"box": BOX.parameters(), "radii": [0.1, 0.2]}
JOBS = {
    "grid": (("table", "theory.exact", "--function", "grid_rows"), EXACT),
    "theory": (("table", "theory.exact", "--function", "theory_rows"), EXACT),
    "monte_carlo": (
        ("point", "sampling.montecarlo"),
        PLACE | {"areas": [], "samples": 1, "shell": 0.02, "volume": True},
    ),
    "dynamics": (
        ("point", "dynamics.counting"),
        PLACE | {"accuracy": {"any_wall": 0.1}, "event_budget": 1},
    ),
    "intervals": (
        ("point", "dynamics.intervals"), PLACE | {"event": "vertical_hop", "intervals": 1}
    ),
    "trajectory": (("table", "dynamics.trajectory"), PLACE),
}  # fmt: skip
MISTAKES = {
    "box": [1, [], {}, {"width": 1.5}, {"width": 1.5, "height": 1.0, "mass": 1}],
    "width": [-1.0, 0, INF, "1.5", None, [1.5], True],
    "height": [-1.0, INF, "1"],
    "effects": [some for some in EFFECTS if some is not None] + [{"radius_ratio": 4.0}],
    "radius": [0.4, 0, -0.2, INF, "0.2"],
    "radii": [[0.1, 0.5], [0.1, -0.1], ["0.1"]],
    "seed": [-1, 1.5, "1"],
    "samples": [0, 1.5, "1"],
    "intervals": [0, 1.5],
    "event_budget": [0, 1e6],
    "accuracy": [{}, {"hop": 0.1}, {"any_wall": 0}, {"any_wall": "0.1"}, 0.1],
    "event": ["hop", 3],
}
CASES = [
    (job, name, value)
    for job, (_, good) in JOBS.items()
    for name in (*good, *BOX.parameters(), "effects")
    for value in MISTAKES.get(name, [])
]


@pytest.fixture
def refused(capsys, monkeypatch, tmp_path):
    """A function that runs a job with parameters that make no sense and returns what it says."""

    def run(job, text):
        # JSON knows no infinity, but a number that is too large becomes one.
        text = text.replace("Infinity", "1e999")
        output = tmp_path / f"{job}.csv"
        words = (*JOBS[job][0], "--parameters", text, "--output", output)
        assert command(monkeypatch, jobs, *words) == 2
        said = capsys.readouterr().err
        assert said.startswith("error: ")
        assert said.count("\n") == 1
        assert not output.exists()
        return said

    return run


@pytest.mark.parametrize("job", JOBS)
def test_jobs_take_what_is_right(job, monkeypatch, tmp_path):
    words, good = JOBS[job]
    output = tmp_path / f"{job}.csv"
    assert command(monkeypatch, jobs, *words, "--parameters", good, "--output", output) == 0
    assert output.exists()


@pytest.mark.parametrize(("job", "name", "value"), CASES)
def test_jobs_refuse_in_one_sentence(job, name, value, refused):
    good = JOBS[job][1]
    inside = name in ("width", "height", "effects")
    wrong = {"box": good["box"] | {name: value}} if inside else {name: value}
    refused(job, json.dumps(good | wrong))


@pytest.mark.parametrize("job", JOBS)
def test_jobs_want_all_their_parameters_and_no_others(job, refused):
    good = JOBS[job][1]
    for name in good:
        wrong = {key: value for key, value in good.items() if key != name}
        assert f"missing a required argument: '{name}'" in refused(job, json.dumps(wrong))
    assert "unexpected keyword argument 'mass'" in refused(job, json.dumps(good | {"mass": 1}))


@pytest.mark.parametrize("job", JOBS)
@pytest.mark.parametrize("text", ["", "1", "[]", "{", '{"radius": NaN}', "__import__('os')"])
def test_jobs_want_an_object(job, text, refused):
    assert refused(job, text).startswith("error: parameters must be a JSON object, not ")


@pytest.mark.parametrize(
    "words",
    [
        ("--width", "nan", "--height", "1", "--radius", "0.2"),
        ("--width", "inf", "--height", "1", "--radius", "0.2"),
        ("--width", "1.5", "--height", "-1", "--radius", "0.2"),
        ("--width", "1.5", "--height", "1", "--radius", "0"),
        ("--width", "1.5", "--height", "1", "--radius", "0.4"),
        ("--width", "0.2", "--height", "1", "--radius", "1.5"),
        ("--width", "wide", "--height", "1", "--radius", "0.2"),
        ("--width", "1.5", "--height", "1"),
    ],
)
def test_exact_numbers_of_nonsense_are_refused(words):
    program = [sys.executable, "-m", "twodiscs.cli", "exact", *words, "--json"]
    run = subprocess.run(program, capture_output=True, text=True)
    assert run.returncode == 2
    assert run.stdout == ""
    assert run.stderr.startswith("error: ")
    assert run.stderr.count("\n") == 1


@pytest.mark.parametrize("error", [ValueError, KeyError, TypeError, ZeroDivisionError])
def test_a_mistake_in_the_program_keeps_its_traceback(error):
    def mistaken():
        raise error("colour")

    with pytest.raises(error, match="colour"):
        arguments.run(mistaken)


def test_every_event_has_an_exact_answer():
    assert set(exact.mean_times(PAPER)) == set(EVENTS)
