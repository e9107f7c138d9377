"""What makes no sense is refused: by every public function, in one sentence that says why."""

import math
import re
import subprocess
import sys
from fractions import Fraction

import numpy as np
import pytest

from twodiscs.comparison import estimates, scores, tables
from twodiscs.dynamics import counting, intervals, trajectory
from twodiscs.model import box, checks, radii
from twodiscs.model.box import largest_radius
from twodiscs.model.events import EVENTS
from twodiscs.model.scene import Scene
from twodiscs.pipeline import arguments
from twodiscs.pipeline.configuration import load
from twodiscs.sampling import montecarlo
from twodiscs.theory import exact, laws

PAPER = Scene(1.5, 1.0, 0.2)
NAN, INF = math.nan, math.inf

LENGTHS = [NAN, INF, -INF, -1.0, 0.0, -0.0, 0, "1", "", b"1", True, None, [1.0], 1j, 1e-61, 1e61]
RADII = [*LENGTHS, 0.5, 0.4, largest_radius(1.5, 1.0), 1e3]
SCENES = [None, 1.0, NAN, "scene", (1.5, 1.0, 0.2), {"width": 1.5}, Scene]
NAMES = [None, 1.0, NAN, "", "hop", "vertical hop", b"any_wall", PAPER]
SEEDS = [-1, 1.5, NAN, INF, "1", True, None, 2**64]
COUNTS = [0, -1, 1.5, 1.0, NAN, INF, "1", True, None, 2**64]
SHARES = [0.0, 1.0, -0.1, 1.1, NAN, INF, "0.1", True, None]
REALS = [NAN, INF, -INF, "1", None, True]
POSITIVE = [*REALS, 0.0, -1.0]


def normal(low, high):
    return estimates.Estimate(low, high, 10)


#: Function, arguments that are right, and for each argument what is wrong.
CALLS = [
    (Scene, {"width": 1.5, "height": 1.0, "radius": 0.2},
     {"width": LENGTHS, "height": LENGTHS, "radius": RADII}),
    (PAPER.with_radius, {"radius": 0.1}, {"radius": RADII}),
    (PAPER.is_possible, {"event": "any_wall"}, {"event": NAMES}),
    (checks.length, {"name": "side", "value": 1.0}, {"value": LENGTHS}),
    (largest_radius, {"width": 1.5, "height": 1.0}, {"width": LENGTHS, "height": LENGTHS}),
    (box.fits, {"width": 1.5, "height": 1.0, "radius": 0.2},
     {"width": LENGTHS, "height": LENGTHS, "radius": LENGTHS}),
    (radii.key, {"radius": 0.2}, {"radius": LENGTHS}),
    (box.thresholds, {"width": 1.5, "height": 1.0}, {"width": LENGTHS, "height": LENGTHS}),
    (radii.radii, {"width": 1.5, "height": 1.0, "smallest": 0.01, "count": 8},
     {"width": LENGTHS, "height": LENGTHS, "smallest": [*RADII, 0.25], "count": COUNTS}),
    (radii.stream_seed, {"root": 1, "scene": "paper", "method": "dynamics", "key": "0.2"},
     {"root": [-1, 1.5, NAN, "1", True, None], "method": NAMES}),
    (exact.volume, {"scene": PAPER}, {"scene": SCENES}),
    (exact.areas, {"scene": PAPER}, {"scene": SCENES}),
    (exact.mean_times, {"scene": PAPER}, {"scene": SCENES}),
    (exact.exact, {"scene": PAPER}, {"scene": SCENES}),
    (laws.closed_form, {"scene": PAPER}, {"scene": SCENES}),
    (exact.rate, {"scene": PAPER, "event": "any_wall"}, {"scene": SCENES, "event": NAMES}),
    (laws.threshold_time, {"scene": PAPER, "event": "any_wall"},
     {"scene": SCENES, "event": NAMES}),
    (exact.shell_expectation, {"scene": PAPER, "event": "top_wall", "epsilon": 0.01},
     {"scene": SCENES, "event": [*NAMES, "any_wall"], "epsilon": [*LENGTHS, 0.21]}),
    (laws.small_radius_time,
     {"width": 1.5, "height": 1.0, "event": "any_wall", "radius": 0.1},
     {"width": LENGTHS, "height": LENGTHS, "event": NAMES,
      "radius": [r for r in RADII if isinstance(r, bool) or r != 0]}),
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
     {"hits": [-1, 11, 1.5, NAN, "1", True, None], "samples": COUNTS, "measure": POSITIVE}),
    (scores.binomial_z, {"hits": 1, "samples": 10, "probability": 0.1},
     {"hits": [-1, 11, 1.5, NAN, "1", True, None], "samples": COUNTS,
      "probability": [*REALS, -0.1, 1.1]}),
    (estimates.effective_count, {"total": 10, "squares": 20, "replicas": 10},
     {"total": [-1, 1.5, "1", NAN, 21], "squares": [-1, 1.5, "1", 9], "replicas": COUNTS}),
    (estimates.mean_time, {"total": 10, "squares": 20, "replicas": 10, "duration": 1.0},
     {"total": [-1, 1.5, "1", NAN, 21], "squares": [-1, 1.5, "1", 9], "replicas": [*COUNTS, 1],
      "duration": POSITIVE}),
    (scores.mean_time_z,
     {"total": 10, "squares": 20, "replicas": 10, "duration": 1.0, "exact": 1.0},
     {"total": [-1, 1.5, "1", NAN], "replicas": COUNTS, "duration": POSITIVE,
      "exact": [x for x in POSITIVE if x is not None]}),
    (estimates.mean_time_bound, {"replicas": 10, "duration": 1.0, "confidence": 0.95},
     {"replicas": COUNTS, "duration": POSITIVE, "confidence": SHARES}),
    (scores.bonferroni_bound, {"comparisons": 10, "alarm": 0.1},
     {"comparisons": COUNTS, "alarm": SHARES}),
    (estimates.coverage, {"estimates": [normal(1.0, 0.1)], "exact": 1.0, "confidence": 0.95},
     {"estimates": [[]], "confidence": SHARES}),
    (scores.z_mean, {"z": [1.0]}, {"z": [[], [NAN], ["1"], [None]]}),
    (scores.z_spread, {"z": [1.0]}, {"z": [[], [NAN], ["1"], [None]]}),
]  # fmt: skip

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
    with pytest.raises(ValueError, match=r"\w") as caught:
        function(**good | {name: value})
    sentence = str(caught.value)
    assert "\n" not in sentence
    assert 10 < len(sentence) < 300
    assert re.search(r"must|does not fit|has no|is blocked|name", sentence), sentence


