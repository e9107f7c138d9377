"""Tails of the times between events, where plain counting finds nothing.

At a random moment of a stationary motion let F be the time to the next event and G the time since
the last event. An interval F + G is picked in proportion to its length. By Palm's theorem

    P(T > t) = τ ⟨1[F + G > t] / (F + G)⟩.

Starts come from the invariant measure; G is found by running backwards from the same start. Long
intervals begin near a neutral motion (see ``theory.tails.tail_constant``), where all energy except
a small share s is along one axis. On the sphere of speeds s is uniform on [0, 1]. The smaller of
the shares along x and y is therefore uniform on [0, 1/2]. This range is cut into strata, each a
quarter of the one before. All strata have the same number of starts; their exact weights are powers
of two, or three times powers of two. A probability of 1e-8 takes no more starts than a probability
of 1/2, and the estimate has no bias. The method needs only + − × / and √.
"""

import math

import numpy as np

from twodiscs.dynamics.ensemble import across, nearest_power_of_two
from twodiscs.dynamics.law import DISC, crosses, crossing_time, law_of
from twodiscs.dynamics.two.path import advance, time_to_next
from twodiscs.model.box import Box
from twodiscs.model.checks import InputError, check_ascending, check_choice, check_integer
from twodiscs.model.events import HOPS
from twodiscs.points.estimates import Estimate, mean_of
from twodiscs.sampling.jit import compiled
from twodiscs.sampling.separations import draw_configuration, draw_constants, draw_in_disc
from twodiscs.sampling.starts import draw_starts, state_in
from twodiscs.sampling.streams import next_bits, open_stream, uniform
from twodiscs.theory import exact, tails

#: Events whose tails are measured.
TAILED = (*HOPS, "disc_collision")

#: Independent blocks behind an error bar, which then has a relative error of about 7 %.
BLOCKS = 100


@compiled
def draw_drifting_velocity(state, largest, least):
    """Return (u1, v1, u2, v2) on the unit sphere with a share of the energy along one of the axes.

    The share is uniform between ``least`` and ``largest`` ≤ 1/2; both axes are equally probable.
    The share is never 0, because then discs might never meet.
    """
    share = largest - (largest - least) * uniform(state)
    p, q, square = draw_in_disc(state)
    scale = math.sqrt((1.0 - share) / square)
    along1, along2 = p * scale, q * scale
    p, q, square = draw_in_disc(state)
    scale = math.sqrt(share / square)
    across1, across2 = p * scale, q * scale
    if next_bits(state) & np.uint64(1 << 62):
        return along1, across1, along2, across2
    return across1, along1, across2, along2


@compiled
def length_biased(seed, first, stop, strata, samples, times, law, draw, hop):
    """Return ⟨1[F + G > t]/(F + G)⟩ for each of blocks ``first`` … ``stop`` − 1 and each time.

    A block has ``samples`` starts in each of ``strata`` strata; ``times`` ascend. The result has
    the shape (stop − first, times), in 1/time.
    """
    rows = np.zeros((stop - first, times.size))
    sums = np.zeros(times.size)
    for block in range(first, stop):
        state = open_stream(seed, block)
        largest = 0.5
        for stratum in range(strata):
            least = 0.25 * largest if stratum < strata - 1 else 0.0
            sums[:] = 0.0
            for _ in range(samples):
                x1, y1, x2, y2 = draw_configuration(state, draw, 0, 0)
                u1, v1, u2, v2 = draw_drifting_velocity(state, largest, least)
                interval = time_to_next((x1, y1, x2, y2, u1, v1, u2, v2), law, hop, np.inf)
                interval += time_to_next((x1, y1, x2, y2, -u1, -v1, -u2, -v2), law, hop, np.inf)
                for i in range(times.size):
                    if interval <= times[i]:
                        break
                    sums[i] += 1.0 / interval
            weight = 2.0 * (largest - least) / samples
            for i in range(times.size):
                rows[block - first, i] += weight * sums[i]
            largest = least
    return rows


