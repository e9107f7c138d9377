"""Rejection sampling of the volume and, by thin shells, of the surfaces of configuration space.

Centres are drawn uniformly in the prism; a sample that does not overlap belongs to the volume, and
one that also lies within ε of a surface belongs to its shell. Shell thickness is measured along
the normal in configuration space, g = 0 being the surface and |∇g| = 1:

    vertical hop     |y1 − y2|/√2 ≤ ε, from both sides        horizontal hop  likewise in x
    disc collision   0 ≤ (|Δx| − σ)/√2 ≤ ε                    right wall      0 ≤ a − x1 ≤ ε
                                                              top wall        0 ≤ b − y1 ≤ ε

A shell of finite thickness is biased; ``theory.shell_expectation`` is what it estimates exactly.

A coordinate is one of 2³² equidistant values, so that two of them come from one draw of 64 bits
and their difference is an integer. The grain shifts a probability by some 2⁻³² of the prism, far
below the error of any number of samples that can be drawn.
"""

import math

import numpy as np

from twodiscs.checks import one_of, proportion, whole
from twodiscs.jit import compiled
from twodiscs.scene import EVENTS, HOPS
from twodiscs.streams import GOLDEN, open_stream, splitmix

LANES = 64

#: Samples that share a random stream: 2¹⁴ passes over the lanes.
BLOCK = LANES << 14

#: Passes between two readings of the packed counts; eight fields of eight bits.
PASSES = 128

#: The shells that are sampled; all walls together follow from the right and the top one.
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
    radius, or for a hop w/4 or h/4. Beyond it a hop's shell is empty, as is its surface.
    """
    limits = {"vertical_hop": scene.width / 4, "horizontal_hop": scene.height / 4}
    limit = limits.get(event, scene.largest_radius)
    room = abs(limit - scene.radius)
    return fraction * (min(scene.radius, room) if room > 0 else scene.radius)


def sample_point(scene, quantities, samples, shell, seed):
    """Estimate the volume and areas of a ``Scene`` by rejection sampling in the prism.

    ``quantities`` is a list of ``"volume"`` and ``"<event>_area"``; ``samples`` is rounded up to
    whole blocks of 2²⁰; ``shell`` sets the thickness of the shells (``shell_thickness``); ``seed``
    is an integer ≥ 0. Returns a dict for a JSON file: radius, samples, and for each sampled
    quantity its hits, its measure and ε, so that measure × hits / samples is the estimate. The
    area of all walls takes no shell of its own: ``right_and_top`` is how many samples lie in both
    shells.

    Raises ``ValueError`` for an unknown quantity or a number out of range.
    """
    allowed = ("volume", *(f"{event}_area" for event in EVENTS))
    for quantity in quantities:
        one_of("quantity", quantity, allowed)
    if not quantities:
        raise ValueError("quantities must name at least one quantity, not none")
    blocks = -(-whole("samples", samples) // BLOCK)
    seed, shell = whole("seed", seed, 0), proportion("shell", shell)

    wanted = {quantity.removesuffix("_area") for quantity in quantities}
    if "any_wall" in wanted:
        wanted |= {"right_wall", "top_wall"}
    epsilon = [shell_thickness(scene, e, shell) if e in wanted else 0.0 for e in SHELLS]
    areas = True if any(epsilon) else None
    counts = sample_blocks(
        np.uint64(seed), 0, blocks, scene.range_x, scene.range_y, scene.contact_distance,
        tuple(epsilon), areas,
    )  # fmt: skip

    prism = (scene.range_x * scene.range_y) ** 2
    found = {}
    if "volume" in wanted:
        found["volume"] = {"hits": int(counts[0]), "measure": prism, "epsilon": None}
    for i, event in enumerate(SHELLS):
        if event in wanted:
            sides = 2 if event in HOPS else 1
            found[f"{event}_area"] = {
                "hits": int(counts[1 + i]),
                "measure": prism / (sides * epsilon[i]),
                "epsilon": epsilon[i],
            }
    point = {"radius": scene.radius, "samples": blocks * BLOCK, "quantities": found}
    if {"right_wall", "top_wall"} <= wanted:
        point["right_and_top"] = int(counts[6])
    return point