def test_swapped_arguments_are_refused():
    for function in (exact.rate, laws.threshold_time):
        with pytest.raises(ValueError, match="scene must be a Scene, not 'any_wall'"):
            function("any_wall", PAPER)
    with pytest.raises(ValueError, match="scene must be a Scene"):
        montecarlo.sample_point(["volume"], PAPER, 1, 0.02, 1)
    with pytest.raises(ValueError, match="scene must be a Scene"):
        counting.count_events({"any_wall": 0.1}, PAPER, 10, 1)
    with pytest.raises(ValueError, match="does not fit"):
        Scene(0.2, 1.0, 1.5)


@pytest.mark.parametrize("kind", [int, np.float64, np.float32, Fraction, np.int64])
def test_other_kinds_of_numbers_are_taken(kind):
    assert Scene(kind(4), kind(3), 0.5) == Scene(4.0, 3.0, 0.5)


@pytest.mark.parametrize("radius", [0.4, 0.5, 0.75, 1.0, 10.0])
def test_a_radius_that_does_not_fit_is_named_with_the_largest_one(radius):
    with pytest.raises(ValueError, match=rf"radius {radius!r} does not fit.*0\.38397"):
        Scene(1.5, 1.0, radius)


def test_the_largest_radius_itself_is_one_too_many():
    for width, height in ((1.5, 1.0), (1.0, 1.0), (2.0, 1.0), (3.0, 1.0), (1.0, 7.0)):
        largest = largest_radius(width, height)
        for radius in (largest * (1 + 1e-15), largest * (1 + 1e-9)):
            with pytest.raises(ValueError, match="does not fit"):
                Scene(width, height, radius)


@pytest.mark.parametrize("mapping", [None, [], "paper", 1, {}, {"scenes": []}, {"scenes": [{}]}])
def test_a_configuration_that_makes_no_sense(mapping):
    with pytest.raises(ValueError, match=r"\w"):
        load.load(mapping)


def test_tables_that_make_no_sense(tmp_path):
    for name in (None, "volumes", 3):
        with pytest.raises(ValueError, match="table must be one of"):
            tables.write(tmp_path / "x.csv", name, [])
        with pytest.raises(ValueError, match="table must be one of"):
            tables.read(tmp_path / "x.csv", name)


# The command line ---------------------------------------------------------------------------------

