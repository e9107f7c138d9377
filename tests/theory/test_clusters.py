"""Bursts of rough discs: regions with their shares, and corners.

Without these tests regions in which events come in crowds could have another share or a share of
nothing.
"""

import math
from dataclasses import replace
from itertools import pairwise

import mpmath as mp
import numpy as np
import pytest
from scipy.integrate import dblquad, quad

from twodiscs.dynamics.two.event_counts import run_blocks
from twodiscs.model.events import EVENTS, WALL_HITS
from twodiscs.model.scene import Scene
from twodiscs.theory import clusters, exact
from twodiscs.theory.flux import flux_constant

BOX = Scene(1.5, 1.0, 0.24, moment_of_inertia=0.5)
RING = Scene(1.0, 2.0, 0.2495, moment_of_inertia=0.01, periodic="x")
WIDE_RING = Scene(1.5, 1.0, 0.249, moment_of_inertia=0.5, periodic="x")


def shares(scene, axis, within):
    """Return the shares of the volume and of collisions that are level within a distance."""
    # The densities of |x1 − x2| and |y1 − y2| and their ranges.
    a, b, sigma = scene.range_x, scene.range_y, scene.contact_distance
    f, g = (lambda u: 2 * (scene.range_x - u)), (lambda v: 2 * (scene.range_y - v))
    if scene.periodic:
        f, a = (lambda u: 2 * scene.width), scene.width / 2
    if axis == "y":
        f, a, g, b = g, b, f, a  # now u is small

    def volume(most):
        def lowest(u):
            return min(b, math.sqrt(max(sigma**2 - u * u, 0.0)))

        ends = [u for u in (0.0, math.sqrt(max(sigma**2 - b * b, 0.0)), sigma) if u < most]
        ends.append(most)
        options = {"epsabs": 0.0, "epsrel": 1e-10}
        return sum(
            dblquad(lambda v, u: f(u) * g(v), low, high, lowest, b, **options)[0]
            for low, high in pairwise(ends)
        )

    def contact(most):
        low = math.acos(min(1.0, b / sigma))
        high = math.asin(min(1.0, min(most, a) / sigma))
        return quad(lambda t: f(sigma * math.sin(t)) * g(sigma * math.cos(t)), low, high)[0]

    return volume(within) / volume(a), contact(within) / contact(a)


@pytest.mark.parametrize("scene", [BOX, RING, WIDE_RING])
def test_shares_of_regions_are_those_of_another_quadrature(scene):
    regions, needed = clusters.regions(scene), dict.fromkeys((0.3, 0.1, 1e-4), 0.0)
    assert len(regions) > 1
    for region in regions:
        volume, contact = shares(scene, region.axis, region.within)
        for error, most in needed.items():
            excess = contact / (0.3 * error)
            needed[error] = max(most, min(100, excess**2) / volume if excess > 1 else 0.0)
        assert region.volume == pytest.approx(volume, rel=1e-8)
        assert region.rates["disc_collision"] == pytest.approx(contact, rel=1e-8)
    for small, large in pairwise(regions):
        if small.axis == large.axis:
            assert large.within == 2 * small.within
            assert all(0 <= small.rates[e] <= large.rates[e] <= 1 + 1e-12 for e in small.rates)
    for error, due in needed.items():
        found = clusters.replicas_needed(scene, "disc_collision", error)
        assert found == pytest.approx(due, rel=1e-7)
    # A hop has all of its rate where the discs are level.
    hops = {"x": "horizontal_hop", "y": "vertical_hop"}
    assert all(r.rates.get(hops[r.axis], 1.0) == pytest.approx(1.0) for r in regions)


def test_the_neck_has_twice_the_room():
    for scene in (BOX, RING):
        region = clusters.regions(scene)[0]
        other = {"x": "y", "y": "x"}[region.axis]
        reach, sigma = float(scene.reach(other)), scene.contact_distance
        room = reach - math.sqrt(sigma**2 - region.within**2)
        assert room == pytest.approx(2 * (reach - sigma), rel=1e-9)


