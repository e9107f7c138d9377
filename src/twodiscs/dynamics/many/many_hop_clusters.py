"""Which hops of two of N discs are passages: ``hop_clusters`` for a pair among others.

Discs 1 and 2 begin on the surface x1 = x2, with the law of the flux through it: a random hop is one
of theirs, because all discs are equal. The correlations C(t) and the clusters are those of this
pair alone. Between walls its hops alternate in direction, whatever the other discs do. On a ring
they alternate unless the discs go around all others.

A state is drawn by rejection. The centres of the pair are uniform on the surface, those of the
others in the box; after an overlap all are drawn again. Velocities are uniform on their sphere and
accepted with a probability ∝ |u1 − u2|.
"""

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from twodiscs.dynamics.ensemble import HOPS_PER_BLOCK, open_kicks, renew_kicks
from twodiscs.dynamics.law import crossing_time
from twodiscs.dynamics.many import all_pairs
from twodiscs.dynamics.many.all_pairs import COLLISIONS, ManyLaw, many_disc_law
from twodiscs.dynamics.two.hop_clusters import LARGEST_CLUSTER, N_HOP_SUMS
from twodiscs.model.checks import InputError
from twodiscs.model.events import EVENT_AXES
from twodiscs.model.many_geometry import CELL_DISCS
from twodiscs.model.scene import hopping_along
from twodiscs.sampling.jit import compiled
from twodiscs.sampling.many import insertions, many_initial_states
from twodiscs.sampling.many.insertions import is_free
from twodiscs.sampling.streams import open_stream, signed_uniform, uniform
from twodiscs.theory import n_discs
from twodiscs.theory.flux import flux_constant

#: For the rate of hops, if it is not known exactly: states on the surface, the most proposals of
#: them, and samples of the volume. The rate then has an error of about one per cent.
SURFACE_STATES, MOST_SURFACE_PROPOSALS, VOLUME_SAMPLES = 2**14, 2**24, 2**20

#: The least fraction of proposals that is accepted: below it states take longer than their motion.
LEAST_ACCEPTED_FRACTION = 1e-4


class Pair(NamedTuple):
    """The constants of a pair on its surface among other discs; ``room`` is B − σ."""

    sampler: many_initial_states.Initial
    room: float
    law: ManyLaw


def surface_pair(scene, hop):
    """Return the ``Pair`` of a ``Scene``, turned by a quarter if the ``hop`` is along y."""
    scene, hop = hopping_along(scene, hop, "x")
    sampler = many_initial_states.make_initial(scene, "rejection")
    return Pair(sampler, scene.clearance(hop), many_disc_law(scene))


@compiled
def draw_on_surface(state, pair, states, most):
    """Fill the columns of ``states`` (rows, number); return (accepted, proposals of centres).

    It stops before the last column after ``most`` proposals.
    """
    sampler, proposals = pair.sampler, 0
    n, ring_x, ring_y, spin = sampler.discs, sampler.ring_x, sampler.ring_y, sampler.spin
    centres, (velocities, cuts) = np.empty((2, n)), many_initial_states.velocity_memory(n, spin)
    for k in range(states.shape[1]):
        i = 0
        while i < n:
            if i == 0:
                if proposals == most:
                    return k, proposals
                proposals += 1
                low, high = pair.room * uniform(state), pair.room * uniform(state)
                low, high = min(low, high), max(low, high)
                centres[0, 0] = centres[0, 1] = sampler.half_x * signed_uniform(state)
                centres[1, 0] = low - sampler.half_y
                centres[1, 1] = sampler.half_y - (pair.room - high)
                i = 2
            else:
                x = sampler.half_x * signed_uniform(state)
                y = sampler.half_y * signed_uniform(state)
                centres[0, i], centres[1, i] = x, y
                i = i + 1 if is_free(centres, i, x, y, sampler, -1) else 0
        while True:
            many_initial_states.draw_velocities(state, velocities, cuts, ring_x, ring_y, spin)
            if math.sqrt(2.0) * uniform(state) < abs(velocities[0, 0] - velocities[0, 1]):
                break
        many_initial_states.put_state(states, k, centres, velocities, spin)
    return states.shape[1], proposals


