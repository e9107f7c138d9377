"""More than two discs: expected rates, the durations of replicas and what an event costs."""

import math
from functools import lru_cache

from twodiscs.dynamics import ensemble
from twodiscs.dynamics.many.all_pairs import EVENT_CLASSES
from twodiscs.model.many_geometry import CELL_DISCS
from twodiscs.sampling.many import insertions
from twodiscs.sampling.many.chains import MOST_CROWDING, crowding
from twodiscs.sampling.many.many_initial_states import CROWDING, method
from twodiscs.theory import n_discs
from twodiscs.theory.equation_of_state import bulk_derivatives
from twodiscs.theory.flux import rates

#: Events of a replica, and of a replica whose initial state takes as long as ten thousand events.
REPLICA_EVENTS, CHAIN_REPLICA_EVENTS = 256, 8192

#: Events of each roomy disc in a replica of ``CELL_DISCS`` discs or more, and the most of all discs
#: together. The motion then takes several times as long as the draw of the state.
EVENTS_PER_DISC, MOST_REPLICA_EVENTS = 256, 2**22

#: Replicas that a budget has room for, if they can be shorter: the 100 that an error needs, and
#: some more. Those of crowded discs cannot, because each has a new chain.
BUDGET_REPLICAS = 108

#: Density relaxes in a time that goes as the number of discs. A chain of replicas has seen it relax
#: if a disc has an event in each of them for this number of discs.
DISCS_PER_EVENT = 128

#: The events of a block of ``CELL_DISCS`` discs or more and its fewest replicas, and the events of
#: each disc in an epoch.
BLOCK_EVENTS, FEWEST_REPLICAS, EPOCH_EVENTS = 2**20, 4, 64

#: The time that a pair of discs adds to an event, over the time of an event of the plain ensemble.
#: Events of 3, 4 and 8 discs take 3.7, 5.9 and 22 times as long. Pairs of rough discs take longer.
PAIR_COST, ROUGH_PAIR_COST = 0.8, 1.3

#: The same for ``CELL_DISCS`` discs or more: the time of an event, and the time that each disc
#: adds.
EVENT_COST, DISC_COST = 50.0, 0.04

#: The time of a kick for each of ``CELL_DISCS`` or more discs, over the time of an event. The time
#: to draw the velocity of a disc, over the time of an event of the plain ensemble.
KICK_COST, VELOCITY_COST = 0.45, 8.0


@lru_cache(maxsize=256)
def expected_rates(scene):
    """Return {event: rate} of the events of a ``Scene`` of more than two discs.

    Rates are exact if that is known, and otherwise from some insertions (``insertions.expected``),
    within a few per cent. If insertions find no room, the rates of wall hits and collisions are
    guessed (``expected_duration``), and so is one of them for which insertions give 0. For
    ``CELL_DISCS`` discs or more rates follow from an equation of state, within some ten per cent.
    It ends where discs are ``MOST_CROWDING``; there the guess, if it is more, takes its place.
    """
    known = n_discs.known_derivatives(scene)
    if known is None:
        known = insertions.expected(scene) if scene.discs < CELL_DISCS else bulk_derivatives(scene)
    half = _guessed_rate(scene) / 2
    guess = {"disc_collision": half, "any_wall": half if scene.walled else 0.0}
    if known is None:
        return guess
    by_class = rates(scene, known)
    summed = {
        event: sum(by_class.get(name, 0.0) for name in parts)
        for event, parts in EVENT_CLASSES.items()
    }
    by_event = guess | {e: rate for e, rate in summed.items() if rate and e in scene.events}
    if (
        scene.discs >= CELL_DISCS
        and crowding(scene) == MOST_CROWDING
        and not n_discs.exact_method(scene)
    ):
        by_event |= {event: max(rate, by_event[event]) for event, rate in guess.items()}
    return by_event


def expected_event_rate(scene):
    """Return the wall hits and collisions per time, as ``expected_rates``."""
    expected = expected_rates(scene)
    return expected["any_wall"] + expected["disc_collision"]


