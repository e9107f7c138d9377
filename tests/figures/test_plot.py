"""Figures of the face: no measured value is lost, in new axes or in the user's."""

import copy
import pickle
import warnings
from concurrent.futures import ThreadPoolExecutor

import matplotlib
import matplotlib.pyplot as plt
import numpy as np
import pytest
from figure_cases import bars, covered, points
from matplotlib.figure import Figure
from PIL import Image

import twodiscs as td
from twodiscs.figures import animation, curves, panels, style
from twodiscs.figures.style import LOOKS, name_of
from twodiscs.model.box import Box

HOPS, COLLISIONS = "vertical_hop", "disc_collision"
RADII = (0.1, 0.2, 0.24)


def scan(*events, **effects):
    return td.scan(1.5, 1.0, RADII, error=0.1, events=events, **effects)


@pytest.mark.filterwarnings("error")
def test_all_events_of_a_scan_are_drawn_with_their_errors():
    found = scan(HOPS, COLLISIONS)
    figure = td.plot(found)
    main, lower = figure.axes
    assert [axes.get_label() for axes in figure.axes] == ["main", "residuals"]
    rows = [row for result in found for row in result.rows]
    for event in (HOPS, COLLISIONS):
        own = [row for row in rows if row["event"] == event]
        due = [(row["radius"], row["estimate"], row["stderr"]) for row in own]
        assert len(due) == len(RADII)
        np.testing.assert_allclose(bars(main, *LOOKS[event]), due, rtol=1e-9)
        assert {(row["radius"], row["z"]) for row in own} <= points(lower, *LOOKS[event])
    legend = [text.get_text() for text in main.get_legend().get_texts()]
    assert legend == [name_of(HOPS), name_of(COLLISIONS)]


def test_a_warning_names_what_is_not_drawn():
    found = td.sample(td.Scene(1.5, 1.0, 0.2), 2**20)
    with pytest.warns(
        UserWarning, match=r"volume does not show vertical_hop_area, .*areas"
    ) as all_:
        td.plot(found)
    assert all_[0].filename == __file__
    assert td.plot(found, figure="areas").axes[0].get_ylabel() == "area $S$"


@pytest.mark.parametrize("event", [HOPS, "horizontal_hop", COLLISIONS, "right_wall"])
def test_the_legend_of_a_single_event_covers_nothing(event):
    with style.context():
        assert covered(td.plot(scan(event)).axes[0]) == []


def test_two_boxes_are_drawn_in_axes_of_the_user(tmp_path):
    axes = Figure().add_subplot()
    one, two = scan(HOPS), scan(HOPS, field=1.0)
    assert td.plot(one, ax=axes) is axes.figure
    low = axes.get_ylim()
    td.plot(two, tmp_path / "two.pdf", ax=axes)
    assert (tmp_path / "two.pdf").stat().st_size > 5000
    assert axes.get_ylim()[0] <= low[0] < low[1] <= axes.get_ylim()[1]
    for found, look in zip((one, two), LOOKS.values(), strict=False):
        rows = [row for result in found for row in result.rows]
        due = [(row["radius"], row["estimate"], row["stderr"]) for row in rows]
        np.testing.assert_allclose(bars(axes, *look), due, rtol=1e-9)
        exact = curves.exact_curves(Box.of(found[0].scene))[1][f"{HOPS}_time"]
        drawn = [line.get_ydata() for line in axes.lines if line.get_color() == look[0]]
        assert any(np.array_equal(line, exact, equal_nan=True) for line in drawn)
    names = [text.get_text() for text in axes.get_legend().get_texts()]
    assert names == [f"vertical hops, {panels.heading(Box.of(f[0].scene))[0]}" for f in (one, two)]


def test_scans_of_one_box_are_one_plot_and_of_two_boxes_a_sentence():
    one, two = scan(HOPS), scan(COLLISIONS)
    names = td.plot([one, two]).axes[0].get_legend().get_texts()
    assert [text.get_text() for text in names] == [name_of(HOPS), name_of(COLLISIONS)]
    with pytest.raises(td.InputError, match="for several boxes call plot with the same ax for"):
        td.plot([one, scan(HOPS, field=1.0)])


def test_only_results_over_the_radius_are_drawn_in_axes_of_the_user():
    trajectory = td.trajectory(td.Scene(1.5, 1.0, 0.2), duration=2)
    with pytest.raises(td.InputError, match="result must be over the radius to be drawn in ax"):
        td.plot(trajectory, ax=Figure().add_subplot())


@pytest.mark.parametrize("name", ["mean_times", "pressure", "mean_wall_time"])
def test_the_figures_of_a_result_are_those_of_its_events(name):
    found = scan("right_wall", COLLISIONS)
    assert td.plot(found, figure=name).axes[0].get_label() == "main"
    with pytest.raises(
        td.InputError, match="figure must be one of mean_times, mean_collision_time"
    ):
        td.plot(found, figure="mean_hop_time")


