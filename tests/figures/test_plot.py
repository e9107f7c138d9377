"""Plots of the face: they show every measured value, and leave the user's settings alone."""

import copy
import pickle
import re
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from effect_scenes import PAPER, SCENES
from factory import EXPECTED, of
from figure_cases import bars, points
from matplotlib.figure import Figure
from matplotlib.image import imread

import twodiscs as td
from twodiscs.figures import curves, style
from twodiscs.figures.draw import BOX_DRAWINGS, TABLE_FIGURES

HOPS, COLLISIONS = "vertical_hop", "disc_collision"
RADII = (0.1, 0.2, 0.24)


@cache
def scan(*events, width=1.5):
    return td.scan(width, 1.0, RADII, error=0.1, events=events)


def test_the_docstring_names_every_figure():
    named = {*re.findall(r"``(\w+)``", td.plot.__doc__.partition("Names of figures:")[2])}
    assert named == {*TABLE_FIGURES, *BOX_DRAWINGS, "transmission", "observed"}


def due_bars(found, event):
    """Return (radius, estimate, standard error) of the rows of a scan on an event."""
    rows = [row for result in found for row in of(result.rows, event=event)]
    return [(row["radius"], row["estimate"], row["stderr"]) for row in rows]


@pytest.mark.filterwarnings("error")
def test_all_events_of_a_scan_are_drawn_with_their_errors():
    found = scan(HOPS, COLLISIONS)
    figure = td.plot(found)
    main, lower = figure.axes
    assert [axes.get_label() for axes in figure.axes] == ["main", "residuals"]
    both = td.plot([scan(HOPS), scan(COLLISIONS)]).axes[0]
    for event in (HOPS, COLLISIONS):
        look = style.EVENT_LOOKS[event]
        np.testing.assert_allclose(bars(main, *look), due_bars(found, event), rtol=1e-9)
        z = {(row["radius"], row["z"]) for one in found for row in of(one.rows, event=event)}
        assert z <= points(lower, *look)
        assert len(z) == len(RADII)
        assert bars(both, *look) == bars(main, *look)
    loaded = td.plot(td.load(EXPECTED / "paper")["mean_times"]).axes[0]
    assert all(points(loaded, *look) for look in style.EVENT_LOOKS.values())


def test_all_areas_stand_first_if_there_are_several():
    areas = td.load(EXPECTED / "paper")["areas"]
    for rows, first in ((areas, "areas, v"), (areas.iloc[[-1]], "wall_area, ")):
        with pytest.raises(td.InputError, match=f"figure must be one of {first}"):
            td.plot(rows, figure="x")


def test_a_warning_names_what_is_not_drawn():
    found = td.sample(PAPER, 2**20)
    said = r"volume does not show vertical_hop_area, .*areas"
    with pytest.warns(UserWarning, match=said) as all_:
        td.plot(found)
    assert all_[0].filename == __file__
    with pytest.warns(UserWarning, match=said) as all_:
        exec("plot(found)", {"plot": td.plot, "found": found})  # code of no module
    assert all_[0].filename == "<string>"
    assert td.plot(found, figure="areas").axes[0].get_ylabel() == "area $S$ (length$^3$)"


def test_two_boxes_are_drawn_in_axes_of_the_user(tmp_path):
    part = Figure().subfigures(1, 2)[0]
    axes = part.add_subplot()
    one, two = scan(HOPS), scan(HOPS, width=2.0)
    assert td.plot(one, ax=axes) is part.get_figure(root=True)
    td.plot(two, tmp_path / "two.pdf", ax=axes)
    assert (tmp_path / "two.pdf").stat().st_size > 5000
    for found, look in zip((one, two), style.EVENT_LOOKS.values(), strict=False):
        td.plot(found, ax=(alone := Figure().add_subplot()))
        low, *ends, high = sorted([*axes.get_ylim(), *alone.get_ylim()])
        assert (low, high) == axes.get_ylim(), ends
        np.testing.assert_allclose(bars(axes, *look), due_bars(found, HOPS), rtol=1e-9)
        exact = curves.exact_curves(found[0].scene.box)[1][f"{HOPS}_time"]
        drawn = [line.get_ydata() for line in axes.lines if line.get_color() == look[0]]
        assert any(np.array_equal(line, exact, equal_nan=True) for line in drawn)


