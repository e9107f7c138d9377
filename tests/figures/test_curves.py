"""Exact curves: they break where times jump, and end close to the limits of a regime."""

import re
from itertools import pairwise

import numpy as np
import pytest
from figure_cases import BOXES, PAPER

from twodiscs.figures import curves, radius
from twodiscs.figures.scene_figures import FIGURES, Caption
from twodiscs.model.scene import Box


@pytest.mark.parametrize("box", BOXES.values(), ids=BOXES)
def test_curves_approach_every_limit_from_both_sides(box):
    ends = [0, *(radius for radius, _ in curves.limits(box))]
    for branch, (low, high) in zip(curves.branches(box), pairwise(ends), strict=True):
        assert (np.diff([low, *branch, high]) > 0).all()
        assert branch[0] - low <= 1.01e-4 * (high - low)
        assert high - branch[-1] <= 1e-8 * high
    # Limits of other boxes below its largest radius are limits too.
    others = (ends[-2] + ends[-1]) / 2, 2 * ends[-1]
    assert len(curves.branches(box, others)) == len(ends)


@pytest.mark.parametrize(("discs", "joined"), [(3, True), (4, False)])
def test_more_than_three_discs_have_no_curve(discs, joined):
    """A radius may take minutes, so that each one of the table stands alone."""
    rows = [{"radius": radius} for radius in (0.2, 0.1, 0.2)]
    branches = curves.branches(Box(1.5, 1.0, discs=discs), rows=rows)
    assert (max(map(len, branches)) > 1) == joined
    assert joined or [*map(float, np.concatenate(branches))] == [0.1, 0.2]


def test_curves_break_where_times_jump():
    radii, exact = curves.exact_curves(PAPER)
    gaps = np.flatnonzero(np.isnan(radii))
    assert len(gaps) == 3
    for event, factors in (("right_wall", [2, 1]), ("top_wall", [1, 2]), ("any_wall", [1, 1])):
        times = exact[f"{event}_time"]
        assert np.isnan(times[gaps]).all()
        # The curves come within 1e-9 of the limits; near w/4 the times change fast.
        jumps = times[gaps[:2] - 1] / times[gaps[:2] + 1]
        np.testing.assert_allclose(jumps, factors, rtol=1e-5)
    impossible = radii > PAPER.height / 4
    assert np.isnan(exact["horizontal_hop_time"][impossible]).all()
    assert (exact["horizontal_hop_area"][impossible] == 0).all()


def test_a_root_is_zero_without_a_hit_of_a_blocked_hop_and_shows_hits_that_are_wrong():
    row = {"quantity": "horizontal_hop_area", "exact": 0.0, "z": None}
    rows = [row | {"radius": 0.30, "hits": 0, "estimate": None, "stderr": None}]
    rows += [row | {"radius": 0.31, "hits": 9, "estimate": 0.04, "stderr": 0.01}]
    (symbols,) = radius.draw("horizontal_hop_area", PAPER, rows).axes[0].containers[:1]
    points, _, (bars,) = symbols
    assert points.get_xydata().tolist() == [[0.3, 0.0], [0.31, 0.2]]
    assert np.ptp(bars.get_segments(), axis=1)[:, 1] == pytest.approx([0.0, 2 * 0.01 / 0.4])


# Limits -------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("effects", "expected"),
    [
        ({}, {"h/4": 0.25, "w/4": 0.375}),
        ({"width": 1.0}, {"h/4": 0.25, "w/4": 0.25}),
        ({"width": 3.0}, {"h/4": 0.25}),  # w/4 is beyond the largest radius
        ({"periodic": "x"}, {"h/2": 0.25, "v": 0.375}),
        ({"periodic": "xy"}, {"h/2": 0.25, "w/2": 0.375}),
        # Two discs one above the other need 2 g r < 1/2; one reaches the top if g (h − 2r) < 1/2.
        ({"field": 2.0}, {"h": 0.125, "v": 0.375, "t": 0.375}),
        # Larger unequal discs cannot hop vertically in a field.
        ({"width": 2.0, "height": 1.3, "field": 0.3, "mass_ratio": 4.0}, {"h": 0.325, "f": 0.5}),
        ({"width": 1.0, "mass_ratio": 2.0}, {"h": 0.25, "v": 0.25}),
        # The larger disc 1 passes behind disc 2 as long as h < (√r1 + √r2)².
        ({"radius_ratio": 0.25}, {"h": 0.4, "x": 4 / 9}),
    ],
    ids=str,
)
def test_limits_have_their_radii_and_names(effects, expected):
    box = Box(**{"width": 1.5, "height": 1.0} | effects)
    marked = curves.limits(box)
    texts = " ".join(name for _, name in marked)
    caption = FIGURES["volume"].caption(box)
    assert {*re.findall(r"r_(\w+)", caption)} == {*re.findall(r"r_{\\mathrm{(\w+)", texts)}
    if "f" not in expected:
        *marked, (largest, name) = marked
        assert name == r"r_{\mathrm{max}}"
        assert largest == pytest.approx(box.largest_radius, rel=1e-14)
    pattern = r"(?:\{|=(?!r)|^(?=[hw]))([\w/]+)"
    names = {radius: re.findall(pattern, text) for radius, text in marked}
    named = {index: radius for radius, some in names.items() for index in some}
    assert named == pytest.approx(expected, rel=1e-15)


def test_a_caption_has_the_sentences_that_its_scenes_call_for():
    caption = Caption("text", "plain", "square", "other", "discs", "field", "periodic")
    assert caption.full_text() == caption.full_text(Box(1.5, 1.0)) == "text plain"
    assert caption.full_text(Box(1.0, 1.0)) == "text plain square"
    for name, value in (("discs", 3), ("field", 0.3), ("periodic", "x")):
        assert caption.full_text(Box(1.0, 1.0, **{name: value})) == f"text other {name}"
