"""The face, `import twodiscs as td`: its numbers are those of the pipeline.

Without these tests its numbers, texts and errors could be others than those of the pipeline.
"""

import inspect
import json
import math
import pickle
import re
from collections import namedtuple
from copy import deepcopy
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml
from checkout import REPOSITORY
from commands import python
from effect_scenes import PAPER, SCENES
from figure_cases import unclear

import twodiscs as td
from twodiscs.analysis.tables import SCENE_TABLES
from twodiscs.dynamics.paths import check_start
from twodiscs.figures import style
from twodiscs.measure.load import plugin
from twodiscs.measure.measurements import Measurement, measurement
from twodiscs.points.monte_carlo_point import InsertionPoint
from twodiscs.sampling.initial_states import components
from twodiscs_paper.configuration import yaml_files
from twodiscs_paper.pipeline import job_cost

#: A configuration of one scene, small.
CONFIGURATION = yaml.safe_load("""
seed: 7
scenes:
- {name: one, box: {width: 1.5, height: 1.0}, radii: [0.2], accuracy: 0.05, event_budget: 1000000,
   monte_carlo: {samples: 1000000}, watch: {volume: true, areas: true, mean_times: true,
   hop_histogram: {radii: [0.2], intervals: 100000}, trajectory: 0.2}}
""")


@pytest.fixture(scope="module")
def simulated():
    return td.simulate(PAPER, 0.05, seed=7, budget=1e6, name="one")


@pytest.fixture(scope="module")
def sampled():
    return td.sample(PAPER, 1e6, seed=7, name="one")


@pytest.fixture(scope="module")
def intervals():
    return td.intervals(PAPER, "vertical_hop", 1e5, seed=7, name="one")


# Names ------------------------------------------------------------------------------------------


def test_the_import_reads_no_module_of_the_package():
    code = "import sys, twodiscs; print(*(name for name in sys.modules if 'twodiscs.' in name))"
    assert python("-c", code, check=True).stdout.split() == []


def test_every_name_is_defined_where_an_editor_looks_for_it():
    """Others are unknown. ``__init__.pyi`` is the list of all names."""
    with pytest.raises(AttributeError, match="attribute Simulate; did you mean simulate"):
        td.Simulate  # noqa: B018
    stub = Path(f"{td.__file__}i").read_text(encoding="utf-8")
    lines = re.findall(r"^from \.(\S+) import (.+)$", stub, re.MULTILINE)
    homes = {name: module for module, line in lines for name in re.findall(r" as (\w+)", line)}
    assert sorted(homes) == sorted(td.__all__)
    for name, module in homes.items():
        if callable(home := getattr(td, name)):
            assert (home.__module__, home.__name__) == (f"twodiscs.{module}", name)
            defaults = {k: one.default for k, one in inspect.signature(home).parameters.items()}
            assert {defaults[one] for one in {"seed", "cores"} & defaults.keys()} <= {1}
            told = re.findall(r"^ +(\w+) : .*, default (\S+)$", home.__doc__ or "", re.MULTILINE)
            assert all(defaults[one] == eval(number) for one, number in told)


# The numbers of the pipeline ----------------------------------------------------------------------


def test_results_are_those_of_the_pipeline(simulated, sampled, intervals):
    box, scene = PAPER.box, yaml_files.load(CONFIGURATION).scenes[0]
    stages = ("dynamics", "monte_carlo", "intervals")
    points = [job_cost.run_at(scene, stage, 0.2).run() for stage in stages]
    assert simulated.rows == SCENE_TABLES["mean_times"].rows(points)
    assert sampled.rows == SCENE_TABLES["volume"].rows(points) + SCENE_TABLES["areas"].rows(points)
    bins = [row for row in SCENE_TABLES["hop_histogram"].rows(points) if row["bins"] == "equal"]
    assert intervals.mean.value == bins[0]["mean"]
    # The bins of a call widen; where both have an edge, as many intervals are below it.
    below = pd.DataFrame(bins).set_index("right")["count"].cumsum()
    found = pd.Series(intervals.counts, intervals.edges[1:]).cumsum()
    common = below.index.intersection(found.index)
    assert len(common) > 20
    assert below[common].equals(found[common])
    followed = SCENE_TABLES["trajectory"].rows(box, 0.2, scene.trajectory_seed)
    path = td.trajectory(PAPER, seed=7, name="one").assign(z1=None, z2=None)
    assert path[[*followed[0]]].to_dict("records") == followed


