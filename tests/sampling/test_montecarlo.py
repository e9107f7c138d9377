"""Volume and areas of two discs by Monte Carlo.

Without these tests a shell could be hit with another probability than its exact expectation.
"""

from dataclasses import replace

import numpy as np
import pytest
from effect_scenes import ALL, PAPER, SCENES, exchanged
from factory import sample_point
from marks import slow
from sampling.uniformity import FALSE_ALARM
from scipy.special import bdtr
from theory.antiderivatives import TURNED

from twodiscs.model.events import HOPS, SHELL_EVENTS, WALLS
from twodiscs.model.scene import Box, Scene
from twodiscs.sampling import montecarlo, streams
from twodiscs.theory import exact


def assert_binomial(hits, samples, probability):
    """``hits`` of ``samples`` are no surprise, by the exact tails of the binomial law."""
    low = bdtr(hits, samples, probability)
    high = 1 - bdtr(hits - 1, samples, probability) if hits else 1.0
    assert 2 * min(low, high) > FALSE_ALARM, (hits, samples * probability)


#: Without effects.
PLAIN = [
    *(PAPER.with_radius(r) for r in (0.01, 0.05, 0.2, 0.24, 0.2501, 0.3, 0.36, 0.376, 0.38)),
    *(Scene(3.0, 1.0, 0.4), Scene(1.0, 1.5, 0.3), Scene(1.0, 1.0, 0.1), Scene(1.0, 1.0, 0.28)),
    *(Scene(2.0, 1.0, 0.4), Scene(1e3, 1.0, 0.3), Scene(1.0, 1e3, 0.3)),
]

#: Blocked hops, discs that hardly fit, a large disc that passes nowhere but reaches all walls, and
#: fields that keep discs from passing, or from the top.
MORE_SCENES = [
    slow(Scene(1.5, 1.0, 0.3, periodic="x")),
    slow(Scene(1.0, 1.0, 0.34, periodic="xy")),
    Scene(1.5, 0.9, 0.4, radius_ratio=0.2, mass_ratio=1e-3),
    Scene(1.5, 1.0, 0.1, radius_ratio=4.0, mass_ratio=1e3),
    Scene(1.5, 1.0, 0.05, field=1.5),
    slow(Scene(1.5, 1.0, 0.3, field=0.1, periodic="x", moment_of_inertia=1.0)),
    Scene(1.5, 1.0, 0.37, moment_of_inertia=0.1),
    Scene(1.0, 1.0, 0.26, depth=1.0),
]


EACH_EFFECT = [slow(s) if n in ("torus", "channel") else s for n, s in SCENES.items()]


@pytest.mark.parametrize("thick", [False, True])
@pytest.mark.parametrize("scene", [*PLAIN, *EACH_EFFECT, *MORE_SCENES], ids=repr)
def test_hits_have_their_exact_probability(scene, thick):
    """Also for thick shells, whose bias is large: the expectation is that of the shell.

    Without effects all walls have the shells of two, and samples are cheap.
    """
    thin_and_thick, blocks, shells = (0.05, 0.8), 2, scene.events
    if scene.is_plain:
        thin_and_thick, blocks, shells = (0.02, 0.3), 8, SHELL_EVENTS
    number = blocks * montecarlo.SAMPLES_PER_BLOCK
    names = ["volume", *(f"{event}_area" for event in scene.events)]
    points = [sample_point(scene, names, number, thin_and_thick[thick], 21)]
    free, volume = exact.free_fraction(scene), exact.volume(scene)
    assert free == pytest.approx(volume / points[0].quantities["volume"].measure, rel=1e-12)
    if scene.is_plain:  # separations have a measure for each set of open hops
        sampler = montecarlo.conditioned(scene, names, thin_and_thick[thick], 22)
        points.append(sampler.point({(0, 4): [sampler.count(0, 4)]}))
    for point in points:
        found = point.quantities
        assert found.keys() == {"volume", *(f"{event}_area" for event in shells)}
        assert (point.right_and_top is not None) == scene.is_plain
        for name, sampled in found.items():
            due = volume
            if name != "volume":
                due = exact.shell_expectation(scene, name[:-5], sampled.epsilon)
            assert_binomial(sampled.hits, point.samples, due / sampled.measure)


def xoroshiro128plus(s0, s1):
    """Yield the numbers of generators in the states ``s0`` and ``s1`` (n,), uint64."""

    def rotated(bits, by):
        return (bits << np.uint64(by)) | (bits >> np.uint64(64 - by))

    while True:
        yield s0 + s1
        s1 = s0 ^ s1
        s0, s1 = rotated(s0, 24) ^ s1 ^ (s1 << np.uint64(16)), rotated(s1, 37)


