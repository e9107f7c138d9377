"""A file of N smooth discs on a ring: how far a tagged disc goes, and how often discs hop.

The ring has the same length per disc, ℓ, as the ring of two discs. In the frame of zero momentum a
disc moves along the ring by hops alone, by ℓ at each hop. If hops were uncorrelated, a disc with ν
hops per time in either direction would have D = ν ℓ².
"""

import math

import numpy as np

from twodiscs.dynamics.ensemble import LANES
from twodiscs.dynamics.many.lockstep import N, advance, find_events, law_of, nearest
from twodiscs.model.checks import check_ascending, check_integer
from twodiscs.points.estimates import Estimate, mean_of
from twodiscs.sampling.jit import compiled
from twodiscs.sampling.many import initial, measures
from twodiscs.theory.many.rates import rates


@compiled
def follow(states, lanes, times, law, squares, crossings):
    """Follow initial ``states`` (4 N, replicas) on a ring to the ascending ``times``.

    Fills ``squares`` (replicas, times) with the mean over the discs of the squared displacement
    along x, and ``crossings`` (replicas) with the number of hops of all pairs up to the last time.
    ``replicas`` is a multiple of ``lanes``.
    """
    discs, replicas = states.shape[0] // 4, states.shape[1]
    x, y = np.zeros((discs, lanes)), np.zeros((discs, lanes))
    u, v = np.zeros((discs, lanes)), np.zeros((discs, lanes))
    old_x, old_y = np.zeros((discs, lanes)), np.zeros((discs, lanes))
    moved, level = np.zeros((discs, lanes)), np.zeros(lanes)
    remaining, flight = np.zeros(lanes), np.zeros(lanes)
    codes, speeds, counts = np.zeros(lanes), np.zeros(lanes), np.zeros((N, lanes))
    for first in range(0, replicas, lanes):
        moved[:], level[:] = 0.0, 0.0
        for i in range(discs):
            x[i], y[i] = states[i, first : first + lanes], states[discs + i, first : first + lanes]
            u[i] = states[2 * discs + i, first : first + lanes]
            v[i] = states[3 * discs + i, first : first + lanes]
        before = 0.0
        for k in range(times.size):
            remaining[:] = times[k] - before
            before = times[k]
            while np.max(remaining) > 0.0:
                find_events(x, y, u, v, remaining, flight, codes, speeds, law)
                for i in range(discs):
                    for j in range(i):
                        for l in range(lanes):
                            # A flight is too short for two discs to meet around the ring.
                            apart = nearest(x[i, l] - x[j, l], law.ring)
                            then = apart + (u[i, l] - u[j, l]) * flight[l]
                            level[l] += 1.0 if (apart > 0.0) != (then > 0.0) else 0.0
                    for l in range(lanes):
                        moved[i, l] += u[i, l] * flight[l]
                advance(x, y, u, v, old_x, old_y, remaining, flight, codes, counts, law, None)
            for l in range(lanes):
                total = 0.0
                for i in range(discs):
                    total += moved[i, l] * moved[i, l]
                squares[first + l, k] = total / discs
        crossings[first : first + lanes] = level


def diffusion(scene, time, replicas, seed):
    """Return (D/(ν ℓ²), hops of a disc per time) as ``Estimate``s, for a ``Scene`` on a ring.

    D follows from the displacements between ``time`` and twice ``time``, ν from all hops until
    then. There are ``replicas`` independent initial states (rounded up to whole lanes). Raises
    ``InputError`` for numbers out of range.
    """
    (time,) = check_ascending("time", [time])
    replicas = -(-check_integer("replicas", replicas, 2) // LANES) * LANES
    states = initial.states(scene, replicas, seed)
    squares, crossings = np.zeros((replicas, 2)), np.zeros(replicas)
    follow(states, LANES, np.array([time, 2 * time]), law_of(scene), squares, crossings)
    hops = mean_of(2 * crossings / (scene.discs * 2 * time))
    per_disc = scene.width / scene.discs
    moved = mean_of((squares[:, 1] - squares[:, 0]) / (2 * time) / per_disc**2)
    ratio = moved.value / (hops.value / 2)
    error = ratio * math.hypot(moved.stderr / moved.value, hops.stderr / hops.value)
    return Estimate(ratio, error, replicas), hops


def sampled_rate(scene, samples, seed):
    """Return the hops of a disc per time along a ring as an ``Estimate``, by Monte Carlo."""
    found, error = (
        rates(scene, part)["horizontal_hop"] for part in measures.sample(scene, samples, seed)
    )
    share = 2 / scene.discs  # two discs take part in a hop
    return Estimate(share * found, share * error, check_integer("samples", samples))