def test_some_events_and_quantities_are_those_of_all(simulated, sampled):
    asked = {"seed": 7, "name": "one"}
    for errors in ({"error": {"any_wall": 0.05}}, {"error": 0.05, "events": "any_wall"}):
        some = td.simulate(PAPER, **errors, budget=1e6, **asked)
        assert list(some) == ["any_wall_time"]
        assert some.rows == [row for row in simulated.rows if row["event"] == "any_wall"]
    for names in (["volume"], "volume"):
        assert td.sample(PAPER, 1e6, quantities=names, **asked).rows == sampled.rows[:1]


# Texts of results ---------------------------------------------------------------------------------


def test_measurements_know_their_errors_and_print_themselves(simulated, sampled):
    """test_tutorial has their texts."""
    found = simulated["vertical_hop_time"]
    assert found.exact == td.mean_times(PAPER)["vertical_hop_time"]
    assert found.relative_stderr == found.stderr / found.value
    ends = found.value - found.stderr, found.value + found.stderr
    assert found.interval(0.6826894921370859) == pytest.approx(ends, rel=1e-12)
    assert sampled.frame().loc["volume", "estimate"] == sampled["volume"].value
    assert "length⁴" in str(sampled["volume"])
    texts = "{0} = {1} ± {2} {4}, exact {3}, z = {5}, {6} counted, {7}"
    assert str(found) == texts.format(*found.cells())


def test_a_measurement_without_an_honest_error_has_no_interval_and_no_score():
    blocked = td.simulate(td.Scene(1.5, 1.0, 0.3), 0.05, events=["horizontal_hop"], budget=1)
    tiny = td.sample(td.Scene(1.5, 1.0, 1e-9), 1e5, quantities=["any_wall_area"])
    for found in (blocked["horizontal_hop_time"], tiny["any_wall_area"]):
        assert {found.value, found.z, found.interval(), found.relative_stderr} == {None}
        assert "z = " not in str(found)
    assert "impossible" in str(blocked)
    assert "0.00" not in f"{blocked}{tiny}"
    unseen = Measurement("any_wall_time", None, None, 1.0, None, 0, "none-seen", "time", None, 0.5)
    assert "> 0.5" in unseen.cells()[1]
    few = Measurement("any_wall_time", 1.0, None, None, None, 3, "too-few", "time")
    assert (few.relative_stderr, few.cells()[3]) == (None, "not known")
    assert blocked["horizontal_hop_time"].cells()[3] == "–"
    for wrong in (float, lambda m: m.u, lambda m: f"{m:.3f}"):
        with pytest.raises(td.InputError, match="must have a value, but its status is impossible"):
            wrong(blocked["horizontal_hop_time"])


def test_a_bound_that_says_nothing_is_no_perfect_match():
    row = {"quantity": "any_wall_time", "estimate": 1.0, "stderr": None, "exact": 2.0, "count": 3}
    row |= {"expectation": 1.5, "bound": 0.5, "status": "too-few"}
    for z, test, known, text in (
        (0.0, "cluster-bound", None, "–"),
        (0.0, "exact-tail", None, "–"),
        (0.0, "normal", 0.0, "+0.00"),
        (-1.5, "cluster-bound", -1.5, "-1.50"),
    ):
        found = measurement(PAPER, row | {"z": z, "test": test})
        assert (found.z, found.expectation, found.bound) == (known, 1.5, 0.5)
        assert found.cells()[5] == text
        assert ("z = " in str(found)) == (known is not None)
        unseen = measurement(PAPER, row | {"estimate": None, "z": z, "test": test})
        assert unseen.z == known


