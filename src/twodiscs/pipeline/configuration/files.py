"""Which files a configuration calls for, and what jobs are told: the Snakefile imports this."""

import json
import os
from hashlib import blake2b
from pathlib import Path

from twodiscs.figures.catalogue import ANIMATION, FIGURES
from twodiscs.pipeline.configuration.request import STAGES
from twodiscs.studies.catalogue import STUDIES, STUDY_FIGURES

#: The modules whose kernels scenes without effects share, by the stamp that says they are compiled.
KERNELS = {
    "montecarlo": ["sampling.montecarlo"],
    "dynamics": ["dynamics.counting", "dynamics.intervals", "dynamics.trajectory"],
}

#: The tables of a scene that are gathered from points, and the stages that found those.
GATHERED = {
    "volume": ["monte_carlo"],
    "areas": ["monte_carlo"],
    "mean_times": ["dynamics"],
    "hop_histogram": ["intervals"],
    "check": [*STAGES],
    "cost": [*STAGES],
}

#: Longer arguments go into a file: Linux takes 131072 letters in all that a shell is told.
LONG = 30_000


class Files:
    """The paths of what is built of a ``Configuration``, below its folder of results.

    Methods that return {name: path} name the tables as who reads them does.
    """

    def __init__(self, configuration, built):
        """``built`` is where they are: whoever uses the workflow as a module may prefix them."""
        self.configuration, self.folder, self.built = configuration, configuration.results, built

    def table(self, name, scene=None):
        """Return the path of a table of a ``scene``, its name, or of one that belongs to none."""
        return "/".join(filter(None, (self.folder, scene, f"{name}.csv")))

    def compiled(self, scene, stage):
        """Return the stamp that says that the kernels of a stage are compiled for a scene."""
        if scene.effects:
            return f"{self.folder}/.compiled/{scene.name}/{stage}"
        (kernels,) = (name for name, some in KERNELS.items() if STAGES[stage] in some)
        return f"{self.folder}/.compiled/{kernels}"

    def points(self, scene, table):
        """Return the bundles of points that a table of a scene is gathered from."""
        return [
            f"{self.folder}/{scene.name}/points/{stage}/bundles/{name}.json"
            for stage in GATHERED[table]
            for name in scene.bundles[stage]
        ]

    def tables(self, scene):
        """Return {name: path} of the tables that a scene calls for."""
        return {name: self.table(name, scene.name) for name in scene.tables}

    def tables_beside(self, scene, table):
        """Return {name: path} of what a table needs besides; of a forecast, if there is one."""
        if table != "cost":
            return {"theory": self.table("theory", scene.name)}
        there = os.path.exists(f"{self.built}/forecast.csv")
        return {"forecast": self.table("forecast")} if there else {}

    def figures(self, scene):
        """Return {name: (PDF, PNG)} of the figures that a scene calls for."""
        watched = scene.watch.quantities
        return {
            name: _drawn(f"{self.folder}/{scene.name}/figures/{name}")
            for name, entry in FIGURES.items()
            if entry.is_called(watched, scene.effects)
        }

    def animation(self, scene):
        """Return the files of the animation of a scene, none if the scene has no trajectory."""
        called = ANIMATION.is_called(scene.watch.quantities, scene.effects)
        return _drawn(f"{self.folder}/{scene.name}/figures/animation", "gif") if called else ()

    def study(self, name):
        """Return the tables of a study and its figures, as PDF and as PNG."""
        study = STUDIES[name]
        found = [self.table(table.name()) for table in study.tables]
        return [*found, *(_drawn(f"{self.folder}/figures/{figure}") for figure in study.figures)]

    def study_reads(self, study):
        """Return {name: path} of the tables that a study reads."""
        return {
            name: self.table(table, scene)
            for name, (scene, table) in study.reads(self.configuration).items()
        }

    def figure_reads(self, entry, scene=None):
        """Return {name: path} of the tables that a figure reads; ``scene`` is a name, or None."""
        main = self.configuration.main
        of_main = self.tables(main) if main else {}
        found = {name: self.table(name, scene) for name in entry.tables}
        return found | {name: of_main[name] for name in entry.main_tables if name in of_main}

    def manuscript(self, results):
        """Return what the manuscript needs beside what it reads in the folder ``results``.

        The hash is that of the configuration with every default filled in.
        """
        return {
            "configuration": _hash(repr(self.configuration).encode()),
            "figures": list(STUDY_FIGURES),
            "results": results,
            "scenes": [
                {
                    "figures": list(self.figures(scene)),
                    "height": scene.box.height,
                    "name": scene.name,
                    "tables": list(scene.tables),
                    "width": scene.box.width,
                }
                for scene in self.configuration.plain
            ],
            "seed": self.configuration.seed,
            "tables": shared_tables(),
        }

    def report(self):
        """Return what the report says of the scenes."""
        return {
            "scenes": [
                {
                    "box": " × ".join(f"{side:g}" for side in scene.box.sides),
                    "effects": scene.effects,
                    "height": scene.box.height,
                    "name": scene.name,
                    "width": scene.box.width,
                }
                for scene in self.configuration.scenes
            ]
        }


def _drawn(path, first="pdf"):
    return f"{path}.{first}", f"{path}.png"


def shared_tables():
    """Return the names of the tables that belong to no scene, those of all studies."""
    return [t.name() for study in STUDIES.values() if study.shared for t in study.tables]


def named_tables(names, paths):
    """Return the arguments NAME=CSV of tables.

    Paths come from the input of a job: who uses this workflow as a module may have prefixed them.
    """
    return [f"{name}={path}" for name, path in zip(names, paths, strict=True)]


def figure_job(scene, entry):
    """Return what a figure depends on beside its tables; ``scene`` is None where none is drawn."""
    given = {"box": scene.box.parameters(), **entry.options} if scene else dict(entry.options)
    return given | ({"radius": scene.watch.trajectory} if "trajectory" in entry.tables else {})


def as_json(value):
    """Return what a job depends on as one JSON object, its keys sorted.

    For what is too long for a command line it is the @path of a file that holds the object.
    """
    text = json.dumps(dict(sorted(value.items())))
    return text if len(text) < LONG else f"@{kept(text)}"


def kept(text):
    """Return the path of a file that holds ``text``, which is named by its hash."""
    path = Path(".snakemake", "parameters", _hash(text.encode(), 16))
    if not path.exists():
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"{text}\n", encoding="utf-8", newline="\n")
    return str(path)


def contents(*paths):
    """Return a hash of files, for inputs whose time stamps may not tell that they were edited."""
    return _hash(b"".join(Path(p).read_bytes() for p in paths if os.path.exists(p)))


def _hash(content, size=8):
    return blake2b(content, digest_size=size).hexdigest()
