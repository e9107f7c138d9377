"""Hops of discs 1 and 2 among N discs by an independent program: textbook formulas, one disc each.

It shares nothing with the package. Centres are drawn until none overlap. Velocities are Gaussian
vectors whose component normal to the surface x1 = x2 has the flux-weighted (Rayleigh) law, scaled
to the energy 1/2. On a ring x is never wrapped: every disc has an image in every period.
"""

import math

import numba
import numpy as np


@numba.njit
def on_surface(n, w, h, r, ring):
    """Return (x, y, u, v) of a state on x1 = x2; on a ``ring`` without momentum along x."""
    x, y = np.zeros(n), np.zeros(n)
    apart = False
    while not apart:
        for i in range(n):
            x[i] = np.random.rand() * (w - (0 if ring else 2 * r))
            y[i] = np.random.rand() * (h - 2 * r)
        x[1], apart = x[0], True
        for i in range(n):
            for j in range(i):
                dx = x[i] - x[j]
                if ring:
                    dx -= w * round(dx / w)
                apart &= math.hypot(dx, y[i] - y[j]) >= 2 * r
    u, v = np.random.standard_normal(n), np.random.standard_normal(n)
    mean = u.mean() if ring else 0.0
    for i in range(n):
        u[i] -= mean
    # (u1 − u2)/√2 is a normal variable; with the flux its size has the law of Rayleigh.
    change = math.sqrt(-2 * math.log(1 - np.random.rand())) - abs(u[0] - u[1]) / math.sqrt(2)
    change *= math.copysign(1 / math.sqrt(2), u[0] - u[1])
    u[0], u[1] = u[0] + change, u[1] - change
    norm = 0.0
    for i in range(n):
        norm += u[i] ** 2 + v[i] ** 2
    for i in range(n):
        u[i], v[i] = u[i] / math.sqrt(norm), v[i] / math.sqrt(norm)
    return x, y, u, v


@numba.njit
def follow(x, y, u, v, w, h, r, ring, duration, gap):
    """Return the hops of discs 1 and 2 after time 0, up to a ``duration`` or each within a ``gap``.

    The state is changed.
    """
    n, sigma = x.size, 2 * r
    clock, hops, latest, first = 0.0, 0, 0.0, True
    while clock < duration and clock - latest < gap:
        # A flight is at most a tenth of the ring, and no faster than 1: images are near.
        best, kind, one, other, image = min(w / 10, duration - clock), 0, 0, 0, 0.0
        for i in range(n):
            if not ring:
                t = ((w - 2 * r if u[i] > 0 else 0.0) - x[i]) / u[i]
                if t < best:
                    best, kind, one = t, 1, i
            t = ((h - 2 * r if v[i] > 0 else 0.0) - y[i]) / v[i]
            if t < best:
                best, kind, one = t, 2, i
            for j in range(i):
                shift = w * round((x[i] - x[j]) / w) if ring else 0.0
                for side in range(-1, 2) if ring else range(1):
                    dx, dy = x[i] - x[j] - shift - side * w, y[i] - y[j]
                    du, dv = u[i] - u[j], v[i] - v[j]
                    p, a = dx * du + dy * dv, du * du + dv * dv
                    q = p * p - a * (dx * dx + dy * dy - sigma * sigma)
                    if p < 0 and q > 0:
                        t = max((-p - math.sqrt(q)) / a, 0.0)
                        if t < best:
                            best, kind, one, other, image = t, 3, i, j, shift + side * w
        du, dx = u[0] - u[1], x[0] - x[1]
        if ring:
            dx -= w * round(dx / w)
        until = -dx / du
        if 0 < until < best and not first:
            hops, latest = hops + (clock + until - latest < gap), clock + until
        # The pair starts at x1 = x2: it cannot come back before an event.
        first = False
        clock += best
        for i in range(n):
            x[i] += u[i] * best
            y[i] += v[i] * best
        if kind == 1:
            u[one] = -u[one]
        elif kind == 2:
            v[one] = -v[one]
        elif kind == 3:
            nx, ny = (x[one] - x[other] - image) / sigma, (y[one] - y[other]) / sigma
            push = (u[one] - u[other]) * nx + (v[one] - v[other]) * ny
            u[one], v[one] = u[one] - push * nx, v[one] - push * ny
            u[other], v[other] = u[other] + push * nx, v[other] + push * ny
    return hops


@numba.njit
def clusters(seed, number, n, w, h, r, ring, gap):
    """Return the sizes of the clusters of ``number`` hops, followed to both sides in time."""
    np.random.seed(seed)
    sizes = np.ones(number)
    for k in range(number):
        x, y, u, v = on_surface(n, w, h, r, ring)
        sizes[k] += follow(x.copy(), y.copy(), u.copy(), v.copy(), w, h, r, ring, math.inf, gap)
        sizes[k] += follow(x, y, -u, -v, w, h, r, ring, math.inf, gap)
    return sizes


@numba.njit
def orders(seed, number, n, w, h, r, ring, time):
    """Return ⟨s_0 s⟩, ±1 for each of ``number`` hops, at a ``time`` after it; between walls."""
    np.random.seed(seed)
    values = np.ones(number)
    for k in range(number):
        x, y, u, v = on_surface(n, w, h, r, ring)
        values[k] = 1.0 - 2.0 * (follow(x, y, u, v, w, h, r, ring, time, math.inf) % 2)
    return values
