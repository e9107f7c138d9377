"""A box: its radii, thresholds, keys and seeds.

Without it a grid could miss a threshold, or two boxes, radii or methods share a seed.
"""

import json
import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from twodiscs import EFFECTS as DECLARED
from twodiscs import Box, InputError, Scene
from twodiscs.model.events import EVENTS, HOPS
from twodiscs.model.seeds import key, seed_text, stream_seed
from twodiscs_paper.configuration.radii import even_radii, radii

EFFECTS = [
    {},
    {"radius_ratio": 0.5, "mass_ratio": 2.0},
    {"periodic": "xy"},
    {"field": 1.0},
    {"moment_of_inertia": 0.5},
    {"periodic": "z", "depth": 1.2},
    {"periodic": "x", "discs": 3},
]
sides = st.floats(-6, 6).map(lambda x: 10**x)


# Scenes and plain values ------------------------------------------------------------------------


@pytest.mark.parametrize("effects", EFFECTS, ids=str)
def test_the_same_box_is_equal_and_has_the_same_hash_and_parameters(effects):
    """Jobs are named by their parameters: order and spelling of the effects must not matter."""
    usual = {effect.name: effect.default for effect in DECLARED.values()} | {"discs": 2}
    spelled = dict(reversed((usual | effects).items()))
    spelled = {k: int(v) if v in (1.0, 2.0) else v for k, v in spelled.items()}
    if "periodic" in effects:
        spelled["periodic"] = effects["periodic"][::-1]
    box, other = Box(1.5, 1.0, **effects), Box(1.5, 1, **spelled)
    scene, discs = box.scene(0.1), effects.get("discs", 2)
    text = json.dumps(box.parameters())
    assert box == other == Box(**json.loads(text)) == scene.box
    assert scene == Scene(1.5, 1.0, 0.1, **effects)
    family = "many" if discs > 2 else "effects" if effects else "plain"
    assert (scene.family, scene.is_plain) == (family, not effects)
    assert scene.options == box.options == effects
    assert eval(repr(scene), {"Scene": Scene}) == scene
    assert scene.masses == (1.0,) + (effects.get("mass_ratio", 1.0),) * (discs - 1)
    assert scene.radii == (0.1,) + (0.1 * effects.get("radius_ratio", 1.0),) * (discs - 1)
    assert hash(box) == hash(other)
    assert text == json.dumps(other.parameters())
    assert list(box.parameters()) == ["width", "height", *(n for n in usual if n in effects)]
    assert scene == Scene(**json.loads(json.dumps(scene.parameters())))
    assert seed_text(box) == seed_text(scene) == seed_text(other)


def test_sides():
    flat = Box(1.5, 1.0, depth=0.5)
    assert (flat.sides, flat.shortest) == ((1.5, 1.0, 0.5), 0.5)
    with pytest.raises(ValueError, match=r"field must be 0 to exchange the axes, not 1\.0"):
        Box(1.5, 1.0, field=1.0).turned()


# Radii at which something ends ------------------------------------------------------------------


#: Effects, and where hops along y and x end by the geometry: None where they have no place, "last"
#: where they go on to the last radius.
ENDS = [
    ({}, 1.5 / 4, 1.0 / 4),
    ({"width": 2.5}, "last", 1.0 / 4),
    # σ = (1 + ratio) r is half the side.
    ({"radius_ratio": 1.5}, 1.5 / 5, 1.0 / 5),
    ({"radius_ratio": 0.5}, "last", 1.0 / 3),
    # The image is as far away as the wall allows.
    ({"periodic": "x"}, 1.5 / 4, None),
    ({"periodic": "y"}, None, 1.0 / 4),
    # Balls pass each other until a disc jams in the rectangle across.
    ({"depth": 1.2}, (2.7 - math.sqrt(3.6)) / 2, (2.2 - math.sqrt(2.4)) / 2),
    # One disc on top of the other takes 2 r g of the energy 1/2.
    ({"field": 1.5}, 1.5 / 4, 1 / 6),
    ({"field": 0.9}, 1.5 / 4, 1.0 / 4),
    # The larger a disc, the less it has to be lifted to touch the top.
    ({"field": 1.2}, 1.5 / 4, 1 / 4.8),
    ({"field": 1.2, "height": 10.0}, 1.5 / 4, 1 / 4.8),
]


