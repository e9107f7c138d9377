"""Points, rows and tables for tests, made from their classes: by simple laws, or as a test says."""

import json
import math
from contextlib import contextmanager
from functools import cached_property
from itertools import combinations_with_replacement
from pathlib import Path
from unittest.mock import patch

import numpy as np

from twodiscs.analysis import tables
from twodiscs.model.events import EVENT_AXES, EVENTS, HOPS, SHELL_EVENTS, WALLS
from twodiscs.model.scene import Box
from twodiscs.points.base import file_content, restore_arrays
from twodiscs.points.dynamics_point import DynamicsPoint
from twodiscs.points.intervals_point import Bins, IntervalsPoint
from twodiscs.points.monte_carlo_point import Hits, MonteCarloPoint
from twodiscs.sampling import montecarlo
from twodiscs.theory import exact

#: The folders of the expected tables and of the long runs.
EXPECTED, LONG_RUNS = (Path(__file__).parents[1] / "paper" / n for n in ("expected", "long_run"))

BOX = Box(1.5, 1.0)
RADII = (0.02, 0.1, 0.2, 0.24, 0.3, 0.36, 0.38)


def empty(table, **values):
    """Return a row of a ``Table`` in which only these ``values`` are not empty."""
    return dict.fromkeys(table.columns) | values


def write_rows(folder, table, names, rows, **same):
    """Write a ``table`` to a folder: of each row some columns, the others are the same or empty."""
    made = [empty(table, **same, **dict(zip(names, row, strict=True))) for row in rows]
    folder.mkdir(exist_ok=True)
    table.write(folder / f"{table.name()}.csv", made)


def of(rows, **where):
    """Return those of ``rows`` that have these values."""
    return [row for row in rows if where.items() <= row.items()]


def cells(rows, *names):
    """Return these cells of each of ``rows``."""
    return [[row.get(name) for name in names] for row in rows]


def deviation(one, other):
    """Return by how many standard errors two rows differ."""
    return abs(one["estimate"] - other["estimate"]) / math.hypot(one["stderr"], other["stderr"])


