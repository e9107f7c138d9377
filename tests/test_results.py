"""Results that are saved, loaded and continued; states of observe and starts.

Without these tests a file could lose a number, more work could repeat or skip some, a state be
wrong.
"""

import itertools
import json
import math
import os
import re
import resource
import stat
import sys
from collections import namedtuple
from copy import copy, deepcopy
from dataclasses import replace
from functools import partial
from types import SimpleNamespace
from unittest.mock import Mock, call, create_autospec

import numpy as np
import pandas as pd
import pytest
from effect_scenes import PAPER, SCENES, THREE, in_unit
from matplotlib.backend_bases import FigureCanvasBase
from numba.core.compiler_lock import global_compiler_lock

import twodiscs as td
from twodiscs.dynamics import averages
from twodiscs.dynamics.stages import STAGES
from twodiscs.measure import load
from twodiscs.measure import result as progress_module
from twodiscs.model.checks import NAMED_ERRORS
from twodiscs.model.formats import texts_with_error
from twodiscs.points.base import file_content, write_json
from twodiscs.sampling import rounds
from twodiscs.sampling.threads import call_in_thread

NARROW = td.Scene(1.5, 1.0, 0.249)
RING = replace(THREE, periodic="x")


def seen(start, now):
    return {"x": now["x1"], "same": start["u1"] * now["u1"]}


#: {name: (less, what says more, more of it)}; the hop of ``NARROW`` is counted from strips as well,
#: and one radius of the scan does not fit.
MADE = {
    "simulate": (
        lambda: td.simulate(NARROW, 0.3, seed=0, events=["horizontal_hop", "any_wall"]),
        "error", 0.02,
    ),
    "sample": (lambda: td.sample(PAPER, 1e6, seed=0), "samples", 5e6),
    "intervals": (lambda: td.intervals(PAPER, "vertical_hop", 1e5, seed=0), "number", 4e5),
    "transmission": (
        lambda: td.transmission(NARROW, "horizontal_hop", 2**12, seed=0), "hops", 2**14,
    ),
    "sample of three": (lambda: td.sample(THREE, 1e3, seed=0), "samples", 1e4),
    "simulate a time": (lambda: td.simulate(PAPER, duration=1, seed=0), "duration", 1e5),
    "scan": (
        lambda: td.scan(1.5, [1, 2], [0.2, 0.9], 1e-3, seed=0, budget=1e5, events="any_wall"),
        "budget", 2e7,
    ),
    "scan of averages": (
        lambda: td.scan([1.5, 2], 1, 0.2, measure=lambda s: td.diffusion(s, [s.width], 1, seed=0),
                        periodic="x"),
        "replicas", 2e4,
    ),
    "sample to an error": (
        lambda: td.sample(PAPER, error=0.1, seed=0, quantities=["volume", "any_wall_area"]),
        "error", 1e-3,
    ),
    "observe": (
        lambda replicas=5e3: td.observe(PAPER, seen, [0, 1], replicas, seed=0), "replicas", 2e4,
    ),
    "diffusion": (
        lambda replicas=1: td.diffusion(RING, [1, 3], replicas, seed=0), "replicas", 2e4,
    ),
}  # fmt: skip


def bits(result):
    """Return all that is in a result, as text."""
    return result.frame().to_csv() + str(result)


@pytest.mark.parametrize("name", MADE)
def test_results_go_on_and_come_back(name, tmp_path, monkeypatch):
    make, setting, value = MADE[name]
    less, path = make(), tmp_path / "result.json"
    less.save(path)
    read = td.load_result(path)
    assert read == less
    assert repr(less) == str(less)  # at a prompt
    with monkeypatch.context() as patch:  # another third digit
        patch.setattr(td, "__version__", f"{td.__version__}1")
        assert bits(td.load_result(path)) == bits(read) == bits(less)
    assert (read.kind, read.version) == (name.partition(" ")[0], td.__version__)
    assert read.settings["seed"] == 0  # which is a seed, too
    more, again = less.more(**{setting: value}), {"cores": 2}
    if name == "observe":
        with pytest.raises(td.InputError, match="function must be given again to go on from a fi"):
            read.more(value)
        with pytest.raises(td.InputError, match="as many numbers each time, with the same names"):
            read.more(value, function=lambda start, now: now["x1"])
        again["function"] = seen
    assert bits(more) == bits(read.more(**{setting: value}, **again))
    if name in ("observe", "diffusion"):  # their sums are no integers
        assert more == make(value)
    assert bits(more) != bits(less)
    assert more != less
    more.save(path)
    assert td.load_result(path) == more
    assert bits(more.more(**{setting: less.settings[setting]})) == bits(less)
    # It does not change, and a copy is the result itself.
    assert deepcopy({"of": [less]})["of"][0] is copy(less) is less
    before = json.dumps(less.to_dict())
    for plain in (less.settings, less.to_dict()):
        emptied(plain)
    assert json.dumps(less.to_dict()) == before