BOX = {"width": 1.5, "height": 1.0}
POINT = BOX | {"radius": 0.2, "seed": 1}
JOBS = {
    "grid": BOX | {"radii": (0.1, 0.2)},
    "theory": BOX | {"radii": (0.1, 0.2)},
    "montecarlo": POINT | {"areas": [], "samples": 1, "shell": 0.02, "volume": True},
    "dynamics": POINT | {"accuracy": {"any_wall": 0.1}, "event_budget": 1},
    "intervals": POINT | {"event": "vertical_hop", "intervals": 1},
    "trajectory": POINT,
}
MISTAKES = {
    "width": ["-1.0", "0", "1e999", "'1.5'", "None", "[1.5]", "True"],
    "height": ["-1.0", "1e999", "'1'"],
    "radius": ["0.4", "0", "-0.2", "1e999", "'0.2'"],
    "radii": ["(0.1, 0.5)", "(0.1, -0.1)", "('0.1',)"],
    "seed": ["-1", "1.5", "'1'"],
    "samples": ["0", "1.5", "'1'"],
    "intervals": ["0", "1.5"],
    "event_budget": ["0", "1e6"],
    "accuracy": ["{}", "{'hop': 0.1}", "{'any_wall': 0}", "{'any_wall': '0.1'}", "0.1"],
    "event": ["'hop'", "3"],
}
EFFECTS = [
    "1", "None", "['field']", "{'gravity': 1}", "{'field': -1.0}", "{'field': '1'}",
    "{'periodic': 'xx'}", "{'periodic': 'z'}", "{'periodic': 1}", "{'mass_ratio': 0}",
    "{'radius_ratio': 1e9}", "{'radius_ratio': 4.0}", "{'moment_of_inertia': 2.0}",
    "{'field': 1.0, 'periodic': 'y'}", "{'periodic': 'xy', 'moment_of_inertia': 0.4}",
    "{'field': False}", "{'depth': 1e50}", "{'depth': 1.0, 'moment_of_inertia': 0.4}",
]  # fmt: skip
CASES = [
    (job, name, text)
    for job, good in JOBS.items()
    for name in good
    for text in MISTAKES.get(name, [])
] + [(job, "effects", text) for job in JOBS for text in EFFECTS]


def run_job(job, text, capsys, monkeypatch, tmp_path):
    """Run a job in this process; return (exit status, what it said, its output file)."""
    from importlib import import_module

    module, output = import_module(f"twodiscs.cli.{job}"), tmp_path / "output"
    words = ["--parameters", text, "--output", str(output)]
    monkeypatch.setattr(sys, "argv", [job, *words])
    with pytest.raises(SystemExit) as end:
        arguments.run(module.main)
    return end.value.code, capsys.readouterr().err, output


@pytest.mark.parametrize(("job", "name", "text"), CASES)
def test_jobs_refuse_in_one_sentence(job, name, text, capsys, monkeypatch, tmp_path):
    parts = {key: repr(value) for key, value in JOBS[job].items()} | {name: text}
    parameters = "{" + ", ".join(f"{key!r}: {value}" for key, value in parts.items()) + "}"
    status, said, output = run_job(job, parameters, capsys, monkeypatch, tmp_path)
    assert status == 2
    assert said.startswith("error: ")
    assert said.count("\n") == 1
    assert not output.exists()


@pytest.mark.parametrize("job", JOBS)
def test_jobs_want_all_their_parameters_and_no_others(job, capsys, monkeypatch, tmp_path):
    for wrong in ({k: v for k, v in JOBS[job].items() if k != "width"}, JOBS[job] | {"mass": 1}):
        status, said, output = run_job(job, repr(wrong), capsys, monkeypatch, tmp_path)
        assert status == 2
        assert said.startswith(f"error: parameters must be {', '.join(sorted(JOBS[job]))}, not ")
        assert not output.exists()


@pytest.mark.parametrize("job", JOBS)
@pytest.mark.parametrize("text", ["", "1", "[]", "{", "{'width': nan}", "__import__('os')"])
def test_jobs_want_a_dict(job, text, capsys, monkeypatch, tmp_path):
    status, said, output = run_job(job, text, capsys, monkeypatch, tmp_path)
    assert status == 2
    assert said.startswith("error: parameters must be a Python dict")
    assert said.count("\n") == 1
    assert not output.exists()


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
    command = [sys.executable, "-m", "twodiscs.cli.main", "exact", *words, "--json"]
    run = subprocess.run(command, capture_output=True, text=True)
    assert run.returncode == 2
    assert run.stdout == ""
    assert run.stderr.startswith("error: ")
    assert run.stderr.count("\n") == 1


def test_every_event_has_an_exact_answer():
    assert set(exact.mean_times(PAPER)) == set(EVENTS)