def sample_point(scene, quantities, samples, shell, seed):
    """Return the point of at least so many samples of the prism of two discs, whole blocks."""
    made = montecarlo.prism_sampler if scene.is_plain else montecarlo.weighted
    sampler = made(scene, quantities, shell, seed)
    blocks = -(-samples // sampler.block)
    return sampler.point({(0, blocks): [sampler.count(0, blocks)]})


def exact_values():
    """Return {(radius, quantity): exact value}, as theory.csv has them."""
    rows = tables.TheoryTable.rows(BOX, RADII)
    return {(row["radius"], row["quantity"]): row["exact"] for row in rows}


@contextmanager
def as_theory(values):
    """Let tables take these exact ``values``, {(radius, quantity): value}, for the right ones."""

    def of_events(kind):
        return lambda scene: {e: values.get((scene.radius, f"{e}_{kind}")) for e in EVENTS}

    fakes = {"areas": of_events("area"), "mean_times": of_events("time")}
    with patch.multiple(exact, volume=lambda s: values.get((s.radius, "volume")), **fakes):
        yield


# As a test says -------------------------------------------------------------------------------


def hits_point(radius=0.1, samples=1000, **hits):
    """Return a Monte Carlo point with some ``hits`` by quantity; the measure is 1, ε is 0.1."""
    quantities = {quantity: Hits(number, 1.0, 0.1) for quantity, number in hits.items()}
    return MonteCarloPoint(BOX.scene(radius), "monte_carlo", samples, quantities)


def counts_point(radius=0.37, event="vertical_hop", total=0, squares=0, **fields):
    """Return a dynamics point with Σ N and Σ N² of one event, and other ``fields``."""
    given = {
        **{"scene": BOX.scene(radius), "duration": 10.0, "replicas": 2048, "events": 10**6},
        **{"counts": {event: total}, "products": {f"{event}*{event}": squares}, "strips": {}},
        **{"target": {event: 3e-4}},
    }
    return DynamicsPoint(**given | fields)


def bins_point(radius=0.1, counts=(7, 5, 0), **fields):
    """Return a point of intervals of the vertical hop, a chain each, and other ``fields``."""
    bins = Bins([*range(len(counts) + 1)], *(list(counts) for _ in range(3)))
    given = {
        **{"scene": BOX.scene(radius), "event": "vertical_hop", "bin_width": 0.125, "overflow": 0},
        **dict.fromkeys(("intervals", "intervals_squared", "chains"), sum(counts)),
        **{"mean": 0.5, "stderr": 0.1},
        **{"equal": bins, "wide": bins},
    }
    return IntervalsPoint(**given | fields)


def all_reached(point):
    """Return whether the errors of all events of a dynamics ``point`` are those asked for."""
    estimates = {event: point.count(event).estimate() for event in point.counted}
    return all(e and e.relative_stderr <= point.target[event] for event, e in estimates.items())


def through_json(ranges):
    """Return the sums of ``ranges`` of blocks as they come back from a file."""
    content = file_content("simulate", {}, {}, {"all": {"sums": ranges}})
    return restore_arrays(json.loads(json.dumps(content))["parts"])["all"]["sums"]


# By laws ----------------------------------------------------------------------------------------


class Laws:
    """The exact numbers behind the points of one radius, computed once."""

    def __init__(self, scene, shell=0.02):
        self.scene, self.shell = scene, shell
        self.times = {e: t for e, t in exact.mean_times(scene).items() if t is not None}

    @cached_property
    def parts(self):
        """{quantity: (probability of a hit, measure, ε)} in a plain scene."""
        scene, epsilon = self.scene, self.shell * self.scene.radius
        prism = (scene.range_x * scene.range_y) ** 2
        parts = {"volume": (exact.volume(scene) / prism, prism, None)}
        for event in SHELL_EVENTS:
            measure = prism / (epsilon * (2 if event in HOPS else 1))
            expectation = exact.shell_expectation(scene, event, epsilon)
            parts[f"{event}_area"] = (expectation / measure, measure, epsilon)
        return parts

    def monte_carlo(self, rng, samples):
        """Return a Monte Carlo point; the shells are hit independently of each other."""
        found = {
            quantity: Hits(int(rng.binomial(samples, p)), measure, epsilon)
            for quantity, (p, measure, epsilon) in self.parts.items()
        }
        right, top = (found[f"{event}_area"].hits for event in ("right_wall", "top_wall"))
        share = self.parts["top_wall_area"][0]
        # Given the hits of both shells, their overlap is hypergeometric; binomial serves here.
        both = min(right, top, int(rng.binomial(right, share)))
        return MonteCarloPoint(self.scene, "monte_carlo", samples, found, both)

    def dynamics(self, rng, replicas=1024, relative=3e-4, events=EVENTS):
        """Return a dynamics point; counts are Poisson, as precise as ``relative`` or more."""
        slowest = max(self.times[event] for event in events if event in self.times)
        duration = 2 * slowest / (relative**2 * replicas)
        means = {e: self.scene.copies(e) * duration / time for e, time in self.times.items()}
        counts = {event: rng.poisson(means.get(event, 0.0), replicas) for event in events}
        if not self.scene.effects:  # as symmetry has it
            first = {}
            for wall in (event for event in events if event in WALLS):
                counts[wall] = counts[first.setdefault(EVENT_AXES[wall], wall)]
            if "any_wall" in events and len(first) == 2:
                counts["any_wall"] = sum(counts[wall] for wall in first.values())
        events = [event for event in EVENTS if event in events]
        pairs = combinations_with_replacement(events, 2)
        fields = {
            "counts": {event: int(counts[event].sum()) for event in events},
            "products": {f"{a}*{b}": int((counts[a] * counts[b]).sum()) for a, b in pairs},
            "target": dict.fromkeys(events, relative),
        }
        return counts_point(scene=self.scene, duration=duration, replicas=replicas, **fields)

    def intervals(self, rng, chains=1024, relative=3e-4):
        """Return an intervals point of the vertical hop, with exponential intervals."""
        mean = self.times["vertical_hop"]
        stderr = relative * mean
        each = int(np.ceil(relative**-2 / chains))
        width, intervals = mean / 4, each * chains
        edges = np.exp(-0.25 * np.arange(13))
        counts = rng.multinomial(intervals, [*-np.diff(edges), edges[-1]])

        def of_chains(edges, counts):
            """Return the ``Bins`` of chains that hold these counts by Poisson's law."""
            whole = [int(n) for n in counts]
            squares = [n + -(-n * n // chains) for n in whole]
            return Bins(edges, whole, squares, [n * each for n in whole])

        wide = [0, 1, 2, 4, 8, 12]
        fields = {
            **{"equal": of_chains([*range(13)], counts[:-1]), "overflow": int(counts[-1])},
            **{"wide": of_chains(wide, np.add.reduceat(counts[:-1], wide[:-1]))},
            **{"intervals": intervals, "intervals_squared": intervals * each, "chains": chains},
            **{"bin_width": width},
            **{"mean": mean + stderr * rng.standard_normal(), "stderr": stderr},
        }
        return bins_point(scene=self.scene, **fields)


#: The laws of all ``RADII``.
LAWS = [Laws(BOX.scene(radius)) for radius in RADII]


def written(folder, table, **given):
    """Return the rows that a ``table`` makes of the ``given`` arguments, written and read again."""
    path = folder / f"{table.name()}.csv"
    table.write(path, table.rows(**given))
    return table.read(path)
