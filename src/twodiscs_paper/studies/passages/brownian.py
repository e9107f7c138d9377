"""First passages in Brownian dynamics, a long run: counts, and the rows that follow from them.

The motion is that of ``models.brownian``, with σ as the unit of length and a step as that of time.
Transition state theory has the rate s ε²/(√π V) of crossings from one side to the other, with the
volume V of the allowed (u, y₁, y₂) on one side. It is exact for reflected discs. κ is the rate of
passages over that rate, so the mean time between passages of a pair is √π V/(κ s ε²).

If the separation u diffuses with the coefficient s², the rate of passages is s²/(V ∫ du/ρ(u)), with
the integral from one end of the ring to the other. Close to the threshold it is π/√2 ε^(−3/2), and
κ = √(2/π) s/√ε. This holds for steps that are short against the neck and, if they may be rejected,
also against its width ε.
"""

import math
import operator
from collections import Counter
from itertools import groupby, pairwise

import numpy as np
from scipy.integrate import quad

from twodiscs.dynamics.transmission import cluster_coefficient
from twodiscs.model.seeds import stream_seed
from twodiscs.points.estimates import Estimate
from twodiscs_paper.studies.estimates import LinearFit
from twodiscs_paper.studies.passages.models import brownian_steps
from twodiscs_paper.studies.passages.near import compared, dense, sparse
from twodiscs_paper.study import row

#: {program: its number in ``models.brownian``}.
PROGRAMS = {
    "reflected": brownian_steps.REFLECTED, "kicked": brownian_steps.KICKED,
    "together": brownian_steps.TOGETHER, "confined": brownian_steps.CONFINED,
    "singly": brownian_steps.SINGLY,
}  # fmt: skip

#: {program that rejects moves: the standard deviation of a move of u over s}.
MOVE_WIDTHS = {"together": math.sqrt(2), "confined": math.sqrt(2), "singly": 1.0}

#: {program: its flights or moves in a step, if they are not one}.
MOVES_PER_STEP = {"kicked": 2, "singly": 2}

#: Half of the length of the ring, in σ: the box 1.5 × 1 has this length close to h/4.
HALF = 1.5

#: Exponents are fitted where the neck is ``LONG_NECK_STEPS`` steps or more, or ``SHORT_NECK_STEPS``
#: steps or less.
LONG_NECK_STEPS, SHORT_NECK_STEPS = 8.0, 0.125

#: If heights diffuse as slowly as u, the resistance of the neck is larger by the factor 1 +
#: ``HEIGHT_TERM`` ε/σ + … Slacks ξ, η up to L then leave Φ′(u) L′(ξ² + η²)/L in the potential Φ,
#: which adds (4/3)∫(L′/L)² du to the resistance 2∫du/L².
HEIGHT_TERM = 4 / 3

#: In wider channels the methods differ by more than a per cent: pairs that are too far apart to
#: touch need not come to the end of the ring, where passages begin and end.
COMPARED_ROOM = 1 / 16

#: Nodes and weights on [0, 1].
NODES, WEIGHTS = (part / 2 for part in np.polynomial.legendre.leggauss(48))
NODES = NODES + 1 / 2


def side_volume(room, near=0.0):
    """Return the volume of the allowed (u, y₁, y₂) on one side, for a neck of the width ``room``.

    It is the integral of L² over ``near`` < u < ``HALF``, with L of ``models.brownian``.
    """
    breadth, u = 1 + room, min(near, 1.0)
    arc = math.acos(u) - u * math.sqrt(1 - u * u)
    return breadth**2 * (HALF - near) - arc * breadth + 2 / 3 - u + u**3 / 3


def acceptance(program, slack):
    """Return the share of moves whose heights stay within the ``slack`` L, in steps s.

    The slacks at the walls are uniform in a triangle. Walls that fold make it a square of the side
    √2 L, over which the two deviates are independent; of one disc the slack is 2tL, 0 ≤ t ≤ 1, with
    the density 2t. Walls that reject leave (1 − m/L)² of the triangle, m the largest of |a|, |b|
    and |a + b|. For L ≪ s the shares are L²/(πs²), (4/3) L/(√(2π) s) and L²/(4πs²).
    """
    if program == "together":
        return _kept(math.sqrt(2) * slack) ** 2
    if program == "singly":
        return sum(w * 2 * t * _kept(2 * t * slack) for t, w in zip(NODES, WEIGHTS, strict=True))
    angles = (2 * NODES - 1) * math.pi / 2
    a, b = np.cos(angles), np.sin(angles)
    reach = slack / np.maximum(np.maximum(np.abs(a), np.abs(b)), np.abs(a + b))
    r = np.outer(NODES, np.minimum(reach, 9.0))
    kept = (1 - r / reach) ** 2 * r * np.exp(-(r**2) / 2) * np.minimum(reach, 9.0)
    return float(WEIGHTS @ kept @ WEIGHTS)


