"""Intervals between hops, each of them an exact draw.

Chains start on the surface of a hop, weighted by the flux through it, and record the next returns:
no window could cut one off. Chains of more than two discs start anywhere, and record to their end
all intervals that begin within a window of time. That has no favourites: what these are in all over
how many they are is, in the mean, what an interval is (Palm's formula).
"""

import math
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import numpy as np

from twodiscs.dynamics.counting import cost_ratio, expected_event_rate
from twodiscs.dynamics.ensemble import (
    LANES,
    PASSES,
    across,
    find_events,
    nearest_power_of_two,
    new_rows,
    put_state,
    state_at,
)
from twodiscs.dynamics.law import after_event, crosses, crossing_time, law_of
from twodiscs.model.box import Box
from twodiscs.model.checks import InputError, check_choice, check_integer
from twodiscs.model.events import HOPS
from twodiscs.model.scene import Scene, check_scene
from twodiscs.sampling.blocks.rounds import all_in_rounds, fixed
from twodiscs.sampling.jit import compiled
from twodiscs.sampling.starts import COMPONENTS, origins, require_room, start_on_surface
from twodiscs.sampling.streams import open_stream
from twodiscs.theory import exact

#: Successive intervals that a chain records, chains that share a stream, bins of a histogram.
RETURNS = 256
CHAINS = 256
BINS = 512

#: The usual budget of wall and disc events.
BUDGET = 10**11

#: Wide bins are at least so much wider than their place.
GROWTH = 0.08


def wide_edges(bins=BINS):
    """Return where wide bins begin, and the last one ends, in units of the width of a bin.

    They begin at zero, and each is a bin wide or wider than ``GROWTH`` times its place.
    """
    edges = [0]
    for i in range(1, bins + 1):
        if i >= (1 + GROWTH) * edges[-1]:
            edges.append(i)
    return edges


@compiled
def record_returns(
    seed,
    first,
    stop,
    chains,
    lanes,
    returns,
    law,
    draw,
    prism,
    horizontal,
    width,
    wide,
    sums,
    going,
):
    """Run the chains of blocks ``first`` … ``stop`` − 1 for ``returns`` hops each.

    The hops are vertical ones, or horizontal ones if ``horizontal`` is True instead of None; they
    start from ``draw`` (vertical ones only), or from ``prism`` unless it is None. With c intervals
    of a chain in a bin, Σ c and Σ c² over the chains are added to ``sums`` (2, bins; int64). Bins
    are of ``width`` from 0, one for what is longer, and the wide ones, of which ``wide`` has one
    for each of the others. Returns the total time of each chain, (stop − first) × ``chains``
    doubles in order.
    """
    rows, start = new_rows(lanes, law), np.zeros((COMPONENTS, 1))
    times, codes, intervals = np.zeros(lanes), np.zeros(lanes), np.zeros(lanes)
    endless = np.full(lanes, np.inf)
    age, elapsed, left = np.zeros(lanes), np.zeros(lanes), np.zeros(lanes)
    chain, finished, lane_of = (
        np.full(lanes, -1),
        np.zeros(lanes + 1),
        np.zeros(lanes + 1, np.int64),
    )
    totals, counts = np.zeros((stop - first) * chains), np.zeros((lanes, sums.shape[1]), np.int64)
    per_width, last_bin, wanted = 1.0 / width, wide.size - 1, np.float64(returns)
    surface = 1 if horizontal is None else 0
    state = open_stream(seed, first)
    started, running = 0, 0

    while True:
        for i in range(lanes):
            if left[i] > 0.0:
                continue
            if chain[i] >= 0:
                totals[chain[i]] = elapsed[i]
                for k in range(sums.shape[1]):
                    sums[0, k] += counts[i, k]
                    sums[1, k] += counts[i, k] * counts[i, k]
                    counts[i, k] = 0
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
        if running == 0 or not going[0]:
            return totals

        for _ in range(PASSES):
            find_events(rows, endless, times, codes, law)
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
                finished[n], lane_of[n] = intervals[i], i
                n += 1 if intervals[i] >= 0.0 else 0
            for k in range(n):
                index = min(np.int64(finished[k] * per_width), last_bin)
                counts[lane_of[k], index] += 1
                counts[lane_of[k], wide[index]] += 1


