"""Figures of a scene: symbols, error bars and curves are those of the tables; texts stand clear.

Every figure is drawn for many boxes. The numbers in its artists are compared with the rows.
"""

from functools import cache
from itertools import groupby

import numpy as np
import pytest
from factory import of
from figure_cases import BOXES, OTHERS, PAPER, bars, draw, points, tables_of, unclear
from matplotlib.legend import Legend
from matplotlib.markers import CARETUPBASE

from twodiscs import EVENTS, Box
from twodiscs.analysis.tables import row_quantity
from twodiscs.figures import curves, panels, radius, style
from twodiscs.figures.scene_figures import FIGURES
from twodiscs.theory import exact, virial
from twodiscs.theory.laws import small_radius_time
from twodiscs_paper.studies.thresholds.measure import leading_law

#: Boxes that differ most, boxes where labels could meet, and boxes of any size.
QUICK = ("square", "paper", "long", *OTHERS)
TABLED = (*QUICK, "ten", "nearly square", "tiny", "large")

#: Most of the time of a figure is the layout of its texts: fast tests look at them in these boxes.
LAID_OUT = ("paper", "effects")

QUANTITIES = {quantity for entry in FIGURES.values() for quantity in entry.needs}


def quantities(box):
    """Return the quantities that scenes in a box have."""
    absent = {*EVENTS} - {*box.events}
    return {quantity for quantity in QUANTITIES if quantity.rpartition("_")[0] not in absent}


def cases(quick, names=FIGURES):
    """Return the parameters (figure, box), slow except in ``quick`` boxes.

    Drawings are in all plain boxes. A figure with every kind of panel stands for headings and
    names of limits.
    """
    return [
        pytest.param(name, box, marks=[] if box in own else pytest.mark.slow)
        for name, entry in FIGURES.items()
        for own in [quick if entry.tables and name != "mean_hop_time" else QUICK]
        for box in (TABLED if entry.tables else BOXES)
        for sides in [(BOXES | OTHERS)[box]]
        if name in names and entry.shown_for(quantities(sides), sides.options)
    ]


@cache
def drawn(name, box):
    """Return a figure of one of the boxes."""
    return draw(name, (BOXES | OTHERS)[box], tables_of(box))


@pytest.mark.parametrize(("name", "box"), [*cases(LAID_OUT), ("wall_area", "tall")])
def test_texts_stand_clear(name, box):
    figure = drawn(name, box)
    faults = unclear(figure)
    if (name, box) == ("all_areas", "ten"):  # no place for a legend is free of h/4 and the curve
        faults = [one for one in faults if one[1] not in ("exact", "Monte Carlo")]
    assert faults == []
    assert figure.get_size_inches()[0] == (7.0 if name == "all_areas" else style.COLUMN_WIDTH)


def select_numbers(rows, quantity, factor=None, rooted=False):
    """Return (x, y, standard error, residual) of the rows of a quantity that have an error.

    A ``factor`` at each radius turns mean times to rates times this factor.
    """
    found = []
    for row in rows:
        if row_quantity(row) == quantity and row["stderr"]:
            value, error, z = row["estimate"], row["stderr"] / row["estimate"], row["z"]
            if factor:
                value, z = factor(row["radius"]) / value, z and -z
            if rooted:
                value, error = value**0.5, error / 2
            found.append((row["radius"], value, value * error, z))
    return found


VIRIAL = ("right_wall", "top_wall", "disc_collision")


def series(name, box, rows):
    """Yield (panel, panel of residuals, quantity, numbers of the rows, exact curve)."""
    radii, columns = curves.exact_curves(box)
    if name == "all_areas":
        for part in radius.AREA_FIGURES:
            for _, _, *numbers in series(part, box, rows):
                yield part, f"residuals of {part}", *numbers
    elif name == "pressure":
        for panel, events, factor in (
            ("main", ("right_wall", "top_wall"), virial.pressure_factor),
            ("beneath", VIRIAL, lambda scene, event: abs(virial.weights(scene)[event])),
        ):
            known = panel == "main" or virial.has_theorem(box)
            for event in [e for e in events if known and e in box.events]:

                def scale(r, factor=factor, event=event):
                    scene = box.scene(float(r))
                    return factor(scene, event) * scene.accessible_fraction(event)

                times = zip(radii, columns[f"{event}_time"], strict=True)
                curve = [np.nan if np.isnan(time) else scale(r) / time for r, time in times]
                due = select_numbers(rows, f"{event}_time", scale)
                yield panel, panel == "main" and "residuals", event, due, np.array(curve)
    else:
        shown = radius.CURVES[name]
        for quantity in shown.names:
            curve = columns[quantity] ** (0.5 if shown.rooted else 1)
            due = select_numbers(rows, quantity, rooted=shown.rooted)
            if any(row_quantity(row) == quantity for row in rows):
                yield "main", "residuals", quantity, due, curve


