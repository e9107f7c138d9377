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
towards it. Their laws are exact, and ⟨N⟩ is a mean over strata of both (``points.estimates``).
"""

import math
from typing import NamedTuple

import numpy as np

from twodiscs.dynamics.ensemble import LANES, REPLICAS, SHORT_SWEEPS
from twodiscs.dynamics.law import END_OF_TIME, crosses
from twodiscs.dynamics.two.follow import follow, relative_motion
from twodiscs.model.events import EVENT_AXES, HOPS
from twodiscs.model.scene import hopping_along
from twodiscs.model.seeds import key, stream_seed
from twodiscs.points.estimates import MOST_STRATA, fractions_of_speeds, stratified_mean
from twodiscs.sampling.initial_states import start_sampler
from twodiscs.sampling.rejection import (
    find_neck,
    proposed_measure,
    rejection_sampler,
    state_kinetic_fraction,
)
from twodiscs.sampling.rounds import SequentialRun, round_up_blocks
from twodiscs.theory import exact

#: Hops that come more often than once in this many events are counted from ordinary initial
#: states.
RARE_HOP_EVENTS = 40

#: A strip is as wide as the neck if the density on its surface is at least ``NECK_FILL`` times the
#: mean density in it. If it is at least ``NO_NECK_FILL`` times in the widest strip, there is no
#: neck.
NECK_FILL = 0.75
NO_NECK_FILL = 0.97

#: The largest number of wall and disc events in the time 2T, about.
EVENTS_PER_PATH = 32

#: The duration of paths over 2T, about: 1 for few events, 0.55 for many.
PATH_DURATION = 0.75

#: An upper bound of the squared relative error times the count, from which the number of starts
#: follows. The product is 0.07 to 0.18 at all radii of the repository's configuration, and 0.51 for
#: rough discs. Discs that diffuse cross the surface more often in a row: with n kicks in the time T
#: of a strip, n = 0.1 to 1000, the product is about 0.3 to 0.5 times n to this power.
MARGIN_OF_COUNTS, MARGIN_OF_ROUGH, GROWTH_BY_KICKS = 0.2, 0.6, 5 / 8

#: The time of an event of these paths over the time of an event of the ensemble, roughly. Paths are
#: short, and every start is drawn.
PATH_EVENT_COST = 6

#: The time of a proposal over the time of an event, roughly; and the most proposals that an event
#: of the budget includes. With more proposals the budget allows fewer events.
PROPOSAL_COST, PROPOSALS_PER_EVENT = 2, 64

#: Counts of hops and of events share a double: a hop counts as this many events.
HOP_UNIT = 2.0**32


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
    # In a field less kinetic energy is left at this height; the first, wider strip bounds it.
    within *= math.sqrt(find_neck(scene, hop, within).most)
    return Strip(time, within, exact.fraction_near(scene, hop, within))


def _fill(scene, hop, strip):
    """Return the density of configurations close to Δ = 0 over the mean density in the strip."""
    narrow = strip_around(scene, hop, strip.time / 1024)
    return narrow.fraction / narrow.within * strip.within / strip.fraction


def widest(scene, hop):
    """Return the largest power of two T whose strip has an exact share.

    Its |Δ| is below √2 times the smaller radius, and below the largest possible |Δ|.
    """
    limit = min(math.sqrt(2) * min(scene.radii), float(scene.reach(EVENT_AXES[hop])))
    return math.ldexp(1.0, math.frexp(0.999 * limit / scene.fastest)[1] - 1)


def expected_events(scene, hop, strip):
    """Return an estimate of the number of events in a time 2T: 2βT over the mean room in the neck.

    In a narrow neck equal discs have events at the rate 1.45 over its room, and β is 1.41. Outside
    of it a large disc may have more events, if it hardly fits between two walls.
    """
    arch = strip.within**2 / (6 * scene.contact_distance)
    rate = scene.fastest / (scene.clearance(hop) + arch)
    return 2 * strip.time * max(rate, exact.event_rate(scene))


def choose_strip(scene, hop):
    """Return the ``Strip`` for an open ``hop``: as wide as its neck, and not for too many events.

    T is a power of two, which makes it the same on every machine.
    """
    time = widest(scene, hop)
    while True:
        strip = strip_around(scene, hop, time)
        few = expected_events(scene, hop, strip) <= EVENTS_PER_PATH
        if few and _fill(scene, hop, strip) >= NECK_FILL:
            return strip
        time /= 2


def stratum_fractions(scene, hop, strip):
    """Return the exact shares of the strata of starts, by |Δ| and by |Δ̇| (``MOST_STRATA``, m)."""
    ends = [strip.within * part / MOST_STRATA for part in range(1, MOST_STRATA + 1)]
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
    measure = proposed_measure(rejection_sampler(scene, hop, strip.within))
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
        and exact.event_rate(scene) > RARE_HOP_EVENTS * exact.rate(scene, hop)
        and _fill(scene, hop, strip_around(scene, hop, widest(scene, hop))) < NO_NECK_FILL
        and acceptance(scene, hop, choose_strip(scene, hop)) >= exact.MIN_FRACTION
    )


class HopsInStrip(NamedTuple):
    """The experiment: hops in a ``time`` before and after an initial state, by its stratum.

    A path ends if its discs would have to be faster than ``fastest`` to hop again. ``near`` is the
    size of a stratum in |Δ|, ``slow`` the size in |Δ̇| if all energy is kinetic. The hops are
    vertical, or horizontal if ``horizontal`` is True instead of None. ``sums`` are initial states,
    Σ N and Σ N² by strata (3, ``MOST_STRATA``, m), int64.
    """

    time: float
    fastest: float
    near: float
    slow: float
    prism: tuple | None  # a ``RejectionSampler``
    horizontal: bool | None
    packed: np.ndarray  # (lanes,), hops and events
    stratum: np.ndarray  # (2, lanes)
    sums: np.ndarray
    events: np.ndarray  # (1,), wall hits and collisions
    both_ways: bool | None = True

    def begin(self, i, state):
        """Find the stratum of an initial state."""
        separation, speed = relative_motion(state, self.horizontal)
        speed /= math.sqrt(state_kinetic_fraction(state, self.prism))
        self.stratum[0, i] = min(np.int64(abs(separation) / self.near), MOST_STRATA - 1)
        self.stratum[1, i] = min(np.int64(abs(speed) / self.slow), self.sums.shape[2] - 1)
        self.packed[i] = 0.0
        return self.time

    def note(self, i, before, after, code, time, left):
        """Count a hop and an event; end the path if no other hop can follow."""
        count, separation = self.packed[i], relative_motion(after, self.horizontal)[0]
        hop = crosses(relative_motion(before, self.horizontal)[0], separation)
        count += HOP_UNIT if hop else 0.0
        self.packed[i] = count + (1.0 if code > END_OF_TIME else 0.0)
        return left if abs(separation) <= self.fastest * left else 0.0

    def ended(self, i, replica, stretch):
        """Go on from the reversed initial state; after that add the count to its stratum."""
        if stretch == 1:
            near, slow = self.stratum[0, i], self.stratum[1, i]
            count = np.int64(self.packed[i] * (1.0 / HOP_UNIT))
            self.events[0] += np.int64(self.packed[i] - count * HOP_UNIT)
            self.sums[0, near, slow] += 1
            self.sums[1, near, slow] += count
            self.sums[2, near, slow] += count * count
        return -self.time * (1 - stretch)


def run_blocks(scene, hop, strip, seed, first, stop, *, replicas=REPLICAS, lanes=LANES):
    """Count a ``hop`` from starts in a ``Strip``, the blocks ``first`` … ``stop`` − 1.

    Returns (starts, Σ N, Σ N² by strata; wall hits and collisions), integers that shards can add.
    """
    strata = MOST_STRATA, len(fractions_of_speeds(scene.velocity_components))
    if scene.is_plain:  # initial states are drawn near the surface of horizontal hops only
        scene, hop = hopping_along(scene, hop, "x")
    sampler = start_sampler(scene, hop, strip.within)
    hops = HopsInStrip(
        time=strip.time,
        fastest=strip.fastest,
        near=strip.within / MOST_STRATA,
        slow=scene.fastest / MOST_STRATA,
        prism=sampler.prism,
        horizontal=True if hop == "horizontal_hop" else None,
        packed=np.zeros(lanes),
        stratum=np.zeros((2, lanes), np.int64),
        sums=np.zeros((3, *strata), np.int64),
        events=np.zeros(1, np.int64),
    )
    follow(hops, scene, sampler, seed, first, stop, replicas, lanes, SHORT_SWEEPS)
    return hops.sums, int(hops.events[0])


def strip_run(scene, hop, target, budget, seed):
    """Return the ``SequentialRun`` that counts a ``hop`` in its strip to an error ``target``.

    It has separate streams.
    """
    strip = choose_strip(scene, hop)
    seed = stream_seed(seed, hop, "strip", key(scene.radius))
    fractions = stratum_fractions(scene, hop, strip)
    hops = REPLICAS * 2 * strip.time * exact.rate(scene, hop) / strip.fraction
    wanders = scene.moment_of_inertia or scene.friction
    margin = MARGIN_OF_ROUGH if wanders else MARGIN_OF_COUNTS
    margin *= max(1.0, (scene.friction * strip.time) ** GROWTH_BY_KICKS)
    events = PATH_DURATION * expected_events(scene, hop, strip)
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
        round_up_blocks(margin / target**2 / hops),
        PATH_EVENT_COST + PROPOSAL_COST * proposals,
    )


def relative_error(fractions, sums):
    """Return the relative standard error of ⟨N⟩, inf without a count.

    ``fractions`` come from ``stratum_fractions``, and the ``sums`` by strata from ``run_blocks``.
    """
    mean, error = stratified_mean(fractions, *sums)
    return error / mean if mean else math.inf


def constants(scene, hop):
    """Return the constants of the component of a rare ``hop`` (see ``StripCount``)."""
    strip = choose_strip(scene, hop)
    return {
        "duration": 2 * strip.time,
        "share": strip.fraction,
        "shares": stratum_fractions(scene, hop, strip).tolist(),
        "replicas": REPLICAS,
    }
