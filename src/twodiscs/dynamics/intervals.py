"""Intervals between hops, each of them an exact draw.

Chains start on the surface of a hop, weighted by the flux through it, and record the next returns.
No interval is cut off by a window. Chains of more than two discs start in the invariant measure,
and record to their end all intervals that begin within a window of time. This has no bias: by
Palm's formula, the mean sum of these intervals over their mean number is the mean interval.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from twodiscs.dynamics.ensemble import RETURNS, nearest_power_of_two
from twodiscs.model.checks import InputError, check_choice, check_integer
from twodiscs.model.events import HOPS
from twodiscs.model.scene import Scene, check_scene, why_absent
from twodiscs.points.intervals import BINS, GRAIN, IntervalsPoint, wide_edges
from twodiscs.sampling.blocks.rounds import all_in_rounds, fixed
from twodiscs.sampling.starts import require_room

#: Chains that share a stream.
CHAINS = 256

#: The usual budget of wall and disc events.
BUDGET = 10**11


def chains_of(scene):
    """Return the module that records the intervals of a ``Scene``: of two discs, or of many."""
    if scene.discs > 2:
        from twodiscs.dynamics.many import experiments as chains
    else:
        from twodiscs.dynamics.two import returns as chains
    return chains


def recorded(scene, event, blocks, chains, returns, seed, first=0, going=None):
    """Return (times of the chains, sums in bins) of a number of ``blocks``, from the ``first`` on.

    Each block has ``chains`` chains of ``returns`` intervals, see ``record_intervals``.
    ``going`` is an array to stop it with.
    """
    edges = wide_edges()
    # Intervals beyond all bins, or in the last ones that fill no wide bin, have no wide bin.
    beyond = BINS + len(edges)
    wide = np.full(BINS + 1, beyond)
    wide[: edges[-1]] = BINS + np.repeat(np.arange(1, len(edges)), np.diff(edges))
    sums = np.zeros((chains_of(scene).INTERVAL_SUMS, beyond + 1), np.int64)
    going, bins = np.ones(1, np.bool_) if going is None else going, (_width(scene, event), wide)
    record = chains_of(scene).record_intervals
    stop = first + blocks
    return record(scene, event, seed, first, stop, chains, returns, bins, sums, going), sums


def _mean(scene, event):
    return chains_of(scene).mean_interval(scene, event)


def hop_intervals(scene, event, intervals, seed, budget=BUDGET):
    """Draw intervals between hops of one kind, each one exact, and count them in bins.

    ``event`` is a hop that the ``Scene`` allows; ``intervals`` is the least number of intervals,
    within the ``budget`` of wall and disc events. Chains of ``RETURNS`` successive intervals start
    on the hop's surface with the flux-weighted measure. The map from hop to hop preserves it, so
    every interval of a chain has the law of the interval between hops. Intervals within a chain are
    correlated, chains are independent.

    Returns an ``IntervalsPoint``, whose bins have a power of two near τ/16 as width. Chains of more
    than two discs differ in their number of intervals. Raises ``InputError`` for a hop that is
    unknown or blocked, for one whose mean time is not known, or for a number out of range.
    """
    return IntervalRun(scene, event, intervals, seed, budget).run()


@dataclass(frozen=True)
class IntervalRun:
    """``hop_intervals`` in blocks, with checked arguments."""

    scene: Scene
    event: str
    intervals: int
    seed: int
    budget: int = BUDGET

    def __post_init__(self):
        scene = check_scene(self.scene)
        check_choice("event", self.event, HOPS)
        if not scene.is_possible(self.event):
            why = why_absent(scene, self.event) or f" is blocked at radius {scene.radius!r}"
            raise InputError(f"event {self.event!r} has no intervals{why}")
        check_integer("seed", self.seed, 0)
        check_integer("budget", self.budget)
        check_integer("intervals", self.intervals)
        require_room(scene)
        if not self._blocks:
            raise InputError(
                f"budget must allow for {self._each} intervals, at radius {scene.radius!r} "
                f"of {self._events:.2g} events each, not {self.budget!r}"
            )

    @property
    def _events(self):
        return chains_of(self.scene).events_per_interval(self.scene, self.event)

    @property
    def _each(self):
        """The number of intervals of a block."""
        return CHAINS * chains_of(self.scene).intervals_of_chain(self.scene, self.event)

    @property
    def _blocks(self):
        wanted = -(-self.intervals // self._each)
        return min(wanted, int(self.budget / (self._each * self._events)))

    @property
    def _grain(self):
        """The unit in which the times of chains are integers, the finest that doubles have."""
        return _width(self.scene, self.event) * GRAIN

    @cached_property
    def _going(self):
        """A flag that long kernels read: false when no thread waits for their result."""
        return np.ones(1, np.bool_)

    @cached_property
    def parts(self):
        """The ``SequentialRun`` of all blocks, {"all": run}.

        Sums are the sums of ``record_intervals``, and Σ t and Σ t² over the times of chains, in
        grains. Chains of more than two discs differ in their number n of intervals. They also have
        Σ t n, Σ n and Σ n².
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

        ratio = chains_of(self.scene).interval_cost(self.scene)
        return {"all": fixed(work, self._blocks, self._each * self._events, ratio)}

    def point(self, pieces):
        """Return the ``IntervalsPoint``, given {"all": pieces}."""
        part = {
            "event": self.event,
            "bin_width": _width(self.scene, self.event),
            "chains": CHAINS,
            "returns": RETURNS,
            "sums": pieces["all"],
        }
        return IntervalsPoint.of(self.scene.radius, {"all": part})

    def run(self, progress=None, cores=1, kept=None):
        """Do all work in this process and return the ``IntervalsPoint``.

        ``kept`` are the parts of an earlier run, which are not done again (see ``all_in_rounds``).
        """
        try:
            return self.point(all_in_rounds(self.parts, progress, cores, kept))
        except BaseException:
            self._going[0] = False
            raise


def _width(scene, event):
    return nearest_power_of_two(_mean(scene, event) / 16)