def emptied(plain):
    """Empty a dict or a list and all that is in it, as a careless reader may."""
    for child in plain.values() if isinstance(plain, dict) else plain:
        if isinstance(child, dict | list):
            emptied(child)
    plain.clear()


#: {stage: (settings, larger settings, function of the face)} of a job of the pipeline.
JOBS = {
    "dynamics": (
        {"error": {"any_wall": 0.01, "horizontal_hop": 0.05}, "budget": 10**8},
        {"error": {"any_wall": 5e-4, "horizontal_hop": 2e-3}}, td.simulate,
    ),
    "intervals": (
        {"hop": "vertical_hop", "number": 10**5, "budget": 10**11}, {"number": 2 * 10**5},
        td.Intervals.makers["intervals"],  # with the bins of a build
    ),
}  # fmt: skip


@pytest.mark.parametrize("stage", JOBS)
def test_a_point_of_the_pipeline_goes_on(stage, tmp_path):
    settings, larger, function = JOBS[stage]
    settings = settings | {"seed": 3, "name": "paper"}
    components = STAGES[stage].run(NARROW, settings).run().components
    content = file_content(STAGES[stage].call, NARROW.parameters(), settings, components)
    write_json(tmp_path / "0.2.json", content)
    read, made = td.load_result(tmp_path / "0.2.json"), function(NARROW, **settings)
    assert read == made
    assert bits(read.more(**larger)) == bits(function(NARROW, **settings | larger))


@pytest.mark.parametrize("name", ["json", "xyz", "xyz.gz", "png", "pdf", "svg", "gif", "html"])
def test_a_file_is_replaced_whole_or_not_at_all(name, tmp_path):
    """A limit on the size of files stands for a full disk, and an entry of a folder for a path."""
    path, link = tmp_path / f"old.{name}", tmp_path / f"link.{name}"
    trajectory = td.trajectory(PAPER, duration=9 if name == "xyz.gz" else 0.3)
    path.write_text("old")
    path.chmod(0o640)
    link.symlink_to(path)
    (entry,) = (entry for entry in os.scandir(tmp_path) if entry.is_symlink())
    write = {
        "json": td.sample(PAPER, 1).save,
        **dict.fromkeys(("xyz", "xyz.gz"), trajectory.to_xyz),
        **dict.fromkeys(("gif", "html"), lambda path: td.animate(trajectory, path)),
    }.get(name, lambda path: td.plot(PAPER, path))
    usual = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100, usual[1]))
    try:
        for one in (entry, tmp_path / f"new.{name}"):
            with pytest.raises(td.InputError, match=r"must be a file to write, .*File too large"):
                write(one)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, usual)
    assert path.read_text() == "old"
    write(entry)
    assert path.stat().st_size > 1000
    assert (path.read_bytes()[:2] == b"\x1f\x8b") == (name == "xyz.gz")
    read = {"json": td.load_result, "xyz.gz": lambda path: td.trajectory(PAPER, 1, start=path)}
    read = read.get(name, os.stat)
    assert str(read(entry)) == str(read(path))
    assert stat.filemode(path.stat().st_mode) == "-rw-r-----"
    assert link.is_symlink()
    assert {*tmp_path.iterdir()} == {path, link}


#: Values in the place of any other in a file; ... stands for its removal.
WRONG = (None, "x", -1, 1.5, 10**30, [], [[]], {"a": 1}, ...)


def edited(node):
    """Yield (keys above it, value, the node with this value in one place), for all places."""
    children = node.items() if isinstance(node, dict) else enumerate(node[:2])
    for key, child in [*children]:
        for wrong in WRONG:
            other = copy(node)
            other[key] = wrong
            if wrong is ...:
                del other[key]
            if other != node:
                yield (key,), wrong, other
        for keys, wrong, below in edited(child) if isinstance(child, dict | list) else ():
            other = copy(node)
            other[key] = below
            yield (key, *keys), wrong, other