def test_who_needs_no_initial_states_in_a_neck():
    """None for smooth discs, none far from a threshold, none for a wall that is not there."""
    assert clusters.regions(Scene(1.5, 1.0, 0.24)) == ()
    far = Scene(1.5, 1.0, 0.1, moment_of_inertia=0.5)
    assert clusters.replicas_needed(far, "disc_collision", 1e-4) == 0
    assert clusters.replicas_needed(RING, "right_wall", 1e-4) == 0


@pytest.mark.parametrize("radius", [0.25, 0.25 * (1 + 1e-9), 0.25 * (1 - 1e-9), 0.26])
def test_at_a_threshold_there_are_regions_of_every_size(radius):
    regions = clusters.regions(Scene(1.5, 1.0, radius, moment_of_inertia=0.2))
    assert 1 <= len(regions) <= 50
    assert all(0 < r.volume <= 1 + 1e-12 for r in regions)


# Corners ------------------------------------------------------------------------------------------

ROUGH = Scene(1.5, 1.0, 0.2, moment_of_inertia=0.5)


def test_only_wall_hits_of_rough_discs_between_two_pairs_of_walls_have_bursts_in_corners():
    assert {e for e in EVENTS if clusters.corner_variance(ROUGH, e, 8.0)} == {*WALL_HITS}
    for other in ({"moment_of_inertia": None}, {"periodic": "x"}):
        scene = replace(ROUGH, **other)
        assert not any(clusters.corner_variance(scene, event, 8.0) for event in EVENTS)


def test_bursts_in_corners_scale_as_the_stays():
    """A stay is as long as a short replica, and ends at a rate in a long one."""
    one, other, kicked = (
        [clusters.corner_variance(scene, "any_wall", t) for t in (1e-3, 2e4)]
        for scene in (ROUGH, replace(ROUGH, mass_ratio=4.0), replace(ROUGH, friction=50.0))
    )
    assert kicked[1] < 0.02 * one[1]
    # The heavy disc is slow, and disc 1 alone hits the walls that are counted as one.
    assert other[0] == pytest.approx(one[0] * (1 + 1 / 4) / 2, rel=1e-2)
    # A long stay ends with the other disc, whose speed is that of its own mass.
    assert other[1] == pytest.approx(one[1] * (2 + 1 / 4) / 2, rel=1e-2)
    assert clusters.corner_variance(ROUGH, "right_wall", 1e-3) == pytest.approx(one[0] / 4)
    # A field keeps discs from the upper corners.
    falling = replace(ROUGH, field=0.5)
    right, top = (clusters.corner_variance(falling, w, 1e-3) for w in ("right_wall", "top_wall"))
    left = (1 - 2 * 0.5 * 0.6) ** 2  # the density at the top over that at the bottom
    assert top / right == pytest.approx(left / (1 + left), rel=1e-9)
    assert clusters.corner_variance(replace(ROUGH, field=0.9), "top_wall", 1e-3) == 0
    # A heavy disc is slow, and falls as a light one in a stronger field.
    heavy, light = replace(ROUGH, field=0.2, mass_ratio=4.0), replace(ROUGH, field=0.8)
    both, one = (clusters.corner_variance(heavy, wall, 1e-3) for wall in ("any_wall", "right_wall"))
    due = clusters.corner_variance(light, "right_wall", 1e-3) / 2
    assert both - 4 * one == pytest.approx(due, rel=1e-9)
    small = [Scene(1.5, 1.0, 0.01, moment_of_inertia=0.5, field=f) for f in (0.0, 1e-6, 1e-60)]
    one, *weak = (clusters.corner_variance(scene, "any_wall", 1e-3) for scene in small)
    assert weak == pytest.approx([one] * 2, rel=1e-2)
    # Others end the stays of one of many discs, however crowded they are.
    crowd = Scene(2.0, 2.0, 0.21, discs=20, moment_of_inertia=0.5)
    once, twice = (clusters.corner_variance(crowd, "any_wall", t) for t in (1e4, 2e4))
    assert twice == pytest.approx(2 * once, rel=1e-2)


