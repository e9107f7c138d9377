"""Which hops are passages: how the hops that follow one another are correlated.

A hop is a passage if the discs do not soon hop back. Transition state theory counts every crossing
of the surface u = 0 of a hop, where u is x1 − x2 or y1 − y2. Their fate is the
reactive flux (Chandler, J. Chem. Phys. 68, 2959 (1978)),

    C(t) = 1 + 2 ⟨Σ s_0 s_k⟩,

over initial states on the surface, weighted by the flux through it: s_0 = ±1 is the direction of
the hop at time 0, s_k that of the hop at time t_k, and the sum has all with 0 < t_k ≤ t. Between
walls hops alternate in direction, and C(t) is the transmission coefficient

    κ(t) = ⟨s_0 sign u(t)⟩,    κ(0) = 1,    κ'(0⁺) = −2 p(0⁺)

with the density p of the intervals between hops. On a ring (one periodic axis) discs may pass each
other in the same direction again and again. The net number n(t) of hops, from initial states of the
invariant measure, has d⟨n²⟩/dt = Γ C(t) with the rate Γ of hops in both directions. At long times n
is a random walk. With the displacement ℓ by a hop and ν = Γ/2 hops per time in each direction,
D/(ν ℓ²) is the limit of C. It is 1 for independent hops (Machta and Zwanzig, Phys. Rev. Lett. 50,
1959 (1983)).

Rare hops come in clusters: n hops with less than a ``gap`` of time between one and the next. A
cluster of odd n is a passage, and since a random hop is in a cluster of n with a weight ∝ n,
passages per hop are

    κ = ⟨1[n odd]/n⟩

over the same initial states, each followed forwards and backwards in time. This has a far smaller
variance than κ(t) where κ is small, κ at most instead of 1.
"""

import math

import numpy as np

from twodiscs.dynamics.ensemble import FOLLOWED as REPLICAS
from twodiscs.dynamics.ensemble import (
    LANES,
    LARGEST,
    SUMS,
    across,
    find_events,
    kick_lanes,
    new_kicks,
    new_rows,
    put_state,
    state_at,
)
from twodiscs.dynamics.kicks import open_kicks, renew_kicks
from twodiscs.dynamics.law import (
    END_OF_TIME,
    WRAP_X,
    WRAP_Y,
    after_event,
    crosses,
    crossing_time,
    law_of,
)
from twodiscs.dynamics.two.strip import law_reverses
from twodiscs.model.checks import (
    InputError,
    check_ascending,
    check_choice,
    check_integer,
    check_length,
)
from twodiscs.model.events import AXIS, HOPS
from twodiscs.model.scene import check_scene, hopping_along
from twodiscs.sampling.jit import compiled
from twodiscs.sampling.prism import prism_of
from twodiscs.sampling.starts import COMPONENTS, fill_start, require_room
from twodiscs.sampling.streams import open_stream
from twodiscs.theory import exact

#: Passes between two looks at which lanes have come to the end of their time.
PASSES = 2

#: Blocks of replicas whose states are in memory together.
CHUNK = 1024


@compiled
def draw_initial_states(seed, first, stop, prism, surface, states):
    """Fill the columns of ``states`` from the streams of blocks ``first`` … ``stop`` − 1.

    They are on a ``surface`` (0 for x1 = x2, 1 for y1 = y2), weighted by the flux through it, or of
    the invariant measure if that is None.
    """
    replicas = states.shape[1] // (stop - first)
    for block in range(first, stop):
        state = open_stream(seed, block)
        for i in range(replicas):
            fill_start(state, prism, surface, states, (block - first) * replicas + i)


