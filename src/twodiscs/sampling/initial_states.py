"""States of the invariant measure, and of its flux through the surface of a hop, for every scene.

A state is a column of (x1, y1, x2, y2, u1, v1, u2, v2): centres, then velocities. Balls append
(z1, z2, w1, w2), rough discs (s1, s2), their spins as the speeds rω of their surfaces. An array of
initial states has ``STATE_ROWS`` rows; rows that a scene does not use are zero.
"""

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from twodiscs.model.checks import InputError
from twodiscs.model.formats import quote
from twodiscs.sampling.conditioned import (
    ConditionedSampler,
    conditioned_sampler,
    draw_configuration,
    draw_crossing,
    draw_velocity,
)
from twodiscs.sampling.jit import compiled, inlined, optional
from twodiscs.sampling.rejection import (
    RejectionSampler,
    draw_in_prism,
    draw_velocities,
    rejection_sampler,
)
from twodiscs.sampling.streams import open_stream
from twodiscs.sampling.threads import call_in_thread, draw_in_calls
from twodiscs.theory import exact

#: The most initial states in one call of a kernel: a tenth of a second without effects.
STATES_PER_CALL = 2**18

#: Initial states in an array that stays in the processor's cache.
STATES_PER_PIECE = 2**13

#: The most numbers of the states that are kept for a user: 1 GB.
MOST_NUMBERS = 120_000_000

#: Rows of an array of initial states of two discs.
STATE_ROWS = 12

#: The largest error of a given state by rounding, over the sides and the energy.
ROUNDING_OF_STATES = 1e-9


def require_initial_states(scene):
    """Raise ``InputError`` for a ``Scene`` whose initial states cannot be drawn or followed."""
    scene.require_followable()
    require_free_fraction(scene)


def require_free_fraction(scene):
    """Raise ``InputError`` for a ``Scene`` whose draws of initial states almost always overlap.

    Only two discs with effects are drawn from the prism.
    """
    least = exact.MIN_FRACTION
    if scene.family == "effects" and (fraction := exact.free_fraction(scene)) < least:
        raise InputError(
            f"radius {scene.radius!r} leaves a fraction {fraction:.1g} of the prism of all centres "
            f"without overlap, but a scene with effects needs {least:g} of it"
        )


def components(scene):
    """Return the names of the components of a state of a ``Scene``.

    Two discs have centres, velocities, then what balls and rough discs append. N > 2 discs have
    x1 … xN, then y, u, v and maybe s of all.
    """
    if scene.discs > 2:
        names = "xyuv" if scene.moment_of_inertia is None else "xyuvs"
        return tuple(f"{name}{disc}" for name in names for disc in range(1, scene.discs + 1))
    balls = ("z1", "z2", "w1", "w2") if scene.depth is not None else ()
    rough = ("s1", "s2") if scene.moment_of_inertia is not None else ()
    return ("x1", "y1", "x2", "y2", "u1", "v1", "u2", "v2", *balls, *rough)


def disc_fields(scene):
    """Return the letters of a disc's components: x, y, u, v, of balls z, w, of rough discs s."""
    return tuple(dict.fromkeys(name[0] for name in components(scene)))


def move_into_cell(scene, columns):
    """Move centres, {name: array}, along periodic axes to images; return {name: how far}.

    Kernels take N discs in the cell, and of two discs the image of disc 2 nearest to disc 1.
    """
    shifts, two = {}, scene.discs == 2
    for axis in scene.periodic:
        near = columns[f"{axis}1"] if two else 0.0
        for name in [f"{axis}{disc}" for disc in range(2 if two else 1, scene.discs + 1)]:
            side = scene.side(axis)
            shifts[name] = side * np.round((columns[name] - near) / side)
            columns[name] -= shifts[name]
    return shifts


def labels_of(start):
    """Return the names in a record, a namedtuple, a dict or a ``Series``, [] for anything else."""
    names = getattr(getattr(start, "dtype", None), "names", None) or getattr(start, "_fields", None)
    return [*(names or (start.keys() if hasattr(start, "keys") else ()))]


