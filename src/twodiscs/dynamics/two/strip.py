"""Rare hops, counted from starts next to their surface.

Relative velocities are bounded, |Δ̇| ≤ β = √(1/m1 + 1/m2), in a field by less, because some of the
energy is in the height of the upper disc. Only starts in the strip |Δ| < βT around the surface
Δ = 0 of a hop can cross it within T, before or after. The rate of the hop is therefore

    P ⟨N⟩ / 2T

with the exact share P of configuration space that is in the strip. ⟨N⟩ is the mean number of
crossings in [−T, T], over initial states of the invariant measure in the strip. This holds for
every T, because only starts without a crossing are left out. The past of a start is the future of
the start with reversed velocities. For the same reason a path ends as soon as |Δ| exceeds β times
the time that is left.

The number of crossings of a start depends mostly on its distance from the surface and its velocity
towards it. Their laws are exact, and ⟨N⟩ is a mean over strata of both (``points.strata``).
"""

import math
from typing import NamedTuple

import numpy as np

from twodiscs.dynamics.ensemble import (
    LANES,
    REPLICAS,
    across,
    kick_lanes,
    new_kicks,
    new_rows,
    put_state,
    state_at,
)
from twodiscs.dynamics.kicks import before_kick, open_kicks, renew_kicks
from twodiscs.dynamics.law import END_OF_TIME, after_event, crosses, law_of, next_event
from twodiscs.model.events import AXIS, HOPS
from twodiscs.model.radii import key, stream_seed
from twodiscs.model.scene import hopping_along
from twodiscs.points.strata import PARTS, fractions_of_speeds, stratified_mean
from twodiscs.sampling.blocks.rounds import SequentialRun, on_grid
from twodiscs.sampling.jit import compiled
from twodiscs.sampling.prism import neck_of, prism_of, proposed_measure
from twodiscs.sampling.starts import COMPONENTS, draw_any_starts, kinetic_fraction_at, origins
from twodiscs.sampling.streams import open_stream
from twodiscs.theory import exact

#: Hops that come more often than once in this many events are counted from ordinary initial
#: states.
RARE = 40

#: Passes between two searches for lanes that have ended: paths are short.
PASSES = 2

#: A strip is as wide as the neck if the density on its surface is at least ``FILL`` times the mean
#: density in it. If it is at least ``NO_NECK`` times in the widest strip, there is no neck.
FILL = 0.75
NO_NECK = 0.97

#: The largest number of wall and disc events in the time 2T, about.
MOST_EVENTS = 32

#: The duration of paths over 2T, about: 1 for few events, 0.55 for many.
LASTING = 0.75

#: An upper bound of the squared relative error times the count, from which the number of starts
#: follows. The product is 0.07 to 0.18 at all radii of the repository's configuration, and 0.51 for
#: rough discs.
MARGIN_OF_COUNTS, MARGIN_OF_ROUGH = 0.2, 0.6

#: The time of an event of these paths over the time of an event of the ensemble, roughly. Paths are
#: short, and every start is drawn.
COST_RATIO = 6

#: The time of a proposal over the time of an event, roughly; and the most proposals that an event
#: of the budget includes. With more proposals the budget allows fewer events.
PROPOSAL, PROPOSALS_PER_EVENT = 2, 64

#: Counts of hops and of events share a double: a hop counts as this many events.
HOP = 2.0**32


class Strip(NamedTuple):
    """Starts around the surface of a hop: T, half the width βT, the exact share P of all starts."""

    time: float
    within: float
    fraction: float

    @property
    def fastest(self):
        """The largest relative speed |Δ̇| = β towards the surface that there is in the strip."""
        return self.within / self.time


def strip_around(scene, hop, time):
    """Return the ``Strip`` of a ``time`` T of at most ``widest``."""
    within = scene.fastest * time
    if scene.field:
        # At this height less kinetic energy is left; the first, wider strip bounds it.
        within *= math.sqrt(neck_of(scene, hop, within).most)
    return Strip(time, within, exact.fraction_near(scene, hop, within))


def _fill(scene, hop, strip):
    """Return the density of configurations close to Δ = 0 over the mean density in the strip."""
    narrow = strip_around(scene, hop, strip.time / 1024)
    return narrow.fraction / narrow.within * strip.within / strip.fraction


def widest(scene, hop):
    """Return the largest power of two T whose strip has an exact share.

    Its |Δ| is below √2 times the smaller radius, and below the largest possible |Δ|.
    """
    limit = min(math.sqrt(2) * min(scene.radii), float(scene.reach(AXIS[hop])))
    return math.ldexp(1.0, math.frexp(0.999 * limit / scene.fastest)[1] - 1)


