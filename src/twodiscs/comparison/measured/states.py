"""Each velocity has two names: "u1" and "vx1", "v1" and "vy1", "w1" and "vz1"."""

import numpy as np

#: The velocity along each axis.
VELOCITIES = {"x": "u", "y": "v", "z": "w"}


def component(name):
    """Return "u1" for the velocity "vx1", and so on; any other ``name`` is returned unchanged."""
    is_velocity = name[:1] == "v" and name[1:2] in VELOCITIES and name[2:].isdigit()
    return VELOCITIES[name[1]] + name[2:] if is_velocity else name


def with_aliases(states):
    """Return an array of states whose velocities have the names "vx1" and so on, too."""
    axes = {velocity: axis for axis, velocity in VELOCITIES.items()}
    fields = [
        ((f"v{axes[name[0]]}{name[1:]}", name) if name[0] in axes else name, float)
        for name in states.dtype.names
    ]
    return states.view(np.dtype(fields))
