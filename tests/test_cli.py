"""The command lines: exact numbers for people and scripts, and mistakes as one sentence."""

import json
import subprocess
import sys

import pytest

from twodiscs.cli import main
from twodiscs.model import effects
from twodiscs.model.events import EVENTS
from twodiscs.model.scene import Scene
from twodiscs.pipeline import arguments
from twodiscs.theory import exact

BOX = ["--width", "1.5", "--height", "1"]


def exact(monkeypatch, capsys, *words):
    """Run ``twodiscs exact`` in this process; return exit status, standard output and error."""
    monkeypatch.setattr(sys, "argv", ["twodiscs", "exact", *words])
    with pytest.raises(SystemExit) as caught:
        main.main()
    shown = capsys.readouterr()
    return caught.value.code, shown.out, shown.err


def test_json_holds_every_digit(monkeypatch, capsys):
    status, out, err = exact(monkeypatch, capsys, *BOX, "--radius", "0.3", "--json")
    assert status in (None, 0)
    assert err == ""
    numbers = json.loads(out)
    assert set(numbers) == {
        "regime",
        "ergodic_components",
        "largest_radius",
        "volume",
        "areas",
        "mean_times",
    }
    assert numbers == exact.exact(Scene(1.5, 1, 0.3))
    assert list(numbers["areas"]) == list(numbers["mean_times"]) == list(EVENTS)
    assert numbers["regime"] == "vertical-hops"
    assert numbers["mean_times"]["horizontal_hop"] is None


def test_the_table_holds_every_digit(monkeypatch, capsys):
    status, out, _ = exact(monkeypatch, capsys, *BOX, "--radius", "0.3")
    assert status in (None, 0)
    numbers = exact.exact(Scene(1.5, 1, 0.3))
    rows = {line.split()[0]: line.split()[1:] for line in out.splitlines() if line}
    assert rows["volume"] == [repr(numbers["volume"])]
    for event in EVENTS:
        time = numbers["mean_times"][event]
        assert rows[event] == [
            repr(numbers["areas"][event]),
            "impossible" if time is None else repr(time),
        ]
    assert "impossible" in rows["horizontal_hop"]


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ([*BOX, "--radius", "0.5"], "radius 0.5 does not fit"),
        ([*BOX, "--radius", "-0.1"], "radius must be a positive, finite number, not -0.1"),
        ([*BOX, "--radius", "0"], "radius must be a positive, finite number, not 0.0"),
        ([*BOX, "--radius", "nan"], "radius must be a positive, finite number, not nan"),
        ([*BOX, "--radius", "x"], "argument --radius: must be a number, not 'x'"),
        ([*BOX, "--radius", ""], "argument --radius: must be a number, not ''"),
        ([*BOX], "the following arguments are required: --radius"),
        ([*BOX, "--radius"], "argument --radius: expected one argument"),
        ([*BOX, "--radius", "0.1", "--rad", "2"], "unrecognized arguments: --rad 2"),
        (
            ["--width", "inf", "--height", "1", "--radius", "0.1"],
            "width must be a positive, finite",
        ),
        (["--width", "1", "--height", "1e99", "--radius", "0.1"], "height must lie between"),
        ([*BOX, "--radius", "0.1", "--mass-ratio", "0"], "mass_ratio must be a positive"),
        ([*BOX, "--radius", "0.1", "--mass-ratio", "two"], "argument --mass-ratio: must be a num"),
        ([*BOX, "--radius", "0.1", "--periodic", "z"], "periodic must be some of the axes xy"),
        ([*BOX, "--radius", "0.1", "--gravity", "1"], "unrecognized arguments: --gravity 1"),
        ([*BOX, "--radius", "0.1", "--field", "1", "--periodic", "y"], "field must be 0 where y"),
        ([*BOX, "--radius", "0.4", "--radius-ratio", "2"], "radius 0.4 does not fit"),
        (
            [*BOX, "--radius", "0.1", "--depth", "1", "--moment-of-inertia", "0.4"],
            "moment_of_inertia must be left out",
        ),
    ],
)
def test_a_mistake_is_one_sentence(monkeypatch, capsys, words, sentence):
    status, out, err = exact(monkeypatch, capsys, *words)
    assert status == 2
    assert out == ""
    assert err.startswith("error: ")
    assert sentence in err
    assert err.count("\n") == 1


