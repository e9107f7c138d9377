"""Results of simulations and samples beside the exact values: objects that print themselves.

Their numbers are those of the rows of the tables, made by the same functions.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from twodiscs.comparison.estimates import (
    MIN_EVENTS,
    density_of_chains_at_zero,
    normal_quantile,
)
from twodiscs.comparison.measured.progress import progress_bar
from twodiscs.comparison.measured.result import Result
from twodiscs.comparison.tables.exact import Theory
from twodiscs.comparison.tables.hop_histogram import HopHistogram
from twodiscs.comparison.tables.mean_times import MeanTimes
from twodiscs.comparison.tables.monte_carlo import Areas, Volume
from twodiscs.model.box import Box
from twodiscs.model.checks import (
    LARGEST_INTEGER,
    InputError,
    check_choice,
    check_count,
    check_error,
    check_fraction,
    quote,
)
from twodiscs.model.events import EVENTS, HOPS
from twodiscs.model.radii import key, stream_seed
from twodiscs.model.scene import Scene, check_scene
from twodiscs.theory import tails

if TYPE_CHECKING:
    import pandas as pd

#: Bins resolve how the density of intervals begins if a pair of discs has no more wall hits and
#: collisions in one. At .23 to .39 of them, extrapolations deviate by less than 0.5 % from the
#: exact density; at .43 to .77 by up to 3 %, at 1.6 by 3 %, at 4.2 by 35 %.
RESOLVED_EVENTS = 0.4

#: The columns that people read, and how wide they are.
COLUMNS = {
    "quantity": 24, "estimate": 12, "± error": 10, "exact": 12, "unit": 9, "z": 7, "count": 12,
    "status": 0,
}  # fmt: skip


@dataclass(frozen=True)
class Measurement:
    """An estimate of one quantity, beside its exact value.

    ``stderr`` is the standard error; it is None where there is too little for an honest one, and
    ``value`` is None where nothing was seen. ``exact`` is None where no exact value is known,
    and where the ``status`` is impossible. ``z`` is None without an exact value or an estimate;
    otherwise it is the standard normal deviate of the estimate from what it is an estimate of: the
    exact value or, for an area, the exact ``expectation`` of its shell. Where events are few, or
    come in few clusters, there is no normal law: then z is that of an upper bound on the chance of
    such a deviation, often 0, and the ``test`` in ``frame()`` of the result says so. ``count`` is
    how many events, or hits, are behind it, and ``bound`` a lower bound on the mean time where none
    was seen. ``status`` is as in the tables. It is "too-few" without an honest error. A mean time
    needs 100 replicas and 100 effective events, of which a cluster counts once. Rough discs near a
    threshold have events in crowds; there it also needs as many initial states as show them
    (``theory.exact.replicas_needed``), which does not depend on the seed. Anything else needs 100
    hits and 100 misses: if discs are so small that all of 1048576 draws are hits, the volume has no
    error.
    """

    quantity: str
    value: float | None
    stderr: float | None
    exact: float | None
    z: float | None
    count: int
    status: str
    unit: str
    expectation: float | None = None
    bound: float | None = None

    def __post_init__(self):
        if self.value is None or self.exact is None:
            # In the tables it is then 0 where nothing was due, which is no comparison to read.
            object.__setattr__(self, "z", None)

    @property
    def relative_stderr(self) -> float | None:
        """The standard error over the size of the value, or None."""
        return self.stderr / abs(self.value) if self.stderr and self.value else None

    def interval(self, confidence: float = 0.95) -> tuple[float, float] | None:
        """Return the normal confidence interval (low, high), or None without an honest error."""
        half = normal_quantile(confidence)
        if self.stderr is None or self.value is None:
            return None
        return self.value - half * self.stderr, self.value + half * self.stderr

    def cells(self) -> tuple[str, ...]:
        """Return what people read of it, a text for each of ``COLUMNS``."""
        value, error = _with_error(self.value, self.stderr)
        if self.value is None and self.bound is not None:
            value = f"> {self.bound:.4g}"
        if self.exact is None:
            exact = "–" if self.status == "impossible" else "not known"
        else:
            exact = _with_error(self.exact, self.stderr)[0]
        z = "" if self.z is None else f"{self.z:+.2f}"
        return self.quantity, value, error, exact, self.unit, z, str(self.count), self.status

    def __str__(self) -> str:
        _, value, error, exact, unit, z, number, status = self.cells()
        compared = f", exact {exact}" + (f", z = {z}" if z else "")
        error = f" ± {error}" if error else ""
        return f"{self.quantity} = {value}{error} {unit}{compared}, {number} counted, {status}"

    __repr__ = __str__


def _with_error(value, error):
    """Return the texts of a value, as far as two digits of its error reach, and of the error."""
    if value is None:
        return "–", ""
    if not error:
        return f"{value:.8g}", ""
    digits = 2
    if value:
        digits += math.floor(math.log10(abs(value))) - math.floor(math.log10(error))
    return f"{value:.{min(max(digits, 2), 17)}g}", f"{error:.2g}"


def aligned(lines, widths):
    """Return texts in columns of these widths, wider where a text needs it, the last one open."""
    lines = [[*line] for line in lines]
    longest = [max(map(len, column)) for column in zip(*lines, strict=True)]
    widths = [max(width, needed + 1) for width, needed in zip(widths, longest, strict=True)]
    return "\n".join(
        "".join(f"{text:<{width}}" for text, width in zip(line, widths, strict=True)).rstrip()
        for line in lines
    )


class Measurements(Result, Mapping[str, Measurement]):
    """{quantity or event: ``Measurement``} of one ``scene``; prints as a table.

    ``rows`` are those of the table of its kind, as the pipeline writes it. How it was made is in
    ``kind``, ``settings`` (with the seed, and the error asked for) and ``version``.
    """

    def __init__(self, kind, scene, rows, settings, kept):
        self.kind, self.scene, self.rows = kind, scene, rows
        self.settings, self.kept = settings, kept
        self._measurements = {
            row.get("event") or row["quantity"]: _measurement(scene, row) for row in rows
        }

    def __getitem__(self, name: str) -> Measurement:
        if name not in self._measurements:
            raise KeyError(f"{quote(name)} is none of {', '.join(self)}")
        return self._measurements[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._measurements)

    def __len__(self) -> int:
        return len(self._measurements)

    def _ipython_key_completions_(self) -> list[str]:
        return list(self)

    def more(
        self,
        error: float | str | Mapping[str, float | str] | None = None,
        budget: float | None = None,
        samples: float | None = None,
        cores: int = 1,
        progress: bool | None = None,
    ) -> Measurements:
        """Return a result with a smaller ``error``, a larger ``budget``, or more ``samples``.

        It goes on from this one, and is the same, bit for bit, as one asked for in one call.
        """
        changes = {"error": error, "budget": budget, "samples": samples}
        return self._again(changes, cores, progress)

    def _repr_html_(self) -> str:
        return self._html(COLUMNS, [measurement.cells() for measurement in self.values()])

    def frame(self) -> pd.DataFrame:
        """Return the rows as a pandas ``DataFrame`` by event or quantity."""
        return _frame(self.rows, index="event" if "event" in self.rows[0] else "quantity")

    def __str__(self) -> str:
        lines = [COLUMNS, *(measurement.cells() for measurement in self.values())]
        return f"{self.scene}\n\n{aligned(lines, COLUMNS.values())}"

    __repr__ = __str__


def _measurement(scene, row):
    quantity = row.get("quantity") or f"{row['event']}_time"
    return Measurement(
        quantity,
        row["estimate"], row["stderr"], row["exact"], row["z"],
        row["count"] if "count" in row else row["hits"], row["status"], scene.unit(quantity),
        row.get("expectation"), row.get("bound"),
    )  # fmt: skip


def _frame(rows, index):
    import pandas as pd

    return pd.DataFrame(rows).set_index(index)


class Intervals(Result):
    """How the intervals between hops of one kind are distributed.

    ``mean`` and ``at_zero``, the density of short intervals, are ``Measurement``; ``edges`` (n + 1)
    and ``counts`` (n) are those of equal bins from 0, ``overflow`` intervals lie beyond, and
    ``intervals`` is how many there are. The exact density at 0 is known in plain scenes; its
    estimate is a parabola through the first two bins, so it has no z. For more than two discs it is
    a straight line, because another pair may hop next. Bins are a share of the mean interval. If
    they are wider than ``RESOLVED_EVENTS`` events of the pair, as they are near a threshold,
    ``at_zero`` has no value and the status "not-resolved". Intervals of one chain are correlated,
    so that all errors are those of the spread between chains. If discs are tiny or hardly fit, few
    long intervals make the errors skew. In four such scenes 65536 intervals gave scores with a mean
    of -0.20 and -4.2 as the worst of 1200; 262144 gave -0.08, a mean square of 0.97, and -3.8 as
    the worst of 800. Ask for that many there.
    """

    hop: str
    intervals: int
    overflow: int
    edges: list[float]
    counts: list[int]
    mean: Measurement
    at_zero: Measurement

    kind = "intervals"

    def __init__(self, scene, point, settings, kept):
        self.scene, self.hop = scene, point["event"]
        self.settings, self.kept = settings, kept
        self.intervals, self.overflow = point["intervals"], point["overflow"]
        self.rows = HopHistogram.rows(_theory(scene), {"intervals": [point]})
        self.counts = point["counts"]
        # Wide bins, which hold the same intervals once more, come after the equal ones.
        self._bins = self.rows[: len(self.counts)]
        self.edges = [row["left"] for row in self._bins] + [self._bins[-1]["right"]]
        first, z = self.rows[0], self.rows[0]["z"]
        status = "sampled" if first["mean_stderr"] else "too-few"
        self.mean = Measurement(
            f"{self.hop}_interval", point["mean"], first["mean_stderr"], first["exact_mean"], z,
            point["intervals"], status, "time",
        )  # fmt: skip
        bins = self.rows[:2]
        at_zero, spread = density_of_chains_at_zero(
            [row["density"] for row in bins], [row["stderr"] or 0.0 for row in bins],
            linear="products" in point,
        )  # fmt: skip
        few = min(self.counts[:2]) < MIN_EVENTS
        exact = None if not scene.is_plain else tails.density_at_zero(scene, self.hop)
        error, status = (None, "too-few") if few else (spread, "extrapolated")
        if _events_of_pair(scene) * bins[0]["right"] > RESOLVED_EVENTS:
            at_zero = error = None
            status = "not-resolved"
        self.at_zero = Measurement(
            "density_at_zero",
            at_zero, error, exact, None, sum(self.counts[:2]), status, "1/time",
        )  # fmt: skip

    def __hash__(self):
        return hash((self.scene, self.hop))

    def more(
        self, number: float | None = None, cores: int = 1, progress: bool | None = None
    ) -> Intervals:
        """Return ``number`` intervals, these among them, as if asked for in one call."""
        return self._again({"number": number}, cores, progress)

    def _repr_html_(self) -> str:
        return self._html(COLUMNS, [self.mean.cells(), self.at_zero.cells()])

    @property
    def density(self) -> list[float]:
        """The density of each bin, in 1/time."""
        return [row["density"] for row in self._bins]

    def frame(self) -> pd.DataFrame:
        """Return the bins as a pandas ``DataFrame``: left, right, count, density and its error."""
        names = "left", "right", "count", "density", "stderr"
        return _frame([{n: row[n] for n in names} for row in self._bins], index="left")

    def __str__(self) -> str:
        lines = [COLUMNS, self.mean.cells(), self.at_zero.cells()]
        return f"{self.scene}\n\n{aligned(lines, COLUMNS.values())}"

    __repr__ = __str__


def _events_of_pair(scene):
    """Return the wall hits and collisions per time, as many as two of the discs have."""
    from twodiscs.dynamics.counting import expected_event_rate

    return expected_event_rate(scene) * 2 / scene.discs


def _theory(scene):
    """Return the rows of theory.csv of one ``Scene``."""
    return Theory.rows(Box.of(scene), [scene.radius])


# The calls -------------------------------------------------------------------------------------


def seed_of(scene, method, seed, name):
    """Return the seed of the random streams of one job, as the pipeline derives it.

    ``name`` is that of the scene in a configuration; None stands for one that names the box.
    """
    box = Box.of(check_scene(scene)).parameters()
    if name is not None and not isinstance(name, str):
        raise InputError(f"name must be that of a scene, not {name!r}")
    return stream_seed(seed, repr(box) if name is None else name, method, key(scene.radius))


def _named(key, what, names, allowed):
    """Return some of the texts ``allowed``, in their order, or all of them for None."""
    if names is None:
        return list(allowed)
    single = isinstance(names, str | bytes | Mapping) or not isinstance(names, Iterable)
    if single or not (names := [*names]):
        raise InputError(f"{key} must be a list of some of {', '.join(allowed)}, not {names!r}")
    for name in names:
        check_choice(what, name, allowed)
    return [name for name in allowed if name in names]


def simulate(scene, error, seed, budget, events, name, cores=1, progress=None, kept=None):
    """Return the ``Measurements`` of mean times by molecular dynamics (see the face)."""
    possible = check_scene(scene).events
    if isinstance(error, Mapping) and not error:
        raise InputError(f"error must hold some of {', '.join(possible)}, not {{}}")
    if not isinstance(error, Mapping):
        errors = dict.fromkeys(possible, error)
    elif events is None:
        errors, events = error, [*error]
    else:
        errors = error
    tracked = _named("events", "event", events, possible)
    if missing := [event for event in tracked if event not in errors]:
        raise InputError(f"error must hold every event, but has none for {missing[0]}")
    target = {event: check_error("error", errors[event]) for event in tracked}
    budget, stream = check_count("budget", budget), seed_of(scene, "dynamics", seed, name)
    settings = {
        "error": target if isinstance(error, Mapping) else check_error("error", error),
        "seed": int(seed), "budget": budget, "events": tracked, "name": name,
    }  # fmt: skip
    from twodiscs.dynamics.counting import CountingRun

    kept, run = {} if kept is None else kept, CountingRun(scene, target, budget, stream)
    with progress_bar(progress, f"simulate r = {scene.radius:g}") as progress:
        point = run.run(progress, cores, kept)
    rows = MeanTimes.rows(Box.of(scene), _theory(scene), {"dynamics": [point]})
    return Measurements("simulate", scene, rows, settings, kept)


def sample(scene, samples, seed, quantities, shell, name, cores=1, progress=None, kept=None):
    """Return the ``Measurements`` of volume and areas by Monte Carlo (see the face)."""
    allowed = ("volume", *(f"{event}_area" for event in check_scene(scene).events))
    quantities = _named("quantities", "quantity", quantities, allowed)
    samples = check_count("samples", samples)
    shell, stream = check_fraction("shell", shell), seed_of(scene, "monte_carlo", seed, name)
    settings = {
        "samples": samples, "seed": int(seed), "quantities": quantities, "shell": shell,
        "name": name,
    }  # fmt: skip
    from twodiscs.sampling.montecarlo import SamplingRun
    from twodiscs.sampling.starts import require_free_fraction

    require_free_fraction(scene)
    kept, run = {} if kept is None else kept, SamplingRun(scene, quantities, samples, shell, stream)
    with progress_bar(progress, f"sample r = {scene.radius:g}") as progress:
        points = {"monte_carlo": [run.run(progress, cores, kept)]}
    theory, areas = _theory(scene), [e for e in EVENTS if f"{e}_area" in quantities]
    rows = Volume.rows(theory, points) + Areas.rows(Box.of(scene), theory, points, areas)
    # Insertions always have the volume.
    rows = [row for row in rows if row["quantity"] in quantities]
    return Measurements("sample", scene, rows, settings, kept)


def intervals(scene, hop, number, seed, name, cores=1, progress=None, kept=None):
    """Return the ``Intervals`` between hops (see the face)."""
    check_choice("hop", hop, HOPS)
    if check_scene(scene).moment_of_inertia is not None:
        raise InputError(
            "scene must have smooth discs, for rough discs in a box are not ergodic and their "
            f"intervals have no exact mean, but moment_of_inertia is {scene.moment_of_inertia!r}"
        )
    number, stream = check_count("number", number), seed_of(scene, "intervals", seed, name)
    settings = {"hop": hop, "number": number, "seed": int(seed), "name": name}
    from twodiscs.dynamics.intervals import IntervalRun

    kept, run = {} if kept is None else kept, IntervalRun(scene, hop, number, stream)
    with progress_bar(progress, f"intervals r = {scene.radius:g}") as progress:
        point = run.run(progress, cores, kept)
    return Intervals(scene, point, settings, kept)


def starts(scene, number, seed, name, progress=None):
    """Return states of the invariant measure, an array with named columns (see the face)."""
    number = check_count("number", number, most=10**8)
    seed = seed_of(scene, "trajectory", seed, name)
    from twodiscs.sampling.starts import records

    with progress_bar(progress, f"starts r = {scene.radius:g}") as progress:
        return records(scene, number, seed, progress)


def exact_table(width, height, radii, effects):
    """Return the exact numbers over radii as a ``DataFrame`` (see the face)."""
    import pandas as pd

    box = box_with(width, height, effects)
    scenes = scenes_of(box, radii)
    rows = [
        {
            "radius": scene.radius,
            "regime": scene.regime,
            "ergodic_components": scene.ergodic_components,
            **{row["quantity"]: row["exact"] for row in Theory.rows(box, [scene.radius])},
        }
        for scene in scenes
    ]
    frame = pd.DataFrame(rows).set_index("radius")
    parts = [scene.ergodic_components for scene in scenes]
    if any(part is None or part > LARGEST_INTEGER for part in parts):
        frame["ergodic_components"] = pd.Series(parts, frame.index, object)
    times = [f"{event}_time" for event in EVENTS]
    known = ["volume", *(f"{event}_area" for event in EVENTS), *times]
    frame[known] = frame[known].astype(float)
    frame.attrs["box"] = box
    return frame


def box_with(width, height, effects):
    """Return the ``Box`` of sides, effects and ``discs``, which may be among the ``effects``."""
    if not isinstance(effects, dict) or "discs" not in effects:
        return Box(width, height, effects)
    rest = {name: value for name, value in effects.items() if name != "discs"}
    return Box(width, height, rest, effects["discs"])


def scenes_of(box, radii):
    """Return the scenes of a ``Box`` at some ``radii``."""
    if isinstance(radii, str | bytes | Mapping) or not isinstance(radii, Iterable):
        raise InputError(f"radii must be a list of numbers, not {quote(radii)}")
    scenes = [box.scene(radius) for radius in radii]
    if not scenes:
        raise InputError("radii must hold one radius at least, not none")
    return scenes


def the_scene(result):
    """Return the ``Scene`` of a result, or that of a trajectory; None for anything else."""
    attributes = getattr(result, "attrs", None)
    scene = result if isinstance(result, Scene) else getattr(result, "scene", None)
    scene = attributes.get("scene") if isinstance(attributes, dict) else scene
    return scene if isinstance(scene, Scene) else None
