"""Tails of the times between events, where plain counting finds nothing.

At a random moment of a stationary motion let F be the time to the next event and G the time since
the last event. An interval F + G is picked in proportion to its length, or to the integral of any
positive marker m of the state. By Palm's theorem

    P(T > t) = τ ⟨1[F + G > t] m / ∫m⟩,

with m at that moment, and its integral over the interval. Starts come from the invariant measure;
G is found by running backwards from the same start. Long intervals begin near a neutral motion
(see ``single.tail_constant``), where all energy except a small share s is along one axis. On the
sphere of speeds s is uniform on [0, 1]. The smaller of the shares along x and y is therefore
uniform on [0, 1/2]. This range is cut into strata, each a quarter of the one before, with powers of
two, or three times powers of two, as exact weights.

The marker is four times larger from one stratum to the next, so that the weight of a stratum times
its marker, the largest value that a start may add, is the same in all. A marker of 1 would leave a
tenth of the long intervals to starts outside of drifts, which hardly meet them; now most of ∫m
comes from the drift. From one stratum to the next the work for a start doubles. Numbers of starts
∝ weight × value/√work (Neyman; Cochran, Sampling Techniques, 1977, section 5.5) are therefore
halved in every second stratum. A probability of 1e-8 takes no more starts than one of 1/2, and the
estimate has no bias.

If a stratum has no interval longer than t, its spread says nothing. Beyond the times of its drifts
its part of P(T > t) falls as t⁻³ or faster, as the tail does. An upper bound is therefore the part
of its longest interval, times the cube of the length of this interval over t. The error includes
these bounds. The method needs only + − × / and √.
"""

import math
from dataclasses import replace
from itertools import pairwise, starmap

import numpy as np

from twodiscs.dynamics.ensemble import nearest_power_of_two
from twodiscs.dynamics.law import DISC, two_disc_law
from twodiscs.dynamics.two.follow import state_at
from twodiscs.model.events import HOPS
from twodiscs.model.scene import Box
from twodiscs.points.estimates import Estimate
from twodiscs.sampling.conditioned import conditioned_sampler, draw_configuration, draw_in_disc
from twodiscs.sampling.initial_states import draw_starts
from twodiscs.sampling.jit import compiled
from twodiscs.sampling.streams import next_bits, open_stream, uniform
from twodiscs.theory import exact
from twodiscs_paper.studies.estimates import LinearFit, chi2_p, sample_mean
from twodiscs_paper.studies.single import advance_to, tail_constant
from twodiscs_paper.study import row, select

#: Independent blocks behind an error bar, which then has a relative error of about 7 %.
TAIL_BLOCKS = 100

#: Times in the table, in units of the mean: for weighted starts and for plain counting.
WEIGHTED_TIMES = (1, 2, 3, 5, 7, 10, 14, 20, 30, 50, 70, 100, 140, 200, 300, 500, 700, 1000)
COUNTED_TIMES = (0.5, 1, 1.5, 2, 3, 4, 5, 6, 7, 8, 9, 10)

#: The window of the fitted rate, in units of the mean.
FIT_WINDOW = (3, 9)

#: The most wall and disc events in a mean time: intervals are followed for a thousand mean times.
MEAN_TIME_EVENTS = 100


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
def marked_time(state, law, hop, lowest):
    """Return the time to the next event, as ``time_to_next``, and the integral of the marker.

    The marker is 1 in the first stratum and four times as large from one to the next. The shares of
    the last stratum are up to ``lowest``. A share changes in collisions only.
    """
    elapsed, marked, mark, code = 0.0, 0.0, 0.0, DISC
    while True:
        if code == DISC:
            _, _, _, _, u1, v1, u2, v2 = state
            share, upper, mark = min(u1 * u1 + u2 * u2, v1 * v1 + v2 * v2), 0.125, 1.0
            while share <= upper and lowest <= upper:
                upper, mark = 0.25 * upper, 4.0 * mark
        state, time, code, met = advance_to(state, law, hop)
        if met >= 0.0:
            return elapsed + met, marked + mark * met
        elapsed, marked = elapsed + time, marked + mark * time