@np.errstate(over="ignore")
def test_samples_have_the_generator_of_its_authors():
    """The first numbers of the implementation in C, and all hits of a block with thick shells."""
    one = xoroshiro128plus(*np.array([[1], [2]], np.uint64))
    assert [int(next(one)[0]) for _ in range(4)] == [
        3, 412333834243, 2360170716294286339, 9295852285959843169
    ]  # fmt: skip
    names, n = [f"{event}_area" for event in SHELL_EVENTS], montecarlo.GENERATORS
    point = sample_point(PAPER, ["volume", *names], 1, 0.3, 5)
    first = streams.open_stream(np.uint64(5), 0)[0]
    steps = first + streams.GOLDEN * np.arange(2 * n + 1, dtype="u8")
    filled = np.array([streams.splitmix(step) for step in steps[1:]], np.uint64)
    bits = xoroshiro128plus(filled[::2], filled[1::2] | np.uint64(1))
    drawn = np.array([next(bits) for _ in range(2 * point.samples // n)]).reshape(-1, 2, n)
    ranges = np.array([PAPER.range_x, PAPER.range_y])[:, None]
    (x1, y1), (x2, y2) = (
        ranges * (np.swapaxes(half, 0, 1).reshape(2, -1) * 2.0**-32 - 0.5)
        for half in (drawn >> np.uint64(32), drawn & np.uint64(2**32 - 1))
    )
    distance, walls = np.hypot(x1 - x2, y1 - y2), ranges / 2 - [x1, y1]
    free = distance >= PAPER.contact_distance
    pairs = np.abs([y1 - y2, x1 - x2, distance - PAPER.contact_distance]) / np.sqrt(2)
    depths = dict(zip(names, [*pairs, *walls], strict=True))
    sets = {name: free & (depths[name] <= point.quantities[name].epsilon) for name in names}
    hits = {name: np.count_nonzero(inside) for name, inside in ({"volume": free} | sets).items()}
    assert hits == {name: sampled.hits for name, sampled in point.quantities.items()}
    both = sets["right_wall_area"] & sets["top_wall_area"]
    assert point.right_and_top == np.count_nonzero(both) > 1000


def test_only_what_is_asked_for_is_sampled():
    point = sample_point(PAPER, ["volume"], 1, 0.02, 1)
    assert point.quantities.keys() == {"volume"}
    assert point.samples == montecarlo.SAMPLES_PER_BLOCK
    assert point.right_and_top is None
    point = sample_point(PAPER, ["right_wall_area", "top_wall_area"], 1, 0.02, 1)
    assert point.right_and_top is not None
    # A hop has a shell at its threshold, too.
    point = sample_point(PAPER.with_radius(0.25), ["horizontal_hop_area"], 1, 0.02, 1)
    thickness = {name: one.epsilon for name, one in point.quantities.items()}
    assert thickness == {"horizontal_hop_area": 0.02 * 0.25}


def test_the_shells_of_opposite_walls_have_equally_many_grains(monkeypatch):
    """Grain k is at (k + 1/2)/2³² of the range; shells of an eighth have the outer ones."""
    seen = []
    monkeypatch.setattr(montecarlo, "shell_ends", lambda *arguments: seen.append(arguments))
    montecarlo.prism_sampler(PAPER, ["top_wall_area"], 0.02, 1)
    first_grain, grains, thick = seen[0][-1], 2**32, PAPER.range_y / 8
    assert first_grain("y", 1, thick) == grains - grains // 8
    assert first_grain("y", -1, thick) == grains // 8 - 1


@pytest.mark.parametrize("share", [0.1, 0.6, 0.9, 1 - 1e-3, 1 - 1e-9])
def test_shells_scale_with_the_room(share):
    scene = PAPER.with_radius(share * Box(1.5, 1.0).largest_radius)
    room = scene.largest_radius - scene.radius
    epsilon = montecarlo.shell_thickness(scene, "disc_collision", 0.02)
    assert epsilon == 0.02 * min(scene.radius, room)
    for hop, side in zip(HOPS, (1.5, 1.0), strict=True):
        epsilon = montecarlo.shell_thickness(scene, hop, 0.02)
        assert epsilon == 0.02 * min(scene.radius, abs(side / 4 - scene.radius))
        # With effects the room is the gap between two discs that pass, at its largest.
        for more, depth in (({"mass_ratio": 4.0}, 0.0), ({"depth": 0.9}, 0.9 - 2 * scene.radius)):
            gap = np.hypot(side - 2 * scene.radius, depth) - 2 * scene.radius
            epsilon = montecarlo.shell_thickness(replace(scene, **more), hop, 0.02)
            assert epsilon == pytest.approx(0.02 * min(scene.radius, abs(gap)), rel=1e-6)


def test_shells_at_the_ends_of_a_long_box_keep_to_the_room_along_it():
    """Discs that hardly fit across have 2.1 − 4r along the box, less than a radius."""
    scene = Box(2.1, 1.0).scene(0.49)
    for event in ("disc_collision", "right_wall"):
        epsilon = montecarlo.shell_thickness(scene, event, 0.02)
        assert epsilon == pytest.approx(0.02 * (2.1 - 4 * 0.49), rel=1e-12)


# Scenes with effects ----------------------------------------------------------------------------


@pytest.mark.parametrize("scene", [*SCENES.values(), ALL, PAPER, PLAIN[-2]], ids=repr)
def test_the_bias_of_a_shell_is_below_its_fraction(scene):
    """Whatever thickness: an expectation that knows it would hide a shell that is too thick."""
    for event in filter(scene.is_possible, SHELL_EVENTS if scene.is_plain else scene.events):
        thick = montecarlo.shell_thickness(scene, event, 0.02)
        area = exact.areas(scene)[event]
        assert abs(exact.shell_expectation(scene, event, thick) / area - 1) < 0.02


@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
def test_no_shell_depends_on_which_disc_and_which_axis_is_the_first(scene):
    """A thickness is a length times the root of a mass, at a wall of that of disc 1."""
    other, speed = exchanged(scene)
    for event in scene.events:
        thick = montecarlo.shell_thickness(scene, event, 0.02)
        unit = 1.0 if event in WALLS else speed
        assert montecarlo.shell_thickness(other, event, 0.02) * unit == pytest.approx(thick)
        if not scene.field and event in TURNED:
            same = montecarlo.shell_thickness(scene.turned(), TURNED[event], 0.02)
            assert same == pytest.approx(thick)