@pytest.mark.parametrize(("effects", "vertical", "horizontal"), ENDS, ids=str)
def test_thresholds_follow_from_the_geometry(effects, vertical, horizontal):
    box = Box(**{"width": 1.5, "height": 1.0} | effects)
    inner = set()
    for hop, end in zip(HOPS, (vertical, horizontal), strict=True):
        found = box.threshold(hop)
        if end is None:
            assert found is None
        elif end == "last":
            assert found == box.last_radius
        else:
            assert found == pytest.approx(end, rel=1e-15)
            inner.add(found)
    assert box.thresholds == tuple(sorted(inner))

    # Events that are no hops are possible up to the last radius.
    too_high = box.field * (box.height - 2 * box.last_radius) > 0.5  # for all the energy
    for event in {*EVENTS} - {*HOPS}:
        happens = event in box.events and not (too_high and event == "top_wall")
        assert box.threshold(event) == (box.last_radius if happens else None)
    assert box.fits(math.nextafter(box.last_radius, 0)) > box.fits(box.last_radius)
    assert box.last_radius <= box.largest_radius * (1 + 1e-15)


@pytest.mark.parametrize("width", [0.6, 0.7])
def test_a_field_ends_the_scenes_where_the_energy_does_not_lift_one_disc_onto_the_other(width):
    box = Box(width, 1.5, field=1.5)
    # Above it the discs lie askew in the width, √(σ² − (w − σ)²) g = 1/2.
    end = (width / 2 + 1 / (18 * width)) / 2
    assert box.largest_radius > box.last_radius == pytest.approx(end, rel=1e-15)
    assert not box.fits(box.last_radius)
    assert box.fits(math.nextafter(box.last_radius, 0))
    # Or where unequal discs side by side have all the energy: g m1 (r2 − r1) or g m2 (r1 − r2).
    for ratio, end in ((1.5, 1 / 5), (0.75, 2 / 15)):
        unequal = Box(3.0, 1.0, field=5.0, radius_ratio=ratio, mass_ratio=3.0)
        assert unequal.last_radius == pytest.approx(end, rel=1e-15)


#: Squares and boxes of 2 to 1, and widths beside these: thresholds coincide, or nearly.
ratios = st.builds(
    lambda ratio, gap: ratio * (1 + gap),
    st.sampled_from([1, 2]),
    st.sampled_from([0.0, *(s * g for s in (1, -1) for g in (2**-52, 1e-15, 1e-12, 1e-7, 1e-5))]),
)


@given(sides, sides | ratios, st.floats(1e-6, 0.99), st.integers(1, 60))
def test_any_box_gets_its_radii(height, ratio, fraction, count):
    width = ratio * height
    box = Box(width, height)
    largest = box.largest_radius
    smallest = fraction * largest
    assume(smallest not in (width / 4, height / 4))
    grid = radii(width, height, smallest, count)
    assert len(grid) == count
    assert grid[0] == smallest
    assert [*grid] == sorted({*grid})
    assert all(map(box.fits, grid))
    assert not {width / 4, height / 4, largest} & set(grid[1:])
    assert all(type(radius) is float for radius in grid)


def test_points_crowd_on_both_sides_of_every_threshold():
    grid = radii(1.5, 1.0, 0.01, 46)
    typical = 0.38 / 46
    assert [float(key(radius)) for radius in grid] == list(grid)
    assert max(len(key(radius)) for radius in grid) <= len("0.37507")
    for threshold in (0.25, 0.375):
        for side in (-1, 1):
            distances = sorted(d for r in grid if (d := side * (r - threshold)) > 0)
            assert distances[0] < typical / 8
            assert distances[1] < typical / 2
            # The gaps widen from the threshold outwards.
            assert distances[0] < distances[1] - distances[0] < distances[3] - distances[2]
    room = [Box(1.5, 1.0).largest_radius - radius for radius in reversed(grid)]
    assert room[0] < typical / 50
    assert room[0] < room[1] - room[0] < room[3] - room[2]


def test_seeds_are_those_of_published_numbers():
    """Fixed for ever, with each of their parts."""
    assert stream_seed(1908, "paper", "dynamics", "0.2") == 2126172600973548450
    assert seed_text(Box(1.5, 1.0)) == "{'height': 1.0, 'width': 1.5}"
    ring = Box(1.5, 1.0, periodic="x", friction=1.5, discs=4)
    effects = "'effects': {'friction': 1.5, 'periodic': 'x'}"
    assert seed_text(ring) == f"{{'discs': 4, {effects}, 'height': 1.0, 'width': 1.5}}"


@given(st.floats(-6, 6).map(lambda x: 10**x), st.floats(1.01, 1e4), st.integers(2, 1000))
def test_even_radii_are_even(smallest, ratio, count):
    largest = ratio * smallest
    found = even_radii(smallest, largest, count)
    step = (largest - smallest) / (count - 1)
    assert len(found) == count
    assert found[0] == smallest
    for i, radius in enumerate(found):
        assert abs(radius - (smallest + i * step)) < 0.2500001 * step
        assert radius < 1.0100001 * largest
    assert even_radii(smallest, largest, 1) == (smallest,)
    with pytest.raises(InputError, match="smallest must be below"):
        even_radii(largest, largest, count)
