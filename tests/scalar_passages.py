"""Hops of discs 1 and 2 by an independent program: replica by replica, textbook formulas.

It shares nothing with the package. Centres are drawn until none overlap. Initial velocities are
Gaussian vectors whose component normal to the surface x1 = x2 has the flux-weighted (Rayleigh) law,
scaled to the energy 1/2. With friction all velocities are drawn anew at random times.
"""

import math

import numpy as np
from scalar_many import END, advance, constants, first_event, put_velocities

from twodiscs.sampling.jit import compiled


@compiled
def on_surface(discs, box, kappa):
    """Set ``discs``, the arrays (x, y, u, v, s), to a state on x1 = x2."""
    (x, y, u, v, s), (half_x, half_y, sigma, ring, _), apart = discs, box, False
    while not apart:
        for i in range(x.size):
            x[i] = half_x * (2 * np.random.rand() - 1)
            y[i] = half_y * (2 * np.random.rand() - 1)
        x[1], apart = x[0], True
        for i in range(x.size):
            for j in range(i):
                dx = x[i] - x[j]
                if ring > 0:
                    dx -= ring * round(dx / ring)
                apart &= math.hypot(dx, y[i] - y[j]) >= sigma
    flux = math.sqrt(-2 * math.log(1 - np.random.rand()))
    put_velocities(u, v, s, np.random.standard_normal(3 * x.size), kappa, box, flux)


@compiled
def follow(discs, box, kappa, times, found, gap, mean):
    """Follow ``discs`` from x1 = x2; fill ``found`` with 1 + 2 Σ s_0 s_k at ``times``.

    With a ``gap`` and no times, return instead how many hops come after the first one, each within
    the gap after the last. Velocities are drawn anew after random times of this ``mean``.
    """
    x, _, u, v, s = discs
    ring, wait = box[3], np.random.exponential(mean)
    first = 1 if u[0] > u[1] else -1
    clock, k, total, hops, latest = 0.0, 0, 1, 0, 0.0
    # The cell of x1 − x2, −∞ … ∞ on a ring; right after the hop at time 0.
    cell = 0 if first > 0 else -1
    while k < times.size or clock - latest < gap:
        event = first_event(discs, box, wait)
        step = 1 if u[0] > u[1] else -1
        # Hops on the way, and the times that are passed.
        while True:
            edge = cell + (step > 0)
            until = math.inf
            if ring > 0 or edge == 0:
                until = max((edge * ring - (x[0] - x[1])) / (u[0] - u[1]), 0.0)
            while k < times.size and clock + min(until, event[0]) > times[k]:
                found[k] = total
                k += 1
            if until >= event[0]:
                break
            cell += step
            total += 2 * first * step
            if clock + until - latest >= gap > 0:
                return hops
            hops, latest = hops + 1, clock + until
        clock += event[0]
        wait -= event[0]
        advance(discs, event, kappa)
        if event[1] == END:
            put_velocities(u, v, s, np.random.standard_normal(3 * x.size), kappa, box, 0.0)
            wait = np.random.exponential(mean)
    return hops


@compiled
def fill(seed, found, sizes, n, box, kappa, times, gap, mean):
    """Fill ``found`` (number, times) and ``sizes`` (number,), see ``sample``."""
    np.random.seed(seed)
    discs = np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n)
    past = np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n)
    for k in range(sizes.size):
        on_surface(discs, box, kappa)
        for part in range(5):
            past[part][:] = discs[part] * (1 if part < 2 else -1)
        sizes[k] = 1 + follow(discs, box, kappa, times, found[k], gap, mean)
        if gap > 0:
            sizes[k] += follow(past, box, kappa, times, found[k], gap, mean)


def sample(scene, number, seed, times=(), gap=0.0):
    """Return (1 + 2 Σ s_0 s_k at ``times``, sizes of the clusters) of a ``number`` of hops.

    Clusters are followed to both sides in time if there is a ``gap``, and no times.
    """
    found, sizes = np.zeros((number, len(times))), np.zeros(number)
    mean = 1 / scene.friction if scene.friction else math.inf
    fill(seed, found, sizes, scene.discs, *constants(scene), np.array(times, float), gap, mean)
    return found, sizes
