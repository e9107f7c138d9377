"""Event-driven molecular dynamics of an ensemble in lock step.

Some tens of independent trajectories are kept as arrays, one entry a lane, and each pass of the
inner loop advances every lane by one event. The loop has no branch, so it is compiled to vector
instructions. A lane whose trajectory has ended idles for a few passes and is then given the next
start.

Two experiments use it. ``count_events`` starts from the invariant measure and runs for a fixed
time T: the mean count is then rate × T exactly, for every T and without burn-in. ``hop_intervals``
starts on the surface of a hop, weighted by the flux through it, and records the next returns: each
of them is an exact draw of the interval between hops, with no window that could cut it off.

Starts come from streams keyed by block, and sums are integers or taken in the order of the starts.
So a result depends on the scene, the seed and the blocks, not on lanes, processors or shards.
"""

import math

import numpy as np

from twodiscs import theory
from twodiscs.checks import a_scene, one_of, proportion, whole
from twodiscs.events import (
    DISC,
    END_OF_TIME,
    WALL_X1,
    WALL_X2,
    WALL_Y1,
    WALL_Y2,
    WALL_Z1,
    WALL_Z2,
    WRAP_X,
    WRAP_Y,
    WRAP_Z,
    after_event,
    crosses,
    crossing_time,
    law_of,
    next_event,
)
from twodiscs.invariant import (
    draw_configuration,
    draw_constants,
    draw_crossing,
    draw_velocity,
    fill_start,
    prism_of,
)
from twodiscs.jit import compiled, inlined, optional
from twodiscs.scene import EVENTS, HOPS, Scene
from twodiscs.streams import open_stream

LANES = 64

#: Passes between two looks at which lanes have ended, and looks between two unpackings of the
#: counts: a packed count must stay below 256.
PASSES = 8
LOOKS = 31

#: Wall and disc events that a replica is meant to last; fewer where an open hop happens less than
#: so many times in it.
EVENTS_PER_REPLICA = 256
HOPS_PER_REPLICA = 4
EVENTS_BETWEEN_RARE_HOPS = 64

#: Blocks of the first round, and how many times the work done so far a round may be: an error seen
#: in few events predicts badly.
FIRST_ROUND = 32
GROWTH = 8.0

#: Replicas that share a random stream.
REPLICAS = 1024

#: Successive intervals that a chain records, chains that share a stream, bins of a histogram.
RETURNS = 256
CHAINS = 256
BINS = 512

#: Wall and disc events that a trajectory for people lasts at most, on average.
LONGEST_TRAJECTORY = 6000

# A lane counts in one double: six fields of eight bits, in the order of EVENTS. The last one takes
# every event, disc collisions included.
FIELD = tuple(256.0**i for i in range(6))
VERTICAL, HORIZONTAL, COLLISION, RIGHT, TOP, ANY = FIELD

COLLISIONS, ANY_WALLS = EVENTS.index("disc_collision"), EVENTS.index("any_wall")


@compiled
def draw_starts(state, draw, side_x, side_y, starts):
    """Fill ``starts`` (8, n) with states of the invariant measure."""
    for i in range(starts.shape[1]):
        x1, y1, x2, y2 = draw_configuration(state, draw, side_x, side_y)
        u1, v1, u2, v2 = draw_velocity(state)
        starts[0, i], starts[1, i], starts[2, i], starts[3, i] = x1, y1, x2, y2
        starts[4, i], starts[5, i], starts[6, i], starts[7, i] = u1, v1, u2, v2


def _plain_starts(state, draw, sides, starts, prism):
    draw_starts(state, draw, sides[0], sides[1], starts)


@optional(_plain_starts)
def draw_any_starts(state, draw, sides, starts, prism):
    """Fill ``starts`` with states of the invariant measure, from ``prism`` unless it is None."""
    for i in range(starts.shape[1]):
        fill_start(state, prism, None, starts, i)


# Rows: the states of all lanes, a tuple of as many arrays as a state has components ---------------


@optional(lambda lanes, present: ())
def pair_of_rows(lanes, present):
    """Return two arrays, or nothing if the effect they belong to is absent."""
    return np.zeros(lanes), np.zeros(lanes)


