"""What a configuration asks for, checked and with every default filled in."""

import math
from collections import defaultdict
from dataclasses import dataclass, field
from functools import cached_property
from hashlib import blake2b

from twodiscs.model.box import Box
from twodiscs.model.checks import InputError
from twodiscs.model.radii import key, stream_seed
from twodiscs.theory import exact

#: The stages whose jobs run once for each radius, and the module that does the work of each.
STAGES = {
    "monte_carlo": "sampling.montecarlo",
    "dynamics": "dynamics.counting",
    "intervals": "dynamics.intervals",
}

#: What a core does in a second, roughly, and the seconds of a day.
EVENTS_PER_SECOND, SAMPLES_PER_SECOND, DAY = 1e8, 3e7, 86400

#: How many times slower effects make it, and how many events must be simulated, roughly, for one
#: of those that are waited for to be counted.
SLOWER, EVENTS_EACH = 10, 20

#: A job does a bundle of points, as many as are worth a process, whose start takes a second: so
#: many seconds of work. Of more radii than ``MANY`` it does about ``BUNDLE``, the most there may
#: be: every job costs Snakemake milliseconds.
WORTH, MANY, BUNDLE = 10.0, 1000, 40

#: So many radii tell what many of them will take.
SOME = 100

#: The most events that any budget allows.
MOST_EVENTS = 10**15

#: The thickness of shells in jobs that sample no area: any will do, and so an edit of the
#: configured one does not concern them.
NO_SHELL = 0.5


@dataclass(frozen=True)
class Watch:
    """What a scene computes and measures; an empty tuple, ``False`` or ``None`` means not at all.

    ``areas`` and ``mean_times`` hold events in the order of ``EVENTS``, ``hop_histogram`` ascending
    radii, ``trajectory`` a radius.
    """

    volume: bool
    areas: tuple
    mean_times: tuple
    hop_histogram: tuple
    trajectory: float | None

    @property
    def quantities(self):
        """Everything watched, as a set of names: those of theory.csv, and the two others.

        Such as {"volume", "right_wall_area", "right_wall_time", "hop_histogram", "trajectory"}.
        """
        names = {f"{event}_area" for event in self.areas}
        names |= {f"{event}_time" for event in self.mean_times}
        names |= {n for n in ("volume", "hop_histogram", "trajectory") if getattr(self, n)}
        return frozenset(names)


