"""N discs one event at a time, by textbook formulas, for comparison with the lock-step kernel.

One long trajectory from any state without overlap, with the mean of batches of equal length; it
shares neither the law, nor the initial states, nor the random numbers of the package.
"""

import math

import numpy as np

from twodiscs.model.many_geometry import arrangement
from twodiscs.sampling.jit import compiled

#: Vertical hops, horizontal hops, collisions, hits of the walls of x and of y.
KINDS = 5


@compiled
def time_to_wall(position, velocity, half):
    """Return the time to the wall ahead."""
    if velocity > 0:
        return (half - position) / velocity
    if velocity < 0:
        return (-half - position) / velocity
    return math.inf


@compiled
def time_to_contact(dx, dy, du, dv, sigma):
    """Return the smaller root of |Δx + t Δv| = σ, infinite for discs that part or miss."""
    b = dx * du + dy * dv
    if b >= 0:
        return math.inf
    a, c = du * du + dv * dv, dx * dx + dy * dy - sigma * sigma
    root = b * b - a * c
    if root <= 0:
        return math.inf
    return max((-b - math.sqrt(root)) / a, 0.0)


@compiled
def impulse(gx, gy, nx, ny, spin, kappa, normal):
    """Return (J_x, J_y, change of the spin) on a rough disc of mass 1 with the outward normal −n.

    Its surface has the velocity g + (``spin``) against what it meets: another disc (``normal`` is
    1) or a wall (2). J reverses this velocity, and its torque about the centre turns the disc.
    """
    gx, gy = gx + spin * ny, gy - spin * nx
    along = gx * nx + gy * ny
    tangential = normal * kappa / (1 + kappa)
    jx = -normal * along * nx - tangential * (gx - along * nx)
    jy = -normal * along * ny - tangential * (gy - along * ny)
    return jx, jy, -(nx * jy - ny * jx) / kappa


@compiled
def run(x, y, u, v, half_x, half_y, sigma, ring, batches, length, s, kappa):
    """Return the counts (batches, kinds) of a trajectory, after a tenth of it; changes the state.

    ``ring`` is the circumference along x, or 0 between walls. ``s`` are the speeds of the surfaces
    of rough discs with the moment of inertia ``kappa`` m r², which is 0 for smooth discs.
    """
    n = x.size
    counts = np.zeros((batches, KINDS), np.int64)
    spare = -0.1 * length * batches
    now, batch = spare, 0
    while batch < batches:
        best, kind, first, second, shift = math.inf, -1, -1, -1, 0.0
        for i in range(n):
            if ring == 0:
                t = time_to_wall(x[i], u[i], half_x)
                if t < best:
                    best, kind, first = t, 3, i
            t = time_to_wall(y[i], v[i], half_y)
            if t < best:
                best, kind, first = t, 4, i
            for j in range(i):
                for image in range(-2, 3) if ring > 0 else range(1):
                    t = time_to_contact(
                        x[i] - x[j] + image * ring, y[i] - y[j], u[i] - u[j], v[i] - v[j], sigma
                    )
                    if t < best:
                        best, kind, first, second, shift = t, 2, i, j, image * ring
        # On a ring no disc may go further than once around before one looks again.
        if ring > 0 and best > ring / 4:
            best, kind = ring / 4, -1
        left = length * (batch + 1) - now
        if left < best:
            best, kind = left, 5
        before = (now >= 0) and (batch < batches)
        for i in range(n):
            for j in range(i):
                if before:
                    dy, dx = y[i] - y[j], x[i] - x[j]
                    counts[batch, 0] += (dy < 0) != (dy + best * (v[i] - v[j]) < 0)
                    if ring == 0:
                        counts[batch, 1] += (dx < 0) != (dx + best * (u[i] - u[j]) < 0)
        for i in range(n):
            x[i] += best * u[i]
            y[i] += best * v[i]
        now += best
        if kappa > 0 and 2 <= kind <= 4:
            if kind == 2:
                dx, dy = x[first] - x[second] + shift, y[first] - y[second]
                distance = math.sqrt(dx * dx + dy * dy)
                jx, jy, turn = impulse(
                    u[first] - u[second], v[first] - v[second], dx / distance, dy / distance,
                    s[first] + s[second], kappa, 1.0,
                )  # fmt: skip
                u[second] -= jx
                v[second] -= jy
                s[second] += turn
            else:
                nx = -math.copysign(1.0, x[first]) if kind == 3 else 0.0
                ny = -math.copysign(1.0, y[first]) if kind == 4 else 0.0
                jx, jy, turn = impulse(u[first], v[first], nx, ny, s[first], kappa, 2.0)
            u[first] += jx
            v[first] += jy
            s[first] += turn
        elif kind == 3:
            u[first] = -u[first]
        elif kind == 4:
            v[first] = -v[first]
        elif kind == 2:
            dx, dy = x[first] - x[second] + shift, y[first] - y[second]
            along = dx * (u[first] - u[second]) + dy * (v[first] - v[second])
            along /= dx * dx + dy * dy
            u[first] -= along * dx
            v[first] -= along * dy
            u[second] += along * dx
            v[second] += along * dy
        if before and 2 <= kind <= 4:
            counts[batch, kind] += 1
        if kind == 5:
            batch += 1
        if ring > 0:
            for i in range(n):
                if abs(x[i]) > half_x:
                    x[i] -= math.copysign(ring, x[i])
    return counts


def rates(scene, events, seed, batches=50):
    """Return (rates of all events of a kind, standard errors), of about ``events`` events."""
    rng = np.random.default_rng(seed)
    x, y = np.array(arrangement(scene)).T.copy()
    u, v = rng.standard_normal((2, scene.discs))
    kappa, s = scene.moment_of_inertia or 0.0, np.zeros(scene.discs)
    if kappa:
        s = rng.standard_normal(scene.discs) / math.sqrt(kappa)
    elif scene.periodic:
        u -= u.mean()
    scale = math.sqrt(np.sum(u * u + v * v + kappa * s * s))
    u, v, s = u / scale, v / scale, s / scale
    ring = scene.width if scene.periodic else 0.0
    box = scene.range_x / 2, scene.range_y / 2, scene.contact_distance, ring
    trial = run(x, y, u, v, *box, 1, 4.0, s, kappa)
    length = 4.0 * events / max(1, int(trial[0, 2:].sum())) / batches
    counts = run(x, y, u, v, *box, batches, length, s, kappa) / length
    return counts.mean(axis=0), counts.std(axis=0, ddof=1) / math.sqrt(batches)
