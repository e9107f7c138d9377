"""The radii at which something ends, and their names."""

import re

import pytest
from figure_cases import BOXES

from twodiscs.figures.curves import hop_ends, limits
from twodiscs.model.box import Box

LARGEST = r"r_{\mathrm{max}}"


def test_limits_of_plain_boxes():
    def names(box):
        return [name for _, name in limits(box)]

    assert names(Box(1.5, 1)) == ["h/4", "w/4", LARGEST]
    assert names(Box(1, 1.5)) == ["w/4", "h/4", LARGEST]
    assert names(Box(1, 1)) == ["h/4=w/4", LARGEST]
    assert limits(Box(3, 1)) == ((0.25, "h/4"), (0.5, LARGEST))


@pytest.mark.parametrize("box", BOXES.values(), ids=BOXES)
def test_limits_follow_from_the_box_or_from_the_scene(box):
    """An effect too small to matter does not change the radii, except for rounding."""
    plain = limits(box)
    same = limits(Box(box.width, box.height, {"mass_ratio": 1 + 1e-15}))
    assert [radius for radius, _ in same] == pytest.approx([r for r, _ in plain], rel=1e-15)
    ends = hop_ends(Box(box.width, box.height, {"mass_ratio": 2.0}))
    assert [end for end, _ in ends.values()] == pytest.approx(
        [end for end, _ in hop_ends(box).values()], rel=1e-15
    )


def test_hops_end_at_the_limit_of_their_name():
    """If they stay possible to the end, it is the largest radius."""
    assert hop_ends(Box(1.5, 1)) == {
        "vertical_hop": (0.375, "w/4"),
        "horizontal_hop": (0.25, "h/4"),
    }
    assert set(hop_ends(Box(1, 1)).values()) == {(0.25, "h/4=w/4")}
    assert hop_ends(Box(3, 1))["vertical_hop"] == (0.5, LARGEST)


@pytest.mark.parametrize(
    ("effects", "expected"),
    [
        ({"periodic": "x"}, {"h/2": 0.25, "v": 0.375}),
        ({"periodic": "y"}, {"h": 0.25, "w/2": 0.375}),
        ({"periodic": "xy"}, {"h/2": 0.25, "w/2": 0.375}),
        # Two discs one above the other need 2 g r < 1/2; one reaches the top if g (h − 2r) < 1/2.
        ({"field": 2.0}, {"h": 0.125, "v": 0.375, "t": 0.375}),
        # The larger disc 1 passes behind disc 2 as long as h < (√r1 + √r2)².
        ({"radius_ratio": 0.25}, {"h": 0.4, "x": 4 / 9}),
        ({"radius_ratio": 4.0}, {"h": 0.1}),
    ],
    ids=str,
)
def test_limits_of_scenes_with_effects(effects, expected):
    box = Box(1.5, 1.0, effects)
    *found, (largest, name) = limits(box)
    assert name == LARGEST
    assert largest == pytest.approx(box.largest_radius, rel=1e-14)
    named = {
        index: radius for radius, text in found for index in re.findall(r"(?:\{|=)([\w/]+)", text)
    }
    assert named == pytest.approx(expected, rel=1e-15)


def test_a_field_lowers_the_largest_radius():
    box = Box(1.5, 1.0, {"field": 10.0})
    *_, (largest, _) = limits(box)
    assert largest < box.largest_radius
    box.scene(largest * (1 - 1e-15))
    with pytest.raises(ValueError, match="too strong"):
        box.scene(largest)