def expected_events(scene, hop, strip):
    """Return an estimate of the number of events in a time 2T: 2βT over the mean room in the neck.

    In a narrow neck equal discs have events at the rate 1.45 over its room, and β is 1.41. Outside
    of it a large disc may have more events, if it hardly fits between two walls.
    """
    arch = strip.within**2 / (6 * scene.contact_distance)
    rate = scene.fastest / (scene.room(hop) + arch)
    return 2 * strip.time * max(rate, exact.event_rate(scene))


def strip_of(scene, hop):
    """Return the ``Strip`` for an open ``hop``: as wide as its neck, and not for too many events.

    T is a power of two, which makes it the same on every machine.
    """
    time = widest(scene, hop)
    while True:
        strip = strip_around(scene, hop, time)
        few = expected_events(scene, hop, strip) <= MOST_EVENTS
        if few and _fill(scene, hop, strip) >= FILL:
            return strip
        time /= 2


def fractions_of(scene, hop, strip):
    """Return the exact shares of the strata of starts, by |Δ| and by |Δ̇| (``PARTS``, m)."""
    ends = [strip.within * part / PARTS for part in range(1, PARTS + 1)]
    near = [exact.fraction_near(scene, hop, end) for end in ends]
    distances = np.diff([0.0, *near]) / near[-1]
    return np.outer(distances, fractions_of_speeds(scene.velocity_components))


def acceptance(scene, hop, strip):
    """Return a lower bound of the acceptance of proposals in a ``Strip``, about 1/4 to 1.

    With effects it may be small. In a field hardly any energy may be left at the heights at which
    the discs can pass. In other scenes hardly any of the neck may be free.
    """
    if scene.is_plain:
        return 0.25
    measure = proposed_measure(prism_of(scene, hop, strip.within))
    return strip.fraction * exact.volume(scene) / measure


def rare_hops(scene):
    """Return the hops that are counted from strips: those that are rare because of a neck.

    Hops are left out if the acceptance of starts in their strip is too small, as for whole scenes
    (``exact.MIN_FRACTION``). They are counted like all other events, mostly without a count. More
    than two discs have no strips.
    """
    if scene.discs > 2:
        return ()
    return tuple(
        hop
        for hop in HOPS
        if scene.is_possible(hop)
        and exact.event_rate(scene) > RARE * exact.rate(scene, hop)
        and _fill(scene, hop, strip_around(scene, hop, widest(scene, hop))) < NO_NECK
        and acceptance(scene, hop, strip_of(scene, hop)) >= exact.MIN_FRACTION
    )


@compiled
def count_hops(
    seed, first, stop, replicas, lanes, time, fastest, sizes, law, draw, prism, horizontal, kicks
):
    """Follow the starts of blocks ``first`` … ``stop`` − 1 for a ``time`` to either side.

    A path ends if its discs would have to be faster than ``fastest`` to hop again. ``sizes`` are
    the size of a stratum in |Δ|, the size of one in |Δ̇| if all energy is kinetic, and the number m
    of the latter. Returns starts, Σ N and Σ N² by strata (3, ``PARTS``, m), and the wall and disc
    events, all int64. The hops are vertical ones, or horizontal ones if ``horizontal`` is True
    instead of None. ``kicks`` are those of the lanes, None without friction.
    """
    rows, initial_states = new_rows(lanes, law), np.zeros((COMPONENTS, replicas))
    origin, legs = np.zeros((COMPONENTS, lanes)), np.zeros(lanes, np.int64)
    remaining, times, codes = np.zeros(lanes), np.zeros(lanes), np.zeros(lanes)
    packed, near, slow = np.zeros(lanes), np.zeros(lanes, np.int64), np.zeros(lanes, np.int64)
    sums, events = np.zeros((3, PARTS, sizes[2]), np.int64), 0
    block, used, running = first, replicas, 0

    while True:
        for i in range(lanes):
            if remaining[i] > 0.0:
                continue
            if legs[i] == 1:
                put_state(rows, i, origin[:, i], law)
                renew_kicks(i, kicks)
                remaining[i] = time
                legs[i] = 2
                continue
            if legs[i] == 2:
                count = np.int64(packed[i] * (1.0 / HOP))
                events += np.int64(packed[i] - count * HOP)
                sums[0, near[i], slow[i]] += 1
                sums[1, near[i], slow[i]] += count
                sums[2, near[i], slow[i]] += count * count
                legs[i] = 0
                running -= 1
            if used == replicas and block < stop:
                draw_any_starts(open_stream(seed, block), draw, (0, 0), initial_states, prism)
                block, used = block + 1, 0
            if used < replicas:
                put_state(rows, i, initial_states[:, used], law)
                open_kicks(i, seed, (block - 1) * replicas + used, kicks)
                separation, speed = across(initial_states[:, used], horizontal)
                speed /= math.sqrt(kinetic_fraction_at(initial_states, used, prism))
                near[i] = min(np.int64(abs(separation) / sizes[0]), PARTS - 1)
                slow[i] = min(np.int64(abs(speed) / sizes[1]), sizes[2] - 1)
                for k in range(COMPONENTS):
                    origin[k, i] = (
                        -initial_states[k, used]
                        if law_reverses(k, law)
                        else initial_states[k, used]
                    )
                remaining[i], packed[i], legs[i] = time, 0.0, 1
                used += 1
                running += 1
        if running == 0:
            return sums, events

        for _ in range(PASSES):
            for i in range(lanes):
                left = before_kick(remaining[i], i, kicks)
                times[i], codes[i] = next_event(state_at(rows, i, law), left, law)
            for i in range(lanes):
                before, code, count = state_at(rows, i, law), codes[i], packed[i]
                after = after_event(before, times[i], code, law)
                put_state(rows, i, after, law)
                separation, left = across(after, horizontal)[0], remaining[i] - times[i]
                remaining[i] = left if abs(separation) <= fastest * left else 0.0
                hop = crosses(across(before, horizontal)[0], separation)
                count += HOP if hop else 0.0
                packed[i] = count + (1.0 if code > END_OF_TIME else 0.0)
            kick_lanes(rows, times, law, kicks)


