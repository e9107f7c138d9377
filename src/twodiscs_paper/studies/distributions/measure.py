"""How the times to the next hop are distributed, from a hop and from a random moment.

Every interval T has its own start, on the surface of the hop and weighted by the flux through it.
Intervals are therefore independent draws of the time between hops, and their counts are exactly
binomial. Every first passage F has a start of the invariant measure. Palm's relation
P(F > t) = (1/τ) ∫_t^∞ P(T > s) ds connects the two: for every c

    ⟨min(F, c)⟩ = ⟨T² − (T − c)₊²⟩/(2τ),    hence    ⟨F⟩ = ⟨T²⟩/(2τ) = τ (1 + CV²)/2.

If the tail of T is cubic (see ``studies.single.tail_constant``), the variances of F and T² are
infinite, and only the first form can be tested.
"""

import math
from itertools import chain
from typing import NamedTuple

import numpy as np

from twodiscs.analysis.scores import student_deviate, two_sided_p
from twodiscs.dynamics.ensemble import nearest_power_of_two
from twodiscs.dynamics.law import two_disc_law
from twodiscs.model.events import HOPS
from twodiscs.model.scene import Box
from twodiscs.model.seeds import key, stream_seed
from twodiscs.points.estimates import Estimate
from twodiscs.sampling.conditioned import (
    conditioned_sampler,
    draw_configuration,
    draw_crossing,
    draw_velocity,
)
from twodiscs.sampling.jit import compiled
from twodiscs.sampling.streams import open_stream
from twodiscs.theory import exact, laws
from twodiscs_paper.studies.estimates import chi2_p, sample_mean
from twodiscs_paper.studies.single import tail_constant, time_to_next
from twodiscs_paper.study import row

#: Independent blocks behind an error bar, and the bins of a histogram of intervals.
INTERVAL_BLOCKS, BINS = 128, 512

#: The most wall and disc events for the intervals of one radius, and again for its first passages;
#: the most intervals and first passages. The density at 0 has an error of half a per cent from 4e6
#: intervals.
INTERVAL_EVENTS, MOST_INTERVALS, MOST_PASSAGES = 2**22, 2**22, 2**18

#: The fewest intervals that must end for a test of constancy.
FEWEST_ENDED = 1000

#: Relative distances below the radius at which a hop becomes blocked.
LIMIT_DISTANCES = (0.16, 0.08, 0.04, 0.02, 0.01)

#: Widening of the bins of the hazard rate, and the fewest intervals in one.
GROWTH, FEWEST_IN_BIN = 0.08, 100

#: A hazard is a plateau if the probabilities of its χ² and of its trend exceed this level.
TEST_LEVEL = 1e-3

#: The columns that identify one hop at one radius.
CASE_COLUMNS = ("scene", "width", "height", "radius", "event", "exact_mean")


def density_at_zero(counts, intervals, width):
    """Return the density at 0 as an ``Estimate``, as ``density_of_chains_at_zero`` does.

    ``counts`` belong to the first two bins of ``width`` from 0, out of a number of independent
    ``intervals``; the error is for multinomial counts.
    """
    n, weights = np.array(counts, float), np.array([7, -1]) / 6
    share = weights @ n / intervals
    spread = weights**2 @ n / intervals - share**2
    return Estimate(share / width, math.sqrt(spread / intervals) / width, intervals)