@compiled
def follow_pair(states, remaining, gap, most, net, hops, law, kicks):
    """Follow the columns of ``states`` (rows, lanes) for the times ``remaining`` (lanes,).

    Σ s_k of the hops of discs 1 and 2 is added to ``net``, their number to ``hops``. With a ``gap``
    (above 0) a lane goes on after each hop for this time, up to ``most`` hops. Returns the number
    of wall hits and collisions.
    """
    lanes = all_pairs.new_lanes(states, remaining, law)
    x, u, old_x, times = lanes.x, lanes.u, lanes.old_x, lanes.times
    rising = np.zeros(remaining.size)
    while np.max(remaining) > 0.0:
        for l in range(remaining.size):
            rising[l] = u[0, l] - u[1, l]
        all_pairs.sweep(lanes, law, None, kicks)
        for l in range(remaining.size):
            apart = old_x[0, l] - old_x[1, l]
            if all_pairs.changes_order(apart, x[0, l] - x[1, l], law.ring_x):
                apart = insertions.ring_separation(apart, law.ring_x)
                net[l] += math.copysign(1.0, rising[l])
                hops[l] += 1.0
                if gap > 0.0:
                    left = gap - (times[l] - crossing_time(apart, rising[l]))
                    remaining[l] = left if hops[l] < most else 0.0
    return np.int64(lanes.counts[COLLISIONS:].sum())


@compiled
def begin(n, states, side, net, hops):
    """Return a copy of ``states`` of ``n`` discs, with reversed velocities if ``side`` is 1.

    Zero counts as positive, so a hop will be counted for a falling pair at time 0: ``net`` and
    ``hops`` begin below zero.
    """
    now = states.copy()
    for l in range(states.shape[1]):
        for i in range(2 * n, states.shape[0]):
            now[i, l] = -now[i, l] if side == 1 else now[i, l]
        falls = now[2 * n, l] < now[2 * n + 1, l]
        net[l], hops[l] = 1.0 if falls else 0.0, -1.0 if falls else 0.0
    return now


@compiled
def follow_blocks(seed, first, stop, times, gap, pair, sums, sizes, kicks):
    """Follow the hops of blocks ``first`` … ``stop`` − 1; return the wall hits and collisions.

    Without a ``gap`` (0), ``sums`` gets the sums of ``hop_clusters.NetHops`` at ``times``.
    With a gap, which is then the only time, ``sizes`` gets the numbers of clusters of each size.
    The other of the two arrays is overwritten and has no meaning. ``kicks`` are those of
    ``HOPS_PER_BLOCK`` lanes, None without friction.
    """
    discs, law, events, sides = pair.sampler.discs, pair.law, 0, 2 if gap > 0.0 else 1
    most = sizes.size - 1
    states, steps = np.zeros((pair.sampler.rows, HOPS_PER_BLOCK)), np.zeros(HOPS_PER_BLOCK)
    net, hops = np.zeros(HOPS_PER_BLOCK), np.zeros(HOPS_PER_BLOCK)
    for block in range(first, stop):
        draw_on_surface(open_stream(seed, block), pair, states, -1)
        own, size = sums[block - first], np.ones(HOPS_PER_BLOCK)
        for side in range(sides):
            now = begin(discs, states, side, net, hops)
            for l in range(HOPS_PER_BLOCK):
                if side == 0:
                    open_kicks(l, seed, block * HOPS_PER_BLOCK + l, kicks)
                else:
                    renew_kicks(l, kicks)
            for k in range(times.size):
                for l in range(HOPS_PER_BLOCK):
                    steps[l] = times[k] - (times[k - 1] if k > 0 else 0.0)
                events += follow_pair(now, steps, gap, most, net, hops, law, kicks)
                for l in range(HOPS_PER_BLOCK):
                    falls = states[2 * discs, l] < states[2 * discs + 1, l]
                    n = np.int64(-net[l] if falls else net[l])
                    own[0, k] += n
                    own[1, k] += n * n
                    own[2, k] += np.int64(hops[l])
            for l in range(HOPS_PER_BLOCK):
                size[l] += hops[l]
        for l in range(HOPS_PER_BLOCK):
            sizes[min(np.int64(size[l]), most)] += 1
    return events


