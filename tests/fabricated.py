"""Points as the jobs write them, drawn from the exact theory by simple laws."""

import json
import math
from functools import cached_property

import numpy as np

from twodiscs.arguments import run
from twodiscs.comparison.tables.exact import Theory
from twodiscs.model.box import Box
from twodiscs.model.events import AXIS, EVENTS, HOPS, SHELLS, WALLS
from twodiscs.theory import exact

BOX = Box(1.5, 1.0)
RADII = (0.02, 0.1, 0.2, 0.24, 0.3, 0.36, 0.38)


def scenes(radii=RADII):
    return [BOX.scene(radius) for radius in radii]


def theory_rows(radii=RADII):
    """Return the rows of theory.csv."""
    return Theory.rows(BOX, radii)


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
        for event in SHELLS:
            measure = prism / (epsilon * (2 if event in HOPS else 1))
            expectation = exact.shell_expectation(scene, event, epsilon)
            parts[f"{event}_area"] = (expectation / measure, measure, epsilon)
        return parts

    def monte_carlo(self, rng, samples):
        """Return a Monte Carlo point; the shells are hit independently of each other."""
        found = {
            quantity: {
                "hits": int(rng.binomial(samples, p)),
                "measure": measure,
                "epsilon": epsilon,
            }
            for quantity, (p, measure, epsilon) in self.parts.items()
        }
        right, top = (found[f"{event}_area"]["hits"] for event in ("right_wall", "top_wall"))
        share = self.parts["top_wall_area"][0]
        # Given the hits of both shells, their overlap is hypergeometric; binomial serves here.
        both = min(right, top, int(rng.binomial(right, share)))
        return {
            "radius": self.scene.radius,
            "method": "monte_carlo",
            "samples": samples,
            "quantities": found,
            "right_and_top": both,
        }

    def dynamics(self, rng, replicas=1024, relative=3e-4, events=EVENTS):
        """Return a dynamics point; counts are Poisson, as precise as ``relative`` or more."""
        slowest = max(self.times[event] for event in events if event in self.times)
        duration = 2 * slowest / (relative**2 * replicas)
        counts = {}
        for event in events:
            mean = 0.0
            if event in self.times:
                mean = self.scene.multiplicity(event) * duration / self.times[event]
            counts[event] = rng.poisson(mean, replicas)
        if not self.scene.has_effects:  # as symmetry has it
            first = {}
            for wall in (event for event in events if event in WALLS):
                counts[wall] = counts[first.setdefault(AXIS[wall], wall)]
            if "any_wall" in events and len(first) == 2:
                counts["any_wall"] = sum(counts[wall] for wall in first.values())
        return {
            "radius": self.scene.radius,
            "duration": duration,
            "replicas": replicas,
            "rounds": 1,
            "events": 10**6,
            "counts": {event: int(counts[event].sum()) for event in events},
            "products": {
                f"{a}*{b}": int((counts[a] * counts[b]).sum())
                for i, a in enumerate(events)
                for b in events[i:]
            },
            "target": dict.fromkeys(events, relative),
            "status": {e: "reached" if e in self.times else "impossible" for e in events},
            "strips": {},
        }

    def intervals(self, rng, chains=1024, relative=3e-4):
        """Return an intervals point of the vertical hop, with exponential intervals."""
        mean = self.times["vertical_hop"]
        stderr = relative * mean
        width, intervals = mean / 4, math.ceil(relative**-2)
        edges = np.exp(-0.25 * np.arange(13))
        counts = rng.multinomial(intervals, [*-np.diff(edges), edges[-1]])

        def of_chains(counts):
            """Return counts and sums of squares of chains that hold them by Poisson's law."""
            whole = [int(n) for n in counts]
            return {"counts": whole, "squares": [n + -(-n * n // chains) for n in whole]}

        wide = [0, 1, 2, 4, 8, 12]
        return {
            "radius": self.scene.radius,
            "event": "vertical_hop",
            "bin_width": width,
            **of_chains(counts[:-1]),
            "wide": {"edges": wide, **of_chains(np.add.reduceat(counts[:-1], wide[:-1]))},
            "overflow": int(counts[-1]),
            "intervals": intervals,
            "chains": chains,
            "mean": mean + stderr * rng.standard_normal(),
            "stderr": stderr,
        }


def command(monkeypatch, module, *arguments):
    """Run the ``main`` of a ``module`` in this process and return its exit status.

    ``arguments`` are those of the command line; a dict is spelled as JSON.
    """
    words = [json.dumps(a) if isinstance(a, dict) else str(a) for a in arguments]
    with monkeypatch.context() as patch:
        patch.setattr("sys.argv", [module.__name__, *words])
        try:
            run(module.main)
        except SystemExit as leave:
            return leave.code or 0


def written(folder, table, **given):
    """Return the rows that a ``table`` makes of what is ``given``, written and read again."""
    path = folder / f"{table.name()}.csv"
    table.write(path, table.rows(**given))
    return table.read(path)