@pytest.mark.parametrize("name", MADE)
def test_a_file_of_another_content_is_one_sentence_and_no_work(name, monkeypatch):
    """Its digest is right. Other counts, and other settings that fit them, cannot be known."""
    made = MADE[name][0]()
    monkeypatch.setattr(rounds, "_done", lambda *given: pytest.fail("loading computes"))
    monkeypatch.setattr(load, "read_json", read := Mock())
    for keys, wrong, content in edited(made.to_dict()):
        read.return_value = json.loads(json.dumps(content))
        try:
            found = td.load_result("result.json")
        except td.InputError as error:
            assert re.match(r"(path|the result) must be .*[^\n]*$", str(error))  # noqa: PT017
        else:
            averages = name in ("observe", "diffusion", "scan of averages")
            assert "sums" not in keys or type(wrong) in (int, float)[: 1 + averages], keys
            names = ["names"] * averages  # of the user
            known = {"sums", "settings", "results", "refused", *names}
            assert known & {*keys}, (keys, wrong)
            bits(found)


def test_files_of_something_else_are_refused(tmp_path):
    path = tmp_path / "result.json"
    kind = json.dumps({"twodiscs": td.__version__, "kind": "x"})
    for content in ("", "[1]", "[" * 10**5, kind):
        path.write_text(content)
        with pytest.raises(td.InputError, match=r"path must be a file that save\(\) wrote"):
            td.load_result(path)
    first, second, _ = td.__version__.split(".")
    for other in ("0", f"{first}.{int(second) + 1}.0", f"{first}.{second}0.0"):
        write_json(path, {"twodiscs": other})
        with pytest.raises(td.InputError, match=f"the result must be of version .*'{other}'"):
            td.load_result(path)


def test_errors_that_are_not_given_and_presets_are_those_of_the_pages():
    assert td.scan(1.5, 1.0, [0.2], budget=1).settings["error"] == 1e-2
    assert td.simulate(PAPER, budget=1).settings["error"] == 1e-3
    assert td.intervals(PAPER, "vertical_hop").settings["number"] == 10**6
    assert td.sample(PAPER).settings["samples"] == 10**7
    assert td.observe(PAPER, seen, [0]).settings["replicas"] == 2**16
    found = td.simulate(PAPER, "draft", events=["any_wall"])
    assert found.settings["error"] == NAMED_ERRORS["draft"]
    assert td.simulate(PAPER, 1, budget=1)["any_wall_time"].status == "reached"


# Shown --------------------------------------------------------------------------------------------


def test_notebooks_show_tables_and_complete_keys():
    found = td.simulate(PAPER, 0.5, budget=1)
    html = found._repr_html_()
    assert found._ipython_key_completions_() == [*found]
    assert html.count("<tr>") == len(found) == len(td.EVENTS)
    assert "<td>vertical_hop_time</td>" in html
    assert html.endswith(f"</table><p>{found.note}</p>")
    assert "<table " in td.intervals(PAPER, "vertical_hop", 1)._repr_html_()