# From a scene to the arguments of the kernels -----------------------------------------------------


def _followed(scene, hop, times, gap, blocks, seed, first):
    sums = np.zeros((blocks, N_HOP_SUMS, len(times)), np.int64)
    sizes = np.zeros(LARGEST_CLUSTER + 1, np.int64)
    run = np.uint64(seed), first, first + blocks, np.array(times), gap, surface_pair(scene, hop)
    return sums, sizes, follow_blocks(*run, sums, sizes, all_pairs.new_kicks(scene, HOPS_PER_BLOCK))


def hop_sums(scene, hop, times, blocks, seed, first=0):
    """Return (sums, events) of ``blocks`` of hops, see ``hop_clusters``."""
    sums, _, events = _followed(scene, hop, times, 0.0, blocks, seed, first)
    return sums, events


def cluster_sizes(scene, hop, gap, blocks, seed, first=0):
    """Return (sizes, events) of ``blocks`` of hops, see ``hop_clusters``."""
    _, sizes, events = _followed(scene, hop, [gap], gap, blocks, seed, first)
    return sizes, events


def require_coefficient(scene, hop):
    """Raise ``InputError`` unless hops of a ``Scene`` can be followed for their coefficient."""
    if scene.discs >= CELL_DISCS:
        raise InputError(f"discs must be at most {CELL_DISCS - 1} for passages, not {scene.discs}")
    if scene.periodic not in ("", EVENT_AXES[hop]):
        raise InputError(
            f"hop must be along the only periodic axis for passages of {scene.discs} discs, not "
            f"{hop!r} with periodic {scene.periodic!r}"
        )
    if not (scene.clearance(hop) > 0 if scene.periodic else scene.is_possible(hop)):
        raise InputError(
            f"hop {hop!r} must be open for passages, but is blocked at radius {scene.radius!r}"
        )
    accepted, proposals = surface_fraction(scene, hop)
    if accepted < LEAST_ACCEPTED_FRACTION * proposals:
        raise InputError(
            f"radius {scene.radius!r} is so large for {scene.discs} discs that fewer than "
            f"{LEAST_ACCEPTED_FRACTION:g} of the proposals of a hop have no overlap"
        )


@lru_cache(maxsize=64)
def surface_fraction(scene, hop):
    """Return (accepted, proposals) of states on the surface of a ``hop``, from the stream 0."""
    pair = surface_pair(scene, hop)
    states = np.zeros((pair.sampler.rows, SURFACE_STATES))
    return draw_on_surface(open_stream(np.uint64(0), 0), pair, states, MOST_SURFACE_PROPOSALS)


def neighbours(scene, hop):
    """Return the mean time between hops of two neighbours, and with how many pairs they share one.

    N − 1 pairs are neighbours, on a ring N; the number of pairs is a mean over these. The time is
    exact if the rate of hops is known, and has an error of about one per cent if not.
    """
    pairs = scene.discs - (not scene.periodic)
    return pairs / hop_rate(scene, hop), 2 - (not scene.periodic) * 2 / pairs


@lru_cache(maxsize=64)
def hop_rate(scene, hop):
    """Return the rate of hops of any pair, from samples if it is not known exactly."""
    if rate := n_discs.rate(scene, hop):
        return rate
    scene, hop = hopping_along(scene, hop, "x")
    accepted, proposals = surface_fraction(scene, hop)
    volume, _ = insertions.sample(scene, VOLUME_SAMPLES, 0)
    a, b, n = scene.range_x, scene.range_y, scene.discs
    level = n * (n - 1) / 2 * (scene.clearance(hop) / b) ** 2 / a * accepted / proposals
    empty = math.exp(n * math.log(a * b) - volume.log_volume)
    return math.sqrt(2) * flux_constant(scene.velocity_components) * level * empty