def recorded(scene, event, blocks, chains, returns, seed, first=0, going=None):
    """Return (times of the chains, sums) as ``record_returns`` finds them.

    There are so many ``blocks``, from the ``first`` one on; ``going`` is an array to stop it with.
    """
    upright, horizontal = scene, None
    if event == "horizontal_hop" and scene.has_effects:
        horizontal = True
    elif event == "horizontal_hop" and scene.discs == 2:
        # That is a vertical hop of the box on its side.
        upright = Box.of(scene).turned().scene(scene.radius)
    edges = wide_edges()
    # What is longer than all bins, or is in the last ones that fill no wide bin, has no wide bin.
    beyond = BINS + len(edges)
    wide = np.full(BINS + 1, beyond)
    wide[: edges[-1]] = BINS + np.repeat(np.arange(1, len(edges)), np.diff(edges))
    sums = np.zeros((2 if scene.discs == 2 else 3, beyond + 1), np.int64)
    going = np.ones(1, np.bool_) if going is None else going
    if scene.discs > 2:
        from twodiscs.dynamics import many  # a kernel that two discs have no use for

        stop, window, bins = first + blocks, _window(scene, event), (_width(scene, event), wide)
        totals = many.run_intervals(
            scene.gas, event, seed, first, stop, chains, window, bins, sums, going
        )
        return totals, sums
    totals = record_returns(
        np.uint64(seed), first, first + blocks, chains, LANES, returns, law_of(upright),
        *origins(upright), horizontal, _width(scene, event), wide, sums, going,
    )  # fmt: skip
    return totals, sums


def _mean(scene, event):
    """Return the mean interval, of more than two discs maybe within a few per cent only."""
    if scene.discs == 2:
        return exact.mean_times(scene)[event]
    from twodiscs.dynamics import many

    if not (rate := many.expected_rates(scene).get(event)):
        raise InputError(
            f"radius {scene.radius!r} leaves {scene.discs} discs so little room that nothing is "
            f"known of the time between two events {event}"
        )
    return 1 / rate


def _window(scene, event):
    """Return a time in which ``RETURNS`` intervals of more than two discs begin, or up to twice."""
    return 2.0 ** math.ceil(math.log2(RETURNS * _mean(scene, event)))


def hop_intervals(scene, event, intervals, seed, budget=BUDGET):
    """Draw intervals between hops of one kind, each one exact, and count them in bins.

    ``event`` is a hop that the ``Scene`` allows; ``intervals`` is how many are wanted at least, as
    far as the ``budget`` of wall and disc events allows. Chains of ``RETURNS`` successive intervals
    start on the hop's surface with the flux-weighted measure, which the map from hop to hop
    preserves: so every interval of a chain has the law of the interval between hops. Intervals
    within a chain are correlated, chains are independent.

    Returns a dict for a JSON file: bin width (a power of two near τ/16), counts, overflow, the
    number of intervals and of chains, and the mean with its standard error over chains. With c
    intervals of a chain in a bin, squares are Σ c² over the chains; wide has edges (in bins),
    counts and squares of bins that widen with time. Chains of more than two discs have n intervals
    each, which differs: then products are Σ c n, and intervals_squared is Σ n². Raises
    ``InputError`` for a hop that is unknown or blocked, one of which nothing is known, or a number
    out of range.
    """
    return IntervalRun(scene, event, intervals, seed, budget).run()


