"""A scene: which radii fit, which events are possible, and how often by symmetry.

Without it discs could pass where there is no room, or hit a wall out of reach.

Closed forms are compared with bisection in exact arithmetic, scenes with effects with a
configuration space made of cells. Centres are put on a grid, cells that overlap or lack energy are
thrown out, and neighbours are joined. These scenes are some way off every threshold, for a grid to
see it.
"""

import math
import pickle
import re
from ast import literal_eval
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from effect_scenes import distance_square
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from twodiscs.model.checks import InputError
from twodiscs.model.effects import EFFECTS
from twodiscs.model.events import EVENT_AXES, EVENTS, WALLS
from twodiscs.model.scene import REGIMES, Box, Scene
from twodiscs.model.two_geometry import ENERGY


def test_discs_that_jam_do_not_fit():
    """In a box of 9/8 × 1 they jam at r = 5/16 exactly: centres at most (1/2, 3/8) apart touch."""
    box = Box(1.125, 1.0)
    assert box.largest_radius == 0.3125
    assert not box.fits(0.3125)
    assert box.fits(math.nextafter(0.3125, 0.0))
    assert not Box(0.5, 3.0, mass_ratio=2.0).fits(0.25)
    assert Box(0.5, 3.0, mass_ratio=2.0).fits(math.nextafter(0.25, 0.0))


def test_discs_that_all_their_energy_can_just_lift_do_not_fit():
    """One is 1/2 above the other in a channel of width 1, where they are at most 3/8 apart."""
    assert Scene(1, 3, 0.3125, field=math.nextafter(1, 0))
    with pytest.raises(InputError, match=r"^field 1\.0 is too strong"):
        Scene(1, 3, 0.3125, field=1)


def test_regimes():
    """They are in the order of their hops; zero room is blocked."""
    lengths = (1.5, 1, 0.2), (1.5, 1, 0.25), (1, 1.5, 0.3), (1, 1, 0.25)
    scenes = [Scene(*three) for three in lengths]
    assert tuple(scene.regime for scene in scenes) == REGIMES
    assert [scene.ergodic_components for scene in scenes] == [1, 2, 2, 4]


def test_a_copy_is_the_same_whatever_was_asked_before():
    """Cached values are not in a pickle, by which libraries compare arguments."""
    scene = Scene(1.5, 1, Fraction(1, 4), periodic="x")
    assert type(scene.height) is type(scene.radius) is float
    new = pickle.dumps(scene)
    assert scene.axes
    assert scene.largest_radius
    assert pickle.dumps(scene) == new
    assert pickle.loads(new) == scene


def test_the_documented_ranges_of_a_scene_are_those_that_it_takes():
    told = re.findall(r"^    (\w+) : [^:]*? from (\S+) to (\w+)", Scene.__doc__, re.MULTILINE)
    own = [one for one in EFFECTS.values() if one.is_number and one.low < one.high]
    assert [name for name, *_ in told] == [*(one.name for one in own if not one.of_box), "discs"]
    for name, low, high in told:
        for end, way in ((low, -math.inf), (high, math.inf)):
            Scene(1.5, 1.0, 1e-5, **{name: literal_eval(end)})
            with pytest.raises(InputError, match=f"^{name} must"):
                Scene(1.5, 1.0, 1e-5, **{name: math.nextafter(float(end), way)})


SCENES = [
    Scene(1.5, 1.0, 0.2, radius_ratio=1.9),
    Scene(1.0, 1.0, 0.25, radius_ratio=1.25),
    Scene(1.5, 0.66, 0.29, radius_ratio=0.2),
    Scene(1.5, 0.66, 0.058, radius_ratio=5.0),
    Scene(1.0, 0.9, 0.4, radius_ratio=0.35),
    Scene(1.5, 1.0, 0.3, periodic="x"),
    Scene(1.0, 1.0, 0.3, periodic="x"),
    Scene(1.0, 1.0, 0.32, periodic="xy"),
    Scene(1.5, 1.0, 0.15, field=2.0),
    Scene(0.7, 1.5, 0.2, field=0.4),
    Scene(1.5, 1.0, 0.15, field=0.9, mass_ratio=4.0, radius_ratio=1.5),
    Scene(1.5, 1.0, 0.3, field=1.2, mass_ratio=0.2, radius_ratio=0.6),
    Scene(0.9, 1.5, 0.2, field=0.7, periodic="x"),
    Scene(0.7, 1.5, 0.2, field=0.4, periodic="x"),
]

