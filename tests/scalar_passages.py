"""Hops of two discs by an independent program: replica by replica, textbook formulas.

It shares nothing with the package. Initial states are Gaussian vectors whose component normal to
the surface x1 = x2 has the flux-weighted (Rayleigh) law, scaled to the energy 1/2. On a ring the
separation along x is never wrapped: disc 2 has an image in every period. With friction all
velocities are drawn anew, at random times or, as in Brownian dynamics, after equal steps.
"""

import math

import numba
import numpy as np


@numba.njit
def on_surface(w, h, r, inertia, ring):
    """Return a state on x1 = x2: places, velocities, angular velocities times r.

    ``inertia`` is I/(m r²), 0 for smooth discs. On a ``ring`` the momentum of smooth discs is 0.
    """
    sigma, b = 2 * r, h / 2 - r
    while True:
        y1, y2 = b * (2 * np.random.rand() - 1), b * (2 * np.random.rand() - 1)
        if abs(y1 - y2) >= sigma:
            break
    x1 = (w / 2 - (0 if ring else r)) * (2 * np.random.rand() - 1)
    x2 = x1
    normal = math.sqrt(-2 * math.log(1 - np.random.rand())) * (1 if np.random.rand() < 0.5 else -1)
    common = 0.0 if ring and inertia == 0 else np.random.randn()
    u1, u2 = (common + normal) / math.sqrt(2), (common - normal) / math.sqrt(2)
    v1, v2 = np.random.randn(), np.random.randn()
    o1, o2 = 0.0, 0.0  # angular velocities times r
    if inertia > 0:
        o1, o2 = np.random.randn() / math.sqrt(inertia), np.random.randn() / math.sqrt(inertia)
    norm = math.sqrt(u1**2 + v1**2 + u2**2 + v2**2 + inertia * (o1**2 + o2**2))
    u1, v1, u2, v2, o1, o2 = u1 / norm, v1 / norm, u2 / norm, v2 / norm, o1 / norm, o2 / norm
    return x1, y1, x2, y2, u1, v1, u2, v2, o1, o2


@numba.njit
def drawn_again(inertia, ring):
    """Return velocities and angular velocities times r, uniform on the sphere of the energy 1/2."""
    u1, v1, u2, v2, o1, o2 = np.random.standard_normal(6)
    if ring and inertia == 0:
        u1, u2 = (u1 - u2) / 2, (u2 - u1) / 2
    o1, o2 = (o1 / math.sqrt(inertia), o2 / math.sqrt(inertia)) if inertia > 0 else (0.0, 0.0)
    norm = math.sqrt(u1**2 + v1**2 + u2**2 + v2**2 + inertia * (o1**2 + o2**2))
    return u1 / norm, v1 / norm, u2 / norm, v2 / norm, o1 / norm, o2 / norm