@dataclass(frozen=True)
class IntervalRun:
    """``hop_intervals`` in blocks: frozen, its arguments checked."""

    scene: Scene
    event: str
    intervals: int
    seed: int
    budget: int = BUDGET

    def __post_init__(self):
        scene = check_scene(self.scene)
        check_choice("event", self.event, HOPS)
        if not scene.is_possible(self.event):
            raise InputError(
                f"event {self.event!r} is blocked at radius {scene.radius!r}: it has no intervals"
            )
        check_integer("seed", self.seed, 0)
        check_integer("budget", self.budget)
        check_integer("intervals", self.intervals)
        require_room(scene)
        if not self._blocks:
            raise InputError(
                f"budget must allow for {CHAINS * RETURNS} intervals, at radius {scene.radius!r} "
                f"of {self._events:.2g} events each, not {self.budget!r}"
            )

    @property
    def _events(self):
        if self.scene.discs == 2:
            return exact.events_per_interval(self.scene, self.event)
        # Of a chain as if it had no more than it is meant to have.
        return _window(self.scene, self.event) * expected_event_rate(self.scene) / RETURNS

    @property
    def _blocks(self):
        wanted = -(-self.intervals // (CHAINS * RETURNS))
        return min(wanted, int(self.budget / (CHAINS * RETURNS * self._events)))

    @property
    def _grain(self):
        """The unit in which the times of chains are integers: in doubles none is finer."""
        return _width(self.scene, self.event) * 2.0**-52

    @cached_property
    def _going(self):
        """What a kernel looks at that may run for long: false once nobody waits for it."""
        return np.ones(1, np.bool_)

    @cached_property
    def parts(self):
        """The ``SequentialRun`` of all blocks, {"all": run}.

        Sums are those of ``record_returns``, and Σ t, Σ t² over the times of chains, in grains; of
        more than two discs, with n intervals in a chain, Σ t n, Σ n and Σ n² besides.
        """

        def work(first, stop):
            totals, sums = recorded(
                self.scene, self.event, stop - first, CHAINS, RETURNS, self.seed, first, self._going
            )
            totals, *numbers = np.atleast_2d(totals)
            times = [int(time) for time in totals / self._grain]
            moments = [sum(times), sum(time * time for time in times)]
            for number in numbers:
                n = [int(each) for each in number]
                joint = sum(time * each for time, each in zip(times, n, strict=True))
                moments += [joint, sum(n), sum(each * each for each in n)]
            return sums, np.array(moments, object)

        ratio = 1.0 if self.scene.discs == 2 else cost_ratio(self.scene)
        return {"all": fixed(work, self._blocks, CHAINS * RETURNS * self._events, ratio)}

    def point(self, outcomes):
        """Return the dict for a JSON file, given {"all": its ``Outcome``}."""
        (sums, (total, squares, *more)), blocks = outcomes["all"][:2]
        n, total, squares = blocks * CHAINS, int(total), int(squares)
        if more:
            return self._of_windows(sums, n, total, squares, *map(int, more))
        unit = self._grain / RETURNS
        variance = (n * squares - total * total) / (n * n * (n - 1))
        mean, stderr = total / n * unit, math.sqrt(variance) * unit
        return _summary(self.scene, self.event, sums, n, mean, stderr)

    def _of_windows(self, sums, chains, total, squares, joint, intervals, intervals_squared):
        """Return the dict of more than two discs: the mean is a ratio."""
        mean = Fraction(total, intervals)
        spread = squares - 2 * mean * joint + mean**2 * intervals_squared
        stderr = math.sqrt(spread * chains / (chains - 1)) / intervals
        values = float(mean) * self._grain, stderr * self._grain
        found, products = (
            _summary(self.scene, self.event, sums[:2], chains, *values), sums[2].tolist()
        )  # fmt: skip
        found["wide"]["products"] = products[BINS + 1 : -1]
        more = {"intervals": intervals, "intervals_squared": intervals_squared}
        return found | more | {"products": products[:BINS]}

    def run(self, progress=None, cores=1, kept=None):
        """Return the dict for a JSON file, all done in this process (see ``all_in_rounds``)."""
        try:
            return self.point(all_in_rounds(self.parts, progress, cores, kept))
        except BaseException:
            self._going[0] = False
            raise


def _width(scene, event):
    return nearest_power_of_two(_mean(scene, event) / 16)


def _summary(scene, event, sums, chains, mean, stderr):
    edges, (counts, squares) = wide_edges(), sums.tolist()
    return {
        "radius": scene.radius,
        "event": event,
        "bin_width": _width(scene, event),
        "counts": counts[:BINS],
        "squares": squares[:BINS],
        "overflow": counts[BINS],
        "wide": {
            "edges": edges,
            "counts": counts[BINS + 1 : BINS + len(edges)],
            "squares": squares[BINS + 1 : BINS + len(edges)],
        },
        "intervals": chains * RETURNS,
        "chains": chains,
        "mean": mean,
        "stderr": stderr,
    }