def expected_duration(scene, events=None):
    """Return a power of two in which about ``events`` happen, within a factor of two.

    The rate is guessed from the wall hits of an ideal gas and from the distance to the largest
    radius. By default ``events`` is 256, or ``CHAIN_REPLICA_EVENTS`` if an initial state takes a
    chain of moves. ``CELL_DISCS`` discs or more have ``EVENTS_PER_DISC`` each, crowded ones more,
    and at most ``MOST_REPLICA_EVENTS``.
    """
    if events is None and scene.discs >= CELL_DISCS:
        events = min(EVENTS_PER_DISC * crowding(scene) * scene.discs, MOST_REPLICA_EVENTS)
    events = events or (CHAIN_REPLICA_EVENTS if method(scene) == "chain" else REPLICA_EVENTS)
    return ensemble.nearest_power_of_two(events / _guessed_rate(scene))


def _guessed_rate(scene):
    room = scene.largest_radius - scene.radius
    return math.sqrt(scene.discs) * (0.5 / scene.range_x + 0.5 / scene.range_y + 0.35 / room)


def replica_duration(scene, budget=None):
    """Return the time T of one replica, a power of two, see ``expected_duration``.

    With friction it is shorter, so that kicks do not add to the work. For ``CELL_DISCS`` discs
    or more, if they are not crowded, it is also so short that ``BUDGET_REPLICAS``, in whole blocks,
    have no more events than the ``budget``; it then has three binary digits. Each disc has at least
    one event, and N/``DISCS_PER_EVENT``.
    """
    work = work_per_event(scene)
    duration = ensemble.nearest_power_of_two(expected_duration(scene) / work)
    if budget is None or scene.discs < CELL_DISCS or crowding(scene) > CROWDING:
        return duration
    whole = max(budget - BLOCK_EVENTS, min(budget, BLOCK_EVENTS))
    least = scene.discs * max(1.0, scene.discs / DISCS_PER_EVENT)
    events = max(whole / BUDGET_REPLICAS / work, least)
    mantissa, exponent = math.frexp(events / expected_event_rate(scene))
    return min(duration, math.ldexp(int(8 * mantissa), exponent - 3))


def block_replicas(scene, duration=None):
    """Return the number of replicas of a block, each of a ``duration``, None for the usual one.

    For ``CELL_DISCS`` discs or more a block has about ``BLOCK_EVENTS``, and ``FEWEST_REPLICAS`` or
    more: 128 in a first round.
    """
    if scene.discs < CELL_DISCS:
        return ensemble.REPLICAS
    events = events_per_disc(scene, duration or replica_duration(scene)) * scene.discs
    return min(max(FEWEST_REPLICAS, round(BLOCK_EVENTS / events)), BUDGET_REPLICAS)


def events_per_disc(scene, duration):
    """Return the expected number of wall hits and collisions in a ``duration``, over N."""
    return duration * expected_event_rate(scene) / scene.discs


def usual_epoch(scene):
    """Return a time in which each disc of a ``Scene`` has some ``EPOCH_EVENTS``."""
    return expected_duration(scene, EPOCH_EVENTS * scene.discs)


def expected_rate(scene, event):
    """Return the rate of all events that count as ``event``; 0 if it is not known."""
    return expected_rates(scene).get(event, 0.0)


# Costs --------------------------------------------------------------------------------------------


def work_per_event(scene):
    """Return the cost of an event over the usual cost, with kicks.

    For few discs a kick costs an event and the draw of all velocities. For ``CELL_DISCS`` discs
    or more it costs ``KICK_COST`` events for each disc.
    """
    few = scene.discs < CELL_DISCS
    kick = 1.0 + VELOCITY_COST * scene.discs / cost_ratio(scene) if few else KICK_COST * scene.discs
    return 1.0 + kick * scene.friction / expected_event_rate(scene)


def cost_ratio(scene):
    """Return the time of an event over the time of an event of the plain ensemble."""
    if scene.discs >= CELL_DISCS:
        return EVENT_COST + DISC_COST * scene.discs
    pair = PAIR_COST if scene.moment_of_inertia is None else ROUGH_PAIR_COST
    return 1 + pair * scene.discs * (scene.discs - 1) / 2


chain_cost_ratio = cost_ratio