def _kept(length):
    """Return the share of normal deviates from uniform points of a ``length`` that stay on it."""
    rest = -math.expm1(-(length**2) / 2) * math.sqrt(2 / math.pi) / length
    return math.erf(length / math.sqrt(2)) - rest


def resistance(room, program="reflected", step=1.0):
    """Return ∫ du/(ρ a) over the whole ring, a the ``acceptance``, which is 1 without rejection.

    This neglects steps through the other disc, which end the law once s is not short against the
    neck.
    """

    def inverse(u):
        slack = 1 + room - math.sqrt(1 - u * u)
        return slack**-2.0 / (acceptance(program, slack / step) if program in MOVE_WIDTHS else 1.0)

    near, _ = quad(inverse, 0, 1, points=[math.sqrt(room)], epsabs=0, epsrel=1e-9)
    return 2 * (near + (HALF - 1) * inverse(1.0))


def first_passage(step, room):
    """Return the mean time from the largest separation to u = 0 if the separation diffuses.

    It is ∫ du/ρ(u) ∫ ρ(u′) du′ over s², with u from 0 to ``HALF`` and u′ from u to ``HALF``.
    """

    def slowness(u):
        return side_volume(room, u) / (1 + room - math.sqrt(max(1 - u * u, 0.0))) ** 2

    time, _ = quad(slowness, 0, HALF, points=[math.sqrt(room), 1], epsabs=0, epsrel=1e-10)
    return time / step**2


def crossing_rate(step, room):
    """Return the rate of crossings from one side, per step, of discs with thermal velocities."""
    return step / math.sqrt(math.pi) * room**2 / side_volume(room)


def diffusive(step, room, program):
    """Return κ of a separation that diffuses, by the moves of a ``program`` that are accepted."""
    passed = step**2 / (side_volume(room) * resistance(room, program, step))
    return passed / crossing_rate(step, room)


def neck(step, halvings):
    """Return the length √(εσ) of the neck over the length of a step."""
    return math.sqrt(2.0**-halvings) / step


# Counts -----------------------------------------------------------------------------------------


def points(groups):
    """Yield (program, step, halvings of ε, samples) of the ``groups`` of a configuration."""
    for group in groups:
        for halvings in group["halvings"]:
            yield group["program"], 2.0 ** -group["step"], halvings, group["samples"]