@pytest.mark.parametrize(("name", "box"), cases(QUICK, {*radius.CURVES, "all_areas", "pressure"}))
def test_numbers_over_the_radius_are_those_of_the_rows(name, box):
    """Estimates with their errors, residuals, and exact curves, in the order of the quantities.

    The legend names estimates without an error if there are any. Such a pressure is not drawn.
    """
    rows = tables_of(box)[FIGURES[name].tables[0]]
    needs = () if name == "pressure" else FIGURES[name].needs
    own = [row for row in rows if row_quantity(row) in needs]
    texts = [text for one in drawn(name, box).findobj(Legend) for text in one.get_texts()]
    named = {text.get_text() for text in texts}
    rough = any(row["estimate"] is not None and row["stderr"] is None for row in own)
    bound = any(row["estimate"] is None and row.get("bound") is not None for row in own)
    assert (rough, bound) == (panels.CROSS_LOOK[0] in named, panels.ARROW_LOOK[0] in named)
    panel = {axes.get_label(): axes for axes in drawn(name, box).axes}
    found = [*series(name, (BOXES | OTHERS)[box], rows)]
    assert found
    for label, group in groupby(found, key=lambda one: one[0]):
        for (_, lower, _, due, curve), look in zip(group, style.SERIES, strict=False):
            shown = [bar for bar in bars(panel[label], *look) if bar[2]]
            due_bars = np.array(due).reshape(-1, 4)[:, :3].astype(float)
            np.testing.assert_allclose(np.reshape(shown, (-1, 3)), due_bars)
            if lower in panel:
                assert {(x, z) for x, _, _, z in due} <= points(panel[lower], *look)
            lines = [line.get_ydata() for line in panel[label].lines]
            lines = [line for line in lines if len(line) == len(curve)]
            assert any(np.allclose(line, curve, rtol=1e-9, equal_nan=True) for line in lines)


@pytest.mark.parametrize("box", QUICK)
def test_the_histogram_has_the_densities_of_its_bins(box):
    """And marks exact densities at 0 in plain boxes, 3√2/(16 (h − 2r)) in units of the time."""
    rows, sides = tables_of(box)["hop_histogram"], (BOXES | OTHERS)[box]
    whole, short = drawn("hop_histogram", box).axes
    exact_values = []
    for i, (r, group) in enumerate(groupby(rows, key=lambda row: row["radius"])):
        own = list(group)
        mean = own[0]["exact_mean"] or own[0]["mean"]
        exact_values.append(mean * 3 * 2**0.5 / (16 * (sides.height - 2 * r)))
        for axes, bins in ((whole, "wide"), (short, "equal")):
            due = [
                ((r["left"] + r["right"]) / 2 / mean, r["density"] * mean, r["stderr"] * mean)
                for r in of(own, bins=bins)
            ]
            shown = np.array(bars(axes, *style.SERIES[i]))
            assert len(shown) > 5
            assert axes.get_ylim()[0] <= shown[:, 1].min()
            for point in shown:
                assert np.isclose(due, point, rtol=1e-9).all(axis=1).any()
    marked = [line.get_ydata()[0] for line in short.lines if not line.get_clip_on()]
    np.testing.assert_allclose(sorted(marked), sorted(exact_values) if sides.is_plain else [])
    assert (short.get_legend() is not None) == bool(marked)
    assert short.get_ylim()[0] == 0


# Which figures ------------------------------------------------------------------------------------