@compiled
def count_long(seed, first, stop, replicas, window, times, law, draw, hop):
    """Return the counts of intervals that begin within a ``window`` of time, (replicas, times + 1).

    The first column counts all intervals, the others the intervals longer than each of ``times``.
    """
    counts = np.zeros(((stop - first) * replicas, times.size + 1), np.int64)
    starts = np.zeros((8, replicas))
    for block in range(first, stop):
        draw_starts(open_stream(seed, block), draw, 0, 0, starts)
        for replica in range(replicas):
            count = counts[(block - first) * replicas + replica]
            state = state_in(starts, replica)
            now, last = 0.0, -1.0
            while True:
                before, rising = across(state, None)
                state, time, code = advance(state, law)
                if hop:
                    met = crosses(before, across(state, None)[0])
                    moment = now + crossing_time(before, rising)
                else:
                    met, moment = code == DISC, now + time
                now += time
                if not met:
                    continue
                if last >= 0.0:
                    count[0] += 1
                    for i in range(times.size):
                        count[i + 1] += moment - last > times[i]
                last = moment
                if last >= window:
                    break
    return counts


def _prepared(scene, event, times):
    """Return (times as an array, the scene with vertical hops, whether the event is a hop).

    For horizontal hops the axes of the scene are exchanged.
    """
    check_choice("event", event, TAILED)
    if tails.tail_constant(scene, event) is None:
        raise InputError(
            f"event {event!r} is blocked at radius {scene.radius!r}: it has no intervals"
        )
    values = check_ascending("times", times)
    if event == "horizontal_hop":
        scene = Box.of(scene).turned().scene(scene.radius)
    return np.array(values), scene, event in HOPS


def tail(scene, event, times, samples, seed, blocks=BLOCKS):
    """Return an ``Estimate`` of P(T > t) for each of the ascending ``times``, without bias.

    T is the interval between hops of one kind or between disc collisions of the ``Scene``.
    ``samples`` starts are drawn in each stratum of each of ``blocks`` ≥ 2 independent blocks. The
    spread between blocks gives the standard error. The strata reach down to drifts that last for
    the longest of the times, so the work grows with this time. Raises ``InputError`` for an event
    that is blocked or has no interval, and for a number out of range.
    """
    times, oriented, hop = _prepared(scene, event, times)
    samples, seed = check_integer("samples", samples), check_integer("seed", seed, 0)
    blocks = check_integer("blocks", blocks, 2)
    # A drift of speed √s crosses the box in a time w/√s.
    longest = nearest_power_of_two(max(1.0, times[-1] / max(scene.width, scene.height)))
    strata = 2 + int(math.frexp(longest)[1])
    means = length_biased(
        np.uint64(seed), 0, blocks, strata, samples, times, law_of(oriented),
        draw_constants(oriented), hop,
    )  # fmt: skip
    means *= exact.mean_times(scene)[event]
    return mean_of(means)


def _counts(scene, event, times, replicas, seed):
    """Return P(T > t) by each replica, (replicas, times): its counts over their mean number."""
    times, oriented, hop = _prepared(scene, event, times)
    replicas, seed = check_integer("replicas", replicas, 2), check_integer("seed", seed, 0)
    window = 8 * exact.mean_times(scene)[event]
    counts = count_long(
        np.uint64(seed), 0, 1, replicas, window, times, law_of(oriented),
        draw_constants(oriented), hop,
    )  # fmt: skip
    return counts[:, 1:] / 8


def counted(scene, event, times, replicas, seed):
    """Return an ``Estimate`` of P(T > t) for each of the ascending ``times``, by plain counting.

    It serves for comparison with ``tail``. From each of ``replicas`` ≥ 2 starts of the invariant
    measure it counts all intervals that begin within eight mean times, however long they last. They
    are eight on average, so the estimate divides by eight. Errors come from the spread between
    replicas. Raises ``InputError`` as ``tail`` does.
    """
    return mean_of(_counts(scene, event, times, replicas, seed))