def test_a_quantity_has_one_name(simulated, sampled):
    times, areas = ([f"{event}_{of}" for event in td.EVENTS] for of in ("time", "area"))
    assert list(simulated) == list(td.mean_times(PAPER)) == list(simulated.frame().index) == times
    assert [m.quantity for m in simulated.values()] == times
    assert list(sampled) == list(sampled.frame().index) == ["volume", *areas]
    assert list(td.areas(PAPER)) == list(td.exact(PAPER)["areas"]) == areas
    columns = ["regime", "ergodic_components", "volume", *areas, *times]
    table = td.exact_table(1.5, 1.0, [0.2, 0.5])  # the second radius does not fit
    assert (list(table), [*table["ergodic_components"]]) == (columns, [1, None])
    for found in (simulated, sampled, td.mean_times(PAPER), td.areas(PAPER)):
        assert "any_wall" not in found
        with pytest.raises(KeyError, match=r"; did you mean any_wall_(time|area)\?"):
            found["any_wall"]
        assert json.dumps([*found])
    for wrong, said in (("hop", "is none of vertical_hop_time, "), ("any_wal", "mean any_wall_t")):
        with pytest.raises(KeyError, match=said):
            simulated[wrong]
    assert simulated.get("vertical_hop_area") is td.mean_times(PAPER).get("hop") is None
    assert pickle.loads(pickle.dumps(td.areas(PAPER))) == td.areas(PAPER)
    assert td.mean_times(PAPER)["any_wall_time"] == 1 / td.rate(PAPER, "any_wall")


def test_intervals_have_a_mean_and_a_density_at_zero(intervals):
    """Five standard errors: one false alarm in two million."""
    assert abs(intervals.mean.z) < 5
    zero = intervals.at_zero
    assert zero.status == "extrapolated"
    # The curvature of the density over two bins of τ/16 is below a hundredth of it.
    assert abs(zero.value - zero.exact) < 5 * zero.stderr + 0.01 * zero.exact
    assert math.isclose(zero.exact, 3 * math.sqrt(2) / 16 / 0.6)
    frame = intervals.frame()
    assert len(intervals.density) == len(intervals.edges) - 1
    assert [*frame["count"]] == intervals.counts
    assert frame.index.is_unique
    assert "density_at_zero" in str(intervals)


def test_the_exact_table_holds_the_exact_numbers():
    """A radius that does not fit has a row that says why."""
    table = td.exact_table(1.5, 1.0, np.array([0.3, 0.9, 0.1]), field=0.2)
    assert [*table.index] == [0.3, 0.1, 0.9]
    assert table["regime"][0.9].startswith("radius 0.9 does not fit")
    assert math.isnan(table["volume"][0.9])
    assert td.exact_table(1.5, 1.0, [0.3, 0.1])["ergodic_components"].dtype == int
    for radius, row in table.drop(0.9).iterrows():
        scene = td.Scene(1.5, 1.0, radius, field=0.2)
        known = pd.Series({"volume": td.volume(scene), **td.areas(scene), **td.mean_times(scene)})
        np.testing.assert_array_equal(row[known.index].astype(float), known.astype(float))


def test_a_scene_prints_what_it_is():
    scene = td.Scene(1.5, 1.0, 0.2, periodic=["y", "x"], mass_ratio=2)
    assert repr(scene) == "Scene(1.5, 1.0, 0.2, mass_ratio=2.0, periodic='xy')"
    assert str(scene).endswith("in a box of 1.5 × 1.0, mass ratio 2.0, periodic xy")
    assert td.Scene(1.5, 1.0, 0.2, periodic=[]) == PAPER
    assert str(td.Scene(1.5, 1, 0.2, discs=3)) == str(PAPER).replace("Two", "3")
    assert td.Scene(1.5, 1, 0.15, discs=12).unit("volume") == "length²⁴"
    assert str(SCENES["balls"]) == "Two balls of radius 0.2 in a box of 1.5 × 1.0 × 1.2"


# States -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["plain", "rough", "combination"])
def test_starts_are_states(name):
    scene = SCENES.get(name, PAPER)
    found = td.starts(scene, 5, seed=3)
    assert found.dtype.names == components(scene)
    for start in found:
        check_start(scene, start)
    again = td.trajectory(scene, 3, start=found[0])
    assert again.equals(td.trajectory(scene, seed=3, duration=3))
    assert again["time"].iloc[-1] == 3


def test_a_state_is_a_start():
    """Names of numbers decide, not their order."""
    (named,) = td.trajectory(PAPER, duration=1).states_at([1])
    known = {name: float(named[name]) for name in sorted(named.dtype.names)}
    record = np.array([(*known.values(),)], [(name, float) for name in known])[0]
    pair = namedtuple("Start", known)(*known.values())
    due = td.trajectory(PAPER, start=named, duration=1)
    for other in (known, record, pair, pd.Series(known)):
        assert td.trajectory(PAPER, start=other, duration=1).equals(due)