@numba.njit
def follow(state, w, h, r, inertia, ring, times, found, gap, wait, mean, equal):
    """Follow a state from x1 = x2; fill ``found`` with 1 + 2 Σ s_0 s_k at ``times``.

    With a ``gap`` and no times, return instead how many hops come after the first one, each within
    the gap after the last. After ``wait`` velocities are drawn anew, and again and again after
    times of this ``mean``, which are all ``equal`` or those of a Poisson process.
    """
    x1, y1, x2, y2, u1, v1, u2, v2, o1, o2 = state
    sigma, b = 2 * r, h / 2 - r
    first = 1 if u1 > u2 else -1
    clock, k, total, hops, latest = 0.0, 0, 1, 0, 0.0
    # The cell of u = x1 − x2, −∞ … ∞ on a ring; right after the hop at time 0.
    cell = 0 if first > 0 else -1
    while k < times.size or clock - latest < gap:
        best, kind, image = math.inf, 0, 0.0
        if not ring:
            for t, c in (((math.copysign(w / 2 - r, u1) - x1) / u1, 1),
                         ((math.copysign(w / 2 - r, u2) - x2) / u2, 2)):  # fmt: skip
                if t < best:
                    best, kind = t, c
        for t, c in (((math.copysign(b, v1) - y1) / v1, 3), ((math.copysign(b, v2) - y2) / v2, 4)):
            if t < best:
                best, kind = t, c
        du, dv, dy = u1 - u2, v1 - v2, y1 - y2
        a = du * du + dv * dv
        middle = math.floor((x1 - x2) / w + 0.5) * w if ring else 0.0
        for shift in (-1, 0, 1) if ring else (0, 0, 0):
            dx = x1 - x2 - middle - shift * w
            p, q = dx * du + dy * dv, dx * dx + dy * dy - sigma * sigma
            if p < 0 and p * p > a * q:
                t = max((-p - math.sqrt(p * p - a * q)) / a, 0.0)
                if t < best:
                    best, kind, image = t, 5, middle + shift * w
        if wait < best:
            best, kind = wait, 6
        if ring:  # look again when another image may be near
            best, kind = (best, kind) if best < w / 4 else (w / 4, 0)
        # Hops on the way, and the times that are passed.
        while True:
            edge = cell + 1 if du > 0 else cell
            until = (edge * w - (x1 - x2)) / du if ring or edge == 0 else math.inf
            until = max(until, 0.0)
            end = min(until, best)
            while k < times.size and clock + end > times[k]:
                found[k] = total
                k += 1
            if until >= best:
                break
            step = 1 if du > 0 else -1
            cell += step
            total += 2 * first * step
            if clock + until - latest >= gap > 0:
                return hops
            hops, latest = hops + 1, clock + until
        clock += best
        wait -= best
        x1, y1, x2, y2 = x1 + u1 * best, y1 + v1 * best, x2 + u2 * best, y2 + v2 * best
        if kind == 1 or kind == 2 or kind == 3 or kind == 4:
            # Normal n into the box; the slip of the surface that touches, along t = (−n_y, n_x).
            first_disc = kind == 1 or kind == 3
            u, v, o = (u1, v1, o1) if first_disc else (u2, v2, o2)
            if kind <= 2:
                nx, ny = -math.copysign(1.0, u), 0.0
                if first_disc:
                    x1 = -nx * (w / 2 - r)
                else:
                    x2 = -nx * (w / 2 - r)
            else:
                nx, ny = 0.0, -math.copysign(1.0, v)
                if first_disc:
                    y1 = -ny * b
                else:
                    y2 = -ny * b
            speed = u * nx + v * ny
            u, v = u - 2 * speed * nx, v - 2 * speed * ny
            if inertia > 0:
                tx, ty = -ny, nx
                slip = u * tx + v * ty - o  # the contact is at −n r from the centre
                push = -2 * slip / (1 + 1 / inertia)
                u, v, o = u + push * tx, v + push * ty, o - push / inertia
            if first_disc:
                u1, v1, o1 = u, v, o
            else:
                u2, v2, o2 = u, v, o
        elif kind == 6:
            u1, v1, u2, v2, o1, o2 = drawn_again(inertia, ring)
            wait = mean if equal else np.random.exponential(mean)
        elif kind == 5:
            nx, ny = (x1 - x2 - image) / sigma, (y1 - y2) / sigma
            speed = du * nx + dv * ny
            u1, v1, u2, v2 = u1 - speed * nx, v1 - speed * ny, u2 + speed * nx, v2 + speed * ny
            if inertia > 0:
                tx, ty = -ny, nx
                slip = (u1 - u2) * tx + (v1 - v2) * ty - (o1 + o2)
                push = -slip / (1 + 1 / inertia)
                u1, v1, u2, v2 = u1 + push * tx, v1 + push * ty, u2 - push * tx, v2 - push * ty
                o1, o2 = o1 - push / inertia, o2 - push / inertia
    return hops


@numba.njit
def replicas(seed, number, w, h, r, inertia, ring, times):
    """Return 1 + 2 Σ s_0 s_k of ``number`` replicas at ``times``."""
    np.random.seed(seed)
    found = np.zeros((number, times.size))
    for i in range(number):
        state, free = on_surface(w, h, r, inertia, ring), math.inf
        follow(state, w, h, r, inertia, ring, times, found[i], 0.0, free, free, False)
    return found


@numba.njit
def clusters(seed, number, w, h, r, inertia, gap, mean, equal):
    """Return the sizes of the clusters in a box of ``number`` hops, to both sides in time.

    Velocities are drawn anew after times of this ``mean``, as in ``follow``, never if it is
    infinite.
    """
    np.random.seed(seed)
    sizes, none = np.ones(number), np.zeros(0)
    for i in range(number):
        x1, y1, x2, y2, u1, v1, u2, v2, o1, o2 = on_surface(w, h, r, inertia, False)
        past = x1, y1, x2, y2, -u1, -v1, -u2, -v2, -o1, -o2
        future = x1, y1, x2, y2, u1, v1, u2, v2, o1, o2
        phase = np.random.rand()
        for state, part in ((future, phase), (past, 1 - phase)):
            wait = math.inf
            if mean < math.inf:
                # The time 0 is somewhere within an equal step.
                wait = mean * part if equal else np.random.exponential(mean)
            sizes[i] += follow(state, w, h, r, inertia, False, none, none, gap, wait, mean, equal)
    return sizes