@pytest.mark.parametrize("sides", [(1.5, 1.0), (1.0, 1.5)])
@pytest.mark.parametrize(("radius", "ratio"), [(0.2, 0.6), (0.2, 1.5), (0.24, 1.5)])
def test_bursts_in_corners_are_those_of_disc_1_with_disc_2_where_it_has_room(sides, radius, ratio):
    """Its room and its contacts with a disc in the corner, counted on a grid and on an arc."""
    scene = Scene(*sides, radius, radius_ratio=ratio, mass_ratio=4.0, moment_of_inertia=0.5)
    (r1, r2), sigma = scene.radii, scene.contact_distance
    place = (np.arange(1000) + 0.5) / 1000
    sides = [side - 2 * r2 for side in scene.sides]
    apart = [r2 - r1 + side * place for side in sides]
    free = math.prod(sides) * np.mean(np.add.outer(*np.square(apart)) >= sigma**2)
    arc = sigma * np.array([np.cos(place * math.pi / 2), np.sin(place * math.pi / 2)])
    within = [(r2 - r1 <= t) & (t <= r2 - r1 + side) for t, side in zip(arc, sides, strict=True)]
    # Disc 2 has the mean speed 8/(15 π) · 2/√m₂ towards a surface, from each side half of it.
    rate = flux_constant(6) / 2 / 2 * np.mean(within[0] & within[1]) * math.pi / 2 * sigma / free
    # Corners at the bottom and at the top, ⟨v²⟩ = 3/6, and a quarter for one wall.
    each = clusters.ADDED_VARIANCE * clusters.corner_hits(0.5)
    each *= 2 * free / exact.volume(scene) * 3 / 6 * 2 / 4
    for time, square in ((1e-3, 1e-6), (1e6, 2e6 / rate)):
        found = clusters.corner_variance(scene, "right_wall", time)
        # The ends of the arc lie between two of its points.
        assert found == pytest.approx(each * square, rel=0.01 + 1 / clusters.ARC_POINTS)


@pytest.mark.parametrize(("inertia", "more"), [(0.1, 1), (0.5, 1), (1.0, 1.1)])
def test_hits_in_corners_have_a_closed_form_and_are_counted(inertia, more):
    """Times to the 200th hit, ∝ the distance; at I = 1 more directions stay. Five errors.

    A hit turns a velocity by half a turn about an axis, exactly.
    """
    hits, n, stream = 200, 50_000, np.random.default_rng(4)
    i, k = mp.mpf(inertia), math.sqrt(inertia)
    q, found = (1 + i) / i, clusters.corner_hits(inertia)
    due = i / (1 + 2 * i) / 4 * (mp.mpf(1) / 3 - (1 - mp.sqrt(q) * mp.atan(1 / mp.sqrt(q))) / i)
    assert found == pytest.approx(float(due), rel=1e-11)
    v, angle, time = stream.normal(size=(3, n)), math.pi / 2 * stream.random(n), np.zeros(n)
    v, place = v / np.linalg.norm(v, axis=0), np.array([np.cos(angle), np.sin(angle)])
    axes = np.array([[0, 1, k], [1, 0, -k]]).T / math.sqrt(1 + inertia)
    for _ in range(hits):
        staying = (v[:2] < 0).any(axis=0)
        v, place, time = v[:, staying], place[:, staying], time[staying]
        flights = np.where(v[:2] < 0, place / np.abs(v[:2]), np.inf)
        wall, flight = flights.argmin(axis=0), flights.min(axis=0)
        time, place, axis = time + flight, place + v[:2] * flight, axes[:, wall]
        place[wall, np.arange(time.size)] = 0.0
        v = 2 * (v * axis).sum(axis=0) * axis - v
    each = math.pi / 4 * ((hits - 0.5) / time) ** 2
    error = math.sqrt((each**2).sum()) / n
    assert abs(each.sum() / n - more * found) < 5 * error < 0.2 * found


@pytest.mark.slow
def test_the_tail_of_hits_in_corners_is_as_counted():
    """P(N > n) → A/n² at the 100th largest of 20000 N: five errors of 10 %, and 20 % more."""
    replicas, largest, event = 20000, 100, EVENTS.index("any_wall")
    counts = np.sort([
        run_blocks(ROUGH, ("any_wall",), 77, k, k + 1, 16.0, replicas=1, lanes=1)[0][event]
        for k in range(replicas)
    ])  # fmt: skip
    found = largest / replicas * (counts[-largest] - counts.mean()) ** 2
    due = clusters.corner_variance(ROUGH, "any_wall", 16.0) / clusters.ADDED_VARIANCE
    assert 0.5 / 1.2 < found / due < 1.5 * 1.2