#: Cells along each coordinate of each disc.
CELLS = 24


def grid(scene, axis, disc, cells=CELLS):
    """Return the coordinates of a disc along an axis, from wall to wall or all the way round."""
    side, r = scene.side(axis), scene.radii[disc]
    if axis in scene.periodic:
        return side * np.arange(cells) / cells
    return np.linspace(r, side - r, cells)


def allowed(scene, x1, y1, x2, y2):
    """Say of centres, arrays that broadcast, whether the discs are apart and have energy."""
    square = distance_square(scene, {"x": (x1, x2), "y": (y1, y2)})
    (r1, r2), (m1, m2) = scene.radii, scene.masses
    potential = scene.field * (m1 * (y1 - r1) + m2 * (y2 - r2))
    return (square >= scene.contact_distance**2 * (1 - 1e-12)) & (potential < ENERGY)


def components(scene):
    """Return how many disjoint parts the cells that are allowed make, along x1, y1, x2, y2."""
    centres = [grid(scene, axis, disc) for disc in (0, 1) for axis in "xy"]
    open_cells = allowed(scene, *np.meshgrid(*centres, indexing="ij", sparse=True))
    number = np.arange(open_cells.size).reshape(open_cells.shape)
    ends = []
    for direction, axis in enumerate("xyxy"):
        count = CELLS if axis in scene.periodic else CELLS - 1
        here = np.take(number, range(count), direction)
        there = np.take(number, range(1, count + 1), direction, mode="wrap")
        both = open_cells.flat[here] & open_cells.flat[there]
        ends.append((here[both], there[both]))
    rows, columns = (np.concatenate(part) for part in zip(*ends, strict=True))
    links = coo_array((np.ones(rows.size, bool), (rows, columns)), shape=(number.size,) * 2)
    _, label = connected_components(links, directed=False)
    sizes = np.bincount(label[open_cells.ravel()])
    return np.count_nonzero(sizes > 0.001 * open_cells.sum())


@pytest.mark.parametrize("scene", SCENES, ids=repr)
def test_components_hops_and_confined_discs(scene):
    """The cells fall into as many parts as the scene says, with a hop where it says so.

    Disc 1 reaches a far wall from the other side of disc 2 unless the scene says it is confined. If
    the hop is open, all starts get there.
    """
    assert components(scene) == scene.ergodic_components
    for hop, confined in zip(("horizontal_hop", "vertical_hop"), scene.confined, strict=True):
        axis, other = EVENT_AXES[hop], "xy".replace(EVENT_AXES[hop], "")
        if axis in scene.periodic:
            assert (confined, scene.is_possible(hop)) == (False, False)
            continue
        across = {other + "1": grid(scene, other, 0, 80)[None, :, None]}
        across[other + "2"] = grid(scene, other, 1, 80)[None, None, :]
        # Both centres at the same place along the axis of the hop.
        level = np.linspace(max(scene.radii), scene.side(axis) - max(scene.radii), 40)
        both = dict.fromkeys((axis + "1", axis + "2"), level[:, None, None])
        is_open = np.any(allowed(scene, **across, **both))
        assert is_open == scene.is_possible(hop)
        wall, beyond = scene.side(axis) - scene.radii[0], grid(scene, axis, 1, 200)
        past = {axis + "1": wall, axis + "2": beyond[beyond > wall, None, None]}
        assert confined == (not is_open and not np.any(allowed(scene, **across, **past)))