@compiled
def draw_passages(seed, first, stop, intervals, passages, cut, law, draw, width, histogram):
    """Return means of T, T², T² − (T − c)₊², F and min(F, c) in blocks ``first`` … ``stop`` − 1.

    T is the time between vertical hops and F the time to the next one, c is ``cut``. A block has
    ``intervals`` values of T and ``passages`` values of F. The result has the shape (stop − first,
    5). Intervals are added to ``histogram`` (int64, bins of ``width``, a power of two, from 0; the
    last entry counts all longer intervals).
    """
    rows = np.zeros((stop - first, 5))
    half_x, half_y = draw.half_x, draw.half_y
    per_width, last_bin = 1.0 / width, histogram.size - 1
    for block in range(first, stop):
        state, sums = open_stream(seed, block), rows[block - first]
        for _ in range(intervals):
            x1, y1, x2, y2, u1, v1, u2, v2 = draw_crossing(state, half_x, half_y, draw.beyond_x)
            # The disc that gets above the other one is called the first.
            if v1 > v2:
                time = time_to_next((x1, y1, x2, y2, u1, v1, u2, v2), law, True, np.inf)
            else:
                time = time_to_next((x2, y2, x1, y1, u2, v2, u1, v1), law, True, np.inf)
            histogram[min(np.int64(time * per_width), last_bin)] += 1
            beyond = max(time - cut, 0.0)
            sums[0] += time
            sums[1] += time * time
            sums[2] += time * time - beyond * beyond
        for _ in range(passages):
            start = draw_configuration(state, draw) + draw_velocity(state)
            time = time_to_next(start, law, True, np.inf)
            sums[3] += time
            sums[4] += min(time, cut)
        for k in range(5):
            sums[k] /= intervals if k < 3 else passages
    return rows


# Hazards from counts ---------------------------------------------------------------------------


def constant_hazard(bins):
    """Fit a constant hazard rate to ``bins``, and test whether it is constant or has a trend.

    ``bins`` are successive bins from ``hazard``. If n intervals are alive at the beginning of a bin
    of width w, the number that end in it is binomial with the mean n (1 − e^{−λw}), given all bins
    before. Bins can therefore be treated as independent; intervals that outlast the last bin are
    censored. Returns (rate, trend, chi2, degrees). The rate is λ of the largest likelihood, an
    ``Estimate`` with the error from Fisher's information. The trend is β of a rate ∝ t^β, by one
    Newton step from β = 0. The others are Pearson's χ² of a constant rate and its degrees of
    freedom.
    """
    ends = sum(part.count for part in bins)
    first, last, _, _, count, alive = np.array(bins, float).T
    width, time = last - first, np.log((first + last) / 2)
    rate = ends / float((alive - count / 2) @ width)
    for _ in range(30):  # Newton, with the information for the slope; the likelihood is concave
        weight = alive * width**2 / np.expm1(rate * width)
        score = width * (count / -np.expm1(-rate * width) - alive)
        rate += float(score.sum() / weight.sum())
    information = float(weight.sum())
    # In units of ln λ, the bins have the information λ² weight.
    spread = rate**2 * weight
    centred = time - spread @ time / spread.sum()
    precision = float(spread @ centred**2)
    trend = float(rate * score @ centred) / precision
    chi2 = float(np.sum(score**2 / weight))
    return (
        Estimate(rate, 1 / math.sqrt(information), ends),
        Estimate(trend, 1 / math.sqrt(precision), ends),
        chi2,
        len(bins) - 1,
    )


class HazardBin(NamedTuple):
    """The rate of hops between ``first`` and ``last``: ``count`` of the intervals ``alive`` end."""

    first: float
    last: float
    rate: float
    error: float
    count: int
    alive: int


def hazard(counts, intervals, width):
    """Yield the rate of hops as a function of the time since the last hop, as ``HazardBin``s.

    The rate from ``first`` to ``last`` is ln(S(first)/S(last))/(last − first), with a binomial
    error. S is the fraction of ``intervals`` that last longer. ``counts`` are joined until a bin is
    as wide as ``GROWTH`` times its first time; the first bin with fewer than ``FEWEST_IN_BIN``
    counts and all later ones are left out.
    """
    left, alive, waiting = 0, intervals, 0
    for i, n in enumerate(counts):
        waiting += int(n)
        if i + 1 < (1 + GROWTH) * left:
            continue
        rest = alive - waiting
        if waiting < FEWEST_IN_BIN or not rest:
            return
        time = (i + 1 - left) * width
        error = math.sqrt(1 / rest - 1 / alive) / time
        rate = math.log(alive / rest) / time
        yield HazardBin(left * width, (i + 1) * width, rate, error, waiting, alive)
        left, alive, waiting = i + 1, rest, 0