def given_state(scene, start):
    """Return a ``start`` that a user gives as floats, one for each of the ``components``.

    If its numbers have names, their order does not matter. An array with an axis of the discs is
    one of ``given_states``.
    """
    names, labels = components(scene), labels_of(start)
    discs, fields = scene.discs, disc_fields(scene)
    if getattr(start, "shape", ()) == (discs, len(fields)) or {*labels} == {*fields}:
        return given_states(scene, np.asarray(start)[None], "start")[:, 0].tolist()
    try:
        values = start.values() if isinstance(start, Mapping) else start
        # NumPy warns of a masked number.
        state = [math.nan if value is np.ma.masked else float(value) for value in values]
        if any(isinstance(label, str) for label in labels):
            known = dict(zip(labels, state, strict=True))
            state = [known.pop(name) for name in names] + [*known.values()]
    except (KeyError, TypeError, ValueError, OverflowError):
        state = []
    if len(state) == len(names) and all(map(math.isfinite, state)):
        return state
    hint = ""
    if getattr(getattr(start, "dtype", None), "names", None) and np.shape(start):
        hint = "; start[0] is one of these states"
    elif hasattr(start, "iloc"):
        hint = "; states_at(times)[0] is a state of a trajectory"
    raise InputError(f"start must be the numbers {', '.join(names)}, not {quote(start)}{hint}")


def given_states(scene, given, name="starts"):
    """Return states that a user gives as an array (components, number).

    They have the form of ``starts`` (number,), or the form of ``frames`` at one time, (number,
    discs) with named fields or (number, discs, fields) without.
    """
    names, fields = components(scene), disc_fields(scene)
    labels = getattr(getattr(given, "dtype", None), "names", None) or ()
    try:
        if {*labels} == {*names}:
            found = np.array([given[name] for name in names])
        else:
            columns = [given[field] for field in fields] if labels else np.moveaxis(given, -1, 0)
            by_field = np.asarray(columns, float)  # field, state, disc
            rows = {name: by_field[fields.index(name[0]), :, int(name[1:]) - 1] for name in names}
            is_right = by_field.shape[::2] == (len(fields), scene.discs)
            found = np.array([*rows.values()] if is_right else [])
        if found.ndim == 2 and np.isfinite(found).all():
            return found
    except (IndexError, KeyError, TypeError, ValueError):
        pass
    raise InputError(
        f"{name} must be states as starts or frames returns them, or an array of shape (number, "
        f"{scene.discs}, {len(fields)}) of {', '.join(fields)}, not {quote(given)}"
    )


class StartSampler(NamedTuple):
    """How initial states of two discs are drawn: by one of two samplers, the other one is None.

    On a ``surface`` (0 for x1 = x2, 1 for y1 = y2) states have the law of the flux through it; with
    None they are of the invariant measure. Plain scenes have the surface y1 = y2 only.
    """

    separations: ConditionedSampler | None
    prism: RejectionSampler | None
    surface: int | None = None


def start_sampler(scene, hop=None, within=None, surface=None):
    """Return the ``StartSampler`` of two discs.

    With a ``hop`` their states are ``within`` a distance of its surface, at most √2 times the
    smaller radius; in a plain scene the hop is horizontal. For a scene with effects call
    ``require_initial_states`` first, because draws from its prism may hardly ever be accepted.
    """
    if scene.is_plain:
        return StartSampler(conditioned_sampler(scene, within), None, surface)
    return StartSampler(None, rejection_sampler(scene, hop, within), surface)


@inlined
def put_in(states, i, state):
    """Put a plain ``state`` into column ``i`` of ``states``."""
    states[0, i], states[1, i], states[2, i], states[3, i] = state[:4]
    states[4, i], states[5, i], states[6, i], states[7, i] = state[4:]


@compiled
def draw_starts(state, sampler, initial_states):
    """Fill the first 8 rows of ``initial_states`` with states of the invariant measure."""
    for i in range(initial_states.shape[1]):
        centres = draw_configuration(state, sampler)
        put_in(initial_states, i, centres + draw_velocity(state))


