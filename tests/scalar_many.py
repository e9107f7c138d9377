"""N discs one event at a time, by textbook formulas, for comparison with the lock-step kernels.

It shares neither the law, nor the initial states, nor the random numbers of the package. Positions
along periodic axes are never wrapped: every disc has an image in every period.
"""

import math

import numpy as np

from twodiscs.model.many_geometry import arrangement
from twodiscs.sampling.jit import compiled

#: Vertical hops, horizontal hops, collisions, hits of the walls of x and of y.
KINDS = 5

#: Ends of a flight that are no event: on periodic axes discs look again; a time is over.
LOOK_AGAIN, END = -1, 5


@compiled
def time_to_wall(position, velocity, half):
    """Return the time to the wall ahead."""
    return (math.copysign(half, velocity) - position) / velocity if velocity != 0 else math.inf


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
    """Return (J_x, J_y, change of the spin) on a disc of mass 1 with the outward normal −n.

    Its surface has the velocity g + (``spin``) against what it meets: another disc (``normal`` is
    1) or a wall (2). J reverses this velocity, and its torque about the centre turns the disc. If
    the disc is smooth (``kappa`` is 0), J is along n.
    """
    gx, gy = gx + spin * ny, gy - spin * nx
    along = gx * nx + gy * ny
    tangential = normal * kappa / (1 + kappa)
    jx = -normal * along * nx - tangential * (gx - along * nx)
    jy = -normal * along * ny - tangential * (gy - along * ny)
    return jx, jy, -(nx * jy - ny * jx) / kappa if kappa > 0 else 0.0


@compiled
def first_event(discs, box, most):
    """Return (time, kind, disc, other disc, shifts of its image) of an event, or its END.

    ``discs`` are (x, y, u, v, s), ``box`` is that of ``constants``; ``most`` is the time after
    which no event is looked for.
    """
    (x, y, u, v, _), (half_x, half_y, sigma, ring_x, ring_y) = discs, box
    best, kind, first, second, shift = most, END, 0, 0, (0.0, 0.0)
    # The largest relative speed is √2: no third image comes near before one looks again.
    for ring in (ring_x, ring_y):
        if 0 < ring < 4 * best:
            best, kind = ring / 4, LOOK_AGAIN
    for i in range(x.size):
        for wall, at, way, half, ring in ((3, x, u, half_x, ring_x), (4, y, v, half_y, ring_y)):
            t = time_to_wall(at[i], way[i], half) if ring == 0 else math.inf
            if t < best:
                best, kind, first = t, wall, i
        for j in range(i):
            near_x = ring_x * round((x[i] - x[j]) / ring_x) if ring_x > 0 else 0.0
            near_y = ring_y * round((y[i] - y[j]) / ring_y) if ring_y > 0 else 0.0
            for turn in range(-1, 2 if ring_x > 0 else 0):
                for round_y in range(-1, 2 if ring_y > 0 else 0):
                    across, up = near_x + turn * ring_x, near_y + round_y * ring_y
                    dx, dy = x[i] - x[j] - across, y[i] - y[j] - up
                    t = time_to_contact(dx, dy, u[i] - u[j], v[i] - v[j], sigma)
                    if t < best:
                        best, kind, first, second, shift = t, 2, i, j, (across, up)
    return best, kind, first, second, shift


@compiled
def advance(discs, event, kappa):
    """Move ``discs`` to an ``event`` and let it happen; κ m r² is their moment of inertia."""
    x, y, u, v, s = discs
    time, kind, i, j, shift = event
    jx = jy = turn = 0.0
    x += time * u
    y += time * v
    if kind == 2:
        dx, dy = x[i] - x[j] - shift[0], y[i] - y[j] - shift[1]
        distance = math.hypot(dx, dy)
        nx, ny = dx / distance, dy / distance
        jx, jy, turn = impulse(u[i] - u[j], v[i] - v[j], nx, ny, s[i] + s[j], kappa, 1.0)
        u[j] -= jx
        v[j] -= jy
        s[j] += turn
    elif kind == 3 or kind == 4:
        nx = -math.copysign(1.0, x[i]) if kind == 3 else 0.0
        ny = -math.copysign(1.0, y[i]) if kind == 4 else 0.0
        jx, jy, turn = impulse(u[i], v[i], nx, ny, s[i], kappa, 2.0)
    u[i] += jx
    v[i] += jy
    s[i] += turn


