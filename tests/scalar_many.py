"""N discs one event at a time, by textbook formulas, for comparison with the lock-step kernels.

It shares neither the law, nor the initial states, nor the random numbers of the package. On a ring
x is never wrapped: every disc has an image in every period.
"""

import math

import numpy as np

from twodiscs.model.many_geometry import arrangement
from twodiscs.sampling.jit import compiled

#: Vertical hops, horizontal hops, collisions, hits of the walls of x and of y.
KINDS = 5

#: Ends of a flight that are no event: on a ring discs look again; a time is over.
LOOK_AGAIN, END = -1, 5


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
def first_event(discs, half_x, half_y, sigma, ring, most):
    """Return (time, kind, disc, other disc, separation of its image) of an event, or its END.

    ``discs`` are (x, y, u, v, s), ``most`` is the time after which no event is looked for.
    """
    x, y, u, v, _ = discs
    best, kind, first, second, shift = most, END, 0, 0, 0.0
    # The largest relative speed is √2: no third image comes near before one looks again.
    if 0 < ring < 4 * most:
        best, kind = ring / 4, LOOK_AGAIN
    for i in range(x.size):
        if ring == 0:
            t = time_to_wall(x[i], u[i], half_x)
            if t < best:
                best, kind, first = t, 3, i
        t = time_to_wall(y[i], v[i], half_y)
        if t < best:
            best, kind, first = t, 4, i
        for j in range(i):
            near = ring * round((x[i] - x[j]) / ring) if ring > 0 else 0.0
            for side in range(-1, 2) if ring > 0 else range(1):
                image = near + side * ring
                t = time_to_contact(
                    x[i] - x[j] - image, y[i] - y[j], u[i] - u[j], v[i] - v[j], sigma
                )
                if t < best:
                    best, kind, first, second, shift = t, 2, i, j, image
    return best, kind, first, second, shift


@compiled
def advance(discs, event, kappa):
    """Move ``discs`` to an ``event`` and let it happen; κ m r² is their moment of inertia."""
    x, y, u, v, s = discs
    time, kind, i, j, shift = event
    jx = jy = turn = 0.0
    for k in range(x.size):
        x[k] += time * u[k]
        y[k] += time * v[k]
    if kind == 2:
        dx, dy = x[i] - x[j] - shift, y[i] - y[j]
        distance = math.hypot(dx, dy)
        jx, jy, turn = impulse(
            u[i] - u[j], v[i] - v[j], dx / distance, dy / distance, s[i] + s[j], kappa, 1.0
        )
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
def run(x, y, u, v, half_x, half_y, sigma, ring, batches, length, s, kappa):
    """Return the counts (batches, kinds) of a trajectory, after a tenth of it; changes the state.

    ``ring`` is the circumference along x, or 0 between walls. ``s`` are the speeds of the surfaces
    of rough discs with the moment of inertia ``kappa`` m r², which is 0 for smooth discs.
    """
    discs, counts = (x, y, u, v, s), np.zeros((batches, KINDS), np.int64)
    now, batch = -0.1 * length * batches, 0
    while batch < batches:
        event = first_event(discs, half_x, half_y, sigma, ring, length * (batch + 1) - now)
        time, kind = event[:2]
        if now >= 0:
            for i in range(x.size):
                for j in range(i):
                    dy, dx = y[i] - y[j], x[i] - x[j]
                    counts[batch, 0] += (dy < 0) != (dy + time * (v[i] - v[j]) < 0)
                    if ring == 0:
                        counts[batch, 1] += (dx < 0) != (dx + time * (u[i] - u[j]) < 0)
            if 2 <= kind < KINDS:
                counts[batch, kind] += 1
        advance(discs, event, kappa)
        now += time
        batch += kind == END
    return counts


@compiled
def put_velocities(u, v, s, normal, kappa, ring, flux):
    """Set u, v and s to a state of the energy 1/2, uniform on its sphere, from normal numbers.

    The momentum of smooth discs on a ``ring`` is 0. A ``flux`` above 0 takes the place of
    |u1 − u2|/√2, which is a normal number as well.
    """
    n, square = u.size, 0.0
    mean = np.sum(normal[:n]) / n if ring > 0 and kappa == 0 else 0.0
    apart = normal[0] - normal[1]
    change = (flux - abs(apart) / math.sqrt(2)) / math.sqrt(2) if flux > 0 else 0.0
    for i in range(n):
        u[i], v[i] = normal[i] - mean, normal[n + i]
        u[i] += (0.0 if i > 1 else (1 - 2 * i) * math.copysign(1.0, apart)) * change
        s[i] = normal[2 * n + i] / math.sqrt(kappa) if kappa > 0 else 0.0
        square += u[i] ** 2 + v[i] ** 2 + kappa * s[i] ** 2
    for i in range(n):
        u[i] /= math.sqrt(square)
        v[i] /= math.sqrt(square)
        s[i] /= math.sqrt(square)


def constants(scene):
    """Return (half-ranges of the centres, σ, the circumference or 0) and κ of a ``Scene``."""
    ring = scene.width if scene.periodic else 0.0
    box = scene.range_x / 2, scene.range_y / 2, scene.contact_distance, ring
    return box, scene.moment_of_inertia or 0.0


def rates(scene, events, seed, batches=50):
    """Return (rates of all events of a kind, standard errors), of about ``events`` events.

    One long trajectory from any state without overlap, with the mean of batches of equal length.
    """
    box, kappa = constants(scene)
    x, y = np.array(arrangement(scene)).T.copy()
    u, v, s = np.zeros((3, scene.discs))
    normal = np.random.default_rng(seed).standard_normal(3 * scene.discs)
    put_velocities(u, v, s, normal, kappa, box[-1], 0.0)
    trial = run(x, y, u, v, *box, 1, 4.0, s, kappa)
    length = 4.0 * events / max(1, int(trial[0, 2:].sum())) / batches
    counts = run(x, y, u, v, *box, batches, length, s, kappa) / length
    return counts.mean(axis=0), counts.std(axis=0, ddof=1) / math.sqrt(batches)