def test_drawings_are_those_of_all_plain_scenes():
    drawings = [entry for entry in FIGURES.values() if not entry.tables]
    assert all(one.shown_for({"volume"}) for one in drawings)
    assert not any(one.shown_for(QUANTITIES, {"field": 1.5}) for one in drawings)


def test_a_table_of_impossible_hops_or_of_one_area_has_its_figure():
    rows = of(tables_of("paper")["mean_times"], event="horizontal_hop")
    assert [row["status"] for row in rows[-2:]] == ["impossible"] * 2
    draw("mean_hop_time", PAPER, {"mean_times": rows[-2:]}).draw_without_rendering()
    rows = of(tables_of("paper")["areas"], quantity="any_wall_area")
    draw("all_areas", PAPER, {"areas": rows}).draw_without_rendering()


# Laws and corners ---------------------------------------------------------------------------------


def laws_in(axes):
    """Return the dashed lines of the limiting laws, as (abscissae, ordinates)."""
    return [line.get_data() for line in axes.lines if line.get_zorder() == 6]


@pytest.mark.parametrize("name", ["mean_hop_time", "mean_collision_time", "mean_wall_time"])
def test_laws_of_plain_scenes_are_not_drawn_with_effects(name):
    for box in ("paper", *OTHERS):
        assert any(laws_in(axes) for axes in drawn(name, box).axes) == (box == "paper")


def test_limiting_laws_run_into_the_curves():
    """The law for small discs begins at the limit r → 0, and that of the end ends on the curve."""
    small, last = laws_in(drawn("mean_collision_time", "paper").axes[0])
    assert small[0][-1] == radius.SMALL_RANGE * PAPER.largest_radius
    assert small[1][0] == small_radius_time(PAPER, "disc_collision", small[0][0])
    time = exact.mean_times(PAPER.scene(float(last[0][-1])))["disc_collision"]
    assert last[1][-1] == pytest.approx(time, rel=1e-3)


def test_laws_of_pressures_begin_where_no_hop_is_left():
    first = [min(radii) for radii, _ in laws_in(drawn("pressure", "paper").axes[0])]
    assert 0.375 <= min(first) <= max(first) < 0.376


def test_times_approach_the_end_of_their_hop():
    """The panel beneath: curves, estimates and laws over the distance from w/4 or h/4."""
    lower = drawn("mean_hop_time", "paper").axes[2]
    ends = {"vertical_hop": 0.375, "horizontal_hop": 0.25}
    curves = [line.get_xydata()[-1] for line in lower.lines if line.get_zorder() == 5]
    lines = zip(ends.items(), laws_in(lower), curves, strict=True)
    for (event, end), (distances, times), (far, time) in lines:
        assert time == pytest.approx(exact.mean_times(PAPER.scene(end * (1 - far)))[event])
        law = leading_law(PAPER, event)
        np.testing.assert_allclose(times, law.coefficient * (end * distances) ** -2, rtol=1e-5)
        assert distances.max() < radius.LAW_RANGE
    rows = of(tables_of("paper")["mean_times"], event="horizontal_hop")
    shown = {x for line in lower.lines if line.get_marker() == "s" for x in line.get_xdata()}
    assert shown == {1 - row["radius"] / 0.25 for row in rows if row["stderr"]}


def test_blocked_hop_area_is_shown_as_zero():
    axes = drawn("horizontal_hop_area", "paper").axes[0]
    blocked = {(r["radius"], 0.0) for r in tables_of("paper")["volume"] if r["radius"] > 0.25}
    assert blocked <= points(axes, *style.SERIES[0]) != set()


def test_an_estimate_above_or_below_the_curve_is_in_the_picture():
    first, *others = of(tables_of("paper")["areas"], quantity="vertical_hop_area")
    far = first | {"estimate": 1.2 * first["exact"], "stderr": 0.1 * first["exact"]}
    main = draw("vertical_hop_area", PAPER, {"areas": [far, *others]}).axes[0]
    assert main.get_ylim()[1] > (1.2 * first["exact"]) ** 0.5
    rows = [row for row in tables_of("paper")["mean_times"] if row["estimate"]]
    slow = [row | {"estimate": 2 * row["estimate"]} for row in rows]
    assert draw("pressure", PAPER, {"mean_times": slow}).axes[0].get_ylim()[0] < 1 / 2