def test_a_scan_is_a_sequence_a_table_and_a_figure(tmp_path):
    """Over any numbers of a scene: all combinations; what does not fit has a row."""
    asked = {"error": 0.3, "events": "any_wall", "budget": 1}
    iterators = {"mass_ratio": iter([2, 1]), "events": iter(["any_wall"])}
    scan = td.scan([1.5, 2.0], 1.0, [0.7, 0.2], **asked | iterators)
    assert (scan.parameters, scan.radii) == (("radius", "width", "mass_ratio"), [0.2] * 4)
    frame = scan.frame()
    assert frame.index.names == [*scan.parameters, "quantity"]
    assert frame["estimate"].nunique() == 4
    for one in scan:
        alone, place = td.simulate(one.scene, **asked), (one.scene.width, one.scene.mass_ratio)
        row = frame.loc[(0.2, *place, "any_wall_time")]
        assert one.rows == alone.rows
        assert (row["estimate"], row["exact"]) == (one.rows[0]["estimate"], one.rows[0]["exact"])
        refused = frame.loc[(0.7, *place, "does not fit")]
        assert refused["status"].startswith("radius 0.7 does not fit")
    for shown in (str(scan), scan._repr_html_()):
        assert shown.count("radius 0.7 does not fit") == 4
    curve = lambda scene: td.transmission(scene, "vertical_hop", 1)  # noqa: E731
    times = td.scan(1.5, 1, [0.2, 0.7], measure=curve, discs=[2])
    assert times.frame().index.names == ["radius", "discs", "time"]
    assert times[0].frame().equals(times.frame().loc[(0.2, 2), ["kappa", "stderr"]])
    refused = times.frame().loc[(0.7, 2)]  # a row without a time and numbers
    assert np.isnan([*refused.index, *refused[["kappa", "stderr"]].iloc[0]]).all()
    sampled, same = (
        td.scan(1.5, 1, [0.1, 0.2], measure=lambda s, of=of: td.sample(s, of(s.radius)))
        for of in ({0.1: 1e6, 0.2: 2e6}.get, lambda radius: 1e6)
    )
    assert sampled.more(1e6) == same
    td.plot(td.scan(1.5, 1.0, [0.2, 0.1], field=0.3, **asked), tmp_path / "scan.png")
    assert (tmp_path / "scan.png").stat().st_size > 5000


def test_a_window_opens_at_a_plain_prompt_alone(monkeypatch):
    canvas = create_autospec(FigureCanvasBase, required_interactive_framework="windows")
    opened = canvas.new_manager
    monkeypatch.setitem(sys.modules, "windows", SimpleNamespace(FigureCanvas=canvas))
    monkeypatch.setattr("matplotlib.get_backend", lambda: "module://windows")
    monkeypatch.delitem(sys.modules, "IPython", raising=False)
    td.plot(PAPER)
    opened.assert_not_called()
    monkeypatch.setattr(sys, "ps1", ">>> ", raising=False)
    figure = td.plot(PAPER)
    assert opened.mock_calls == [call(figure, 1), call().show()]
    canvas.required_interactive_framework = None  # no window there
    td.plot(PAPER)
    opened.assert_called_once()


@pytest.mark.parametrize("progress", [None, True, False])
def test_progress_is_shown_where_someone_looks(progress, monkeypatch, capsys):
    pytest.importorskip("tqdm", reason="tqdm shows progress")
    monkeypatch.setattr(progress_module, "BAR_DELAY", 0.0)
    td.simulate(PAPER, 0.02, progress=progress)
    td.starts(PAPER, 10, progress=progress)
    td.trajectory(PAPER, duration=1, progress=progress)
    said = capsys.readouterr()
    assert said.out == ""
    assert ("simulate r = 0.2" in said.err) == (progress is True)
    assert ("trajectory r = 0.2" in said.err) == (progress is True)


def test_a_bar_is_where_the_work_is(monkeypatch):
    """It says when that is a compilation. A logger in the place of the terminal has none."""
    tqdm = pytest.importorskip("tqdm", reason="tqdm shows progress").tqdm
    monkeypatch.setattr(progress_module, "BAR_DELAY", 0.0)
    with progress_module.progress_bar(True, "work") as watch:
        for done in (2, 5, None, 9):
            watch(done, 10)
        assert [(bar.n, bar.total) for bar in tqdm._instances] == [(9, 10)]
        with global_compiler_lock:
            call_in_thread(watch, None, 10)
        assert [bar.desc for bar in tqdm._instances] == ["work, compiling"]
        watch(10, 10)
        assert [bar.desc for bar in tqdm._instances] == ["work"]
    # A terminal has the bar of a terminal, also where notebooks could have another one.
    monkeypatch.setattr("importlib.util.find_spec", lambda name: name)
    monkeypatch.setitem(sys.modules, "tqdm.notebook", None)
    terminal = SimpleNamespace(write=len, flush=dict, isatty=lambda: True)
    for progress, stderr in ((None, SimpleNamespace(write=len)), (True, None), (None, terminal)):
        monkeypatch.setattr(sys, "stderr", stderr)
        with progress_module.progress_bar(progress, "work") as watch:
            assert (watch is None) == (stderr is not terminal)


# States -------------------------------------------------------------------------------------------