@inlined
def new_rows(lanes, law):
    """Return the rows of a ``Law``: (lanes,) zeros for each component of a state."""
    plain = (
        np.zeros(lanes), np.zeros(lanes), np.zeros(lanes), np.zeros(lanes),
        np.zeros(lanes), np.zeros(lanes), np.zeros(lanes), np.zeros(lanes),
    )  # fmt: skip
    deep = pair_of_rows(lanes, law.depth) + pair_of_rows(lanes, law.depth)
    return plain + deep + pair_of_rows(lanes, law.rough)


@optional(lambda rows, k, i, present: ())
def pair_at(rows, k, i, present):
    """Return the entries of lane ``i`` in rows ``k`` and ``k`` + 1, or nothing if absent."""
    return rows[k][i], rows[k + 1][i]


@inlined
def state_at(rows, i, law):
    """Return the state of lane ``i``."""
    plain = (
        rows[0][i], rows[1][i], rows[2][i], rows[3][i],
        rows[4][i], rows[5][i], rows[6][i], rows[7][i],
    )  # fmt: skip
    deep = pair_at(rows, 8, i, law.depth) + pair_at(rows, 10, i, law.depth)
    return plain + deep + pair_at(rows, 8, i, law.rough)


@optional(lambda rows, k, i, state, present: None)
def put_pair(rows, k, i, state, present):
    """Set the entries of lane ``i`` in rows ``k`` and ``k`` + 1, unless they are absent."""
    rows[k][i], rows[k + 1][i] = state[k], state[k + 1]


@inlined
def put_state(rows, i, state, law):
    """Set the state of lane ``i``."""
    rows[0][i], rows[1][i], rows[2][i], rows[3][i] = state[0], state[1], state[2], state[3]
    rows[4][i], rows[5][i], rows[6][i], rows[7][i] = state[4], state[5], state[6], state[7]
    put_pair(rows, 8, i, state, law.depth)
    put_pair(rows, 10, i, state, law.depth)
    put_pair(rows, 8, i, state, law.rough)


@inlined
def state_in(starts, i):
    """Return the plain state in column ``i`` of ``starts``."""
    return (
        starts[0, i], starts[1, i], starts[2, i], starts[3, i],
        starts[4, i], starts[5, i], starts[6, i], starts[7, i],
    )  # fmt: skip


@compiled
def unpack(packed, counts, lane):
    """Move the packed counts of a ``lane`` to ``counts`` (6, lanes)."""
    tally = np.int64(packed[lane])
    packed[lane] = 0.0
    for e in range(6):
        counts[e, lane] += (tally >> (8 * e)) & 255


