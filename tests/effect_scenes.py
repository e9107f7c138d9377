"""One scene for each effect, two that combine many of them, and the same scene seen otherwise."""

from dataclasses import replace

import numpy as np

from twodiscs.model.scene import Scene

#: Without effects.
PAPER = Scene(1.5, 1.0, 0.2)
THREE = Scene(1.5, 1.0, 0.15, discs=3)

#: Each of two unequal discs is the larger and lighter one in one of these scenes.
SCENES = {
    "unequal": Scene(1.5, 1.0, 0.15, radius_ratio=0.6, mass_ratio=3.0),
    "larger": Scene(1.5, 1.0, 0.12, radius_ratio=1.5, mass_ratio=0.4),
    "torus": Scene(1.5, 1.0, 0.2, periodic="xy"),
    "channel": Scene(1.5, 1.0, 0.2, periodic="x"),
    "field": Scene(1.5, 1.0, 0.2, field=0.4),
    "rough": Scene(1.5, 1.0, 0.2, moment_of_inertia=0.5),
    "friction": Scene(1.5, 1.0, 0.2, friction=5.0),
    "balls": Scene(1.5, 1.0, 0.2, depth=1.2),
    "combination": Scene(
        1.5, 1.0, 0.15, depth=0.9, radius_ratio=1.4, mass_ratio=0.3, periodic="x", field=0.3
    ),
}

#: Discs in the plane with all effects that go together; its kernels take longest to compile.
ALL = replace(SCENES["channel"], field=0.3, radius_ratio=1.2, mass_ratio=2, moment_of_inertia=0.4)


def exchanged(scene):
    """Return (the same scene with disc 2 as the first, its speeds over those of ``scene``).

    Its unit of mass is that of disc 2, and its energy is 1/2 as well.
    """
    ratio, mass = scene.radius_ratio, scene.mass_ratio
    names = {"radius": scene.radii[1], "radius_ratio": 1 / ratio, "mass_ratio": 1 / mass}
    names |= {"field": mass * scene.field, "friction": mass**0.5 * scene.friction}
    return replace(scene, **names), mass**0.5


def distance_square(scene, places):
    """Return |Δ|² to the nearest image; ``places`` are {axis: (q1, q2)}."""
    total = 0.0
    for axis, (q1, q2) in places.items():
        gap = q1 - q2
        if axis in scene.periodic:
            gap = gap - scene.side(axis) * np.round(gap / scene.side(axis))
        total = total + gap**2
    return total


def in_unit(scene, unit):
    """Return the scene whose lengths and times are ``unit`` times as large."""
    scaled = {name: unit * getattr(scene, name) for name in scene.LENGTHS}
    scaled |= {"depth": scene.depth and unit * scene.depth}
    return replace(scene, **scaled, field=scene.field / unit, friction=scene.friction / unit)