EFFECTS = {"radius_ratio": 0.5, "mass_ratio": 2.0, "field": 0.5}


def test_effects_are_options(monkeypatch, capsys):
    assert main.EFFECTS.keys() == effects.EFFECTS.keys()
    words = ["--radius-ratio", "0.5", "--mass-ratio", "2", "--field", ".5"]
    status, out, _ = exact(monkeypatch, capsys, *BOX, "--radius", "0.1", *words, "--json")
    assert status in (None, 0)
    assert json.loads(out) == exact.exact(Scene(1.5, 1, 0.1, **EFFECTS))
    _, out, _ = exact(monkeypatch, capsys, *BOX, "--radius", "0.1", *words)
    assert all(f"{name.replace('_', ' '):<20}{value}" in out for name, value in EFFECTS.items())
    _, out, _ = exact(monkeypatch, capsys, *BOX, "--radius", "0.1", "--depth", "1.2")
    assert out.startswith("Two balls of radius 0.1 in a box of 1.5 × 1.0 × 1.2\n")
    assert "\nvelocity components 6\n" in out
    _, out, _ = exact(monkeypatch, capsys, *BOX, "--radius", "0.1", "--periodic", "yx")
    assert "\nvelocity components 2\ntotal momentum      0 along x, y\n" in out
    _, out, _ = exact(monkeypatch, capsys, *BOX, "--radius", "0.1")
    assert "velocity components" not in out


def test_the_installed_command():
    command = [sys.executable, "-m", "twodiscs.cli.main", "exact", *BOX, "--radius", "1"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr.startswith("error: radius 1.0 does not fit")
    assert "Traceback" not in done.stderr


def test_parameters_come_back_from_their_text():
    value = {"a": [1, 2.5, "x"], "b": {"c": None, "d": True}}
    assert arguments.parameters(repr(value)) == value


def test_parameters_may_be_optional():
    for value in ({"a": 1}, {"a": 1, "b": 2}):
        assert arguments.parameters(repr(value), "a", optional=["b"]) == value
    for value in ({"b": 1}, {"a": 1, "c": 2}):
        with pytest.raises(ValueError, match="parameters must be a, not"):
            arguments.parameters(repr(value), "a", optional=["b"])


@pytest.mark.parametrize("text", ["", "1", "[1]", "{", "{a: 1}", "dict()", "{[]: 1}", "(" * 500])
def test_text_that_is_no_dict_is_refused(text):
    with pytest.raises(ValueError, match="parameters must be a Python dict"):
        arguments.parameters(text)


@pytest.mark.parametrize(
    ("error", "sentence"),
    [
        (ValueError("two\n  lines"), "error: two lines\n"),
        (FileNotFoundError(2, "No such file", "a.csv"), "error: a.csv: No such file\n"),
        (OSError("broken"), "error: broken\n"),
    ],
)
def test_run_turns_an_error_into_a_sentence(capsys, error, sentence):
    def broken():
        raise error

    with pytest.raises(SystemExit) as caught:
        arguments.run(broken)
    assert caught.value.code == 2
    assert capsys.readouterr().err == sentence


@pytest.mark.parametrize("status", [None, 0, 1])
def test_run_exits_with_what_main_returns(status):
    with pytest.raises(SystemExit) as caught:
        arguments.run(lambda: status)
    assert caught.value.code == status


def test_run_does_not_hide_a_defect():
    with pytest.raises(ZeroDivisionError):
        arguments.run(lambda: 1 / 0)