def crossing_counts(seed, program, step, halvings, crossings):
    """Return the counts of a number of random ``crossings`` as plain values for JSON."""
    stream = _stream(seed, "crossings", program, step, halvings)
    sizes, tried, steps = brownian_steps.cluster_sizes(
        PROGRAMS[program], step, 2.0**-halvings, HALF, stream, 0,
        -(-crossings // brownian_steps.STEP_CROSSINGS)
    )  # fmt: skip
    return {"tried": int(tried), "steps": int(steps), "sizes": sparse(sizes)}


def passage_counts(seed, program, step, halvings, pairs):
    """Return the counts of the first passages of ``pairs`` as plain values for JSON."""
    stream = _stream(seed, "passages", program, step, halvings)
    found = brownian_steps.first_passages(
        PROGRAMS[program], step, 2.0**-halvings, HALF, stream, 0, pairs
    )
    columns = dict(zip(("first", "passage", "crossings"), found.T.tolist(), strict=True))
    sums = {name: [sum(own), sum(n * n for n in own)] for name, own in columns.items()}
    both = sum(map(operator.mul, columns["passage"], columns["crossings"]))
    return {"pairs": len(found), **sums, "passage*crossings": both}


def _stream(seed, what, program, step, halvings):
    """Return the seed of the streams of one point."""
    point = f"{step!r} {2.0**-halvings!r}"
    return np.uint64(stream_seed(seed, f"brownian {program} {what}", "passages", point))


# Rows -------------------------------------------------------------------------------------------


def joined(counts):
    """Return the sums of the ``counts`` of several seeds."""
    total = {}
    for name in counts[0]:
        values = [one[name] for one in counts]
        if name == "sizes":
            sizes = sum(map(Counter, map(dict, values)), Counter())
            total[name] = sorted(sizes.items())
        else:
            total[name] = np.sum(values, axis=0).tolist()
    return total


def crossing_estimates(point, counts):
    """Return {quantity: ``Estimate``} from the ``counts`` of random crossings at a ``point``."""
    sizes = dense(counts["sizes"], brownian_steps.STEP_CLUSTER + 2)
    number = int(sizes.sum())
    kappa, found = cluster_coefficient(sizes), {}
    if point["program"] in MOVE_WIDTHS:
        step, room = point["step"], 2.0 ** -point["halvings"]
        length = MOVE_WIDTHS[point["program"]] * step
        farthest = min(brownian_steps.LONGEST_MOVE * length, 1.0)
        area = (1 + room - math.sqrt(1 - farthest**2)) ** 2
        tried = length / math.sqrt(2 * math.pi) * area / side_volume(room)
        tried *= MOVES_PER_STEP.get(point["program"], 1)
        share = number / counts["tried"]
        ratio = tried / crossing_rate(step, room) * share
        spread = math.sqrt((1 - share) / number)
        found["crossing_rate"] = Estimate(ratio, ratio * spread, number)
        error = math.hypot(kappa.stderr / kappa.value, spread)
        kappa = Estimate(ratio * kappa.value, ratio * kappa.value * error, number)
    return {"coefficient": kappa} | found


def passage_estimates(point, counts):
    """Return {quantity: ``Estimate``} from the ``counts`` of first passages at a ``point``."""
    pairs, moves = counts["pairs"], MOVES_PER_STEP.get(point["program"], 1)
    means = {name: counts[name][0] / pairs for name in ("first", "passage", "crossings")}
    squares = {name: counts[name][1] / pairs for name in means}

    def time(name):
        error = math.sqrt((squares[name] - means[name] ** 2) / (pairs - 1))
        return Estimate(means[name] / moves, error / moves, pairs)

    passage = time("passage")
    own = crossing_rate(point["step"], 2.0 ** -point["halvings"])
    kappa = 1 / (own * passage.value)
    ratio = means["crossings"] / means["passage"]
    spread = (
        squares["crossings"]
        - 2 * ratio * counts["passage*crossings"] / pairs
        + ratio**2 * squares["passage"]
    )
    error = math.sqrt(spread / (pairs - 1)) / means["passage"]
    return {
        "coefficient": Estimate(kappa, kappa * passage.stderr / passage.value, pairs),
        "passage_time": passage,
        "first_time": time("first"),
        "crossing_rate": Estimate(ratio * moves / own, error * moves / own, pairs),
    }


#: {method: (counts of a sample at a point, function of a point and its counts)}.
METHODS = {
    "crossings": (crossing_counts, crossing_estimates),
    "passages": (passage_counts, passage_estimates),
}


def counted(seeds, **groups):
    """Return {method: points}: the counts at each point of the ``groups`` of a method, by seed."""
    found = {}
    for method, (count, _) in METHODS.items():
        found[method] = [
            {"program": program, "step": step, "halvings": halvings}
            | {"seeds": [count(seed, program, step, halvings, samples) for seed in seeds]}
            for program, step, halvings, samples in points(groups[method])
        ]
    return found


def rows(counts):
    """Yield the rows of brownian_steps.csv from what ``counted`` returns."""
    known = {}
    for method, (_, estimates) in METHODS.items():
        for point in counts[method]:
            program, step, halvings = (point[name] for name in ("program", "step", "halvings"))
            start = {"program": program, "step": step, "room": 2.0**-halvings, "method": method}
            start["neck"] = neck(step, halvings)
            seeds = [estimates(point, one) for one in point["seeds"]]
            both = joined(point["seeds"])
            for quantity, found in estimates(point, both).items():
                cells = start | {"quantity": quantity}
                if quantity == "coefficient":
                    cells["diffusive"] = diffusive(step, start["room"], program)
                if quantity == "first_time":
                    cells["diffusive"] = first_passage(step, start["room"])
                place = (program, step, halvings, quantity)
                reference = _reference(known, *place)
                if reference is not None:
                    cells |= compared(found, reference)
                    del cells["test"]
                if quantity == "coefficient" and method == "crossings":
                    known[place] = found
                if len(seeds) == 2:
                    one, other = (seed[quantity] for seed in seeds)
                    cells["seeds_z"] = compared(one, other)["z"]
                steps = both["passage"][0] if method == "passages" else both["steps"]
                yield row(cells, found, samples=found.n, steps=steps)
    yield from exponents(counts)


def _reference(known, program, step, halvings, quantity):
    """Return what a quantity is compared with: an ``Estimate``, or None, as in a wide channel."""
    if 2.0**-halvings > COMPARED_ROOM:
        return None
    if quantity == "crossing_rate" and program == "reflected":
        return Estimate(1.0, 0.0, 1)
    if program == "kicked":
        program = "reflected"
    return known.get((program, step, halvings, quantity))


def exponents(counts):
    """Yield the rows of exponents of times, as powers of ε.

    They are those of the time between passages over V, and of the first crossing from far apart as
    it is. Local exponents are between neighbouring widths of the neck, of all seeds together.
    Fitted ones are of reflected discs, for each seed and for all seeds.
    """
    for method, (_, estimates) in METHODS.items():
        for (program, step), group in groupby(
            counts[method], key=operator.itemgetter("program", "step")
        ):
            own = sorted(group, key=operator.itemgetter("halvings"))
            start = {"program": program, "step": step, "method": method}
            found = [(point, estimates(point, joined(point["seeds"]))) for point in own]
            for quantity, time in EXPONENTS[method].items():
                for one, other in pairwise([time(*one) for one in found]):
                    cells = start | {"room": math.sqrt(one[0] * other[0]), "quantity": quantity}
                    cells["neck"] = math.sqrt(cells["room"]) / step
                    yield _slope_row(cells, [one, other])
            if (program, method) != ("reflected", "crossings"):
                continue
            for where in (lambda x: x >= LONG_NECK_STEPS, lambda x: x <= SHORT_NECK_STEPS):
                chosen = [point for point in own if where(neck(step, point["halvings"]))]
                if len(chosen) > 2:
                    cells = start | {"quantity": "exponent"}
                    cells["room"] = 2.0 ** -chosen[-1]["halvings"]
                    cells["neck"] = neck(step, chosen[-1]["halvings"])
                    yield from _fits(cells, chosen, estimates)


def _fits(cells, chosen, estimates):
    """Yield the fitted exponents of some points: of all seeds together, and of each seed."""
    together = [_time(point, estimates(point, joined(point["seeds"]))) for point in chosen]
    seeds = [
        [_time(point, estimates(point, one)) for point, one in zip(chosen, own, strict=True)]
        for own in zip(*(point["seeds"] for point in chosen), strict=True)
    ]
    agree = {"seeds_z": compared(*map(_slope, seeds))["z"]} if len(seeds) == 2 else {}
    if cells["neck"] >= LONG_NECK_STEPS:
        slow = [(*time[:3], time[3] + math.log1p(HEIGHT_TERM * time[0])) for time in together]
        agree["reference"] = _slope(slow, column=3).value
    yield _slope_row(cells | agree, together)
    for number, times in enumerate(seeds, 1):
        yield _slope_row(cells | {"seed": number}, times)


def _time(point, found):
    """Return (ε, ln of the time between passages over V, its error, the same by diffusion)."""
    kappa, room = found["coefficient"], 2.0 ** -point["halvings"]
    time = -math.log(kappa.value * room**2)
    passed = resistance(room, point["program"], point["step"])
    return room, time, kappa.stderr / kappa.value, math.log(passed)


def _first(point, found):
    """Return (ε, ln of the time of the first crossing, its error, the same by diffusion)."""
    time, room = found["first_time"], 2.0 ** -point["halvings"]
    diffusing = math.log(first_passage(point["step"], room))
    return room, math.log(time.value), time.stderr / time.value, diffusing


#: {method: {quantity: the function of a point and its estimates whose exponent it is}}.
EXPONENTS = {
    "crossings": {"local_exponent": _time},
    "passages": {"local_exponent": _time, "first_exponent": _first},
}


def _slope(times, column=1):
    """Return the exponent of some ``times`` as an ``Estimate``."""
    rooms, errors = ([time[k] for time in times] for k in (0, 2))
    return LinearFit(np.log(rooms), [time[column] for time in times], errors).slope


def _slope_row(cells, times):
    """Return the row of the exponent of some ``times``, with that of a separation that diffuses."""
    diffusing = _slope(times, column=3).value
    return row(cells, _slope(times), samples=len(times), diffusive=diffusing)