def test_two_events_may_have_one_time():
    """Discs that mirror each other hit their walls together."""
    path = td.trajectory(PAPER, start=[-0.4, 0, 0.4, 0, -(0.5**0.5), 0, 0.5**0.5, 0], duration=3)
    assert not path["time"].is_unique
    (state,) = path.states_at(1.0)
    assert state["x1"] == -state["x2"]


@pytest.mark.parametrize("scene", [PAPER, SCENES["combination"]], ids=str)
def test_states_between_rows_lead_from_one_to_the_next(scene):
    path = td.trajectory(scene, seed=2, duration=30)
    names = [name for name in path.columns if name not in ("time", "event", "first", "second")]
    assert tuple(sorted(names)) == tuple(sorted(td.starts(scene, 1).dtype.names))
    times = path["time"].to_numpy()
    states = path.states_at(times)
    ends = path.states_at(np.nextafter(times[1:], 0))
    for name in names:
        assert np.array_equal(states[name], path[name])
        if name[0] in "xyz":
            # No place jumps, on periodic axes neither.
            assert np.allclose(ends[name], path[name][1:], rtol=0, atol=1e-9)


def test_averages_over_states_have_honest_errors(tmp_path):
    """Five standard errors each: energy is kept, ⟨u²⟩ of four components is 1/4, and t u at first.

    A velocity together with a position is an array for each replica.
    """

    def seen(start, now):
        energy = sum(now[name] ** 2 for name in ("u1", "v1", "u2", "v2"))
        return np.stack([energy, start["u1"] * now["u1"], now["x1"] - start["x1"]], axis=1)

    found = td.observe(PAPER, seen, [0, 1, 7.5], 20000, seed=3)
    assert found.mean.shape == found.stderr.shape == (3, 3)
    assert found.replicas == 20480
    assert np.allclose(found.mean[:, 0], 1, rtol=0, atol=1e-12)
    assert abs(found.mean[0, 1] - 0.25) < 5 * found.stderr[0, 1]
    assert np.all(np.abs(found.mean[:, 2]) <= 5 * found.stderr[:, 2])
    assert found.stderr[0, 2] == 0.0  # nothing has moved
    # ⟨u⁴⟩ = 1/8 on the sphere in four dimensions.
    assert math.isclose(found.stderr[0, 1], math.sqrt((1 / 8 - 1 / 16) / 20480), rel_tol=0.05)
    assert found == td.observe(PAPER, seen, [0, 1, 7.5], 20000, seed=3, cores=2)
    assert found != td.observe(PAPER, seen, [0, 1, 7.5], 20000, seed=4)
    assert list(found.frame().columns) == [f"{n}_{k}" for n in ("mean", "stderr") for k in range(3)]
    given = np.sort(td.starts(PAPER, 5000), order="x1")  # more than a block; their means differ
    found = td.observe(PAPER, lambda start, now: now["x1"].tolist(), [0], starts=given)
    error = given["x1"].std(ddof=1) / math.sqrt(5000)
    assert (found.replicas, found.mean[0]) == (5000, pytest.approx(given["x1"].mean()))
    assert list(found.frame().columns) == ["mean", "stderr"]
    assert found.stderr[0] == pytest.approx(error, rel=1e-12)
    found.save(tmp_path / "a.json")
    assert td.load_result(tmp_path / "a.json").note.startswith("5000 given starts: errors hold if ")


def test_what_is_observed_has_names():
    """A dict of functions, and what returns names, are the columns of an array; as a tuple is."""
    parts = {"x": lambda start, now: now["x1"], "u²": lambda start, now: now["u1"] ** 2}
    labelled = namedtuple("Labelled", ["x", "u"])
    columns, listed, packed, made, named, table, fields = (
        td.observe(PAPER, form, [0, 1], 1)
        for form in (
            lambda *of: np.stack([part(*of) for part in parts.values()], axis=1),
            lambda *of: [part(*of) for part in parts.values()],
            lambda *of: tuple(part(*of) for part in parts.values()),
            lambda *of: {name: part(*of) for name, part in parts.items()},
            parts,
            lambda *of: pd.DataFrame({name: part(*of) for name, part in parts.items()}),
            lambda *of: labelled(*(part(*of) for part in parts.values())),
        )
    )
    named_forms = ((found, (*parts,)) for found in (made, named, table))
    for found, names in ((listed, ()), (packed, ()), *named_forms, (fields, ("x", "u"))):
        assert np.array_equal(found.mean, columns.mean)
        assert np.array_equal(found.stderr, columns.stderr)
        assert found.names == names
    assert list(named.frame().columns) == ["x", "u²", "x_stderr", "u²_stderr"]
    assert np.array_equal(named.frame().to_numpy(), np.hstack([columns.mean, columns.stderr]))
    pairs = zip(columns.mean[0], columns.stderr[0], strict=True)
    texts = [text for pair in pairs for text in texts_with_error(*pair)]
    assert str(named).splitlines()[3].split() == ["0", *texts]
    assert "± error" in named._repr_html_()
    # A partial function has no name.
    small = td.observe(PAPER, partial(lambda by, start, now: now["x1"] * by, 1e-203), [0, 1], 1)
    assert np.all(small.stderr > np.abs(small.mean))