@compiled
def law_reverses(k, law):
    """Return whether component ``k`` of a start is a velocity or a spin."""
    return 4 <= k < 8 or k >= (10 if law.depth is not None else 8)


def run_blocks(scene, hop, strip, seed, first, stop, *, replicas=REPLICAS, lanes=LANES):
    """Count a ``hop`` from starts in a ``Strip``, the blocks ``first`` … ``stop`` − 1.

    Returns (sums, events) as ``count_hops`` does, integers that shards can add.
    """
    speeds = len(fractions_of_speeds(scene.velocity_components))
    sizes = strip.within / PARTS, scene.fastest / PARTS, speeds
    if scene.is_plain:  # initial states are drawn near the surface of horizontal hops only
        scene, hop = hopping_along(scene, hop, "x")
    horizontal = True if hop == "horizontal_hop" else None
    return count_hops(
        np.uint64(seed), first, stop, replicas, lanes, strip.time, strip.fastest, sizes,
        law_of(scene), *origins(scene, hop, strip.within), horizontal, new_kicks(scene, lanes),
    )  # fmt: skip


def run_of(scene, hop, target, budget, seed):
    """Return the ``SequentialRun`` that counts a ``hop`` in its strip to an error ``target``.

    It has separate streams.
    """
    strip = strip_of(scene, hop)
    seed, fractions = (
        stream_seed(seed, hop, "strip", key(scene.radius)),
        fractions_of(scene, hop, strip),
    )
    hops = REPLICAS * 2 * strip.time * exact.rate(scene, hop) / strip.fraction
    wanders = scene.moment_of_inertia or scene.friction
    margin = MARGIN_OF_ROUGH if wanders else MARGIN_OF_COUNTS
    events = max(1.0, LASTING * expected_events(scene, hop, strip))
    proposals = 1 / acceptance(scene, hop, strip) / events

    def work(first, stop):
        sums, events = run_blocks(scene, hop, strip, seed, first, stop)
        return sums, np.array(events)

    return SequentialRun(
        work,
        lambda sums, blocks: np.array([relative_error(fractions, sums[0]) / target]),
        lambda sums: int(sums[1]),
        REPLICAS * events,
        max(1, int(budget / max(1.0, proposals / PROPOSALS_PER_EVENT))),
        on_grid(margin / target**2 / hops),
        COST_RATIO + PROPOSAL * proposals,
    )


def relative_error(fractions, sums):
    """Return the relative standard error of ⟨N⟩, inf without a count.

    ``fractions`` come from ``fractions_of``, and the ``sums`` by strata from ``run_blocks``.
    """
    mean, error = stratified_mean(fractions, *sums)
    return error / mean if mean else math.inf


def constants(scene, hop):
    """Return the constants of the part of a rare ``hop``, see ``points.dynamics.StripCount``."""
    strip = strip_of(scene, hop)
    return {
        "duration": 2 * strip.time,
        "share": strip.fraction,
        "shares": fractions_of(scene, hop, strip).tolist(),
        "replicas": REPLICAS,
    }
