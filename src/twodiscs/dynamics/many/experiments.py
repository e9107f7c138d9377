"""The experiments of more than two discs: their costs, windows and arguments."""

import math

from twodiscs.dynamics.ensemble import RETURNS, nearest_power_of_two
from twodiscs.dynamics.many import kernels, lockstep
from twodiscs.model.checks import InputError
from twodiscs.model.events import HOPS
from twodiscs.sampling.many.initial import LARGE

#: Numbers that are summed in each bin of intervals: Σ c, Σ c² and Σ c n.
INTERVAL_SUMS = 3

#: The time that a pair of discs adds to an event, over the time of an event of the plain ensemble.
#: Events of 3, 4 and 8 discs take 3.7, 5.9 and 22 times as long. Pairs of rough discs take longer.
PAIR, ROUGH_PAIR = 0.8, 1.3

#: The same for ``LARGE`` numbers of discs: the time of an event, and the time that each disc adds.
TOUCHED, COMPARED = 50.0, 0.25

#: The time of a kick for each of ``LARGE`` numbers of discs, over the time of an event. The time to
#: draw the velocity of a disc, over the time of an event of the plain ensemble.
KICK, DRAW = 0.45, 8.0

#: The largest factor by which the window of ``LARGE`` numbers of discs is longer.
LONGER = 64


def replica_duration(scene):
    """Return the time T of one replica, a power of two, see ``lockstep``.

    With friction it is shorter, so that kicks do not add to the work.
    """
    return nearest_power_of_two(lockstep.replica_duration(scene) / work_per_event(scene))


def expected_event_rate(scene):
    """Return the rate of wall hits and disc collisions, an estimate if it is not known."""
    return lockstep.expected_event_rate(scene)


def expected_rate(scene, event):
    """Return the rate of all events that count as ``event``; 0 if it is not known."""
    return lockstep.expected_rates(scene).get(event, 0.0)


def run_blocks(scene, events, seed, first, stop, duration, **shape):
    """Count all events in some blocks, see ``counting.run_blocks``; few discs detect all."""
    hops = any(event in HOPS for event in events)
    counts = kernels.run_blocks(scene, seed, first, stop, duration, hops=hops, **shape)
    return lockstep.of_events(*counts)


def block_replicas(scene):
    """Return the number of replicas of a block."""
    return lockstep.replicas_of(scene)


def planned(needed, affordable):
    """Return the number of planned blocks: the number ``needed``, within the budget."""
    return min(needed, affordable)


def work_per_event(scene):
    """Return the cost of an event over the usual cost, with kicks.

    For few discs a kick costs an event and the draw of all velocities. For ``LARGE`` numbers of
    discs it costs ``KICK`` events for each disc.
    """
    few = scene.discs < LARGE
    kick = 1.0 + DRAW * scene.discs / cost_ratio(scene) if few else KICK * scene.discs
    return 1.0 + kick * scene.friction / expected_event_rate(scene)


def cost_ratio(scene):
    """Return the time of an event over the time of an event of the plain ensemble."""
    if scene.discs >= LARGE:
        return TOUCHED + COMPARED * scene.discs
    pair = PAIR if scene.moment_of_inertia is None else ROUGH_PAIR
    return 1 + pair * scene.discs * (scene.discs - 1) / 2


def interval_cost(scene):
    """Return the time of an event over the time of an event of the plain ensemble."""
    return cost_ratio(scene)


def mean_interval(scene, hop):
    """Return the mean time between two hops of any pair, maybe within a few per cent only."""
    if not (rate := lockstep.expected_rates(scene).get(hop)):
        raise InputError(
            f"radius {scene.radius!r} is so large for {scene.discs} discs that the time between "
            f"two events {hop} is not known"
        )
    return 1 / rate


def _window(scene, hop):
    """Return a time in which ``RETURNS`` intervals begin, or up to twice as many.

    ``LARGE`` numbers of discs have a longer window, the duration of a replica, but at most
    ``LONGER`` times the usual one. Their initial states take as much time to draw.
    """
    window = 2.0 ** math.ceil(math.log2(RETURNS * mean_interval(scene, hop)))
    if scene.discs < LARGE:
        return window
    return min(max(window, replica_duration(scene)), LONGER * window)


def intervals_of_chain(scene, hop):
    """Return a number of intervals; up to twice as many begin in the window of a chain."""
    return max(RETURNS, int(_window(scene, hop) / mean_interval(scene, hop) / 2))


def events_per_interval(scene, hop):
    """Return the wall and disc events per interval, as if there were ``intervals_of_chain``."""
    window = _window(scene, hop)
    events = window * expected_event_rate(scene) * work_per_event(scene)
    return events / intervals_of_chain(scene, hop)


def record_intervals(scene, hop, seed, first, stop, chains, returns, bins, sums, going):
    """Record the intervals between hops, see ``many.lockstep.record_intervals``."""
    window = _window(scene, hop)
    return kernels.record_intervals(
        scene, hop, seed, first, stop, chains, window, bins, sums, going
    )
