"""Rejection sampling of the volume and, by thin shells, of the surfaces of configuration space.

Centres are drawn uniformly in the prism; a sample that does not overlap belongs to the volume, and
one that also lies within ε of a surface belongs to its shell. Shell thickness is measured along
the normal in configuration space, g = 0 being the surface and |∇g| = 1:

    vertical hop     |y1 − y2|/√2 ≤ ε, from both sides        horizontal hop  likewise in x
    disc collision   0 ≤ (|Δx| − σ)/√2 ≤ ε                    right wall      0 ≤ a − x1 ≤ ε
                                                              top wall        0 ≤ b − y1 ≤ ε

A shell of finite thickness is biased; ``theory.shell_expectation`` is what it estimates exactly.
Where the prism is almost all overlap, ``conditioned_point`` takes the place of ``sample_point``;
``better_point`` is whichever of them is the better one.

A coordinate is one of 2³² equidistant values, so that two of them come from one draw of 64 bits
and their difference is an integer. The grain shifts a probability by some 2⁻³² of the prism, far
below the error of any number of samples that can be drawn.

Scenes with effects are sampled one draw at a time (``weighted_blocks``), with the weight of the
invariant measure as the probability that a sample counts: so their errors are binomial too.
Thickness is then measured in the metric of the masses, as ``rates.shell_expectation`` has it.
"""

import math
from typing import NamedTuple

import numpy as np

from twodiscs import theory
from twodiscs.checks import a_scene, one_of, proportion, whole
from twodiscs.invariant import (
    draw_constants,
    kinetic_share,
    power_chance,
    prism_of,
    propose_in_prism,
    propose_separation,
)
from twodiscs.jit import compiled, optional
from twodiscs.scene import AXIS, EVENTS, HOPS
from twodiscs.streams import GOLDEN, next_bits, open_stream, splitmix, uniform

LANES = 64

#: Samples of the prism that share a random stream: 2¹⁴ passes over the lanes.
BLOCK = LANES << 14

#: Passes between two readings of the packed counts; eight fields of eight bits.
PASSES = 128

#: Proposals of the conditioned sampler that share a random stream.
PROPOSALS = 1 << 16

#: How many times the time of a sample of the prism one of them takes, roughly.
DEARER = 64

#: The shells that are sampled in a plain scene; all walls follow from the right and the top one.
SHELLS = EVENTS[:5]