@given(
    st.sampled_from(["", "x", "y", "xy"]),
    st.floats(0.3, 3.0),
    st.just(1.0) | st.floats(0.2, 5.0),
    st.none() | st.floats(0.3, 3.0),
)
@settings(max_examples=200, deadline=None, derandomize=True)
def test_largest_radius(periodic, width, ratio, depth):
    """Discs fit below the largest radius and not above it."""
    scene = Scene(width, 1.0, 1e-6, depth=depth, radius_ratio=ratio, periodic=periodic)
    largest = scene.largest_radius
    assert scene.with_radius(largest * (1 - 1e-12)).largest_radius == largest
    with pytest.raises(ValueError, match="does not fit"):
        scene.with_radius(largest * (1 + 1e-12))


@pytest.mark.parametrize(
    ("effects", "conserved", "components"),
    [
        ({}, (), 4),
        ({"periodic": "x"}, ("x",), 3),
        ({"periodic": "xy", "mass_ratio": 2}, ("x", "y"), 2),
        ({"depth": 1.2, "periodic": "xz"}, ("x", "z"), 4),
        ({"moment_of_inertia": 0.5}, (), 6),
        # Rough walls push discs along them.
        ({"moment_of_inertia": 0.5, "periodic": "x"}, (), 6),
        ({"discs": 3, "periodic": "x"}, ("x",), 5),
    ],
)
def test_momenta_that_are_conserved_and_0_do_not_count(effects, conserved, components):
    scene = Scene(1.5, 1.0, 0.2, **effects)
    assert (scene.conserved, scene.velocity_components) == (conserved, components)
    units = ["length⁶", "length⁵"] if scene.depth or scene.discs == 3 else ["length⁴", "length³"]
    assert [scene.unit(quantity) for quantity in ("volume", "any_wall_area")] == units


@pytest.mark.parametrize(
    ("effects", "right", "top"),
    [
        ({}, 4, 4),  # two discs, two walls
        ({"radius": 0.3}, 2, 4),  # discs that cannot pass along x
        ({"radius": 0.38}, 2, 2),
        ({"field": 0.4}, 4, 2),
        ({"mass_ratio": 2}, 2, 2),
        ({"radius_ratio": 0.5, "field": 0.4}, 2, 1),
        ({"radius": 0.3, "field": 0.4}, 2, 2),
        ({"discs": 3}, 6, 6),
    ],
)
def test_walls_of_one_rate_that_a_trajectory_reaches_are_counted_together(effects, right, top):
    scene = Scene(1.5, 1.0, **{"radius": 0.2} | effects)
    by_axis = {"x": right, "y": top}
    for event in EVENTS:
        assert scene.copies(event) == (by_axis[EVENT_AXES[event]] if event in WALLS else 1)


def test_energy_to_pass_one_above_the_other_is_that_of_the_cheaper_order():
    """The upper disc is the other one's diameter up: g m2 2r1 with disc 2 on top, or g m1 2r2."""
    for ratios in ({"radius_ratio": 2, "mass_ratio": 3}, {"radius_ratio": 0.5, "mass_ratio": 0.2}):
        scene = Scene(3.0, 2.0, 0.1, **ratios)
        limit = ENERGY / (2 * min(scene.masses[1] * scene.radii[0], scene.radii[1]))
        weak, strong = (replace(scene, field=part * limit) for part in (0.999, 1.001))
        assert weak.horizontal_hops
        assert not strong.horizontal_hops
    # No energy to spare is none.
    assert not Scene(3.0, 2.0, 0.25, field=1.0).horizontal_hops
    assert Scene(3.0, 2.0, 0.25, field=math.nextafter(1.0, 0)).horizontal_hops
    corner = Scene(1.5, 0.6, 0.25, radius_ratio=0.25, mass_ratio=0.25, field=8.0)
    assert corner.confined == (True, False)
    assert replace(corner, field=math.nextafter(8.0, 0)).confined == (False, False)
    # Nor is no room in the corner, (h − σ)² + (r1 − r2)² = σ².
    assert Scene(1.5, 0.5625, 0.25, radius_ratio=0.25).confined == (True, False)


def test_friction_is_limited_by_the_time_along_the_shortest_side():
    assert Scene(1.5, 0.5, 0.2, friction=2e6).friction == 2e6
    with pytest.raises(InputError, match=r"the shortest side, which is 2000000\.0, not 2020000\.0"):
        Scene(1.5, 0.5, 0.2, friction=2.02e6)
