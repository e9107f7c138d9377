"""Panels: labels that keep clear of each other, and a symbol for every kind of row."""

import numpy as np
import pytest
from effect_scenes import SCENES
from figure_cases import PAPER, unclear

from twodiscs.figures import panels, style
from twodiscs.model.box import Box


def row(radius, **values):
    shown = {"radius": radius, "estimate": None, "stderr": None, "z": None, "bound": None}
    return shown | {"test": "normal"} | values


def drawn_lines(rows):
    """Draw ``rows`` of one series and return {(panel, marker): abscissae and ordinates}."""
    with style.context():
        _, main, lower, _ = panels.over_radius(PAPER, "")
        before = set(main.lines) | set(lower.lines)
        one = panels.Series("", rows, np.array([1.0, 1.0]))
        panels.draw_series(main, lower, np.array([0.1, 0.2]), [one])
        found = {}
        for name, axes in (("main", main), ("lower", lower)):
            for line in set(axes.lines) - before:
                if len(line.get_xdata()) and line.get_linestyle() == "None":
                    points = zip(line.get_xdata(), line.get_ydata(), strict=True)
                    found[name, line.get_marker()] = sorted(points)
        return found


def test_every_status_has_its_symbol():
    found = drawn_lines(
        [
            row(0.1, estimate=1.0, stderr=0.1, z=1.0),
            row(0.15, estimate=1.2, z=-0.5),
            row(0.2, bound=3.0),
            row(0.25, z=0.0, test="certain"),
            row(0.3, estimate=2.0, stderr=0.1, z=9.0),
            row(0.35, estimate=2.0, stderr=0.1, z=-40.0),
        ]
    )
    assert found["main", "o"] == [(0.1, 1.0), (0.3, 2.0), (0.35, 2.0)]
    assert found["main", "x"] == [(0.15, 1.2)]
    (caret,) = [points for (_, marker), points in found.items() if not isinstance(marker, str)]
    assert [x for x, _ in caret] == [0.2]
    assert found["lower", "o"] == [(0.1, 1.0), (0.15, -0.5)]
    assert found["lower", "^"] == [(0.3, 0.97 * panels.LARGEST_RESIDUAL)]
    assert found["lower", "v"] == [(0.35, -0.97 * panels.LARGEST_RESIDUAL)]


@pytest.mark.parametrize(
    ("effects", "symbols"),
    [
        ({}, []),
        ({"periodic": "xy"}, ["$x$, $y$ periodic"]),
        ({"field": 1.5}, ["$g=1.5$"]),
        ({"field": 2.5e-6}, [r"$g=2.5\times10^{-6}$"]),
        ({"mass_ratio": 2, "radius_ratio": 0.5}, ["$r_2/r_1=0.5$", "$m_2/m_1=2$"]),
    ],
    ids=str,
)
def test_effects_are_written_in_symbols(effects, symbols):
    assert sorted(panels.effects(Box(1.5, 1.0, effects))) == sorted(symbols)


@pytest.mark.parametrize(
    ("number", "text"),
    [
        (1.5, "1.5"),
        (100.0, "100"),
        (3e-6, r"3\times10^{-6}"),
        (1e-5, "10^{-5}"),
        (2.5e7, r"2.5\times10^{7}"),
    ],
)
def test_small_and_large_numbers_are_written_with_powers_of_ten(number, text):
    assert panels.math_of(number) == text


def test_sides_are_told_from_powers_of_ten():
    assert panels.sides(Box(1.5, 1)) == r"1.5\times1"
    assert panels.sides(Box(3e-6, 1e-5)) == r"(3\times10^{-6})\times10^{-5}"


@pytest.mark.parametrize("name", SCENES)
def test_limits_and_effects_of_a_box_stand_clear(name):
    with style.context():
        figure, *_ = panels.over_radius(Box.of(SCENES[name]), "volume $V$")
        assert unclear(figure) == []


@pytest.mark.parametrize(
    ("ends", "labels"),
    [
        ((1.3, 2.3), ["1.4", "1.6", "1.8", "2", "2.2"]),
        ((0.9, 30), ["1", "2", "5", "10", "20"]),
        ((9e-6, 3e-4), ["0.1", "0.2", "0.5", "1", "2", r"$\times10^{-4}$"]),
    ],
)
def test_a_short_logarithmic_axis_has_labels(ends, labels):
    with style.context():
        axes = style.new_figure(2).add_axes((0.2, 0.2, 0.7, 0.7))
        axes.set(yscale="log", ylim=ends)
        panels.label_decades(axes.yaxis, ends[1] / ends[0])
        axes.figure.draw_without_rendering()
        ticks = [*axes.yaxis.get_major_ticks(), *axes.yaxis.get_minor_ticks()]
        shown = [
            (tick.get_loc(), tick.label1.get_text())
            for tick in ticks
            if ends[0] <= tick.get_loc() <= ends[1] and tick.label1.get_text()
        ]
        shown = [text for _, text in sorted(shown)]
        shown += filter(None, [axes.yaxis.get_offset_text().get_text()])
    assert shown == labels