def test_what_a_transmission_leaves_falls_at_twice_its_rate():
    """The points with their errors, and the curve κ exp(−2κt/τ) of the coefficient."""
    found = td.transmission(td.Scene(1.5, 1.0, 0.249), "horizontal_hop", 2**12)
    # Two neighbours among more discs hop less often than any pair does.
    found = replace(found, neighbour_mean=2 * found.exact_mean)
    (axes,) = td.plot(found).axes
    assert axes.get_title("left").endswith(r"1.5\times1$,  $r=0.249$,  horizontal hops")
    frame = found.frame().reset_index()
    known = frame["stderr"].notna()
    assert 0 < known.sum() < len(frame)
    due = frame.loc[known, ["time", "kappa", "stderr"]]
    np.testing.assert_allclose(bars(axes, *style.EVENT_LOOKS["horizontal_hop"]), due, rtol=1e-9)
    (crosses,) = (line.get_xydata() for line in axes.lines if line.get_marker() == "x")
    np.testing.assert_allclose(crosses, frame.loc[~known, ["time", "kappa"]], rtol=1e-12)
    (times, values), *_ = (line.get_data() for line in axes.lines if "clusters" in line.get_label())
    kappa = found.coefficient.value
    np.testing.assert_allclose(values, kappa * np.exp(-kappa * times / found.exact_mean), 1e-12)
    times, values = next(n.get_data() for n in axes.lines if n.get_label() == "exact slope at 0")
    np.testing.assert_allclose(values, 1 - 3 * 2**0.5 / 8 * times / (1.5 - 2 * 0.249), rtol=1e-12)
    # Hops that are not rare, in a field: neither the exact slope nor the plateau is known.
    (axes,) = td.plot(td.transmission(SCENES["field"], "horizontal_hop", 2**8)).axes
    assert axes.get_legend() is None
    assert style.BLACK not in {line.get_color() for line in axes.lines}


# The user's process and axes ----------------------------------------------------------------------


def test_a_returned_figure_is_saved_as_plot_saves_it(tmp_path):
    """By its own method, also after it was pickled."""
    figure = td.plot(PAPER, tmp_path / "ours.png")
    pickle.loads(pickle.dumps(figure)).savefig(tmp_path / "own.png")
    np.testing.assert_array_equal(imread(tmp_path / "own.png"), imread(tmp_path / "ours.png"))
    figure.savefig(tmp_path / "own.pdf")
    assert b"/Type3" not in (tmp_path / "own.pdf").read_bytes()


def test_plots_in_threads_are_those_of_one_thread():
    """As a notebook shows them; a copy can be changed. test_process looks at the settings."""
    with ThreadPoolExecutor(2) as pool:
        first, second = pool.map(lambda _: td.plot(PAPER)._repr_png_(), range(2))
    figure = td.plot(PAPER)
    assert first == second == figure._repr_png_()
    other = copy.deepcopy(figure)
    other.axes[0].set_title("another")
    assert other._repr_png_() != first


# Curves -------------------------------------------------------------------------------------------


@pytest.mark.filterwarnings("error")  # nothing was measured, so nothing is left out
def test_exact_values_alone_are_curves():
    """Lines without symbols and residuals; all quantities of the table can be chosen."""
    table = td.exact_table(1.5, 1.0, [0.1, 0.2, 0.6])
    main, *others = td.plot(table).axes
    (volume,) = td.plot(table, figure="volume").axes
    assert not others
    curves = [line for line in main.lines if len(line.get_xdata()) > 2]
    assert len(curves) == 6
    assert main.get_legend() is None  # no place in the panel is large enough for six names
    assert {line.get_marker() for line in curves} == {"None"}
    (curve,) = (line for line in volume.lines if len(line.get_xdata()) > 2)
    radii, values = curve.get_data()
    known = np.isfinite(radii)
    found = np.interp([0.1, 0.2], radii[known], values[known])
    np.testing.assert_allclose(found, table["volume"].iloc[:2], rtol=1e-3)


def test_exact_values_of_four_and_more_discs_are_bars_at_the_radii_of_the_table():
    """A curve would take up to a minute for each of its radii."""
    table = td.exact_table(2.5, 0.6, [0.19, 0.22], discs=5)
    main = td.plot(table).axes[0]
    bars = [line for line in main.lines if line.get_marker() == "_"]
    assert len(bars) == 5
    assert all(set(bar.get_xdata()[::2]) == {0.19, 0.22} for bar in bars)
    heights = np.concatenate([bar.get_ydata()[::2] for bar in bars])
    low, high = main.get_ylim()
    assert low < heights.min() < heights.max() < high
    assert [axes.get_label() for axes in td.plot(table, figure="mean_hop_time").axes] == ["main"]