# The table ------------------------------------------------------------------------------------


def near_threshold(box, hop):
    """Return radii that approach the threshold of ``hop``, or [] if it stays open at all radii.

    They are ``LIMIT_DISTANCES`` below it, relative to it. Radii at which the hop is too rare even
    for the fewest intervals, in very long boxes, are left out.
    """
    limit = box.threshold(hop)
    if limit not in box.thresholds:
        return []
    radii = [float(f"{limit * (1 - distance):.6g}") for distance in LIMIT_DISTANCES]
    return [radius for radius in radii if _affordable(box.scene(radius), hop)]


def _affordable(scene, hop):
    """Return whether the fewest possible intervals take a few times ``INTERVAL_EVENTS`` at most."""
    events = exact.event_rate(scene) * exact.mean_times(scene)[hop]
    return INTERVAL_BLOCKS * events < 4 * INTERVAL_EVENTS


def _z(deviation, error):
    return student_deviate(deviation / error, INTERVAL_BLOCKS - 1)


def measured(start, scene, hop, seed, events=INTERVAL_EVENTS):
    """Yield the rows of distributions.csv on the times to the next ``hop`` of a ``Scene``.

    ``start`` has the columns that name scene and hop. ``events`` is the most wall and disc events
    that the intervals may take, and the first passages as well.
    """
    constant, mean = tail_constant(scene, hop), exact.mean_times(scene)[hop]
    rate = exact.event_rate(scene)
    affordable = int(nearest_power_of_two(events / (rate * mean))) // INTERVAL_BLOCKS
    block = max(1, min(affordable, MOST_INTERVALS // INTERVAL_BLOCKS))
    passages = min(block, MOST_PASSAGES // INTERVAL_BLOCKS)
    # For a test, first passages are cut at this many mean times.
    width, cut = nearest_power_of_two(mean / 16), 20 * mean
    oriented = scene
    if hop == "horizontal_hop":
        oriented = scene.turned()
    draw, histogram = conditioned_sampler(oriented), np.zeros(BINS + 1, np.int64)
    means = draw_passages(
        np.uint64(seed), 0, INTERVAL_BLOCKS, block, passages, cut, two_disc_law(oriented), draw,
        width, histogram,
    )  # fmt: skip
    intervals, passages = INTERVAL_BLOCKS * block, INTERVAL_BLOCKS * passages
    time, square, cut_square, passage, cut_passage = sample_mean(means)

    of_intervals = start | {"count": intervals}
    z = _z(time.value - mean, time.stderr)
    yield row(of_intervals, time, quantity="mean", reference=mean, z=z)
    variation = Estimate(square.value / mean**2 - 1, square.stderr / mean**2, INTERVAL_BLOCKS)
    yield row(of_intervals, variation, quantity="squared_cv", reference=1.0)
    scale = 1 / (2 * mean)
    for last, times, squares in ((None, passage, square), (cut, cut_passage, cut_square)):
        due, error = scale * squares.value, scale * squares.stderr
        found = {"last": last, "reference": due, "reference_stderr": error}
        if last or not constant:
            found["z"] = _z(times.value - due, math.hypot(times.stderr, error))
        yield row(start, times, quantity="first_passage", count=passages, **found)
    counts = histogram[:-1]
    if 4 * width <= draw.beyond_x:
        zero = density_at_zero(counts[:2], intervals, width)
        due = laws.density_at_zero(scene, hop)
        ends = {"first": 0.0, "last": 2 * width, "z": (zero.value - due) / zero.stderr}
        yield row(of_intervals, zero, quantity="density_at_zero", reference=due, **ends)
    bins = list(hazard(counts, intervals, width))
    # The hazard is tested for constancy from this many mean times to its last bin.
    yield from _constancy(start, [part for part in bins if part.first >= 4 * mean], mean)
    for part in bins:
        found = Estimate(part.rate, part.error, part.count)
        ends = {"first": part.first, "last": part.last, "count": part.count}
        yield row(start, found, quantity="hazard", **ends)


def _constancy(start, bins, mean):
    """Yield the rows that test whether the hazard is constant over ``bins``, if these suffice."""
    if len(bins) < 3 or sum(part.count for part in bins) < FEWEST_ENDED:
        return
    fit, trend, chi2, degrees = constant_hazard(bins)
    ends = start | {"first": bins[0].first, "last": bins[-1].last, "count": fit.n}
    tested = {"chi2": chi2, "degrees": degrees, "p": chi2_p(chi2, degrees)}
    z = (fit.value - 1 / mean) / fit.stderr
    yield row(ends, fit, quantity="rate", reference=1 / mean, z=z, **tested)
    z = trend.value / trend.stderr
    yield row(ends, trend, quantity="trend", reference=0.0, z=z, p=two_sided_p(z))


def rows(scenes, seed, events=INTERVAL_EVENTS):
    """Return the rows of distributions.csv.

    ``scenes`` are dicts of name, box, event and radii of hops. For the first scene, the radii near
    the thresholds of its hops are added (``near_threshold``). Every case has its own stream, from
    the root ``seed``, its scene, hop and radius. The rows on the shapes of hazards come last.
    """
    found = []
    for i, case in enumerate(scenes):
        box = Box(**case["box"])
        cases = [(case["event"], radius) for radius in case["radii"]]
        if i == 0:
            cases += [(hop, radius) for hop in HOPS for radius in near_threshold(box, hop)]
        for hop, radius in dict.fromkeys(cases):
            scene = box.scene(radius)
            stream = stream_seed(seed, case["name"], "intervals", f"{hop} {key(radius)}")
            start = {"scene": case["name"], "width": box.width, "height": box.height}
            start |= {"radius": radius, "event": hop, "exact_mean": exact.mean_times(scene)[hop]}
            found.append([*measured(start, scene, hop, stream, events)])
    return [*chain(*found), *chain(*map(shape, found))]


# The shape of a hazard: constant within the errors, or falling, and how far ---------------------


def is_drifted(row):
    """Return whether discs can avoid the hop of a ``row`` by a drift past each other."""
    side = row["height"] if row["event"] == "vertical_hop" else row["width"]
    return row["radius"] <= side / 4


def late_hazard(late):
    """Return the hazard of the bins ``late`` as an ``Estimate``: hops over their time at risk."""
    hops = sum(one["count"] for one in late)
    hazard = hops / sum(one["count"] / one["estimate"] for one in late)
    return Estimate(hazard, hazard / math.sqrt(hops), hops)


def shape(case):
    """Yield the rows on the shape of a hazard; ``case`` are the rows of one hop at one radius.

    The late bins of a hazard that falls are in the last two fifths of the time of the fitted rate.
    """
    of = {one["quantity"]: one for one in case}
    if "rate" not in of:
        return
    rate, start = of["rate"], {name: of["rate"][name] for name in CASE_COLUMNS}
    if min(rate["p"], of["trend"]["p"]) > TEST_LEVEL:
        names = ("first", "last", "count", "estimate", "stderr")
        yield start | {name: rate[name] for name in names} | {"quantity": "plateau"}
        return
    hazards = [one for one in case if one["quantity"] == "hazard"]
    # Late bins begin beyond this fraction of the time that the data reach.
    late = [one for one in hazards if one["first"] >= 0.6 * rate["last"] and one["count"] > 0]
    falling = "falling" if is_drifted(rate) else "falling_without_drift"
    if not late:
        yield row(start, quantity=falling)
        return
    found = late_hazard(late)
    ends = {"first": late[0]["first"], "last": late[-1]["last"], "count": found.n}
    yield row(start, found, quantity=falling, **ends)