# Figures and tables -------------------------------------------------------------------------------


def test_what_changes_with_time_is_drawn_with_its_errors(tmp_path):
    seen = {"uu": lambda a, b: a["u1"] * b["u1"], "xx": lambda a, b: (b["x1"] - a["x1"]) ** 2}
    averages = td.observe(PAPER, seen, [0, 1, 2], replicas=1)
    (axes,) = td.plot(averages, tmp_path / "averages.png").axes
    moved = td.diffusion(td.Scene(1.5, 1.0, 0.2, periodic="x"), [1, 2], 1)
    panels = td.plot(moved).axes
    for found, drawn in ((averages, axes.containers), (moved, [p.containers[0] for p in panels])):
        for symbols, *columns in zip(drawn, found.mean.T, found.stderr.T, strict=True):
            line, _, (bars,) = symbols.lines
            half = [np.ptp(bar[:, 1]) / 2 for bar in bars.get_segments()]
            np.testing.assert_allclose([*line.get_data(), half], [found.times, *columns], rtol=1e-9)
    assert [text.get_text() for text in axes.get_legend().texts] == ["uu", "xx"]
    assert axes.get_ylabel() == "average"
    assert [p.get_ylabel() for p in panels] == [name.replace("_", " ") for name in moved.names]
    for small in (moved, averages.more(5000)):
        for panel in td.plot(small).axes:
            panel.figure.draw_without_rendering()
            assert panel.yaxis.get_offset_text().get_text() == ""
    eight = td.observe(PAPER, lambda a, b: np.stack([b["x1"]] * 8, axis=1), [1], replicas=1)
    symbols = [drawn.lines[0] for drawn in td.plot(eight).axes[0].containers]
    looks = {(s.get_color(), s.get_marker(), s.get_markerfacecolor()) for s in symbols}
    assert len(looks) == 8
    for some in (PAPER, SCENES["combination"]):
        figure = td.plot(td.observe(some, {"a_place": lambda a, b: b["x1"]}, [1], replicas=1))
        assert figure.axes[0].get_legend() is None
        assert figure.axes[0].get_ylabel() == "a place"
        with style.context():
            assert unclear(figure) == []


def test_tables_come_back_with_units_and_provenance(simulated, sampled, tmp_path):
    one = {"name": "one", "box": PAPER.box.parameters(), "discs": 3, "effects": {"periodic": "x"}}
    folder, provenance = tmp_path / "one", {"seed": 7, "scenes": [one]}
    folder.mkdir()
    SCENE_TABLES["theory"].write(folder / "theory.csv", [])
    SCENE_TABLES["mean_times"].write(folder / "mean_times.csv", simulated.rows)
    SCENE_TABLES["volume"].write(folder / "volume.csv", sampled.rows[:1])
    plugin("tables")["tails"].write(folder / "tails.csv", [])  # of a study
    (folder / "mine.csv").write_text("a,b\n1,2\n")
    several = provenance | {"scenes": [one | {"name": "two"}, one]}
    (tmp_path / "configuration.json").write_text(json.dumps(several))
    found = td.load(folder)
    assert [*found] == ["mean_times", "tails", "theory", "volume"]
    times = found["mean_times"]
    for column in ("estimate", "count"):
        assert [*times[column]] == [row[column] for row in simulated.rows]
    assert times["bound"].isna().all()
    assert times.attrs["units"]["estimate"] == "time"
    assert found["theory"].attrs["units"]["exact"] == "length⁶, length⁵ or time"
    assert times.attrs["meaning"].startswith("One row per radius and event: ")
    column = SCENE_TABLES["mean_times"].columns["estimate"]
    assert times.attrs["meanings"]["estimate"] == column.meaning
    assert times.attrs["path"] == str(folder / "mean_times.csv")
    assert times.attrs["configuration"] == provenance
    assert times.attrs["box"] == td.Box(1.5, 1.0, discs=3, periodic="x").parameters()
    (folder / "configuration.json").write_text('{"seed": 3}')  # as beside the tables of a build
    assert td.load(folder)["volume"].attrs["configuration"] == {"seed": 3}
    (folder / "volume.csv").write_text("radius,quantity\nx,y\n")
    with pytest.raises(td.InputError, match=r"volume\.csv "):
        td.load(folder)


