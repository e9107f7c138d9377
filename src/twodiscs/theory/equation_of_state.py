"""Pressure of many discs without an exact volume: few overlaps, or an equation of state."""

import math

from twodiscs.model.scene import Scene
from twodiscs.theory import plain
from twodiscs.theory.flux import Derivatives


def pair_overlap(scene):
    """Return q, the probability that two of the centres, drawn uniformly, overlap."""
    if scene.periodic == "xy":
        return math.pi * scene.contact_distance**2 / (scene.width * scene.height)
    if scene.periodic == "y":
        return pair_overlap(scene.turned())
    if scene.periodic:
        # On a ring the separation along x is uniform; along y it has the density 2 (B − v)/B².
        b, sigma = scene.range_y, scene.contact_distance
        reach = min(b, sigma)
        phi = math.asin(reach / sigma)
        whole = b * sigma * (phi + math.sin(phi) * math.cos(phi)) / 2 * sigma
        moment = sigma**3 * (1 - math.cos(phi) ** 3) / 3
        return 4 * (whole - moment) / (b * b * scene.width)
    two = Scene(scene.width, scene.height, scene.radius)
    return 1 - plain.volume_and_areas(two)[0] / (scene.range_x * scene.range_y) ** 2


def bulk_derivatives(scene):
    """Return approximate ``Derivatives`` of many discs, from an equation of state.

    PV/(N kT) is Z = (1 + η²/8)/(1 − η)², with η the packing fraction (Henderson, Mol. Phys. 30, 971
    (1975)). The rate of hops of a pair is taken as without other discs.
    """
    a, b, n, sigma = scene.range_x, scene.range_y, scene.discs, scene.contact_distance
    packing = n * math.pi * sigma * sigma / 4 / (scene.width * scene.height)
    z = (1 + packing * packing / 8) / (1 - packing) ** 2
    pairs = n * (n - 1) / 2
    return Derivatives(
        math.nan, 0.0 if "x" in scene.periodic else n * z / a,
        0.0 if "y" in scene.periodic else n * z / b, 2 * n * (z - 1) / sigma,
        pairs / a * max(0.0, 1 - sigma / b) ** 2, pairs / b * max(0.0, 1 - sigma / a) ** 2,
    )  # fmt: skip
