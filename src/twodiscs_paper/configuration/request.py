"""A configuration as classes, with every default filled in, and the files that it calls for.

The Snakefile imports this, so it must be quick.
"""

from dataclasses import dataclass, field
from functools import cached_property
from hashlib import blake2b

from twodiscs.dynamics.stages import STAGES
from twodiscs.figures.scene_figures import ANIMATION, FIGURES
from twodiscs.model.scene import Box
from twodiscs.model.seeds import key, stream_seed
from twodiscs_paper.catalogue import STUDIES
from twodiscs_paper.configuration.model import MOST_EVENTS

#: The thickness of shells in jobs that sample no area. It has no effect; as a constant it keeps an
#: edit of the configured thickness from running these jobs again.
UNUSED_SHELL = 0.5

#: The events to which studies are scaled if the main scene has no budget.
USUAL_EVENTS = 2 * 10**9


@dataclass(frozen=True)
class RequestedQuantities:
    """The quantities that a scene computes and measures; empty, ``False`` or ``None`` means not.

    ``areas`` and ``mean_times`` hold events in the order of ``EVENTS``, ``hop_histogram`` ascending
    radii, ``trajectory`` a radius.
    """

    volume: bool
    areas: tuple
    mean_times: tuple
    hop_histogram: tuple
    trajectory: float | None

    @property
    def names(self):
        """The names of all quantities: as in theory.csv, "hop_histogram" and "trajectory".

        An example is {"volume", "right_wall_area", "right_wall_time", "hop_histogram"}.
        """
        names = {f"{event}_area" for event in self.areas}
        names |= {f"{event}_time" for event in self.mean_times}
        names |= {n for n in ("volume", "hop_histogram", "trajectory") if getattr(self, n)}
        return frozenset(names)


@dataclass(frozen=True)
class SceneRequest:
    """One scene of the configuration.

    ``radii`` ascend. ``monte_carlo``, ``dynamics`` and ``histogram`` are the settings of the
    stages, blocks of the configuration. The key of a radius names its jobs.
    """

    name: str
    box: Box
    radii: tuple
    quantities: RequestedQuantities
    monte_carlo: dict
    dynamics: dict
    histogram: dict
    seed: int
    shard_events: int

    @property
    def effects(self):
        """All that differs from two equal, smooth discs between walls, {name: value}.

        These are the effects, and ``discs`` if there are more than two.
        """
        return self.box.options

    @property
    def event_budget(self):
        """The most events that the simulation of one radius may spend."""
        return self.dynamics["event_budget"]

    @cached_property
    def keys(self):
        """{stage: {key: radius}} of all jobs."""
        quantities = self.quantities
        radii = {
            "monte_carlo": self.radii if quantities.volume or quantities.areas else (),
            "dynamics": self.radii if quantities.mean_times else (),
            "intervals": quantities.hop_histogram,
        }
        return {stage: {key(radius): radius for radius in radii[stage]} for stage in STAGES}

    def exact_radii(self, table):
        """Return the radii of a table of exact values; theory.csv also has radii of histograms."""
        return sorted({*self.radii, *(self.quantities.hop_histogram if table == "theory" else ())})

    @cached_property
    def tables(self):
        """The names of the tables of the scene."""
        jobs = any(self.keys.values())
        measured = {
            "volume": self.quantities.volume,
            "areas": self.quantities.areas,
            "mean_times": self.quantities.mean_times,
            "hop_histogram": self.quantities.hop_histogram,
            "trajectory": self.quantities.trajectory,
            "check": jobs,
            "cost": jobs,
        }
        return ("grid", "theory", *(name for name, called in measured.items() if called))

    @property
    def sampled(self):
        """The quantities that Monte Carlo samples: the volume, and areas of events."""
        areas = [f"{event}_area" for event in self.quantities.areas]
        return ["volume"] * self.quantities.volume + areas

    @property
    def shell(self):
        """The thickness of the shells with which Monte Carlo measures areas."""
        return self.monte_carlo["shell"] if self.quantities.areas else UNUSED_SHELL

    @property
    def target(self):
        """{event: requested relative standard error} of the mean times."""
        return self.dynamics["accuracy"]

    def arguments(self, stage):
        """Return the arguments of the function of the face that does the work of a ``stage``.

        With the scene they are all that a job depends on.
        """
        sampling = self.monte_carlo | {"quantities": self.sampled, "shell": self.shell}
        settings = {
            "monte_carlo": dict(sorted(sampling.items())),
            "dynamics": {"error": self.target, "budget": self.event_budget},
            "intervals": {
                "hop": self.histogram["event"],
                "number": self.histogram["intervals"],
                "budget": self.histogram["event_budget"],
            },
        }
        return settings[stage] | {"seed": self.seed, "name": self.name}

    def shard_arguments(self, stage):
        """Return ``arguments`` of a shard, which does not depend on accuracy and budgets."""
        constant = {
            "monte_carlo": {"samples": 1},
            "dynamics": {"error": dict.fromkeys(self.target, 0.5), "budget": 1},
            "intervals": {"number": 1, "budget": MOST_EVENTS},
        }
        return self.arguments(stage) | constant[stage]

    @property
    def trajectory_seed(self):
        """The seed of the random streams of the trajectory."""
        return stream_seed(self.seed, self.name, "trajectory", key(self.quantities.trajectory))


