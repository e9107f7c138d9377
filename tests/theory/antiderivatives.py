"""The numbers of plain scenes once more: first over v, then over u by antiderivatives.

With the 150 digits that ``DIGITS`` asks for, of which cancellation near the largest radius takes up
to 100. Nothing is shared with ``theory/reference.py`` but the integrals.
"""

import math

from mpmath import mp, mpf

from twodiscs.model.events import HOPS

DIGITS = 150


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

    right, top = profile.integral(a, 2, 0), 2 * profile.weighted(a, a, 1)
    return {
        "volume": 2 * profile.weighted(a, a, 2),
        "vertical_hop": mp.sqrt(2) * b * max(a - s, mpf(0)) ** 2,
        "horizontal_hop": mp.sqrt(2) * a * max(b - s, mpf(0)) ** 2,
        "disc_collision": 4 * mp.sqrt(2) * s * (antiderivative(end) - antiderivative(profile.u0)),
        "right_wall": right,
        "top_wall": top,
        "any_wall": 4 * (right + top),
    }


def reference_times(scene):
    """Return the mean times of a scene, by cases."""
    exact = reference(scene)
    volume = exact.pop("volume")
    one_sided = 3 * mp.pi / 2 * volume
    times = {event: one_sided / area if area else None for event, area in exact.items()}
    for hop, wall in (("horizontal_hop", "right_wall"), ("vertical_hop", "top_wall")):
        if times[hop] is None:
            times[wall] /= 2
        else:
            times[hop] /= 2
    return times


def reference_shell(scene, event, epsilon):
    """Return the expectation of a shell."""
    a, b, s = lengths(scene)
    thick = mpf(epsilon)
    if event == "disc_collision":
        outer = s + mp.sqrt(2) * thick
        return (reference_volume(a, b, s) - reference_volume(a, b, outer)) / thick
    if event in ("horizontal_hop", "top_wall"):
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