@pytest.mark.parametrize("scene", [SCENES["combination"], THREE, replace(RING, discs=4)], ids=repr)
def test_what_is_observed_is_a_trajectory(scene):
    """The states of a replica are those of the trajectory from its start, beyond the cell too."""
    replicas, kept, times, gone = 20, [], [1.0, 4.0], 0

    def seen(start, now):
        kept.append((start[:replicas].copy(), now[:replicas].copy()))
        return now["x1"]

    td.observe(scene, seen, times, 10)
    for time, both in zip(times, kept, strict=True):
        for start, now in zip(*both, strict=True):
            (state,) = td.trajectory(scene, start=start, duration=12.0).states_at([time])
            assert np.allclose([*state], [*now], rtol=0, atol=1e-5)
            gone += abs(now["x1"]) > scene.width / 2
    assert bool(gone) == bool(scene.periodic)
    # Frames are the same states, and starts from which the same motion goes on.
    frames = td.frames(scene, times, replicas)
    for name, k in itertools.product(kept[0][0].dtype.names, (0, 1)):
        due = frames[name[0]][:, k, int(name[1:]) - 1]
        assert np.array_equal(kept[k][1][name], due)
    kept.clear()
    plain = frames[:, 0].view((float, len(frames.dtype.names)))
    names = [letters[: len(scene.axes)] for letters in ("xyz", "uvw")]
    pair = [np.stack([frames[name][:, 0] for name in few], axis=-1) for few in names]
    pair[0] += np.array(scene.sides) / 2  # from the corner
    for given in (frames[:, 0], plain, pair):
        found = td.observe(scene, seen, [times[1] - times[0]], starts=given)
        assert found.replicas == replicas
        assert found.note.endswith("errors hold if they are independent")
        for name in kept[-1][1].dtype.names:
            due = frames[name[0]][:, 1, int(name[1:]) - 1]
            np.testing.assert_allclose(kept[-1][1][name], due, rtol=0, atol=1e-5)


def test_blocks_of_replicas_have_different_kicks():
    """A hundred kicks: hardly any velocity is left that the start gave."""
    kicked = td.Scene(1.5, 1.0, 0.2, friction=1e5)
    speeds = td.frames(kicked, [1e-3], 2 * 4096)["u"][:, 0, 0]
    assert not np.any(speeds[:4096] == speeds[4096:])


def test_averages_tell_and_count_their_replicas():
    run, done = averages.ObserveRun(PAPER, 1, np.array([0, 1e-3]), 5000, None, names=("x",)), []
    run.frames(lambda *now: done.append(now))
    assert [now for now in done if now[0]] == [(4096, 5000), (5000, 5000)]
    sums = 2 * 4096, np.zeros((2, 1)), np.array([[1.0], [-1.0]])
    with pytest.raises(td.InputError, match="sums must be those of all"):
        run.point({"all": {(0, 2): sums}})
    run = averages.ObserveRun(PAPER, 1, np.array([0]), 4096, None, names=("x", "x_stderr"))
    with pytest.raises(td.InputError, match="time or another one with _stderr"):
        run.point({"all": {(0, 1): (4096, np.zeros((1, 2)), np.ones((1, 2)))}})


@pytest.mark.parametrize("which", [0, 1])
def test_what_is_handed_over_is_read_only(which):
    """A start that the function changes would be another one at the next time."""

    def seen(*states):
        states[which]["x1"] += 1

    with pytest.raises(ValueError, match="read-only"):
        td.observe(PAPER, seen, [0, 1], 1)