@dataclass(frozen=True)
class Configuration:
    """A whole configuration: the folder of results, the root seed and the scenes in their order.

    ``accuracy_cost`` is the block of this name. ``shared`` names the documents and studies that are
    built once, in the order of the schema, with all that the manuscript reads. ``effect_scenes``
    are the scenes of the study of effects; they do not depend on ``scenes``.

    Methods return the paths of files below ``results``, and take the folder of a scene. If a method
    returns {name: path}, the reader of the tables uses these names.
    """

    results: str
    seed: int
    shared: tuple
    scenes: tuple
    accuracy_cost: dict = field(default_factory=dict)
    effect_scenes: tuple = ()

    @property
    def plain(self):
        """The scenes without effects."""
        return tuple(scene for scene in self.scenes if not scene.effects)

    @property
    def main(self):
        """The first scene without effects, or None."""
        return next(iter(self.plain), None)

    @property
    def study_events(self):
        """The events to which studies are scaled: the budget of the main scene, or the usual."""
        return self.main.event_budget or USUAL_EVENTS

    @cached_property
    def folders(self):
        """The scenes by the folders of their files, {folder: ``SceneRequest``}."""
        folders = {scene.name: scene for scene in self.scenes}
        return folders | {f"effects/{scene.name}": scene for scene in self.effect_scenes}

    def table(self, name, scene=None):
        """Return the path of a table of a ``scene``, or without a scene of a study."""
        return "/".join(filter(None, (self.results, scene, f"{name}.csv")))

    def tables(self, scene):
        """Return {name: path} of the tables of a scene."""
        return {name: self.table(name, scene) for name in self.folders[scene].tables}

    def points(self, scene, table):
        """Return {stage: paths} of the points from which a table of a scene is made."""
        return {
            stage.name: [
                f"{self.results}/{scene}/points/{stage.name}/{key}.json"
                for key in self.folders[scene].keys[stage.name]
            ]
            for stage in STAGES.values()
            if table in stage.tables
        }

    def all_points(self):
        """Return the paths of the points of all scenes of the configuration."""
        return [
            path
            for scene in self.scenes
            for paths in self.points(scene.name, "cost").values()
            for path in paths
        ]

    def checked(self):
        """Return the paths of the tables that compare simulations: of scenes and of studies."""
        scenes = [scene.name for scene in self.scenes if "check" in scene.tables]
        studies = [STUDIES[name] for name in self.shared if name in STUDIES]
        return [self.table("check", name) for name in scenes] + [
            self.table(study.tables[0].name()) for study in studies if study.checked
        ]

    def figures(self, scene):
        """Return {name: (PDF, PNG)} of the figures of a scene."""
        request = self.folders[scene]
        return {
            name: _pictures(f"{self.results}/{scene}/figures/{name}")
            for name, entry in FIGURES.items()
            if entry.shown_for(request.quantities.names, request.effects)
        }

    def shown(self, scene):
        """Return the files of the figures of a scene that a report on it shows.

        Drawings show the sides of a box only. They are built for the manuscript, or by name.
        """
        drawings = "paper" in self.shared
        return [
            files for name, files in self.figures(scene).items() if drawings or FIGURES[name].needs
        ]

    def animation(self, scene):
        """Return the files of the animation of a scene, () if the scene has no trajectory."""
        request = self.folders[scene]
        called = ANIMATION.shown_for(request.quantities.names, request.effects)
        return _pictures(f"{self.results}/{scene}/figures/animation", "gif") if called else ()

    def study(self, name):
        """Return the tables of a study and its figures, as PDF and as PNG."""
        study = STUDIES[name]
        figures = (_pictures(f"{self.results}/figures/{figure}") for figure in study.figures)
        return [*(self.table(table.name()) for table in study.tables), *figures]

    def study_reads(self, study):
        """Return {name: path} of the tables that a study reads, including its own parts."""
        parts = {name: (f"parts/{study.name}", name) for name in study.parts(self)}
        return {
            name: self.table(table, scene)
            for name, (scene, table) in (parts | study.reads(self)).items()
        }

    def figure_reads(self, entry, scene=None):
        """Return {name: path} of the tables that a figure reads; ``scene`` may be None."""
        of_main = self.tables(self.main.name) if self.main else {}
        own = {name: self.table(name, scene) for name in entry.tables}
        return own | {name: of_main[name] for name in entry.main_tables if name in of_main}

    def studied(self, kind):
        """Return all "tables", or "figures" as PDF, of the studies that the manuscript reads."""
        studies = STUDIES.values()
        if kind == "tables":
            return [self.table(table.name()) for study in studies for table in study.tables]
        return [f"{self.results}/figures/{name}.pdf" for study in studies for name in study.figures]

    def printed(self):
        """Return the paths of the tables, and of the figures of scenes, of the manuscript."""
        figures = (self.figures(scene.name).values() for scene in self.plain)
        tables = (self.tables(scene.name).values() for scene in self.plain)
        drawn = [pdf for pictures in figures for pdf, _ in pictures]
        return [*drawn, *(path for paths in tables for path in paths), *self.studied("tables")]

    def configuration_hash(self):
        """Return 16 hexadecimal digits of the configuration with every default filled in."""
        return blake2b(repr(self).encode(), digest_size=8).hexdigest()

    def described(self):
        """Return the properties of the scenes that documents show."""
        return [
            {
                "name": scene.name,
                "width": scene.box.width,
                "height": scene.box.height,
                "box": " × ".join(f"{side:g}" for side in scene.box.sides),
                "effects": scene.effects,
                "event_budget": scene.event_budget,
                "detected": list(scene.target),
                "tables": list(self.tables(scene.name)),
                "figures": list(self.figures(scene.name)),
            }
            for scene in self.scenes
        ]


def _pictures(path, first="pdf"):
    return f"{path}.{first}", f"{path}.png"
