"""How the times to the next hop are distributed, from a hop and from a random moment.

Every interval T has its own start, on the surface of the hop and weighted by the flux through it.
Intervals are therefore independent draws of the time between hops, and their counts are exactly
binomial. Every first passage F has a start of the invariant measure. Palm's relation
P(F > t) = (1/τ) ∫_t^∞ P(T > s) ds connects the two: for every c

    ⟨min(F, c)⟩ = ⟨T² − (T − c)₊²⟩/(2τ),    hence    ⟨F⟩ = ⟨T²⟩/(2τ) = τ (1 + CV²)/2.

If the tail of T is cubic (see ``theory.tails.tail_constant``), the variances of F and T² are
infinite, and only the first form can be tested.
"""

import math
from typing import NamedTuple

import numpy as np

from twodiscs.comparison.scores import chi2_p, student_deviate, two_sided_p
from twodiscs.dynamics.ensemble import nearest_power_of_two
from twodiscs.dynamics.law import law_of
from twodiscs.dynamics.two.path import time_to_next
from twodiscs.model.box import Box
from twodiscs.model.checks import InputError, check_choice, check_integer
from twodiscs.model.events import HOPS
from twodiscs.model.radii import key, stream_seed
from twodiscs.points.estimates import Estimate, density_at_zero, mean_of
from twodiscs.sampling.jit import compiled
from twodiscs.sampling.separations import (
    draw_configuration,
    draw_constants,
    draw_crossing,
    draw_velocity,
)
from twodiscs.sampling.streams import open_stream
from twodiscs.theory import exact, tails

#: Independent blocks behind an error bar, and the bins of a histogram of intervals.
BLOCKS, BINS = 128, 512

#: The most wall and disc events for the intervals of one radius, and again for its first passages;
#: the most intervals and first passages. The density at 0 has an error of half a per cent from 4e6
#: intervals.
EVENTS, MOST_INTERVALS, MOST_PASSAGES = 2**22, 2**22, 2**18

#: For a test, first passages are cut at this many mean times.
CUT = 20

#: The hazard is tested for constancy from this many mean times to its last bin.
FIRST = 4

#: The fewest intervals that must end for a test of constancy.
FEWEST = 1000

#: Relative distances below the radius at which a hop becomes blocked.
DISTANCES = (0.16, 0.08, 0.04, 0.02, 0.01)

#: Widening of the bins of the hazard rate, and the fewest intervals in one.
GROWTH, FEWEST_IN_BIN = 0.08, 100


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
            start = draw_configuration(state, draw, 0, 0) + draw_velocity(state)
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
    freedom. Raises ``InputError`` for fewer than three bins or ``FEWEST`` ends.
    """
    bins = list(bins)
    ends = sum(part.count for part in bins)
    if len(bins) < 3 or ends < FEWEST:
        raise InputError(
            f"bins must be at least 3 with {FEWEST} ends in all, not {len(bins)} with {ends}"
        )
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


class Bin(NamedTuple):
    """The rate of hops between ``first`` and ``last``: ``count`` of the intervals ``alive`` end."""

    first: float
    last: float
    rate: float
    error: float
    count: int
    alive: int


def hazard(counts, intervals, width):
    """Yield the rate of hops as a function of the time since the last hop, as ``Bin`` objects.

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
        yield Bin(left * width, (i + 1) * width, rate, error, waiting, alive)
        left, alive, waiting = i + 1, rest, 0


# The table ------------------------------------------------------------------------------------


def near_threshold(box, hop):
    """Return radii that approach the threshold of ``hop``, or [] if it stays open at all radii.

    They are ``DISTANCES`` below it, relative to it. Radii at which the hop is too rare even for the
    fewest intervals, in very long boxes, are left out.
    """
    limit = box.threshold(check_choice("hop", hop, HOPS))
    if limit not in box.thresholds:
        return []
    radii = [float(f"{limit * (1 - distance):.6g}") for distance in DISTANCES]
    return [radius for radius in radii if _affordable(box.scene(radius), hop)]


def _affordable(scene, hop):
    """Return whether the fewest possible intervals take a few times ``EVENTS`` at most."""
    events = exact.event_rate(scene) * exact.mean_times(scene)[hop]
    return BLOCKS * events < 4 * EVENTS