@compiled
def count_blocks(
    seed, first, stop, replicas, lanes, duration, law, draw, prism, sides, confined, hops, walls
):
    """Follow the starts of blocks ``first`` … ``stop`` − 1 for a ``duration`` and add their counts.

    Returns (sums, products, eligible): Σ N_e (6), Σ N_e N_f for e ≤ f (6, 6) over all replicas, and
    how many replicas can see each event (6), all int64, in the order of EVENTS. Starts come from
    ``draw`` with ``sides`` as in ``draw_configuration``, or from ``prism`` unless it is None.
    ``confined`` says whether only starts with disc 1 on the right (on top) see the right (top)
    wall. ``hops`` and ``walls`` are True or None: what is None is not compiled.
    """
    rows, starts = new_rows(lanes, law), np.zeros((12, replicas))
    remaining, times, codes = np.zeros(lanes), np.zeros(lanes), np.zeros(lanes)
    packed, counts = np.zeros(lanes), np.zeros((6, lanes), np.int64)
    sums, products = np.zeros(6, np.int64), np.zeros((6, 6), np.int64)
    eligible = np.zeros(6, np.int64)
    busy = np.zeros(lanes, np.bool_)
    one = np.zeros(6, np.int64)
    block, used, running, looks = first, replicas, 0, 0

    while True:
        for i in range(lanes):
            if remaining[i] > 0.0:
                continue
            if busy[i]:
                unpack(packed, counts, i)
                for e in range(6):
                    one[e] = counts[e, i]
                    counts[e, i] = 0
                one[5] -= one[2]
                for e in range(6):
                    sums[e] += one[e]
                    for f in range(e, 6):
                        products[e, f] += one[e] * one[f]
                busy[i] = False
                running -= 1
            if used == replicas and block < stop:
                draw_any_starts(open_stream(seed, block), draw, sides, starts, prism)
                block, used = block + 1, 0
            if used < replicas:
                put_state(rows, i, starts[:, used], law)
                remaining[i] = duration
                busy[i] = True
                running += 1
                for e in range(6):
                    eligible[e] += 1
                if confined[0] and starts[0, used] < starts[2, used]:
                    eligible[3] -= 1
                if confined[1] and starts[1, used] < starts[3, used]:
                    eligible[4] -= 1
                used += 1
        if running == 0:
            return sums, products, eligible

        for _ in range(PASSES):
            for i in range(lanes):
                times[i], codes[i] = next_event(state_at(rows, i, law), remaining[i], law)
            for i in range(lanes):
                before, code, tally = state_at(rows, i, law), codes[i], packed[i]
                remaining[i] -= times[i]
                after = after_event(before, times[i], code, law)
                put_state(rows, i, after, law)
                tally += ANY if code > END_OF_TIME else 0.0
                tally += COLLISION if code == DISC else 0.0
                if hops is not None:
                    vertical = crosses(before[1] - before[3], after[1] - after[3])
                    horizontal = crosses(before[0] - before[2], after[0] - after[2])
                    tally += VERTICAL if vertical else 0.0
                    tally += HORIZONTAL if horizontal else 0.0
                if walls is not None:
                    tally += RIGHT if (code == WALL_X1) & (after[0] > 0.0) else 0.0
                    tally += TOP if (code == WALL_Y1) & (after[1] > 0.0) else 0.0
                packed[i] = tally
        looks += 1
        if looks == LOOKS:
            looks = 0
            for i in range(lanes):
                unpack(packed, counts, i)


def nearest_power_of_two(value):
    """Return the power of two next to ``value`` > 0 on a logarithmic scale.

    Durations and bin widths come from the exact theory, whose last digit may depend on the math
    library; rounded like this they are the same on every machine.
    """
    mantissa, exponent = math.frexp(value)
    return math.ldexp(1.0, exponent if mantissa > math.sqrt(0.5) else exponent - 1)


def replica_duration(scene):
    """Return the time T of one replica, a power of two: some ``EVENTS_PER_REPLICA`` events.

    That is long enough for drawing a start to cost little. Where an open hop happens less than
    ``HOPS_PER_REPLICA`` times in it, the discs keep their sides for long, and counts of wall hits
    have two states: then more and shorter replicas know the mean better for the same work.
    """
    rate = theory.event_rate(scene)
    duration = nearest_power_of_two(EVENTS_PER_REPLICA / rate)
    times = theory.mean_times(scene)
    if any(scene.is_possible(hop) and HOPS_PER_REPLICA * times[hop] > duration for hop in HOPS):
        return nearest_power_of_two(EVENTS_BETWEEN_RARE_HOPS / rate)
    return duration


def origins(scene):
    """Return (``Draw``, ``Prism``) of a ``Scene``: starts come from one, the other one is None."""
    if scene.has_effects:
        return None, prism_of(scene)
    return draw_constants(scene), None


def run_blocks(
    scene, events, seed, first, stop, duration, *, replicas=REPLICAS, lanes=LANES, sides=(0, 0)
):
    """Count ``events`` in the blocks ``first`` … ``stop`` − 1 of the stream ``seed``.

    A block is ``replicas`` starts from the invariant measure, each followed for ``duration``;
    ``sides`` chooses the component (see ``draw_configuration``). Only what ``events`` asks for is
    detected: without a hop among them no crossing is looked for. Returns (sums, products,
    eligible) as ``count_blocks`` does. They are integers: two shards add up to the whole.
    """
    hops = True if any(event in HOPS for event in events) else None
    walls = True if {"right_wall", "top_wall"} & set(events) else None
    return count_blocks(
        np.uint64(seed), first, stop, replicas, lanes, duration, law_of(scene), *origins(scene),
        sides, scene.confined, hops, walls,
    )  # fmt: skip