@compiled
def run(x, y, u, v, box, batches, length, s, kappa):
    """Return the counts (batches, kinds) of a trajectory, after a tenth of it; changes the state.

    ``s`` are the speeds of the surfaces of rough discs with the moment of inertia ``kappa`` m r²,
    which is 0 for smooth discs. Hops along periodic axes are not counted.
    """
    discs, counts = (x, y, u, v, s), np.zeros((batches, KINDS), np.int64)
    now, batch = -0.1 * length * batches, 0
    while batch < batches:
        event = first_event(discs, box, length * (batch + 1) - now)
        time, kind = event[:2]
        if now >= 0:
            for i in range(x.size):
                for j in range(i):
                    dy, dx = y[i] - y[j], x[i] - x[j]
                    if box[4] == 0:
                        counts[batch, 0] += (dy < 0) != (dy + time * (v[i] - v[j]) < 0)
                    if box[3] == 0:
                        counts[batch, 1] += (dx < 0) != (dx + time * (u[i] - u[j]) < 0)
            if 2 <= kind < KINDS:
                counts[batch, kind] += 1
        advance(discs, event, kappa)
        now += time
        batch += kind == END
    return counts


@compiled
def put_velocities(u, v, s, normal, kappa, box, flux):
    """Set u, v and s to a state of the energy 1/2, uniform on its sphere, from normal numbers.

    The momentum of smooth discs along the periodic axes of a ``box`` is 0. A ``flux`` above 0
    takes the place of |u1 − u2|/√2, which is a normal number as well.
    """
    n, square = u.size, 0.0
    mean = np.sum(normal[:n]) / n if box[3] > 0 and kappa == 0 else 0.0
    mean_v = np.sum(normal[n : 2 * n]) / n if box[4] > 0 and kappa == 0 else 0.0
    apart = normal[0] - normal[1]
    change = (flux - abs(apart) / math.sqrt(2)) / math.sqrt(2) if flux > 0 else 0.0
    for i in range(n):
        u[i], v[i] = normal[i] - mean, normal[n + i] - mean_v
        u[i] += (0.0 if i > 1 else (1 - 2 * i) * math.copysign(1.0, apart)) * change
        s[i] = normal[2 * n + i] / math.sqrt(kappa) if kappa > 0 else 0.0
        square += u[i] ** 2 + v[i] ** 2 + kappa * s[i] ** 2
    for part in (u, v, s):
        part /= math.sqrt(square)


def constants(scene):
    """Return (half-ranges of the centres, σ, the periods of x and y or 0) and κ of a ``Scene``."""
    rings = [scene.side(axis) if axis in scene.periodic else 0.0 for axis in "xy"]
    box = scene.range_x / 2, scene.range_y / 2, scene.contact_distance, *rings
    return box, scene.moment_of_inertia or 0.0


def rates(scene, events, seed, batches=50):
    """Return (rates of all events of a kind, standard errors), of about ``events`` events.

    One long trajectory from any state without overlap, with the mean of batches of equal length.
    """
    box, kappa = constants(scene)
    x, y = np.array(arrangement(scene)).T.copy()
    u, v, s = np.zeros((3, scene.discs))
    normal = np.random.default_rng(seed).standard_normal(3 * scene.discs)
    put_velocities(u, v, s, normal, kappa, box, 0.0)
    trial = run(x, y, u, v, box, 1, 4.0, s, kappa)
    length = 4.0 * events / max(1, int(trial[0, 2:].sum())) / batches
    counts = run(x, y, u, v, box, batches, length, s, kappa) / length
    return counts.mean(axis=0), counts.std(axis=0, ddof=1) / math.sqrt(batches)