def decay(scene, event, first, last, replicas, seed):
    """Return an ``Estimate`` of the rate at which P(T > t) falls from ``first`` to ``last``.

    It is ln[P(T > first)/P(T > last)]/(last − first) from the intervals that ``counted`` counts,
    with its error by the delta method over replicas. Raises ``InputError`` as ``counted`` does, and
    if no interval is longer than ``last``.
    """
    counts = _counts(scene, event, [first, last], replicas, seed)
    early, late = counts.mean(axis=0)
    if not late:
        raise InputError(f"last must be shorter: none of the intervals lasts longer than {last!r}")
    n = len(counts)
    spread = np.std(counts[:, 0] / early - counts[:, 1] / late, ddof=1) / math.sqrt(n)
    return Estimate(math.log(early / late) / (last - first), spread / (last - first), n)


#: Times in the table, in units of the mean: for weighted starts and for plain counting.
WEIGHTED = (1, 2, 3, 5, 7, 10, 14, 20, 30, 50, 70, 100, 140, 200, 300, 500, 700, 1000)
COUNTED = (0.5, 1, 1.5, 2, 3, 4, 5, 6, 7, 8, 9, 10)

#: The window of the fitted rate, in units of the mean.
WINDOW = (3, 9)

#: The most wall and disc events in a mean time: intervals are followed for a thousand mean times.
RAREST = 100


def cases(box):
    """Return the pairs (event, radius) of a ``Box`` whose tails are measured.

    They are disc collisions at 0.24 times the shorter side, and hops at 0.1 and 0.3 times the
    shorter side. Beyond a quarter of this side no drift avoids the hops that are still open; if no
    hop is open, the last case is missing. In very long boxes, events that come less than once in
    ``RAREST`` events are left out.
    """
    hop, short = "vertical_hop" if box.width >= box.height else "horizontal_hop", box.shortest
    candidates = [("disc_collision", 0.24 * short), (hop, 0.1 * short), (hop, 0.3 * short)]
    return [
        (event, radius)
        for event, radius in candidates
        if box.fits(radius) and _comes(box.scene(radius), event)
    ]


def _comes(scene, event):
    return scene.is_possible(event) and (
        exact.event_rate(scene) * exact.mean_times(scene)[event] < RAREST
    )


def rows(box, samples, replicas, seed):
    """Yield the rows of tails.csv for a ``Box``; ``tail`` and ``counted`` explain the arguments.

    Every case and method has its own stream: ``seed`` and the numbers after it.
    """
    seed = check_integer("seed", seed, 0)
    for i, (event, radius) in enumerate(cases(box)):
        scene = box.scene(radius)
        mean, constant = exact.mean_times(scene)[event], tails.tail_constant(scene, event)
        start = {"event": event, "radius": radius, "exact_mean": mean}
        counts = counted(scene, event, _scaled(COUNTED, mean), replicas, seed + 2 * i)
        parts = [("counted", COUNTED, counts)]
        if constant:
            estimates = tail(scene, event, _scaled(WEIGHTED, mean), samples, seed + 2 * i + 1)
            parts.append(("weighted", WEIGHTED, estimates))
        for method, times, estimates in parts:
            for time, estimate in zip(times, estimates, strict=True):
                law = constant / (time * mean) ** 3 if constant else None
                yield start | _row("survival", method, time * mean, None, estimate, law)
        if not constant:
            first, last = _scaled(WINDOW, mean)
            estimate = decay(scene, event, first, last, replicas, seed + 2 * i)
            yield start | _row("rate", "counted", first, last, estimate, 1 / mean)


def _scaled(times, mean):
    return [time * mean for time in times]


def _row(quantity, method, time, until, estimate, law):
    return {
        "quantity": quantity,
        "method": method,
        "time": time,
        "until": until,
        "estimate": estimate.value,
        "stderr": estimate.stderr or None,
        "law": law,
    }