@pytest.mark.parametrize(
    ("scene", "error", "method"),
    [
        (PAPER, {"vertical_hop_area": 4e-3, "volume": 1e-4}, "rejection"),
        (td.Scene(1.5, 1.0, 0.37), {"volume": 3e-4, "disc_collision_area": 0.02}, "conditioned"),
        (td.Scene(1.5, 1.0, 0.2, field=0.5), {"volume": 1e-3}, "rejection"),
        (td.Scene(1.5, 1.0, 0.2, discs=3), 0.02, "insertions"),
    ],
    ids=str,
)  # fmt: skip
def test_samples_are_drawn_until_their_errors_are_reached(scene, error, method):
    """Scores at five sigma; the sums are those of as many samples that were asked for."""
    found = td.sample(scene, error=error, seed=2, method=method)
    frame = found.frame()
    assert {*frame["status"]} <= {"reached", "impossible"}
    reached = frame[frame["status"] == "reached"]
    assert (reached["stderr"] / reached["estimate"] <= reached["target"]).all()
    assert np.allclose(reached["relative_stderr"], reached["stderr"] / reached["estimate"])
    assert all(abs(one.z) < 5 for one in found.values() if one.z is not None)
    assert {*found} == {*(error if isinstance(error, dict) else td.sample(scene, 1))}
    each = 64 if method == "conditioned" else 1
    drawn, same = int(frame["samples"].iloc[0]), {"seed": 2, "method": method}
    again = td.sample(scene, drawn * each, quantities=[*found], **same)
    columns = ["estimate", "stderr", "hits", "samples"]
    pd.testing.assert_frame_equal(again.frame()[columns], frame[columns])
    with pytest.warns(td.AccuracyWarning, match=r"of 1 samples ended the run .* A budget of .* is"):
        short = td.sample(scene, error=1e-5, budget=1, quantities="volume", method=method)
    assert short["volume"].status == "budget"


def test_a_volume_of_hardly_any_overlap_is_not_short_of_a_budget():
    """Too few samples miss it for an error, and the error that they would have is small."""
    dilute = td.sample(td.Scene(1.5, 1.0, 1e-3), error=1e-6, budget=1e6, quantities="volume")
    assert (dilute["volume"].status, dilute.note) == ("too-few", None)


def test_a_method_whose_price_was_printed_can_be_taken():
    """The prices of a rare hop and of the volume; the default is the first or the fastest one."""
    near = td.Scene(1.5, 1.0, 0.249)
    printed = {price.method for price in td.cost(near, 0.1).prices if "hop_time" in price.quantity}
    assert printed == {"dynamics", "strips"}
    asked = {"events": "horizontal_hop", "budget": 1e6}
    starts = {
        method: td.simulate(near, 1, method=method, **asked).frame()["starts"].iloc[0]
        for method in (None, *sorted(printed))
    }
    assert starts == {None: "strip", "strips": "strip", "dynamics": "invariant"}
    for method, made in {None: "monte_carlo", "conditioned": "conditioned"}.items():
        # 1.08 of 64 draws fit.
        assert {*td.sample(PAPER.with_radius(0.352), 1, method=method).frame()["method"]} == {made}