def test_times_are_any_iterable():
    averages = td.observe(PAPER, lambda start, now: now["x1"], [0, 1], 1)
    path = td.trajectory(PAPER, duration=3)
    for times in ((0, 1), range(2), map(float, range(2)), (t for t in (0, 1)), {0: 1, 1: 0}.keys()):
        assert td.observe(PAPER, lambda start, now: now["x1"], times, 1) == averages
    assert td.diffusion(RING, iter([1, 3]), 1) == td.diffusion(RING, [1, 3], 1)
    for times in (iter([0.5, 2]), {0.5: 0, 2: 0}.keys(), np.array([0.5, 2], object)):
        assert np.array_equal(path.states_at(times), path.states_at([0.5, 2]))
    assert path.states_at(np.array(2.0)) == path.states_at(2)


@pytest.mark.parametrize(
    "scene",
    [PAPER, *map(SCENES.get, ("combination", "rough", "friction")), td.Scene(6, 1, 0.2, discs=5),
     in_unit(PAPER, 1e12)],
    ids=str,
)  # fmt: skip
def test_states_show_that_rows_are_missing(scene, tmp_path):
    """New labels hide a selection; only rows of hops can be left out, which change no state."""
    path = td.trajectory(scene, duration=30 * scene.height, seed=1)
    middle = path["time"].iloc[-1] / 2
    whole = path.states_at([middle])
    hops = path.event.str.endswith("_hop")
    for right in (path.reset_index(drop=True), path.set_index("time", drop=False), path.iloc[3:-3]):
        assert right.states_at([middle]) == whole
    without, places = path[~hops].positions([middle]), path.positions([middle])
    np.testing.assert_allclose(without, places, rtol=0, atol=1e-14 * scene.height)
    k = len(path) // 3
    for wrong in (
        path[::-1],
        path[path.event == "disc_collision"],
        path[path.event == "disc_collision"].reset_index(drop=True),
        path.iloc[::2].reset_index(drop=True),
        pd.concat([path.iloc[:k], path.iloc[2 * k :]], ignore_index=True),
        pd.concat([path, path], ignore_index=True),
        path.set_index("time", drop=False).iloc[::3],
        path.assign(u1=-path["u1"]),
    ):
        for use, *given in (
            (wrong.positions, [middle]), (wrong.to_xyz, tmp_path / "a.xyz", [middle]),
            (td.plot, wrong), (td.animate, wrong, tmp_path / "a.gif"),
        ):  # fmt: skip
            with pytest.raises(td.InputError, match="must have all rows from its first to its"):
                use(*given)
    assert not [*tmp_path.iterdir()]


def test_tables_have_plain_values_beside_them(tmp_path):
    """Parquet and other formats write ``attrs`` as JSON; a table that comes back can be drawn."""
    scene = td.Scene(1.5, 1.0, 0.2, field=0.1)
    path = td.trajectory(scene, duration=0.5)
    for frame in (path, td.exact_table(1.5, 1.0, [0.1, 0.2], field=0.1, periodic="x")):
        assert json.loads(json.dumps(frame.attrs)) == frame.attrs
    assert path.scene == scene
    back = pd.DataFrame(path.to_dict("list"))
    back.attrs = json.loads(json.dumps(path.attrs))
    td.animate(back, tmp_path / "a.gif")
    assert td.plot(back).axes[0].get_xlim()[1] == 0.5
    back.attrs = {"scene": "a scene"}
    with pytest.raises(td.InputError, match="result must be a scene, a trajectory"):
        td.plot(back)


def test_bins_of_your_own_are_one_kind_and_may_be_empty():
    """A figure then begins with the first bin that has intervals."""
    for bins in ([0, 1e-9, 1, 2], [0, 1e-9]):
        found = td.intervals(PAPER, "horizontal_hop", 1, bins=bins)
        assert found.counts[0] == 0
        assert found.at_zero.exact == pytest.approx(3 * math.sqrt(2) / (16 * 1.1))
        assert [row["bins"] for row in found.rows] == ["own"] * (len(bins) - 1)
        for axes in td.plot(found).axes:
            steps = [patch.get_data().edges for patch in axes.patches]
            due = [np.array(bins[1:]) / found.mean.exact] * (len(bins) > 2)
            np.testing.assert_allclose(steps, due)