def relative_errors(sums, products, eligible):
    """Return the relative standard error of each mean count (6), inf where nothing was counted.

    Replicas are independent, so the error is √(var N / R) / ⟨N⟩ over the replicas that can see the
    event.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        mean = sums / eligible
        variance = np.maximum(np.diag(products) / eligible - mean**2, 0.0)
        errors = np.sqrt(variance / eligible) / mean
    return np.where(sums > 0, errors, np.inf)


def count_events(scene, target, budget, seed, report=None):
    """Count the events of a ``Scene`` in independent replicas until each is known well enough.

    ``target`` maps each watched event to the relative standard error asked for (0 < target < 1);
    blocked hops are counted but not waited for. ``budget`` is the largest number of wall and disc
    events to simulate; a block of replicas is the least that is. Work goes in rounds: the first
    one is small, the next ones as long as the errors seen so far predict. ``report``, if given, is
    called after each round with a dict of events, error (the worst in units of its target) and
    needed (the events still to come).

    Returns a dict for a JSON file: radius, duration T and number of replicas, rounds, wall and disc
    events simulated, and for each watched event how many replicas can see it (eligible), its count
    ΣN, its target and status (reached, budget or impossible); products hold ΣN_a N_b of each pair.
    Raises ``ValueError`` for an unknown event or a number out of range.
    """
    a_scene(scene)
    if not isinstance(target, dict) or not target:
        raise ValueError(f"target must name at least one event, with its error, not {target!r}")
    target = {
        one_of("event", e, EVENTS): proportion(f"target of {e}", t) for e, t in target.items()
    }
    budget, seed = whole("budget", budget), whole("seed", seed, 0)

    duration = replica_duration(scene)
    events = [event for event in EVENTS if event in target]
    waited = [event for event in events if scene.is_possible(event)]
    index = [EVENTS.index(event) for event in waited]
    goals = np.array([target[event] for event in waited])

    sums, products, eligible = (
        np.zeros(6, np.int64),
        np.zeros((6, 6), np.int64),
        np.zeros(6, np.int64),
    )
    rate = theory.event_rate(scene)
    affordable = int(budget / (REPLICAS * rate * duration))
    blocks = max(1, min(FIRST_ROUND, affordable))
    done, rounds = 0, 0
    while True:
        for total, part in zip(
            (sums, products, eligible),
            run_blocks(scene, events, seed, done, done + blocks, duration),
            strict=True,
        ):
            total += part
        done, rounds = done + blocks, rounds + 1
        simulated = int(sums[COLLISIONS] + sums[ANY_WALLS])
        if not waited:
            break
        excess = relative_errors(sums, products, eligible)[index] / goals
        worst = float(np.max(excess))
        # In units of the work done so far: what the error asks for, and what the budget allows.
        missing, affordable = 1.05 * worst * worst - 1.0, budget / simulated - 1.0
        if report is not None:
            needed = max(0.0, min(missing, affordable)) * simulated
            report({"events": simulated, "error": worst, "needed": needed})
        if worst <= 1.0 or affordable * done < 1.0:
            break
        blocks = math.ceil(min(missing, GROWTH) * done)
        blocks = min(blocks, math.floor(affordable * done))

    watched = [EVENTS.index(event) for event in events]
    reached = dict(zip(waited, excess <= 1.0, strict=True)) if waited else {}
    return {
        "radius": scene.radius,
        "duration": duration,
        "replicas": done * REPLICAS,
        "rounds": rounds,
        "events": simulated,
        "eligible": {EVENTS[e]: int(eligible[e]) for e in watched},
        "counts": {EVENTS[e]: int(sums[e]) for e in watched},
        "products": {
            f"{EVENTS[e]}*{EVENTS[f]}": int(products[e, f])
            for e in watched
            for f in watched
            if e <= f
        },
        "target": {event: target[event] for event in events},
        "status": {
            e: ("reached" if reached[e] else "budget") if e in reached else "impossible"
            for e in events
        },
    }


def _plain_start(state, draw, surface, start, prism):
    start[0, 0], start[1, 0], start[2, 0], start[3, 0], u1, v1, u2, v2 = draw_crossing(
        state, draw.half_x, draw.half_y, draw.beyond_x
    )
    start[4, 0], start[5, 0], start[6, 0], start[7, 0] = u1, v1, u2, v2


@optional(_plain_start)
def start_on_surface(state, draw, surface, start, prism):
    """Fill the column ``start`` (12, 1) with a state on the surface of a hop, by its flux."""
    fill_start(state, prism, surface, start, 0)


@inlined
def across(state, horizontal):
    """Return the separation and relative velocity along y, or along x if ``horizontal``."""
    if horizontal is None:
        return state[1] - state[3], state[5] - state[7]
    return state[0] - state[2], state[4] - state[6]


@compiled
def record_returns(
    seed, first, stop, chains, lanes, returns, law, draw, prism, horizontal, width, histogram
):
    """Run the chains of blocks ``first`` … ``stop`` − 1 for ``returns`` hops each.

    The hops are vertical ones, or horizontal ones if ``horizontal`` is True instead of None; they
    start from ``draw`` (vertical ones only), or from ``prism`` unless it is None. Adds the
    intervals to ``histogram`` (int64, bins of ``width`` from 0; the last entry takes what is
    longer) and returns the total time of each chain, (stop − first) × ``chains`` doubles in order.
    """
    rows, start = new_rows(lanes, law), np.zeros((12, 1))
    times, codes, intervals = np.zeros(lanes), np.zeros(lanes), np.zeros(lanes)
    age, elapsed, left = np.zeros(lanes), np.zeros(lanes), np.zeros(lanes)
    chain, found = np.full(lanes, -1), np.zeros(lanes + 1)
    totals = np.zeros((stop - first) * chains)
    per_width, last_bin, wanted = 1.0 / width, histogram.size - 1, np.float64(returns)
    surface = 1 if horizontal is None else 0
    state = open_stream(seed, first)
    started, running = 0, 0

    while True:
        for i in range(lanes):
            if left[i] > 0.0:
                continue
            if chain[i] >= 0:
                totals[chain[i]] = elapsed[i]
                chain[i] = -1
                running -= 1
            if started == totals.size:
                continue
            if started % chains == 0:
                state = open_stream(seed, first + started // chains)
            start_on_surface(state, draw, surface, start, prism)
            put_state(rows, i, start[:, 0], law)
            chain[i], elapsed[i], age[i] = started, 0.0, 0.0
            # A start that falls through the surface is seen to cross it at time 0; that is not a
            # return.
            _, rising = across(state_at(rows, i, law), horizontal)
            left[i] = wanted + (1.0 if rising < 0.0 else 0.0)
            started += 1
            running += 1
        if running == 0:
            return totals

        for _ in range(PASSES):
            for i in range(lanes):
                times[i], codes[i] = next_event(state_at(rows, i, law), np.inf, law)
            for i in range(lanes):
                before, time, waited = state_at(rows, i, law), times[i], age[i]
                after = after_event(before, time, codes[i], law)
                put_state(rows, i, after, law)
                apart, rising = across(before, horizontal)
                hop = crosses(apart, across(after, horizontal)[0])
                until, to_come = crossing_time(apart, rising), left[i]
                recorded = hop & (to_come > 0.0) & (to_come <= wanted)
                interval = waited + until
                intervals[i] = interval if recorded else -1.0
                elapsed[i] += interval if recorded else 0.0
                age[i] = time - until if hop else waited + time
                left[i] = to_come - 1.0 if hop else to_come
            n = 0
            for i in range(lanes):
                found[n] = intervals[i]
                n += 1 if intervals[i] >= 0.0 else 0
            for k in range(n):
                histogram[min(np.int64(found[k] * per_width), last_bin)] += 1


def hop_intervals(scene, event, intervals, seed):
    """Draw intervals between hops of one kind, each one exact, and count them in bins.

    ``event`` is a hop that the ``Scene`` allows; ``intervals`` is how many are wanted at least.
    Chains of ``RETURNS`` successive intervals start on the hop's surface with the flux-weighted
    measure, which the map from hop to hop preserves: so every interval of a chain has the law of
    the interval between hops. Intervals within a chain are correlated, chains are independent.

    Returns a dict for a JSON file: bin width (a power of two near τ/16), counts, overflow, the
    number of intervals and of chains, and the mean with its standard error over chains. Raises
    ``ValueError`` for a hop that is unknown or blocked, or a number out of range.
    """
    a_scene(scene)
    one_of("event", event, HOPS)
    if not scene.is_possible(event):
        raise ValueError(
            f"event {event!r} is blocked at radius {scene.radius!r}: it has no intervals"
        )
    blocks = -(-whole("intervals", intervals) // (CHAINS * RETURNS))
    seed = whole("seed", seed, 0)
    width = nearest_power_of_two(theory.mean_times(scene)[event] / 16)
    upright, horizontal = scene, None
    if event == "horizontal_hop" and scene.has_effects:
        horizontal = True
    elif event == "horizontal_hop":
        # That is a vertical hop of the box on its side.
        upright = Scene(scene.height, scene.width, scene.radius)
    histogram = np.zeros(BINS + 1, np.int64)
    totals = record_returns(
        np.uint64(seed), 0, blocks, CHAINS, LANES, RETURNS, law_of(upright), *origins(upright),
        horizontal, width, histogram,
    )  # fmt: skip
    means = totals / RETURNS
    return {
        "radius": scene.radius,
        "event": event,
        "bin_width": width,
        "counts": [int(n) for n in histogram[:-1]],
        "overflow": int(histogram[-1]),
        "intervals": totals.size * RETURNS,
        "chains": totals.size,
        "mean": math.fsum(means) / means.size,
        "stderr": float(np.std(means, ddof=1) / math.sqrt(means.size)),
    }


#: Names of what ends a flight, by code; only disc 1 on the right and on top has a name as an event.
_NAMES = {
    END_OF_TIME: "end",
    WALL_X1: "wall_x1",
    WALL_Y1: "wall_y1",
    WALL_X2: "wall_x2",
    WALL_Y2: "wall_y2",
    DISC: "disc_collision",
    WALL_Z1: "wall_z1",
    WALL_Z2: "wall_z2",
    WRAP_X: "wrap_x",
    WRAP_Y: "wrap_y",
    WRAP_Z: "wrap_z",
}


def _row(time, event, state, scene):
    """Return (time, x1, y1, x2, y2, event, z1, z2), None for z in the plane."""
    return (time, *state[:4], event, *((None, None) if scene.depth is None else state[8:10]))


def follow(scene, state, duration):
    """Yield (time, x1, y1, x2, y2, event, z1, z2) for all that happens within ``duration``.

    ``state`` of the ``Scene`` is as in ``events``; z1 and z2 are None in the plane. Hops are events
    here, reported where they occur in a flight; walls are named by disc and axis, and the places
    after a jump of a periodic separation follow the name of its axis; the first row is the start,
    the last one the end.
    """
    law, time = law_of(scene), 0.0
    yield _row(time, "start", state, scene)
    while True:
        flight, code = next_event(state, duration - time, law)
        after = after_event(state, flight, code, law)
        hops = []
        for name, horizontal in (("vertical_hop", None), ("horizontal_hop", True)):
            before, rising = across(state, horizontal)
            passed = crosses(before, across(after, horizontal)[0])
            if name in scene.events and passed:
                hops.append((crossing_time(before, rising), name))
        for until, name in sorted(hops):
            yield _row(time + until, name, after_event(state, until, END_OF_TIME, law), scene)
        time, state = time + flight, after
        yield _row(time, _NAMES[code], state, scene)
        if code == END_OF_TIME:
            return


def trajectory(scene, seed):
    """Return one trajectory of a ``Scene`` from the invariant measure, as rows of ``follow``.

    It lasts some eight mean times of the rarest hop that is open, but no longer than
    ``LONGEST_TRAJECTORY`` wall and disc events on average. Raises ``ValueError`` for anything that
    is not a ``Scene``, and for a seed that is not an integer ≥ 0.
    """
    stream = open_stream(np.uint64(whole("seed", seed, 0)), 0)
    start = np.zeros((12, 1))
    draw, prism = origins(a_scene(scene))
    draw_any_starts(stream, draw, (0, 0), start, prism)
    components = 8 + 4 * (scene.depth is not None) + 2 * (scene.moment_of_inertia is not None)
    start = tuple(map(float, start[:components, 0]))
    rate = theory.event_rate(scene)
    hops = [theory.mean_times(scene)[hop] for hop in HOPS if scene.is_possible(hop)]
    duration = min(8 * max(hops, default=math.inf), LONGEST_TRAJECTORY / rate)
    return list(follow(scene, start, nearest_power_of_two(duration)))