@compiled
def length_biased(seed, first, stop, strata, samples, times, law, draw, hop):
    """Return ⟨1[F + G > t] m/∫m⟩ in blocks ``first`` … ``stop`` − 1, by stratum, and the longest.

    A block has ``samples`` starts in the last of ``strata`` strata, twice as many in every second
    one before; ``times`` ascend. The first result has the shape (stop − first, strata, times), in
    1/time; its sums over strata are the estimates. The second one has the longest interval of each
    stratum, and what this start adds to the estimate of its block.
    """
    rows, longest = np.zeros((stop - first, strata, times.size)), np.zeros((strata, 2))
    lowest = 0.5 ** (2 * strata - 1)
    for block in range(first, stop):
        state, largest, mark = open_stream(seed, block), 0.5, 1.0
        for stratum in range(strata):
            least = 0.25 * largest if stratum < strata - 1 else 0.0
            starts = samples << ((strata - 1 - stratum) // 2)
            weight, sums = 2.0 * (largest - least) / starts, rows[block - first, stratum]
            for _ in range(starts):
                x1, y1, x2, y2 = draw_configuration(state, draw)
                u1, v1, u2, v2 = draw_drifting_velocity(state, largest, least)
                ahead, marked = marked_time((x1, y1, x2, y2, u1, v1, u2, v2), law, hop, lowest)
                since, more = marked_time((x1, y1, x2, y2, -u1, -v1, -u2, -v2), law, hop, lowest)
                interval, value = ahead + since, weight * mark / (marked + more)
                if interval > longest[stratum, 0]:
                    longest[stratum] = interval, value
                for i in range(times.size):
                    if interval <= times[i]:
                        break
                    sums[i] += value
            largest, mark = least, 4.0 * mark
    return rows, longest


@compiled
def count_long(seed, first, stop, replicas, window, times, law, draw, hop):
    """Return the counts of intervals that begin within a ``window`` of time, (replicas, times + 1).

    The first column counts all intervals, the others the intervals longer than each of ``times``.
    """
    counts = np.zeros(((stop - first) * replicas, times.size + 1), np.int64)
    starts = np.zeros((8, replicas))
    for block in range(first, stop):
        draw_starts(open_stream(seed, block), draw, starts)
        for replica in range(replicas):
            count = counts[(block - first) * replicas + replica]
            state = state_at(starts, replica, law)
            now, last = 0.0, -1.0
            while True:
                state, time, _, met = advance_to(state, law, hop)
                moment = now + met
                now += time
                if met < 0.0:
                    continue
                if last >= 0.0:
                    count[0] += 1
                    for i in range(times.size):
                        count[i + 1] += moment - last > times[i]
                last = moment
                if last >= window:
                    break
    return counts


def _oriented(scene, event):
    """Return the scene in which a hop is a vertical one, and whether the ``event`` is a hop."""
    if event == "horizontal_hop":
        scene = scene.turned()
    return scene, event in HOPS


def tail(scene, event, times, samples, seed, blocks=TAIL_BLOCKS):
    """Return an ``Estimate`` of P(T > t) for each of the ascending ``times``, without bias.

    T is the interval between hops of one kind or between disc collisions of the ``Scene``.
    Each of ``blocks`` independent blocks has ``samples`` starts in the last stratum. The spread
    between blocks gives the standard error, with the bounds of strata without a longer interval.
    The strata reach down to drifts that last for the longest of the times, so the work grows with
    this time.
    """
    oriented, hop = _oriented(scene, event)
    # A drift of speed √s crosses the box in a time w/√s.
    longest = nearest_power_of_two(max(1.0, times[-1] / max(scene.width, scene.height)))
    strata = 2 + int(math.frexp(longest)[1])
    sums, longest = length_biased(
        np.uint64(seed), 0, blocks, strata, samples, np.array(times), two_disc_law(oriented),
        conditioned_sampler(oriented), hop,
    )  # fmt: skip
    mean = exact.mean_times(scene)[event]
    estimates, (ends, values) = sample_mean(sums.sum(axis=1) * mean), longest.T
    return [
        replace(one, stderr=math.hypot(one.stderr, *unseen[ends <= time]))
        for one, time in zip(estimates, times, strict=True)
        for unseen in [values * mean / blocks * (ends / time) ** 3]
    ]


def survivals(scene, event, times, replicas, seed):
    """Return P(T > t) for each of the ascending ``times`` by each replica, by plain counting.

    From each of ``replicas`` starts of the invariant measure it counts all intervals that begin
    within eight mean times, however long they last. They are eight on average, so the counts are
    divided by eight. The result has the shape (replicas, times).
    """
    oriented, hop = _oriented(scene, event)
    window = 8 * exact.mean_times(scene)[event]
    counts = count_long(
        np.uint64(seed), 0, 1, replicas, window, np.array(times), two_disc_law(oriented),
        conditioned_sampler(oriented), hop,
    )  # fmt: skip
    return counts[:, 1:] / 8


def counted_survival(scene, event, times, replicas, seed):
    """Return an ``Estimate`` of P(T > t) for each of ``times``: the mean of ``survivals``.

    If no interval was longer, the error is that of one interval.
    """
    found = sample_mean(survivals(scene, event, times, replicas, seed))
    return [one if one.value else replace(one, stderr=1 / (8 * replicas)) for one in found]


def decay(counted, first, last):
    """Return an ``Estimate`` of the rate at which P(T > t) falls from ``first`` to ``last``.

    It is ln[P(T > first)/P(T > last)]/(last − first), from ``survivals`` at the two times, with the
    error by the delta method over replicas.
    """
    early, late = counted.mean(axis=0)
    n = len(counted)
    spread = np.std(counted[:, 0] / early - counted[:, 1] / late, ddof=1) / math.sqrt(n)
    return Estimate(math.log(early / late) / (last - first), spread / (last - first), n)


# The table --------------------------------------------------------------------------------------


def cases(box):
    """Return the pairs (event, radius) of a ``Box`` whose tails are measured.

    They are disc collisions at 0.24 times the shorter side, and hops at 0.1 and 0.3 times the
    shorter side. Beyond a quarter of this side no drift avoids the hops that are still open; if no
    hop is open, the last case is missing. In very long boxes, events that come less than once in
    ``MEAN_TIME_EVENTS`` events are left out.
    """
    hop, short = "vertical_hop" if box.width >= box.height else "horizontal_hop", box.shortest

    def comes(event, radius):
        scene = box.scene(radius)
        return scene.is_possible(event) and (
            exact.event_rate(scene) * exact.mean_times(scene)[event] < MEAN_TIME_EVENTS
        )

    candidates = [("disc_collision", 0.24 * short), (hop, 0.1 * short), (hop, 0.3 * short)]
    return [case for case in candidates if box.fits(case[1]) and comes(*case)]


def event_cells(scene, event):
    """Return the cells that all rows on an ``event`` of a ``Scene`` have in common."""
    return {"event": event, "radius": scene.radius, "exact_mean": exact.mean_times(scene)[event]}


def survival_rows(method, start, times, estimates, constant):
    """Return the rows of P(T > t) at ``times``, with the law of a tail with the ``constant`` C."""
    return [
        row(
            start, estimate, quantity="survival", method=method, time=time,
            law=constant / time**3 if constant else None,
        )
        for time, estimate in zip(times, estimates, strict=True)
    ]  # fmt: skip


def rows(box, samples, replicas, seed):
    """Return the rows of tails.csv for a ``Box``; ``tail`` and ``survivals`` explain the arguments.

    Every case and method has its own stream: ``seed`` and the numbers after it.
    """
    found = []
    for i, (event, radius) in enumerate(cases(box)):
        scene = box.scene(radius)
        start, constant = event_cells(scene, event), tail_constant(scene, event)
        mean = start["exact_mean"]
        times = [time * mean for time in COUNTED_TIMES]
        estimates = counted_survival(scene, event, times, replicas, seed + 2 * i)
        found += survival_rows("counted", start, times, estimates, constant)
        if constant:
            times = [time * mean for time in WEIGHTED_TIMES]
            estimates = tail(scene, event, times, samples, seed + 2 * i + 1)
            found += survival_rows("weighted", start, times, estimates, constant)
        else:
            ends = [time * mean for time in FIT_WINDOW]
            counted = survivals(scene, event, ends, replicas, seed + 2 * i)
            if not counted[:, 1].any():
                continue
            rate = decay(counted, *ends)
            cells = {"quantity": "rate", "method": "counted", "time": ends[0], "until": ends[1]}
            found.append(row(start, rate, law=1 / mean, **cells))
    return [*found, *last_ratios(found), *constancy(found)]


def long_run(weighted, counted):
    """Return the rows of a long run: a ``weighted`` tail, and a ``counted`` one of several runs.

    Each run has its own random streams. The rates between two times follow from the probabilities.
    """

    def given(run):
        scene = Box(run["width"], run["height"]).scene(run["radius"])
        start = event_cells(scene, run["event"])
        return scene, run["event"], [time * start["exact_mean"] for time in run["times"]], start

    scene, event, times, start = given(weighted)
    estimates = tail(scene, event, times, weighted["samples"], weighted["seed"])
    constant = tail_constant(scene, event)
    falling = survival_rows("weighted", start, times, estimates, constant)
    scene, event, times, start = given(counted)
    seeds = range(counted["seed"], counted["seed"] + counted["runs"])
    of_runs = [counted_survival(scene, event, times, counted["replicas"], s) for s in seeds]
    alone = survival_rows("counted", start, times, map(joined, zip(*of_runs, strict=True)), None)
    # Hops approach their law as (t/τ)^(−1/2) from this time on, in units of the mean.
    late = [one for one in falling if one["time"] > 0.999 * 1000 * one["exact_mean"]]
    follow = []
    if late:
        follow = [approach_power(falling, late[0]), *map(approach, late), mean_approach(late)]
    return [*falling, *follow, *alone, *starmap(rate_between, pairwise(alone))]


# Rows that follow from others -------------------------------------------------------------------


def last_ratios(rows):
    """Yield the rows on the last well measured ratio of each tail to its law, and its approach."""
    last = {
        one["event"]: one
        for one in rows
        if one["method"] == "weighted" and one["stderr"]
        if one["stderr"] < 0.2 * one["estimate"]
    }
    for event, one in last.items():
        ratio, error = one["estimate"] / one["law"], one["stderr"] / one["law"]
        fit = {"quantity": "last_ratio", "method": "fit", "law": None}
        yield one | fit | {"estimate": ratio, "stderr": error}
        if event in HOPS:
            yield approach(one)


def approach(weighted):
    """Return the row on the c of the ratio 1 + c (t/τ)^(−1/2) of a ``weighted`` row to its law.

    Hops approach the law like that; collisions have no such term.
    """
    root = math.sqrt(weighted["time"] / weighted["exact_mean"])
    ratio, error = (weighted[name] / weighted["law"] for name in ("estimate", "stderr"))
    found = {"estimate": (ratio - 1) * root, "stderr": error * root}
    return weighted | {"quantity": "approach", "method": "fit", "law": None} | found


def approach_power(weighted, end):
    """Return the row on the power of t with which the ratio of survival to its law approaches 1.

    It is fitted to ratio − 1 of the ``weighted`` rows up to that of the ``end``.
    """
    rows = [one for one in weighted if one["time"] <= end["time"]]
    times, ratios, errors = np.array([
        (one["time"], one["estimate"] / one["law"] - 1, one["stderr"] / one["law"]) for one in rows
    ]).T  # fmt: skip
    slope = LinearFit(np.log(times), np.log(ratios), errors / ratios).slope
    cells = {"quantity": "approach_power", "method": "fit", "until": end["time"], "law": None}
    return rows[0] | cells | {"estimate": slope.value, "stderr": slope.stderr}


def mean_approach(weighted):
    """Return the row on the c of ``approach`` from several ``weighted`` rows, by their errors.

    The times share their starts, so the error is that of the first of them, the smallest one.
    """
    rows = [approach(one) for one in weighted]
    weights = [1 / one["stderr"] ** 2 for one in rows]
    mean = float(np.average([one["estimate"] for one in rows], weights=weights))
    found = {"estimate": mean, "quantity": "mean_approach", "until": rows[-1]["time"]}
    return rows[0] | found


def joined(estimates):
    """Return the mean of independent ``estimates`` from equal numbers of replicas."""
    runs = len(estimates)
    error = math.sqrt(sum(e.stderr**2 for e in estimates)) / runs
    return Estimate(float(np.mean([e.value for e in estimates])), error, runs * estimates[0].n)


def rate_between(first, later):
    """Return the row on the rate between the times of two rows of survival.

    Intervals that last longer than the second time are among those that last longer than the first.
    The variance of the logarithm is therefore the difference of their relative variances.
    """
    time = later["time"] - first["time"]
    late, early = ((one["stderr"] / one["estimate"]) ** 2 for one in (later, first))
    rate = math.log(first["estimate"] / later["estimate"]) / time
    found = {"estimate": rate, "stderr": math.sqrt(late - early) / time}
    ends = {"quantity": "rate", "until": later["time"], "law": 1 / first["exact_mean"]}
    return first | found | ends


def constant_hazard(rows):
    """Return (χ², degrees of freedom) of a constant hazard between the times of ``rows``.

    ``rows`` are rows of survival at ascending times. The variances are those of ``rate_between``.
    """
    rates = [rate_between(*pair) for pair in pairwise(rows)]
    hazards, errors = np.array([(one["estimate"], one["stderr"]) for one in rates]).T
    weights = (1 / errors) ** 2
    mean = np.average(hazards, weights=weights)
    return float(np.sum(weights * (hazards - mean) ** 2)), len(rates) - 1


def constancy(rows):
    """Yield the rows that test whether a rate of decay is constant over the times of its fit."""
    for rate in select(rows, quantity="rate"):
        case = {name: rate[name] for name in ("event", "radius")}
        first, last = rate["time"] * (1 - 1e-9), rate["until"] * (1 + 1e-9)
        within = [
            one
            for one in select(rows, quantity="survival", method="counted", **case)
            if first <= one["time"] <= last and one["estimate"]
        ]
        if len(within) < 3:
            continue
        chi2, degrees = constant_hazard(within)
        for quantity, value in (
            ("chi2", chi2),
            ("degrees", float(degrees)),
            ("chance", chi2_p(chi2, degrees)),
        ):
            fit = {"quantity": quantity, "method": "fit", "law": None}
            yield rate | fit | {"estimate": value, "stderr": None}