def test_what_a_transmission_leaves_falls_at_twice_its_rate():
    """The points with their errors, and the curve κ exp(−2κt/τ) of the coefficient."""
    found = td.transmission(td.Scene(1.5, 1.0, 0.249), "horizontal_hop", 2**12)
    (axes,) = td.plot(found).axes
    frame = found.frame().reset_index()
    known = frame["stderr"].notna()
    assert 0 < known.sum() < len(frame)
    due = frame.loc[known, ["time", "kappa", "stderr"]]
    np.testing.assert_allclose(bars(axes, *LOOKS["horizontal_hop"]), due, rtol=1e-9)
    (crosses,) = (line.get_xydata() for line in axes.lines if line.get_marker() == "x")
    np.testing.assert_allclose(crosses, frame.loc[~known, ["time", "kappa"]], rtol=1e-12)
    (times, values), *_ = (line.get_data() for line in axes.lines if "clusters" in line.get_label())
    kappa = found.coefficient.value
    expected = kappa * np.exp(-2 * kappa * times / found.exact_mean)
    np.testing.assert_allclose(values, expected, rtol=1e-12)


# The user's process and axes ----------------------------------------------------------------------


def pixels(path):
    return np.asarray(Image.open(path).convert("RGB"))


def test_a_returned_figure_is_saved_as_plot_saves_it(tmp_path):
    """By its own method, after it was pickled, and as a notebook shows a copy that was changed."""
    figure = td.plot(scan(HOPS), tmp_path / "ours.png")
    figure.savefig(tmp_path / "own.png")
    pickle.loads(pickle.dumps(figure)).savefig(tmp_path / "pickled.png")
    ours = pixels(tmp_path / "ours.png")
    for name in ("own", "pickled"):
        np.testing.assert_array_equal(pixels(tmp_path / f"{name}.png"), ours)
    figure.savefig(tmp_path / "own.pdf")
    assert b"/Type3" not in (tmp_path / "own.pdf").read_bytes()
    other = copy.deepcopy(figure)
    other.axes[0].set_title("another")
    assert other._repr_png_() != figure._repr_png_()


def test_plots_in_threads_leave_the_settings_of_matplotlib_alone():
    found, before = scan(HOPS), dict(matplotlib.rcParams)
    expected = td.plot(found)._repr_png_()
    with ThreadPoolExecutor(2) as pool:
        figures = [*pool.map(lambda _: td.plot(found), range(3))]
    assert dict(matplotlib.rcParams) == before
    assert all(figure._repr_png_() == expected for figure in figures)


def test_axes_of_the_user_may_be_in_a_part_of_a_figure(tmp_path):
    parts = Figure().subfigures(1, 2)
    drawn = td.plot(scan(HOPS), tmp_path / "part.png", ax=parts[0].add_subplot())
    assert drawn is parts[0].get_figure(root=True)
    assert (tmp_path / "part.png").exists()


@pytest.mark.parametrize(
    "axes",
    [Figure().add_subplot(projection="3d"), Figure().subplots(2), Figure(), "main"],
    ids=["3d", "array", "figure", "text"],
)
def test_other_axes_are_refused(axes):
    with pytest.raises(td.InputError, match="ax must be one plane Axes of matplotlib, not "):
        td.plot(scan(HOPS), ax=axes)


# Animations ---------------------------------------------------------------------------------------

EFFECTS = [
    {"field": 1.5},
    {"periodic": "x"},
    {"depth": 1.2, "periodic": "xz"},
    {"moment_of_inertia": 0.5, "mass_ratio": 2.0},
]


@pytest.mark.parametrize("effects", EFFECTS, ids=str)
def test_scenes_with_effects_are_animated(effects, tmp_path, monkeypatch):
    monkeypatch.setattr(animation, "BEFORE", 1)
    monkeypatch.setattr(animation, "AFTER", 1)
    scene = td.Scene(1.5, 1.0, 0.2, **effects)
    td.animate(td.trajectory(scene, duration=20), tmp_path / "two.gif")
    assert Image.open(tmp_path / "two.gif").n_frames > 1


def test_discs_are_where_the_trajectory_has_them_on_a_periodic_axis():
    """Which goes on beyond the box, while a table keeps the separation within one period."""
    scene = td.Scene(1.5, 1.0, 0.2, periodic="x")
    found = td.trajectory(scene, duration=60)
    assert np.abs(found["x1"] - found["x2"]).max() > 1.0
    with style.context():
        stage = animation.Stage(Box.of(scene), scene.radius, found.to_dict("records"))
    times = np.linspace(0, 60, 50)
    states = found.states_at(times)
    for disc in (1, 2):
        due = np.column_stack([states[f"x{disc}"], states[f"y{disc}"]])
        np.testing.assert_allclose(stage.places(disc, times), due, atol=1e-12)


def test_exact_values_alone_are_curves():
    """Lines without symbols and residuals; all quantities of the table can be chosen."""
    table = td.exact_table(1.5, 1.0, [0.1, 0.2, 0.6])
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # nothing was measured, so nothing is left out
        main, *others = td.plot(table).axes
        (volume,) = td.plot(table, figure="volume").axes
        hops = td.plot(table, figure="mean_hop_time").axes
    assert not others
    assert [axes.get_label() for axes in hops] == ["main", "beneath"]
    curves = [line for line in main.lines if len(line.get_xdata()) > 2]
    assert len(curves) == 6
    assert {line.get_marker() for line in curves} == {"None"}
    assert [text.get_text() for text in volume.get_legend().get_texts()] == ["exact"]
    (curve,) = (line for line in volume.lines if len(line.get_xdata()) > 2)
    radii, values = curve.get_data()
    known = np.isfinite(radii)
    found = np.interp([0.1, 0.2], radii[known], values[known])
    np.testing.assert_allclose(found, table["volume"].iloc[:2], rtol=1e-3)
    figure, own = plt.subplots()
    td.plot(table, ax=own, figure="volume")
    assert own.lines
    plt.close(figure)