@dataclass(frozen=True)
class SceneRequest:
    """One scene of the configuration.

    ``radii`` ascend. ``monte_carlo``, ``dynamics`` and ``histogram`` are the settings of the
    stages, blocks of the configuration that are handed on as they are. Methods return what one job
    depends on and nothing else, as a dict of plain values with sorted keys, so that an edit reruns
    the jobs it concerns and no other. A job for one radius is named by its key.
    """

    name: str
    box: Box
    radii: tuple
    watch: Watch
    monte_carlo: dict
    dynamics: dict
    histogram: dict
    seed: int
    shard_events: int

    @property
    def effects(self):
        """The effects of the box, {name: value}."""
        return self.box.effects

    @property
    def event_budget(self):
        """The most events that the simulation of one radius may spend."""
        return self.dynamics["event_budget"]

    @cached_property
    def keys(self):
        """{stage: {key: radius}} of the jobs that there are."""
        watch = self.watch
        radii = {
            "monte_carlo": self.radii if watch.volume or watch.areas else (),
            "dynamics": self.radii if watch.mean_times else (),
            "intervals": watch.hop_histogram,
        }
        return {stage: {key(radius): radius for radius in radii[stage]} for stage in STAGES}

    @cached_property
    def bundles(self):
        """{stage: {name: keys}} of the bundles of points: a job finds one, or merges its shards.

        Another radius joins one of them, and leaves all others as they are. What takes a job of its
        own, or is in shards, is called by its key.
        """
        found = {stage: defaultdict(list) for stage in STAGES}
        for stage, keys in self.keys.items():
            size = BUNDLE if len(keys) > MANY else min(BUNDLE, WORTH / self._seconds(stage))
            if size <= 1 or self.is_sharded(stage):
                found[stage] = {name: [name] for name in keys}
                continue
            number = 1 << max(0, round(math.log2(max(1, len(keys)) / size)))
            for name in keys:
                digits = blake2b(name.encode(), digest_size=4).digest()
                found[stage][f"{int.from_bytes(digits) % number:04d}"].append(name)
        return {stage: dict(some) for stage, some in found.items()}

    def _seconds(self, stage):
        """Return the seconds that a point of a ``stage`` takes, roughly, for no theory is asked."""
        worst = min(self.dynamics["accuracy"].values(), default=1.0)
        counted, drawn = 1 / worst / worst, self.histogram["intervals"]
        work = {
            "monte_carlo": self.monte_carlo["samples"] / SAMPLES_PER_SECOND,
            "dynamics": min(self.event_budget, EVENTS_EACH * counted) / EVENTS_PER_SECOND,
            "intervals": min(self.histogram["event_budget"], EVENTS_EACH * drawn)
            / EVENTS_PER_SECOND,
        }
        return work[stage] * (SLOWER if self.effects else 1)

    @property
    def days(self):
        """The processor time that the scene takes, roughly: in days of a usual core.

        Theory says how many events an error takes; that is looked at only where the budgets alone
        would allow for a day, and at some of many radii.
        """
        samples = self.monte_carlo["samples"] * len(self.keys["monte_carlo"])
        events = self.event_budget * len(self.keys["dynamics"])
        if events > DAY * EVENTS_PER_SECOND:
            some = self.radii[:: -(-len(self.radii) // SOME)]
            events = sum(map(self._events, some)) * len(self.radii) / len(some)
        events += sum(map(self._events_of_histogram, self.watch.hop_histogram))
        return (samples / SAMPLES_PER_SECOND + events / EVENTS_PER_SECOND) / DAY

    def _events(self, radius):
        scene = self.box.scene(radius)
        total = exact.event_rate(scene)
        needed = (
            total / exact.rate(scene, event) / error**2
            for event, error in self.dynamics["accuracy"].items()
            if scene.is_possible(event)
        )
        return min(self.event_budget, max(needed, default=0.0))

    def _events_of_histogram(self, radius):
        each = exact.events_per_interval(self.box.scene(radius), self.histogram["event"])
        return min(self.histogram["event_budget"], each * self.histogram["intervals"])

    @cached_property
    def tables(self):
        """The names of the tables that the scene calls for."""
        jobs = any(self.keys.values())
        measured = {
            "volume": self.watch.volume,
            "areas": self.watch.areas,
            "mean_times": self.watch.mean_times,
            "hop_histogram": self.watch.hop_histogram,
            "trajectory": self.watch.trajectory,
            "check": jobs,
            "cost": jobs,
        }
        return ("grid", "theory", *(name for name, called in measured.items() if called))

    def job(self, stage, key):
        """Return what the job of a ``stage`` at the radius of this ``key`` depends on.

        Raises ``InputError`` if there is no such job.
        """
        radii = self.keys[stage]
        if key not in radii:
            raise InputError(f"key must be one of {', '.join(radii) or 'none'}, not {key!r}")
        sampled = {"areas": list(self.watch.areas), "volume": self.watch.volume}
        settings = {
            "monte_carlo": self.monte_carlo
            | sampled
            | ({} if self.watch.areas else {"shell": NO_SHELL}),
            "dynamics": self.dynamics,
            "intervals": self.histogram,
        }
        seed = stream_seed(self.seed, self.name, stage, key)
        return self._sorted(**settings[stage], radius=radii[key], seed=seed)

    def is_sharded(self, stage):
        """Say whether the jobs of a ``stage`` may be too much for one, and are cut into shards."""
        most = {
            "monte_carlo": [self.monte_carlo["samples"]],
            "dynamics": [self.event_budget],
            "intervals": map(self._events_of_histogram, self.watch.hop_histogram),
        }
        return max(most[stage], default=0) > self.shard_events

    def minutes(self, stage, bundle=None):
        """Return how long a job of a ``stage`` may take, a shard or a bundle of it, in minutes.

        That is several times what it takes on a usual core; effects make all of it slower.
        """
        most = {
            "monte_carlo": self.monte_carlo["samples"] / SAMPLES_PER_SECOND,
            "dynamics": self.event_budget / EVENTS_PER_SECOND,
            "intervals": self.histogram["event_budget"] / EVENTS_PER_SECOND,
        }
        speed = SAMPLES_PER_SECOND if stage == "monte_carlo" else EVENTS_PER_SECOND
        points = len(self.bundles[stage].get(bundle, ())) or 1
        seconds = points * min(most[stage], self.shard_events / speed)
        return math.ceil(10 + seconds / 60 * 4 * (SLOWER if self.effects else 1))

    def bundle_job(self, stage, name):
        """Return what each job of a bundle depends on; raise ``InputError`` if there is none."""
        if name not in self.bundles[stage]:
            raise InputError(f"bundle must be one of those of {stage}, not {name!r}")
        return {"jobs": {one: self.job(stage, one) for one in self.bundles[stage][name]}}

    def shard_job(self, stage, key, part, first, stop):
        """Return what a shard depends on: neither the accuracy asked for nor the budget."""
        given = self.job(stage, key)
        whatever = {
            "monte_carlo": {"samples": 1},
            "dynamics": {
                "accuracy": dict.fromkeys(given.get("accuracy", ()), 0.5),
                "event_budget": 1,
            },
            "intervals": {"intervals": 1, "event_budget": MOST_EVENTS},
        }
        return given | whatever[stage] | {"part": part, "first": first, "stop": stop}

    def plan_job(self, stage, keys):
        """Return what a plan of the shards of a ``stage`` depends on; ``keys`` are those known."""
        jobs = {key: self.job(stage, key) for key in self.keys[stage]}
        return {"jobs": jobs, "keys": keys, "shard_events": self.shard_events}

    def kernels(self, stage):
        """Return what the compiled code of a ``stage`` depends on, as all of its jobs do too."""
        watched = {
            "monte_carlo": {"areas": list(self.watch.areas), "volume": self.watch.volume},
            "dynamics": {"events": list(self.watch.mean_times)},
            "intervals": {"event": self.histogram["event"]},
        }
        return self._sorted(**watched[stage])

    def exact_job(self, table):
        """Return the box and the radii of a table: in theory.csv are those of histograms, too."""
        more = self.watch.hop_histogram if table == "theory" else ()
        return self._sorted(radii=sorted({*self.radii, *more}))

    def trajectory_job(self):
        """Return box, radius and seed; raise ``InputError`` if no trajectory is watched."""
        radius = self.watch.trajectory
        if radius is None:
            raise InputError(f"scene {self.name} watches no trajectory")
        return self._sorted(
            radius=radius, seed=stream_seed(self.seed, self.name, "trajectory", key(radius))
        )

    def table_job(self, stages):
        """Return what a table of the points of these ``stages`` depends on, beside the points."""
        keys = {stage: list(self.keys[stage]) for stage in stages if self.keys[stage]}
        return self._sorted(keys=keys, watched=list(self.watch.areas))

    def _sorted(self, **more):
        return dict(sorted({"box": self.box.parameters(), **more}.items()))


@dataclass(frozen=True)
class Configuration:
    """A whole configuration: the folder of results, the root seed and the scenes in their order.

    ``accuracy_cost`` is the block of this name, and ``shared`` names what is built once, in the
    order of the schema, with all that the manuscript reads.
    """

    results: str
    seed: int
    shared: tuple
    scenes: tuple
    accuracy_cost: dict = field(default_factory=dict)

    @property
    def days(self):
        """The processor time that the scenes take, roughly, in days of a usual core."""
        return sum(scene.days for scene in self.scenes)

    @property
    def plain(self):
        """The scenes without effects."""
        return tuple(scene for scene in self.scenes if not scene.effects)

    @property
    def main(self):
        """The first scene without effects, or None."""
        return next(iter(self.plain), None)

    def scene(self, name):
        """Return the scene called ``name``, or raise ``InputError``."""
        for scene in self.scenes:
            if scene.name == name:
                return scene
        names = ", ".join(scene.name for scene in self.scenes)
        raise InputError(f"name must be one of {names}, not {name!r}")