def measured(scene, hop, seed, events=EVENTS):
    """Yield the rows of distributions.csv on the times to the next ``hop`` of a ``Scene``.

    The columns that name scene and hop are missing. ``events`` is the most wall and disc events
    that the intervals may take, and the first passages as well. Raises ``InputError`` for a scene
    with effects, a hop that is unknown or blocked, and numbers out of range.
    """
    check_choice("hop", hop, HOPS)
    constant = tails.tail_constant(scene, hop)
    if constant is None:
        raise InputError(f"hop {hop!r} is blocked at radius {scene.radius!r}: it has no intervals")
    seed, events = check_integer("seed", seed, 0), check_integer("events", events)
    mean = exact.mean_times(scene)[hop]
    rate = exact.event_rate(scene)
    affordable = int(nearest_power_of_two(max(1.0, events / (rate * mean)))) // BLOCKS
    block = max(1, min(affordable, MOST_INTERVALS // BLOCKS))
    passages = min(block, MOST_PASSAGES // BLOCKS)
    width, cut = nearest_power_of_two(mean / 16), CUT * mean
    oriented = scene
    if hop == "horizontal_hop":
        oriented = Box.of(scene).turned().scene(scene.radius)
    draw, histogram = draw_constants(oriented), np.zeros(BINS + 1, np.int64)
    means = draw_passages(
        np.uint64(seed), 0, BLOCKS, block, passages, cut, law_of(oriented), draw, width, histogram,
    )  # fmt: skip
    intervals, passages = BLOCKS * block, BLOCKS * passages
    time, square, cut_square, passage, cut_passage = mean_of(means)

    yield _row("mean", intervals, time, mean, z=_z(time.value - mean, time.stderr))
    scale = 1 / (2 * mean)
    variation = Estimate(square.value / mean**2 - 1, square.stderr / mean**2, BLOCKS)
    yield _row("squared_cv", intervals, variation, 1.0)
    for last, times, squares in ((None, passage, square), (cut, cut_passage, cut_square)):
        row = _row("first_passage", passages, times, scale * squares.value, last=last)
        row["reference_stderr"] = scale * squares.stderr
        if last or not constant:
            deviation = times.value - row["reference"]
            row["z"] = _z(deviation, math.hypot(times.stderr, row["reference_stderr"]))
        yield row
    counts = histogram[:-1]
    if 4 * width <= draw.beyond_x:
        zero = density_at_zero(counts[:2], intervals, width)
        due = tails.density_at_zero(scene, hop)
        z = (zero.value - due) / zero.stderr
        yield _row("density_at_zero", intervals, zero, due, first=0.0, last=2 * width, z=z)
    bins = list(hazard(counts, intervals, width))
    yield from _constancy([part for part in bins if part.first >= FIRST * mean], mean)
    for part in bins:
        estimate = Estimate(part.rate, part.error, part.count)
        yield _row("hazard", part.count, estimate, None, first=part.first, last=part.last)


def _constancy(bins, mean):
    """Yield the rows that test whether the hazard is constant over ``bins``, if these suffice."""
    if len(bins) < 3 or sum(part.count for part in bins) < FEWEST:
        return
    fit, trend, chi2, degrees = constant_hazard(bins)
    ends = {"first": bins[0].first, "last": bins[-1].last}
    z, p = (fit.value - 1 / mean) / fit.stderr, chi2_p(chi2, degrees)
    yield _row("rate", fit.n, fit, 1 / mean, **ends, z=z, chi2=chi2, degrees=degrees, p=p)
    z = trend.value / trend.stderr
    yield _row("trend", trend.n, trend, 0.0, **ends, z=z, p=two_sided_p(z))


def rows(scenes, seed, events=EVENTS):
    """Yield the rows of distributions.csv.

    ``scenes`` are dicts of name, box, event and radii of hops. For the first scene, the radii near
    the thresholds of its hops are added (``near_threshold``). Every case has its own stream, from
    the root ``seed``, its scene, hop and radius. Raises ``InputError`` as ``measured`` does.
    """
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
            for row in measured(scene, hop, stream, events):
                yield row | start


def _z(deviation, error):
    return student_deviate(deviation / error, BLOCKS - 1)


def _row(quantity, count, estimate, reference, first=None, last=None, z=None, **more):
    """Return a row; ``more`` are columns that other rows leave empty."""
    return {
        "quantity": quantity,
        "first": first,
        "last": last,
        "count": count,
        "estimate": estimate.value,
        "stderr": estimate.stderr,
        "reference": reference,
        "z": z,
        **more,
    }
