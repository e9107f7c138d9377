"""Two discs: expected rates, the durations of replicas and what an event costs."""

from twodiscs.dynamics.ensemble import REPLICAS, nearest_power_of_two
from twodiscs.dynamics.two import strip
from twodiscs.model.events import HOPS
from twodiscs.theory import exact

#: The mean number of wall and disc events in a replica, which is smaller if an open hop happens
#: less often in it than ``HOPS_PER_REPLICA``.
EVENTS_PER_REPLICA = 256
HOPS_PER_REPLICA = 4
EVENTS_BETWEEN_RARE_HOPS = 64


def expected_event_rate(scene):
    """Return the exact wall hits and collisions per time."""
    return exact.event_rate(scene)


def expected_rate(scene, event):
    """Return the exact rate of all events that count as ``event``."""
    return exact.rate(scene, event) * scene.copies(event)


def replica_duration(scene, budget=None):
    """Return the time T of one replica, a power of two: some ``EVENTS_PER_REPLICA`` events.

    T is so long that the draw of a start costs little. If an open hop happens less than
    ``HOPS_PER_REPLICA`` times in it, the discs keep their sides for long, and counts are
    correlated. More and shorter replicas then give a smaller error for the same work. It is the
    same for any ``budget``.
    """
    rate = exact.event_rate(scene) * exact.work_per_event(scene)
    duration = nearest_power_of_two(EVENTS_PER_REPLICA / rate)
    times = exact.mean_times(scene)
    if any(scene.is_possible(hop) and HOPS_PER_REPLICA * times[hop] > duration for hop in HOPS):
        return nearest_power_of_two(EVENTS_BETWEEN_RARE_HOPS / rate)
    return duration


def block_replicas(scene, duration=None):
    """Return the number of replicas of a block, for any ``duration``."""
    return REPLICAS


def cost_ratio(scene):
    """Return the time of an event, with the draws of starts, over its time in the plain scene."""
    return 1 + strip.PROPOSAL_COST * proposals_per_event(scene)


def chain_cost_ratio(scene):
    """Return the time of an event of a chain, over its time in the plain scene."""
    return 1.0


def proposals_per_event(scene):
    """Return the proposals of initial states for each event; 0 in plain scenes, with few."""
    if scene.is_plain:
        return 0.0
    return 1 / exact.free_fraction(scene) / (exact.event_rate(scene) * replica_duration(scene))


def work_per_event(scene):
    """Return an upper bound on the cost of an event over the usual cost, with the draws of starts.

    A start is drawn by proposals. The usual cost of an event includes ``strip.PROPOSALS_PER_EVENT``
    of them.
    """
    proposals = proposals_per_event(scene) / strip.PROPOSALS_PER_EVENT
    return max(exact.work_per_event(scene), proposals)