#: Discs that hardly fit: a block has 2¹⁶ conditioned samples, each of which stands for 64 others.
CLOSE = PAPER.with_radius(0.38)
NOTES = """
td.sample(PAPER, 10) → You asked for 10 samples and got 1048576, because work is done in
td.sample(CLOSE, 1e7) → You asked for 10000000 samples and got 196608
td.sample(PAPER, error=0.5) → You asked for an error of 0.5 and got 0.01, because the
td.sample(PAPER, error=0.01, budget=1e6, shell=2e-5, quantities="top_wall_area") → You asked
td.sample(CLOSE, error=1, budget=1) → You asked for a budget of 1, but the smallest run has 4.2e6
td.sample(PAPER, error=0.5, budget=4e5) → You asked for a budget of 400000, but the smallest
td.sample(PAPER, error=0.5, budget=6e5) → You asked for an error of 0.5 and got 0.058
td.intervals(PAPER, "vertical_hop", 10) → You asked for 10 intervals and got 65536
td.observe(PAPER, lambda a, b: b["x1"], [1], 10) → You asked for 10 replicas and
td.observe(PAPER, lambda a, b: b["x1"], [1], 8192) →
td.simulate(PAPER, 0.5) → You asked for an error of 0.5 and got 0.0028, because the smallest run
td.simulate(PAPER, dict.fromkeys(td.EVENTS, 1) | {"top_wall": 0.5}) → You asked for an error of 0.5
td.simulate(PAPER, {"any_wall": 0.5, "horizontal_hop": 0.004}) →
td.simulate(PAPER, 0.5, budget=1) → You asked for a budget of 1, but the smallest run has 250000
td.simulate(PAPER, duration=65536) →
td.simulate(PAPER, duration=100) → You asked for a duration of 100 and got 65536: 1024
td.transmission(td.Scene(1.5, 1, 0.249), "horizontal_hop", 10) → You asked for 10
"""


@pytest.mark.parametrize("line", NOTES.strip().splitlines())
def test_a_result_says_what_was_done_instead(line, recwarn):
    call, _, said = line.partition(" →")
    found = eval(call)
    assert (found.note or "").startswith(said.strip())
    assert bool(found.note) == bool(said) == str(found).endswith(found.note or "no note")
    assert bool(recwarn.list) == ("but the budget" in (found.note or ""))


@pytest.mark.parametrize(
    ("scene", "error", "budget"),
    [
        (PAPER, 1e-3, 1e7), (PAPER.with_radius(0.1), 2e-3, 1e6), (td.Scene(2, 1, 0.22), 1e-3, 1e7),
        (td.Scene(2, 1, 0.22), 2e-3, 2e6), (td.Scene(1.5, 1, 0.2, field=0.5), 2e-3, 2e7),
    ],
    ids=str,
)  # fmt: skip
def test_a_budget_that_ends_a_run_is_a_warning_and_the_budget_that_it_names_is_enough(
    scene, error, budget, recwarn
):
    sentence = f"You asked for an error of {error:g}, but the budget .* A budget of (.*) is enough"
    with pytest.warns(td.AccuracyWarning, match=sentence) as all_:
        found = td.simulate(scene, error, budget=budget / 2).more(budget=budget)
    assert {one.filename for one in all_} == {__file__}  # not a line of the library
    assert str(found).endswith(found.note)
    enough = float(re.match(sentence, found.note)[1])
    assert enough < 20 * budget
    recwarn.clear()
    assert td.simulate(scene, error, budget=enough).note is None
    assert not recwarn.list


def test_a_time_is_simulated_whatever_the_errors_are():
    """Scores of 12 mean times and a rare hop at 5 sigma: one false alarm in 140,000."""
    found = td.simulate(PAPER, duration=2e5, seed=3)
    frame = found.frame()
    total = frame["replicas"] * frame["duration"]
    assert (total >= 2e5).all()
    assert (total < 2e5 + 1024 * frame["duration"]).all()
    assert {*frame["status"]} == {"counted"}
    assert frame["target"].isna().all()
    assert all(abs(m.z) < 5 for m in found.values())
    assert found.more(4e5).rows == td.simulate(PAPER, duration=4e5, seed=3).rows
    # Without strips the rare hop is counted as everything else.
    rare = td.simulate(td.Scene(1.5, 1.0, 0.24), duration=1e5, seed=3)
    assert {*rare.frame()["starts"]} == {"invariant"}
    assert all(abs(m.z) < 5 for m in rare.values() if m.z is not None)
    assert rare["horizontal_hop_time"].z is None  # too few for a score


# Arithmetic ---------------------------------------------------------------------------------------


def test_a_measurement_is_a_number_with_its_error(simulated):
    hop = simulated["vertical_hop_time"]
    assert (f"{hop:.3f}", round(hop, 3)) == (f"{hop.value:.3f}", round(hop.value, 3))
    assert f"{hop}" == str(hop)
    rare = td.simulate(td.Scene(1.5, 1.0, 0.24), 0.3, seed=1)["horizontal_hop_time"]
    for one in (hop, rare):  # the error of the strip
        assert (one.u.nominal_value, one.u.std_dev) == (one.value, pytest.approx(one.stderr))