@compiled
def follow_hops(
    states, lanes, times, gap, law, hopping, horizontal, sums, sizes, seed, first, kicks
):
    """Follow the hops from the ``states`` (``COMPONENTS``, replicas), along x or y.

    The hops are those along y, or along x if ``horizontal`` is True instead of None. If ``hopping``
    the states are on the surface of the hop, and the hop at time 0 has the direction s_0 in which
    they fall through it; otherwise s_0 is 1. Without a ``gap`` (0) n, n², N and N² at each of the
    ascending ``times`` are added to ``sums`` (blocks of replicas, ``SUMS``, times; int64), where
    n = Σ s_0 s_k is over the hops after time 0 and N their number. With a ``gap`` replicas are
    followed forwards and backwards, and the sizes of their clusters are counted in ``sizes``
    (int64), the last of which takes all that are larger. The ``kicks`` of the lanes, None without
    friction, come from the streams of ``seed`` (uint64), for replicas from the ``first`` on, and
    are independent in both directions of time. Returns the number of wall and disc events.
    """
    rows, reverse = new_rows(lanes, law), np.zeros((COMPONENTS, lanes))
    flights, codes, remaining = np.zeros(lanes), np.zeros(lanes), np.zeros(lanes)
    direction, net, hops = np.zeros(lanes), np.zeros(lanes), np.zeros(lanes)
    replica, due, events = np.full(lanes, -1), np.zeros(lanes, np.int64), np.zeros(lanes)
    most = np.float64(sizes.size - 1) if gap > 0.0 else np.inf
    wrap = WRAP_Y if horizontal is None else WRAP_X
    total, per_block = states.shape[1], states.shape[1] // sums.shape[0]
    started, running = 0, 0

    while True:
        for i in range(lanes):
            if remaining[i] > 0.0:
                continue
            if replica[i] >= 0:
                if gap > 0.0 and due[i] == 0:
                    put_state(rows, i, reverse[:, i], law)
                    renew_kicks(i, kicks)
                    due[i], remaining[i] = 1, gap
                    # The hop at time 0 has been counted.
                    hops[i] -= 1.0 if across(state_at(rows, i, law), horizontal)[1] < 0.0 else 0.0
                    continue
                if gap > 0.0:
                    sizes[min(np.int64(hops[i]), sizes.size - 1)] += 1
                else:
                    n, m = np.int64(net[i]), np.int64(hops[i])
                    block = sums[replica[i] // per_block, :, due[i]]
                    block[0] += n
                    block[1] += n * n
                    block[2] += m
                    block[3] += m * m
                    due[i] += 1
                    if due[i] < times.size:
                        remaining[i] = times[due[i]] - times[due[i] - 1]
                        continue
                replica[i] = -1
                running -= 1
            if started == total:
                continue
            put_state(rows, i, states[:, started], law)
            open_kicks(i, seed, first + started, kicks)
            for k in range(COMPONENTS):
                value = states[k, started]
                reverse[k, i] = -value if law_reverses(k, law) else value
            replica[i], due[i], remaining[i] = started, 0, gap if gap > 0.0 else times[0]
            direction[i], net[i], hops[i] = 1.0, 0.0, 0.0
            if hopping and across(state_at(rows, i, law), horizontal)[1] < 0.0:
                # Zero counts as positive, so a hop will be counted for this one at time 0.
                direction[i], net[i], hops[i] = -1.0, -1.0, -1.0
            hops[i] += 1.0 if gap > 0.0 else 0.0  # a cluster has the hop at time 0 as well
            started += 1
            running += 1
        if running == 0:
            return np.int64(events.sum())

        for _ in range(PASSES):
            find_events(rows, remaining, flights, codes, law, kicks)
            for i in range(lanes):
                before, time, code = state_at(rows, i, law), flights[i], codes[i]
                after = after_event(before, time, code, law)
                put_state(rows, i, after, law)
                apart, rising = across(before, horizontal)
                # Half a period apart the separation changes its sign without a hop.
                end = rising if code == wrap else across(after, horizontal)[0]
                hop = crosses(apart, end)
                net[i] += math.copysign(1.0, direction[i] * rising) if hop else 0.0
                hops[i] += 1.0 if hop else 0.0
                left = gap - (time - crossing_time(apart, rising))
                left = left if hop & (gap > 0.0) else remaining[i] - time
                remaining[i] = left if hops[i] < most else 0.0
                events[i] += 1.0 if code > END_OF_TIME else 0.0
            kick_lanes(rows, flights, law, kicks)


# From a scene to the arguments of the kernel ----------------------------------------------------


def require_passing(scene, hop):
    """Raise ``InputError`` unless the discs of a ``Scene`` can be followed past each other.

    The axis of the ``hop`` may be periodic, where hops are no events of the scene.
    """
    check_choice("hop", hop, HOPS)
    require_room(check_scene(scene))
    periodic = AXIS[hop] in scene.periodic
    if not (scene.room(hop) > 0 if periodic else scene.is_possible(hop)):
        raise InputError(
            f"hop {hop!r} must be open for passages, but is blocked at radius {scene.radius!r}"
        )


def require_coefficient(scene, hop):
    """Raise ``InputError`` unless the hops of a ``Scene`` can have a transmission coefficient."""
    require_passing(scene, hop)
    if AXIS[hop] in scene.periodic:
        raise InputError(
            f"hop {hop!r} must be between walls for a transmission coefficient, but its axis is "
            "periodic"
        )


def neighbours(scene, hop):
    """Return the mean time between hops of two neighbours, and no pairs that change this."""
    return exact.mean_times(scene)[hop], 0


def initial_states(scene, hop, blocks, seed, first=0, on_surface=True):
    """Return states (``COMPONENTS``, ``blocks`` × ``REPLICAS``) on the surface of a ``hop``.

    They are weighted by the flux through it, or of the invariant measure unless ``on_surface``; the
    blocks are those from the ``first`` one on of the streams of ``seed``. Raises ``InputError`` as
    ``require_passing`` does, and for numbers out of range.
    """
    require_passing(scene, hop)
    blocks, seed, first = (
        check_integer("blocks", blocks),
        check_integer("seed", seed, 0),
        check_integer("first", first, 0),
    )
    states = np.zeros((COMPONENTS, blocks * REPLICAS))
    prism = prism_of(scene, hop, 0.0) if on_surface else prism_of(scene)
    surface = "xy".index(AXIS[hop]) if on_surface else None
    draw_initial_states(np.uint64(seed), first, first + blocks, prism, surface, states)
    return states


def _followed(scene, hop, blocks, seed, first, times, gap, sums, sizes, on_surface=True):
    """Run ``follow_hops``, some blocks at a time; return the number of events."""
    scene, hop = hopping_along(scene, hop, "x")
    horizontal, events = None if AXIS[hop] == "y" else True, 0
    for start in range(0, blocks, CHUNK):
        number = min(CHUNK, blocks - start)
        states = initial_states(scene, hop, number, seed, first + start, on_surface)
        own = sums[start : start + number]
        events += int(
            follow_hops(
                states,
                LANES,
                times,
                gap,
                law_of(scene),
                on_surface,
                horizontal,
                own,
                sizes,
                np.uint64(seed),
                (first + start) * REPLICAS,
                new_kicks(scene, LANES),
            )
        )
    return events


def hop_sums(scene, hop, times, blocks, seed, first=0, on_surface=True):
    """Return (sums, events) of ``blocks`` blocks of ``REPLICAS`` initial states each.

    ``sums`` (blocks, ``SUMS``, times; integers) have Σ n, Σ n², Σ N and Σ N² at the ascending
    ``times``, lengths over unit speed, as in ``follow_hops``; initial states are on the surface of
    the ``hop``, or those of the invariant measure unless ``on_surface``. The blocks are those from
    the ``first`` one on of the streams of ``seed``. Raises ``InputError`` for a hop that is unknown
    or blocked, and numbers out of range.
    """
    times, blocks = np.array(check_ascending("times", times)), check_integer("blocks", blocks)
    sums = np.zeros((blocks, SUMS, times.size), np.int64)
    none = np.zeros(1, np.int64)
    return sums, _followed(scene, hop, blocks, seed, first, times, 0.0, sums, none, on_surface)


def cluster_sizes(scene, hop, gap, blocks, seed, first=0):
    """Return (sizes, events): how many hops are in a cluster of 0, 1, 2 … hops.

    ``sizes`` (``LARGEST`` + 1 integers) are over ``blocks`` blocks of ``REPLICAS`` hops, each a
    random one; the last has all larger clusters. A cluster ends where no hop comes for a time
    ``gap``. Arguments and errors are otherwise as for ``hop_sums``.
    """
    gap, blocks = check_length("gap", gap), check_integer("blocks", blocks)
    sizes, none = np.zeros(LARGEST + 1, np.int64), np.zeros((blocks, SUMS, 1), np.int64)
    events = _followed(scene, hop, blocks, seed, first, np.array([gap]), gap, none, sizes)
    return sizes, events