@compiled
def sample_blocks(seed, first, stop, range_x, range_y, sigma, shells, areas):
    """Count the samples of blocks ``first`` … ``stop`` − 1 that fall into each set.

    ``shells`` are five thicknesses (0 where a shell is not wanted), in the order of ``SHELLS``.
    Returns int64 counts: volume, five shells, right and top at once. ``areas`` is True, or None
    where only the volume is wanted: the shells are then not compiled.
    """
    s0, s1 = np.empty(LANES, np.uint64), np.empty(LANES, np.uint64)
    packed, totals = np.zeros(LANES, np.int64), np.zeros(7, np.int64)
    unit_x, unit_y = range_x * 2.0**-32, range_y * 2.0**-32
    inner = sigma * sigma
    outer = (sigma + math.sqrt(2.0) * shells[2]) ** 2
    low_v, low_u = 2.0 * shells[0] ** 2, 2.0 * shells[1] ** 2
    # The first grain that lies in the shell of the wall.
    right = np.int64(math.ceil((1.0 - shells[3] / range_x) * 2.0**32 - 0.5))
    top = np.int64(math.ceil((1.0 - shells[4] / range_y) * 2.0**32 - 0.5))
    mask = np.uint64(0xFFFFFFFF)
    for block in range(first, stop):
        counter = open_stream(seed, block)[0]
        for i in range(LANES):
            counter += GOLDEN
            s0[i] = splitmix(counter)
            counter += GOLDEN
            s1[i] = splitmix(counter) | np.uint64(1)
        for _ in range(BLOCK // LANES // PASSES):
            for _ in range(PASSES):
                for i in range(LANES):
                    # xoroshiro128+ (Blackman and Vigna 2021), twice.
                    a, b = s0[i], s1[i]
                    bits_x = a + b
                    b ^= a
                    a = ((a << np.uint64(24)) | (a >> np.uint64(40))) ^ b ^ (b << np.uint64(16))
                    b = (b << np.uint64(37)) | (b >> np.uint64(27))
                    bits_y = a + b
                    b ^= a
                    s0[i] = ((a << np.uint64(24)) | (a >> np.uint64(40))) ^ b ^ (b << np.uint64(16))
                    s1[i] = (b << np.uint64(37)) | (b >> np.uint64(27))
                    grain_x = np.int64(bits_x >> np.uint64(32))
                    grain_y = np.int64(bits_y >> np.uint64(32))
                    u = np.float64(grain_x - np.int64(bits_x & mask)) * unit_x
                    v = np.float64(grain_y - np.int64(bits_y & mask)) * unit_y
                    uu, vv = u * u, v * v
                    square = uu + vv
                    free = square >= inner
                    tally = 1 if free else 0
                    if areas is not None:
                        tally += (1 << 8) if free & (vv <= low_v) else 0
                        tally += (1 << 16) if free & (uu <= low_u) else 0
                        tally += (1 << 24) if free & (square <= outer) else 0
                        tally += (1 << 32) if free & (grain_x >= right) else 0
                        tally += (1 << 40) if free & (grain_y >= top) else 0
                        tally += (1 << 48) if free & (grain_x >= right) & (grain_y >= top) else 0
                    packed[i] += tally
            for i in range(LANES):
                for e in range(7):
                    totals[e] += (packed[i] >> (8 * e)) & 255
                packed[i] = 0
    return totals


def shell_thickness(scene, event, fraction):
    """Return ε for the shell of ``event``: a ``fraction`` of the radius, or of the room if smaller.

    The room is the distance of the radius from the one at which the surface vanishes: the largest
    radius, or for a hop w/4 or h/4. Beyond it a hop's shell is empty, as is its surface. In a box
    more than twice as long as wide the discs keep room along it up to the largest radius: long − 4r
    is then that of collisions and of the walls at the far ends.

    With effects it is a fraction of the smaller radius or of the room, in units of the lightest
    disc's metric, so that the shell is no thicker than that anywhere (√2 of it for the separation
    of two discs) and stays inside the box. The room is that to the largest radius or, for a hop,
    the width of the gap between the discs when they pass each other as far apart as they can be.

    Raises ``ValueError`` for an event without a shell and a ``fraction`` that is not between 0 and
    1.
    """
    one_of("event", event, scene.events if a_scene(scene).has_effects else SHELLS)
    fraction = proportion("fraction", fraction)
    if scene.has_effects:
        return fraction * _weighted_thickness(scene, event)
    limits = {"vertical_hop": scene.width / 4, "horizontal_hop": scene.height / 4}
    room = abs(limits.get(event, scene.largest_radius) - scene.radius)
    long, short = max(scene.width, scene.height), min(scene.width, scene.height)
    ahead = {"right_wall": scene.width, "top_wall": scene.height, "disc_collision": long}
    if long > 2 * short and ahead.get(event) == long:
        room = long - 4 * scene.radius
    return fraction * (min(scene.radius, room) if room > 0 else scene.radius)


def _weighted_thickness(scene, event):
    """Return the length that ``shell_thickness`` takes a fraction of, with effects."""
    if event in HOPS:
        across = sum(scene.reach(axis) ** 2 for axis in scene.axes if axis != AXIS[event])
        room = abs(math.sqrt(across) - scene.contact_distance)
    else:
        room = scene.largest_radius - scene.radius
    smallest = min(scene.radii)
    lightest = 1.0 if event in ("right_wall", "top_wall") else min(scene.masses)
    return math.sqrt(lightest) * (min(smallest, room) if room > 0 else smallest)


def sample_point(scene, quantities, samples, shell, seed):
    """Estimate the volume and areas of a ``Scene`` by rejection sampling in the prism.

    ``quantities`` is a list of ``"volume"`` and ``"<event>_area"``; ``samples`` is rounded up to
    whole blocks of 2²⁰; ``shell`` sets the thickness of the shells (``shell_thickness``); ``seed``
    is an integer ≥ 0. Returns a dict for a JSON file: radius, method, samples, and for each sampled
    quantity its hits, its measure and ε, so that measure × hits / samples is the estimate. The
    area of all walls takes no shell of its own: ``right_and_top`` is how many samples lie in both
    shells.

    For a scene with effects see ``weighted_point``. Raises ``ValueError`` for an unknown quantity
    or a number out of range.
    """
    if a_scene(scene).has_effects:
        return weighted_point(scene, quantities, samples, shell, seed)
    wanted, epsilon = _shells(scene, quantities, shell)
    blocks, seed = -(-whole("samples", samples) // BLOCK), whole("seed", seed, 0)
    areas = True if any(epsilon) else None
    counts = sample_blocks(
        np.uint64(seed), 0, blocks, scene.range_x, scene.range_y, scene.contact_distance,
        tuple(epsilon), areas,
    )  # fmt: skip
    prism = (scene.range_x * scene.range_y) ** 2
    return _point(scene, "monte_carlo", wanted, epsilon, blocks * BLOCK, prism, counts)


def _shells(scene, quantities, shell):
    """Return (the set of "volume" and events to sample, ε for each event with a shell or 0).

    These are ``SHELLS``, or all ``EVENTS`` in a scene with effects.
    """
    allowed = ("volume", *(f"{event}_area" for event in a_scene(scene).events))
    for quantity in quantities:
        one_of("quantity", quantity, allowed)
    if not quantities:
        raise ValueError("quantities must name at least one quantity, not none")
    shell = proportion("shell", shell)
    wanted = {quantity.removesuffix("_area") for quantity in quantities}
    if "any_wall" in wanted and not scene.has_effects:
        wanted |= {"right_wall", "top_wall"}
    shells = EVENTS if scene.has_effects else SHELLS
    return wanted, [shell_thickness(scene, e, shell) if e in wanted else 0.0 for e in shells]


def _point(scene, method, wanted, epsilon, samples, measure, counts):
    """Return the dict for a JSON file; ``measure`` is the volume that the samples fill."""
    found = {}
    if "volume" in wanted:
        found["volume"] = {"hits": int(counts[0]), "measure": measure, "epsilon": None}
    # A sample looks at both sides of a hop, and at one disc and one of its walls.
    share = dict.fromkeys(HOPS, 1 / 2) | {"any_wall": 4 * len(scene.walled)}
    for event, thickness, hits in zip(EVENTS, epsilon, counts[1:], strict=False):
        if event in wanted:
            found[f"{event}_area"] = {
                "hits": int(hits),
                "measure": share.get(event, 1) * measure / thickness,
                "epsilon": thickness,
            }
    point = {"radius": scene.radius, "method": method, "samples": samples, "quantities": found}
    if {"right_wall", "top_wall"} <= wanted and not scene.has_effects:
        point["right_and_top"] = int(counts[6])
    return point


@compiled
def propose_blocks(seed, first, stop, draw, shells):
    """Count the proposals of blocks ``first`` … ``stop`` − 1 that fall into each set.

    The counts are those of ``sample_blocks``, for the same ``shells``; ``draw`` is the ``Draw`` of
    the scene. Distances are taken from the far corner and from contact, as the proposals give them,
    so that shells keep their thickness where the discs hardly fit.
    """
    totals = np.zeros(7, np.int64)
    low_v, low_u = 2.0 * shells[0] ** 2, 2.0 * shells[1] ** 2
    thick = math.sqrt(2.0) * shells[2]
    touching = thick * (2.0 * draw.sigma + thick)
    for block in range(first, stop):
        state = open_stream(seed, block)
        for _ in range(PROPOSALS):
            accepted, slack_x, slack_y, u, excess = propose_separation(state, draw)
            if not accepted:
                continue
            v = draw.range_y - slack_y
            bits = next_bits(state)
            # Disc 1 has a share of the room that is left, and the separation if it is the far one.
            to_right = slack_x * uniform(state)
            to_right += u if bits & np.uint64(1 << 62) else 0.0
            to_top = slack_y * uniform(state)
            to_top += v if bits & np.uint64(1 << 61) else 0.0
            right, top = to_right <= shells[3], to_top <= shells[4]
            totals[0] += 1
            totals[1] += v * v <= low_v
            totals[2] += u * u <= low_u
            totals[3] += excess <= touching
            totals[4] += right
            totals[5] += top
            totals[6] += right & top
    return totals


def conditioned_point(scene, quantities, samples, shell, seed):
    """Estimate the volume and areas of a ``Scene`` by draws that keep to where the discs fit.

    For radii where the prism is almost all overlap, up to the largest one: at least a quarter of
    the proposals is accepted at any radius. A proposal is a sample of a set whose volume, twice
    ``Draw.mass``, is known; so its point has the form of that of ``sample_point``, for the same
    arguments, and the errors are binomial too. ``samples`` counts proposals and is rounded up to
    whole blocks of 2¹⁶. A sample costs some forty times that of the prism, which is the better
    choice wherever it accepts a few in a hundred. Raises ``ValueError`` as ``sample_point`` does.
    """
    if a_scene(scene).has_effects:
        raise ValueError(f"scene must have no effects for conditioned draws, not {scene.effects}")
    wanted, epsilon = _shells(scene, quantities, shell)
    blocks, seed = -(-whole("samples", samples) // PROPOSALS), whole("seed", seed, 0)
    draw = draw_constants(scene)
    counts = propose_blocks(np.uint64(seed), 0, blocks, draw, tuple(epsilon))
    return _point(scene, "conditioned", wanted, epsilon, blocks * PROPOSALS, 2 * draw.mass, counts)


# Scenes with effects ----------------------------------------------------------------------------


class Shells(NamedTuple):
    """How far the shells reach, as lengths; None for a shell that is not wanted."""

    vertical_hop: float | None  # |y1 − y2|
    horizontal_hop: float | None
    disc_collision: float | None  # the square of the distance of the centres
    right_wall: float | None
    top_wall: float | None
    any_wall: tuple | None  # for disc 1 and disc 2
    walled: tuple  # the numbers of the axes with walls


def weighted_shells(scene, epsilon):
    """Return the ``Shells`` of a ``Scene`` for thicknesses ε, 0 where one is not wanted.

    ``epsilon`` is in the order of ``EVENTS``. None in the place of ``Shells`` says that there are
    none at all.
    """
    if not any(epsilon):
        return None
    thick = dict(zip(EVENTS, epsilon, strict=True))
    relative = math.sqrt(sum(1 / mass for mass in scene.masses))
    outer = scene.contact_distance + relative * thick["disc_collision"]
    return Shells(
        vertical_hop=relative * thick["vertical_hop"] or None,
        horizontal_hop=relative * thick["horizontal_hop"] or None,
        disc_collision=outer * outer if thick["disc_collision"] else None,
        right_wall=thick["right_wall"] or None,
        top_wall=thick["top_wall"] or None,
        any_wall=tuple(thick["any_wall"] / math.sqrt(m) for m in scene.masses)
        if thick["any_wall"]
        else None,
        walled=tuple("xyz".index(axis) for axis in scene.walled),
    )


@optional(lambda state, share, power, weights: True)
def counted(state, share, power, weights):
    """Say whether a sample counts, with the probability ``share`` to the ``power``/2."""
    return power_chance(state, share, power)


@optional(lambda distance, end: False)
def within(distance, end):
    """Say whether a sample is in the shell that reaches to ``end``."""
    return distance <= end


@optional(lambda state, prism, place, separation, walled, thickness: False)
def at_random_wall(state, prism, place, separation, walled, thickness):
    """Say whether a disc is in the shell of a wall, both of them picked at random."""
    pick = int(4 * len(walled) * uniform(state))
    axis, first = walled[pick // 4], pick & 2 == 0
    q = place[axis] if first else place[axis] - separation[axis]
    half = prism.half_1[axis] if first else prism.half_2[axis]
    distance = half - q if pick & 1 == 0 else half + q
    return distance <= (thickness[0] if first else thickness[1])


@optional(lambda totals, state, prism, place, separation, share, shells: None)
def count_shells(totals, state, prism, place, separation, share, shells):
    """Count a sample that counts for the volume in the shells, ``totals`` from 1 on.

    Volume and area are weighted with powers of the kinetic share that differ by 1/2.
    """
    if not counted(state, share, 1, prism.weights):
        return
    dx, dy, dz = separation
    totals[1] += within(abs(dy), shells.vertical_hop)
    totals[2] += within(abs(dx), shells.horizontal_hop)
    totals[3] += within(dx * dx + dy * dy + dz * dz, shells.disc_collision)
    totals[4] += within(prism.half_1[0] - place[0], shells.right_wall)
    totals[5] += within(prism.half_1[1] - place[1], shells.top_wall)
    totals[6] += at_random_wall(state, prism, place, separation, shells.walled, shells.any_wall)


@compiled
def weighted_blocks(seed, first, stop, prism, shells):
    """Count the samples of blocks ``first`` … ``stop`` − 1 that count for each set.

    ``prism`` is the ``Prism`` of a scene with effects, ``shells`` are its ``Shells`` or None.
    Returns int64 counts: volume, then ``EVENTS``.
    """
    totals = np.zeros(7, np.int64)
    for block in range(first, stop):
        state = open_stream(seed, block)
        for _ in range(BLOCK):
            x1, y1, z1, dx, dy, dz = propose_in_prism(state, prism)
            if dx * dx + dy * dy + dz * dz < prism.sigma * prism.sigma:
                continue
            share = kinetic_share(y1, y1 - dy, prism.half_1[1], prism.half_2[1], prism.weights)
            if counted(state, share, prism.components - 2, prism.weights):
                totals[0] += 1
                count_shells(totals, state, prism, (x1, y1, z1), (dx, dy, dz), share, shells)
    return totals


def weighted_point(scene, quantities, samples, shell, seed):
    """Estimate the weighted volume and areas of a ``Scene`` with effects.

    A sample of the prism in which the discs do not overlap counts for the volume with the
    probability (1 − U/E)₊^(D/2 − 1), and for a shell it lies in with (1 − U/E)₊^((D − 1)/2). All
    walls have an entry of their own: for each sample one disc and one wall are picked at random, so
    that its measure is that of the prism times their number. Otherwise arguments, result and errors
    are those of ``sample_point``; a sample takes some forty times as long.
    """
    wanted, epsilon = _shells(scene, quantities, shell)
    blocks, seed = -(-whole("samples", samples) // BLOCK), whole("seed", seed, 0)
    # Spins have no place in configuration space: one kernel less to compile.
    prism = prism_of(scene)._replace(inertia=None)
    found = weighted_blocks(np.uint64(seed), 0, blocks, prism, weighted_shells(scene, epsilon))
    axes = range(len(scene.axes))
    measure = math.prod(4 * prism.half_1[axis] * prism.half_2[axis] for axis in axes)
    return _point(scene, "monte_carlo", wanted, epsilon, blocks * BLOCK, measure, found)


# The choice -------------------------------------------------------------------------------------


def better_point(scene, quantities, samples, shell, seed):
    """Estimate the volume and areas of a ``Scene`` by the sampler that suits it.

    With effects that is ``weighted_point``. Without, it is ``sample_point`` where a sample of the
    prism is free with a probability of at least 1/``DEARER``; else it is ``conditioned_point``,
    with as many samples as take the same time. Arguments, result and errors are those of either.
    """
    draw_from, samples = plan(scene, samples)
    return draw_from(scene, quantities, samples, shell, seed)


def plan(scene, samples):
    """Return (the sampler that suits a ``Scene``, the number of its samples for ``samples``)."""
    in_prism = -(-whole("samples", samples) // BLOCK) * BLOCK
    if a_scene(scene).has_effects:
        return weighted_point, in_prism
    free = theory.volume(scene) / (scene.range_x * scene.range_y) ** 2
    if free >= 1 / DEARER:
        return sample_point, in_prism
    return conditioned_point, -(-samples // (DEARER * PROPOSALS)) * PROPOSALS
