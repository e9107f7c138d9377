"""One scene for each effect, and two that combine many of them."""

from twodiscs.model.scene import Scene

SCENES = {
    "unequal": Scene(1.5, 1.0, 0.15, radius_ratio=0.6, mass_ratio=3.0),
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
ALL = Scene(
    1.5, 1.0, 0.2, periodic="x", field=0.3, radius_ratio=1.2, mass_ratio=2.0, moment_of_inertia=0.4
)
