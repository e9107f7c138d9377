"""States of the invariant measure, and of that on the surface of a hop, for every scene.

A state is a column of (x1, y1, x2, y2, u1, v1, u2, v2): centres, then velocities. Balls append
(z1, z2, w1, w2), rough discs (s1, s2), their spins as the speeds rω of their surfaces. An array of
starts has ``COMPONENTS`` rows; those that a scene has no use for are zero.
"""

import math

import numpy as np

from twodiscs.model.checks import InputError
from twodiscs.sampling.jit import compiled, inlined, optional
from twodiscs.sampling.prism import (
    draw_in_prism,
    draw_on_surface,
    draw_velocities,
    kinetic_share,
    prism_of,
)
from twodiscs.sampling.separations import (
    draw_configuration,
    draw_constants,
    draw_crossing,
    draw_velocity,
)
from twodiscs.sampling.streams import open_stream
from twodiscs.theory import exact

#: Rows of an array of starts.
COMPONENTS = 12

#: Their names: in every scene, and what balls and rough discs append.
PLANE, BALLS, ROUGH = (
    ("x1", "y1", "x2", "y2", "u1", "v1", "u2", "v2"),
    ("z1", "z2", "w1", "w2"),
    ("s1", "s2"),
)


def require_room(scene):
    """Raise ``InputError`` for a ``Scene`` whose starts cannot be drawn, or not be followed."""
    scene.require_followable()
    require_share(scene)


def require_share(scene):
    """Raise ``InputError`` for a ``Scene`` with effects that hardly ever accepts a place."""
    if scene.has_effects and (share := exact.free_share(scene)) < exact.LEAST_SHARE:
        raise InputError(
            f"radius {scene.radius!r} leaves the discs {share:.1g} of the prism of all places, and "
            f"a scene with effects needs more room, {exact.LEAST_SHARE:g} of it"
        )


def components(scene):
    """Return the names of the components of a state of a ``Scene``."""
    balls, rough = scene.depth is not None, scene.moment_of_inertia is not None
    return PLANE + BALLS * balls + ROUGH * rough


def origins(scene, hop=None, within=None):
    """Return (``Draw``, ``Prism``) of a ``Scene``: starts come from one, the other one is None.

    With a ``hop`` they keep ``within`` a distance of its surface, one that is no more than √2 times
    the smaller radius. In a plain scene that is for the horizontal hop. A scene with effects needs
    room (``require_room``), or draws from its prism hardly end.
    """
    if scene.has_effects:
        return None, prism_of(scene, hop, within)
    return draw_constants(scene, within), None


@inlined
def state_in(starts, i):
    """Return the plain state in column ``i`` of ``starts``."""
    return (
        starts[0, i], starts[1, i], starts[2, i], starts[3, i],
        starts[4, i], starts[5, i], starts[6, i], starts[7, i],
    )  # fmt: skip


@compiled
def draw_starts(state, draw, side_x, side_y, starts):
    """Fill the first 8 rows of ``starts`` with states of the invariant measure."""
    for i in range(starts.shape[1]):
        x1, y1, x2, y2 = draw_configuration(state, draw, side_x, side_y)
        u1, v1, u2, v2 = draw_velocity(state)
        starts[0, i], starts[1, i], starts[2, i], starts[3, i] = x1, y1, x2, y2
        starts[4, i], starts[5, i], starts[6, i], starts[7, i] = u1, v1, u2, v2


def _anywhere(state, prism, direction, velocity, surface):
    place = draw_in_prism(state, prism)
    draw_velocities(state, prism, math.sqrt(place[6]), -1, direction, velocity)
    return place


@optional(_anywhere)
def draw_state(state, prism, direction, velocity, surface):
    """Return a place as ``draw_in_prism`` does, or one on a ``surface``, and fill ``velocity``."""
    place = draw_on_surface(state, prism, surface)
    draw_velocities(state, prism, math.sqrt(place[6]), surface, direction, velocity)
    return place


@optional(lambda starts, i, k, a, b, present: None)
def set_pair(starts, i, k, a, b, present):
    """Set the entries ``k`` and ``k`` + 1 of column ``i``, unless they are absent."""
    starts[k, i], starts[k + 1, i] = a, b


@compiled
def fill_start(state, prism, surface, starts, i):
    """Write a state of the invariant measure to column ``i`` of ``starts``.

    With a ``surface`` (0 for x1 = x2, 1 for y1 = y2; None for anywhere) it is one of the measure on
    that surface, weighted by the flux through it.
    """
    direction, velocity = np.empty(6), np.empty(8)
    x1, y1, z1, dx, dy, dz, _ = draw_state(state, prism, direction, velocity, surface)
    starts[0, i], starts[1, i], starts[2, i], starts[3, i] = x1, y1, x1 - dx, y1 - dy
    starts[4, i], starts[5, i] = velocity[0], velocity[1]
    starts[6, i], starts[7, i] = velocity[4], velocity[5]
    set_pair(starts, i, 8, z1, z1 - dz, prism.depth)
    set_pair(starts, i, 10, velocity[2], velocity[6], prism.depth)
    set_pair(starts, i, 8, velocity[3], velocity[7], prism.inertia)


def _plain_starts(state, draw, sides, starts, prism):
    draw_starts(state, draw, sides[0], sides[1], starts)


@optional(_plain_starts)
def draw_any_starts(state, draw, sides, starts, prism):
    """Fill ``starts`` with states of the invariant measure, from ``prism`` unless it is None."""
    for i in range(starts.shape[1]):
        fill_start(state, prism, None, starts, i)


@optional(lambda starts, i, prism: 1.0)
def kinetic_share_at(starts, i, prism):
    """Return the share of the energy that is kinetic in the state in column ``i`` of ``starts``."""
    half_1, half_2 = prism.half_1[1], prism.half_2[1]
    return kinetic_share(starts[1, i], starts[3, i], half_1, half_2, prism.weights)


def _plain_start(state, draw, surface, start, prism):
    start[0, 0], start[1, 0], start[2, 0], start[3, 0], u1, v1, u2, v2 = draw_crossing(
        state, draw.half_x, draw.half_y, draw.beyond_x
    )
    start[4, 0], start[5, 0], start[6, 0], start[7, 0] = u1, v1, u2, v2


@optional(_plain_start)
def start_on_surface(state, draw, surface, start, prism):
    """Fill the column ``start`` (12, 1) with a state on the surface of a hop, by its flux."""
    fill_start(state, prism, surface, start, 0)


def states(scene, number, seed, block=0, sides=(0, 0)):
    """Return ``number`` states of the invariant measure of a ``Scene``, one a column.

    They are the first ones of the stream of ``seed`` for ``block``, integers ≥ 0, in an array of
    ``COMPONENTS`` rows; ``sides`` choose the ergodic component of a plain scene (see
    ``draw_configuration``).
    """
    require_room(scene)
    found = np.zeros((COMPONENTS, number))
    draw, prism = origins(scene)
    draw_any_starts(open_stream(np.uint64(seed), block), draw, sides, found, prism)
    return found


def records(scene, number, seed):
    """Return ``states`` as an array of ``number`` records, with a field for each component."""
    names, found = components(scene), states(scene, number, seed)
    columns = np.empty(number, [(name, float) for name in names])
    for name, row in zip(names, found, strict=False):
        columns[name] = row
    return columns