@pytest.mark.parametrize("radius", [0.01, 1e-4])
def test_an_error_that_is_not_known_is_no_number(radius):
    """Small discs have too few collisions in the samples, tiny ones too few of everything."""
    found = td.sample(td.Scene(1.5, 1.0, radius), 1, seed=1)
    numbers = {m.stderr: m.u.std_dev for m in found.values() if m.value is not None}
    assert math.isnan(numbers.pop(None))
    assert bool(numbers) == (radius == 0.01)
    assert all(error == pytest.approx(stderr) for stderr, error in numbers.items())


@pytest.mark.parametrize("scene", [PAPER, td.Scene(1.5, 1.0, 0.2, discs=3)])
def test_numbers_of_one_run_are_correlated_as_its_counts_are(scene):
    """All hits are those of the right and the top wall, in every replica: no error is left."""
    md = td.simulate(scene, duration=1e4, seed=3)
    walls = ("right_wall", "top_wall", "any_wall")
    hits = [scene.accessible_fraction(w) * scene.copies(w) / md[f"{w}_time"].u for w in walls]
    left = hits[0] + hits[1] - hits[2]
    assert abs(left.nominal_value) < 1e-12
    assert left.std_dev < 1e-6 * hits[2].std_dev
    again = td.simulate(scene, duration=1e4, seed=4)
    # pandas copies attrs deeply in each operation.
    table = md.frame()
    table.attrs |= {"result": md, "wall": md["any_wall_time"]}
    assert (table.copy().attrs["wall"].u / md["any_wall_time"].u).std_dev < 1e-12
    assert table.copy().attrs["result"] is md
    apart = md["any_wall_time"].u - again["any_wall_time"].u
    due = math.hypot(md["any_wall_time"].stderr, again["any_wall_time"].stderr)
    assert apart.std_dev == pytest.approx(due)


def test_a_shell_is_a_part_of_the_volume(sampled):
    """The samples in the shell are a random share of the samples without overlap."""
    area, volume = sampled["vertical_hop_area"], sampled["volume"]
    ratio = area.u / volume.u
    relative = ratio.std_dev / ratio.nominal_value
    assert relative**2 == pytest.approx(1 / area.count - 1 / volume.count)
    # All walls follow from two of them, also if no volume is asked for.
    three = [f"{wall}_area" for wall in ("right_wall", "top_wall", "any_wall")]
    right, top, both = (m.u for m in td.sample(PAPER, 1, quantities=three).values())
    assert (both - 4 * (right + top)).std_dev < 1e-6 * both.std_dev
    # With effects all walls have a shell of their own.
    walls = td.sample(SCENES["rough"], 1)["any_wall_area"]
    assert (walls.u.nominal_value, walls.u.std_dev) == pytest.approx((walls.value, walls.stderr))
    # Insertions count the products of their weights.
    many = td.sample(td.Scene(1.5, 1.0, 0.2, discs=3), 1, seed=1)
    ratio = many["disc_collision_area"].u / many["volume"].u
    due = many.point.ratio({"disc_collision_area": 1.0})
    assert (ratio.nominal_value, ratio.std_dev) == pytest.approx((due.value, due.stderr))
    alone = td.sample(many.scene, 1, seed=1, quantities="disc_collision_area")
    due = many["disc_collision_area"].u.std_dev
    assert alone["disc_collision_area"].u.std_dev == pytest.approx(due)
    # An event at the other wall of an axis is counted by the same sum.
    part = deepcopy(many.components["all"])
    part["quantities"]["bottom_wall_area"] = part["quantities"]["top_wall_area"]
    names, means, covariances = InsertionPoint.of(many.scene, {"all": part}).moments()
    places = [names.index(f"{wall}_wall_area") for wall in ("top", "bottom")]
    assert len({*means[places]}) == len({*covariances[np.ix_(places, places)].flat}) == 1


def test_the_names_of_the_reference_are_those_of_the_code():
    reference = (REPOSITORY / "docs/reference.md").read_text(encoding="utf-8")
    assert sorted(re.findall(r"^\* `td\.(\w+)`$", reference, re.MULTILINE)) == sorted(td.__all__)