def test_curves_are_drawn_to_their_end_without_any_residual():
    """Times from too few events for an error: a panel for them and one beneath."""
    rough = {"stderr": None, "z": None, "status": "too-few"}
    rows = [row | rough for row in tables_of("paper")["mean_times"] if row["estimate"]]
    figure = draw("mean_hop_time", PAPER, {"mean_times": rows})
    assert [axes.get_label() for axes in figure.axes] == ["main", "beneath"]


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("estimate", [1.4e-3, None])
def test_a_single_value_has_an_ordinate_around_it(estimate):
    """And there is one where nothing is known at all."""
    alone = tables_of("paper")["volume"][0] | {"exact": None, "z": None, "estimate": estimate}
    low, high = draw("volume", Box(3.0, 1.5, discs=8), {"volume": [alone]}).axes[0].get_ylim()
    assert low < (estimate or 1) < high
    assert 2.9 < high / low < 10


def test_every_status_has_its_symbol():
    """A cross without an error, a caret for a bound, triangles for residuals beyond the panel."""
    look, empty = style.SERIES[0], dict.fromkeys(("estimate", "stderr", "z", "bound"))
    values = {
        0.1: {"estimate": 1.0, "stderr": 0.1, "z": 1.0},
        0.15: {"estimate": 1.2, "z": -0.5},
        0.2: {"bound": 3.0},
        0.25: {"z": 0.0, "test": "certain"},
        0.3: {"estimate": 2.0, "stderr": 0.1, "z": 9.0},
        0.35: {"estimate": 2.0, "stderr": 0.1, "z": -40.0},
    }
    rows = [{"radius": r, "test": "normal"} | empty | some for r, some in values.items()]
    with style.context():
        _, main, lower, _ = panels.radius_panels(PAPER, "")
        one = panels.Series("", rows, np.array([1.0, 1.0]))
        panels.draw_series(main, lower, np.array([0.1, 0.2]), [one])
    assert points(main, *look) == {(0.1, 1.0), (0.3, 2.0), (0.35, 2.0)}
    assert points(main, look[0], "x") == {(0.15, 1.2)}
    caret = [line for line in main.lines if not isinstance(line.get_marker(), str)]
    assert [(*line.get_xdata(), line.get_marker()) for line in caret] == [(0.2, CARETUPBASE)]
    assert points(lower, *look) == {(0.1, 1.0), (0.15, -0.5)}
    assert points(lower, look[0], "^") == {(0.3, 0.97 * panels.LARGEST_RESIDUAL)}
    assert points(lower, look[0], "v") == {(0.35, -0.97 * panels.LARGEST_RESIDUAL)}


@pytest.mark.parametrize(
    ("number", "text"), [(100.0, "100"), (3e-6, r"3\times10^{-6}"), (1e-5, "10^{-5}")]
)
def test_small_and_large_numbers_are_written_with_powers_of_ten(number, text):
    assert panels.mathtext(number) == text
    assert panels.numbers([number, 0.2]) == [text, "0.2" if number > 1 else r"2\times10^{-1}"]


@pytest.mark.parametrize(
    ("ratio", "named"), [(100, []), (99, [20, 50]), (3, [20, 50]), (2.9, [20, 30, 50, 70])]
)
def test_ticks_between_powers_of_ten_have_numbers_if_these_are_few(ratio, named):
    axis = style.new_figure(1.0).subplots(subplot_kw={"ylim": (10, 10 * ratio)}).yaxis
    panels.label_decades(axis, ratio)
    assert [x for x in range(20, 100, 10) if axis.get_minor_formatter()(x)] == named


def test_a_power_of_ten_of_all_ticks_is_at_the_end_of_the_axis():
    axis = style.new_figure(1.0).subplots(subplot_kw={"ylim": (1e-8, 9e-8)}).yaxis
    panels.label_decades(axis, 9)
    assert axis.get_major_formatter().get_offset() == r"$\times10^{-8}$"
    assert (axis.get_major_formatter()(1e-8), axis.get_minor_formatter()(5e-8)) == ("1", "5")
