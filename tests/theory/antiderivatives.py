"""The numbers of plain scenes once more: first over v, then over u by antiderivatives.

With the 150 digits that ``DIGITS`` asks for, of which cancellation near the largest radius takes up
to 100. Nothing is shared with ``twodiscs_paper/reference.py`` but the integrals.
"""

import math

from mpmath import mp, mpf

from twodiscs.model.events import DECLARED_EVENTS, EVENT_AXES, HOPS, WALLS, by_kind

DIGITS = 150

#: {event: that of the box turned by a quarter}, of the events that have one.
TURNED = {
    one.name: other.name
    for one in DECLARED_EVENTS.values()
    for other in DECLARED_EVENTS.values()
    if (one.kind, one.side) == (other.kind, other.side) and (one is other) == (one.axis is None)
}


def relative_error(value, exact):
    """Return |value/exact − 1|; an exact zero must be met exactly."""
    if exact == 0:
        return 0.0 if value == 0 else math.inf
    return float(abs(mpf(value) - exact) / abs(exact))


def lengths(scene):
    """Return (A, B, σ) of the scene's doubles, with all digits."""
    w, h, r = mpf(scene.width), mpf(scene.height), mpf(scene.radius)
    return w - 2 * r, h - 2 * r, 2 * r


class Profile:
    """Integrals over v ≥ k(u) = √(σ² − u²)₊, from u = 0 to x, for x ≥ 0."""

    def __init__(self, range_y, sigma):
        self.b, self.s = range_y, sigma
        # Below this u the arc runs above the rectangle.
        self.u0 = mp.sqrt(max(sigma**2 - range_y**2, mpf(0)))

    def integral(self, x, power, moment):
        """Return ∫ u^moment (B − k)₊^power du with power 1 or 2, moment 0 or 1."""
        if x <= self.u0:
            return mpf(0)
        b, s, end = self.b, self.s, min(x, self.s)

        def antiderivative(u):
            k = mp.sqrt(s * s - u * u)
            if moment == 0:
                of_1, of_k, of_k2 = u, (u * k + s * s * mp.asin(u / s)) / 2, s * s * u - u**3 / 3
            else:
                of_1, of_k, of_k2 = u * u / 2, -(k**3) / 3, s * s * u * u / 2 - u**4 / 4
            return b * of_1 - of_k if power == 1 else b * b * of_1 - 2 * b * of_k + of_k2

        total = antiderivative(end) - antiderivative(self.u0)
        if x > s:
            total += b**power * (x ** (moment + 1) - s ** (moment + 1)) / (moment + 1)
        return total

    def weighted(self, a, x, power):
        """Return ∫ (a − u) (B − k)₊^power du from 0 to x."""
        return a * self.integral(x, power, 0) - self.integral(x, power, 1)


def reference_volume(a, b, s):
    """Return the volume for ranges a, b and contact distance s; 0 when the discs do not fit."""
    return 2 * Profile(b, s).weighted(a, a, 2) if s * s < a * a + b * b else mpf(0)


def reference(scene):
    """Return the volume and the areas of a scene."""
    a, b, s = lengths(scene)
    profile = Profile(b, s)
    end = min(a, s)

    def antiderivative(u):  # of (A − u)(B/k − 1)
        k = mp.sqrt(s * s - u * u)
        return a * b * mp.asin(u / s) + b * k - a * u + u * u / 2

    hops = {"x": a * max(b - s, mpf(0)) ** 2, "y": b * max(a - s, mpf(0)) ** 2}
    walls = {"x": profile.integral(a, 2, 0), "y": 2 * profile.weighted(a, a, 1)}
    contact = 4 * mp.sqrt(2) * s * (antiderivative(end) - antiderivative(profile.u0))
    areas = {
        "hop": lambda event: mp.sqrt(2) * hops[event.axis],
        "collision": lambda event: contact,
        "wall": lambda event: walls[event.axis],
        "walls": lambda event: 4 * sum(walls.values()),
    }
    return {"volume": 2 * profile.weighted(a, a, 2)} | by_kind("antiderivatives.py", areas)


def reference_times(scene):
    """Return the mean times of a scene, by cases."""
    exact = reference(scene)
    volume = exact.pop("volume")
    one_sided = 3 * mp.pi / 2 * volume
    times = {event: one_sided / area if area else None for event, area in exact.items()}
    for hop in HOPS:
        if times[hop] is not None:
            times[hop] /= 2
            continue
        for wall in WALLS:
            times[wall] /= 2 if EVENT_AXES[wall] == EVENT_AXES[hop] else 1
    return times


def reference_shell(scene, event, epsilon):
    """Return the expectation of a shell."""
    a, b, s = lengths(scene)
    thick = mpf(epsilon)
    if event == "disc_collision":
        outer = s + mp.sqrt(2) * thick
        return (reference_volume(a, b, s) - reference_volume(a, b, outer)) / thick
    if EVENT_AXES[event] != ("y" if event in HOPS else "x"):
        a, b = b, a
    if event in HOPS:
        # ∬ over v ≤ √2 ε of 4 (A − u)(B − v), over 2ε: the profile with the axes exchanged.
        return Profile(a, s).weighted(b, min(mp.sqrt(2) * thick, b), 2) / thick
    # x1 = a − g: disc 2 is up to A − g to the left or up to g to the right of it.
    profile = Profile(b, s)
    within = min(thick, a)

    def twice(x):
        return profile.weighted(x, x, 2)

    return (twice(a) - twice(a - within) + twice(within)) / thick
