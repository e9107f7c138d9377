"""How tests of random numbers decide that a law is not the one they should have."""

import math

import numpy as np
from scipy.special import betainc
from scipy.stats import kstest

#: Five sigma, two-sided: the rate of false alarms of each comparison.
FALSE_ALARM = 5.7e-7


def assert_uniform(values):
    """Kolmogorov–Smirnov: ``values`` are uniform on [0, 1]."""
    found = kstest(values, "uniform", method="asymp")
    assert found.pvalue > FALSE_ALARM, found


def parts(scene, starts):
    """Return {axis: (q1, q2, v1, v2)} and the spins (s1, s2) of rough discs or None.

    Coordinates on periodic axes are wrapped into the box.
    """
    found = {"x": starts[[0, 2, 4, 6]], "y": starts[[1, 3, 5, 7]]}
    if scene.depth is not None:
        found["z"] = starts[8:12]
    for axis in scene.periodic:
        side = scene.side(axis)
        found[axis][:2] -= side * np.round(found[axis][:2] / side)
    return found, starts[8:10] if scene.moment_of_inertia else None


def energy_left(scene, y1, y2):
    """Return twice the kinetic energy at total energy 1/2; heights count from the bottom."""
    (r1, r2), (m1, m2) = scene.radii, scene.masses
    half = scene.height / 2
    return 1 - 2 * scene.field * (m1 * (y1 + half - r1) + m2 * (y2 + half - r2))


def scaled_components(scene, found, spins, normal=None, roundings=16):
    """Return unit vectors of D components, from velocities scaled by √mass, a row each.

    With a ``normal`` axis the first row is the relative motion along it. Energy and momenta have
    the required values to some ``roundings``.
    """
    m1, m2 = scene.masses
    reduced, common, rows = math.sqrt(m1 * m2 / (m1 + m2)), [], []
    for axis in (normal, *(a for a in scene.axes if a != normal)) if normal else scene.axes:
        v1, v2 = found[axis][2:]
        if axis in scene.conserved:
            momentum = np.abs(m1 * v1 + m2 * v2) / math.sqrt(max(m1, m2))
            assert np.max(momentum) < roundings * 2.0**-53
            rows.append(reduced * (v1 - v2))
        elif axis == normal:
            rows.append(reduced * (v1 - v2))
            common.append((m1 * v1 + m2 * v2) / math.sqrt(m1 + m2))
        else:
            rows += [math.sqrt(m1) * v1, math.sqrt(m2) * v2]
    rows += common
    if spins is not None:
        rows += [math.sqrt(scene.moment_of_inertia * m1) * spins[0]]
        rows += [math.sqrt(scene.moment_of_inertia * m2) * spins[1]]
    assert len(rows) == scene.velocity_components
    square, left = np.sum(np.square(rows), axis=0), energy_left(scene, *found["y"][:2])
    assert np.max(np.abs(square - left)) < roundings * 2.0**-52
    return np.array(rows) / np.sqrt(square)


def assert_uniform_on_sphere(unit):
    """Every component squared has a beta law; second and fourth mixed moments are exact."""
    d, n = unit.shape
    for i, a in enumerate(unit):
        assert abs(np.mean(np.sign(a))) <= 5 / math.sqrt(n)
        assert_uniform(betainc(1 / 2, (d - 1) / 2, a**2))
        for b in unit[:i]:
            assert abs(np.mean(a * b)) <= 5 * np.std(a * b) / math.sqrt(n)
            product = a**2 * b**2
            assert abs(np.mean(product) - 1 / (d * (d + 2))) <= 5 * np.std(product) / math.sqrt(n)