@optional(lambda surface: -1)
def hop_axis(surface):
    """Return the axis of the hops through a ``surface``, −1 for None."""
    return surface


@optional(lambda initial_states, i, k, a, b, present: None)
def set_pair(initial_states, i, k, a, b, present):
    """Set the entries ``k`` and ``k`` + 1 of column ``i``, unless they are absent."""
    initial_states[k, i], initial_states[k + 1, i] = a, b


def _draw_plain(stream, sampler, initial_states, surface):
    draw_starts(stream, sampler.separations, initial_states)


@optional(_draw_plain)
def draw_plain(stream, sampler, initial_states, surface):
    """Fill ``initial_states`` of a plain scene, on a ``surface`` unless it is None."""
    plain = sampler.separations
    for i in range(initial_states.shape[1]):
        state = draw_crossing(stream, plain.half_x, plain.half_y, plain.beyond_x)
        put_in(initial_states, i, state)


def _draw_without_prism(stream, sampler, initial_states, prism):
    draw_plain(stream, sampler, initial_states, sampler.surface)


@optional(_draw_without_prism)
def draw_with(stream, sampler, initial_states, prism):
    """Fill ``initial_states`` by a ``prism``, or by separations if it is None."""
    direction, velocity, axis = np.empty(6), np.empty(8), hop_axis(sampler.surface)
    for i in range(initial_states.shape[1]):
        x1, y1, z1, dx, dy, dz, fraction = draw_in_prism(stream, prism, axis)
        draw_velocities(stream, prism, math.sqrt(fraction), axis, direction, velocity)
        centres = x1, y1, x1 - dx, y1 - dy
        put_in(initial_states, i, (*centres, velocity[0], velocity[1], velocity[4], velocity[5]))
        set_pair(initial_states, i, 8, z1, z1 - dz, prism.depth)
        set_pair(initial_states, i, 10, velocity[2], velocity[6], prism.depth)
        set_pair(initial_states, i, 8, velocity[3], velocity[7], prism.inertia)


@inlined
def draw_states(stream, sampler, initial_states):
    """Fill ``initial_states`` (``STATE_ROWS``, n) from a ``stream`` by a ``StartSampler``."""
    draw_with(stream, sampler, initial_states, sampler.prism)


def states(scene, number, seed, block=0, progress=None):
    """Return ``number`` states of the invariant measure of a ``Scene``, one a column.

    They are the first states of the stream of ``seed`` for ``block``, integers ≥ 0, in an array of
    ``STATE_ROWS`` rows. N > 2 discs have the rows of ``components``. ``progress``, if given, is
    called repeatedly with the number of drawn states, and ``number``.
    """
    require_initial_states(scene)
    if scene.discs > 2:
        from twodiscs.sampling.many.many_initial_states import labelled

        return labelled(scene, number, seed, block, progress)
    filled = np.zeros((STATE_ROWS, number))
    sampler = start_sampler(scene)
    stream = call_in_thread(open_stream, np.uint64(seed), block)

    # The kernel fills whole arrays, continues the stream, and does not use all rows.
    used, buffer = len(components(scene)), np.zeros((STATE_ROWS, min(number, STATES_PER_PIECE)))

    def fill(first, stop):
        for start in range(first, stop, STATES_PER_PIECE):
            end = min(start + STATES_PER_PIECE, stop)
            some = buffer if end - start == buffer.shape[1] else np.zeros((STATE_ROWS, end - start))
            draw_states(stream, sampler, some)
            filled[:used, start:end] = some[:used]
        return stop

    share = 1.0 if sampler.prism is None else exact.free_fraction(scene)
    step = int(STATES_PER_CALL * share)
    calls = ((first, min(first + step, number)) for first in range(0, number, step))
    draw_in_calls(fill, calls, number, progress)
    return filled


def make_records(scene, filled):
    """Return ``states`` of a ``Scene`` as an array with a named field for each component."""
    names, number = components(scene), filled.shape[1]
    columns = np.empty(number, [(name, float) for name in names])
    for name, row in zip(names, filled, strict=False):
        columns[name] = row
    return columns
