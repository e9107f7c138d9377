"""Which files a configuration calls for: the Snakefile imports this."""

import shlex
from hashlib import blake2b

from twodiscs.figures.catalogue import ANIMATION, FIGURES
from twodiscs_paper.catalogue import STUDIES
from twodiscs_paper.pipeline.configuration.request import STAGES

#: The tables of a scene that are made of points, and the stages of these points.
GATHERED = {
    "volume": ["monte_carlo"],
    "areas": ["monte_carlo"],
    "mean_times": ["dynamics"],
    "hop_histogram": ["intervals"],
    "check": [*STAGES],
    "cost": [*STAGES],
}


class Files:
    """The paths of all files of a ``Configuration``, below its folder of results.

    ``scenes`` are {folder: ``SceneRequest``}; methods take the folder of a scene. If a method
    returns {name: path}, the reader of the tables uses these names.
    """

    def __init__(self, configuration, scenes):
        self.configuration, self.scenes = configuration, scenes
        self.folder = configuration.results

    def table(self, name, scene=None):
        """Return the path of a table of a ``scene``, or without a scene of a shared table."""
        return "/".join(filter(None, (self.folder, scene, f"{name}.csv")))

    def tables(self, scene):
        """Return {name: path} of the tables of a scene."""
        return {name: self.table(name, scene) for name in self.scenes[scene].tables}

    def points(self, scene, table, stage):
        """Return the paths of the points of a ``stage`` from which a table of a scene is made."""
        keys = self.scenes[scene].keys[stage] if stage in GATHERED[table] else ()
        return [f"{self.folder}/{scene}/points/{stage}/{key}.json" for key in keys]

    def figures(self, scene):
        """Return {name: (PDF, PNG)} of the figures of a scene."""
        request = self.scenes[scene]
        return {
            name: _pictures(f"{self.folder}/{scene}/figures/{name}")
            for name, entry in FIGURES.items()
            if entry.is_called(request.quantities.names, request.effects)
        }

    def shown(self, scene):
        """Return the files of the figures of a scene that a report on it shows.

        Drawings show the sides of a box only. They are built for the manuscript, or by name.
        """
        drawings = "paper" in self.configuration.shared
        return [
            files for name, files in self.figures(scene).items() if drawings or FIGURES[name].needs
        ]

    def animation(self, scene):
        """Return the files of the animation of a scene, () if the scene has no trajectory."""
        request = self.scenes[scene]
        called = ANIMATION.is_called(request.quantities.names, request.effects)
        return _pictures(f"{self.folder}/{scene}/figures/animation", "gif") if called else ()

    def study(self, name):
        """Return the tables of a study and its figures, as PDF and as PNG."""
        study = STUDIES[name]
        tables = [self.table(table.name()) for table in study.tables]
        return [
            *tables,
            *(_pictures(f"{self.folder}/figures/{figure}") for figure in study.figures),
        ]

    def study_reads(self, study):
        """Return {name: path} of the tables that a study reads, including its own parts."""
        parts = {name: (f"parts/{study.name}", name) for name in study.parts(self.configuration)}
        return {
            name: self.table(table, scene)
            for name, (scene, table) in (parts | study.reads(self.configuration)).items()
        }

    def figure_reads(self, entry, scene=None):
        """Return {name: path} of the tables that a figure reads; ``scene`` may be None."""
        main = self.configuration.main
        of_main = self.tables(main.name) if main else {}
        own = {name: self.table(name, scene) for name in entry.tables}
        return own | {name: of_main[name] for name in entry.main_tables if name in of_main}

    def studied(self, kind):
        """Return all "tables", or "figures" as PDF, of the studies that the manuscript reads."""
        read = [study for study in STUDIES.values() if study.shared]
        if kind == "figures":
            return [f"{self.folder}/figures/{name}.pdf" for study in read for name in study.figures]
        return [self.table(table.name()) for study in read for table in study.tables]

    def configuration_hash(self):
        """Return 16 hexadecimal digits of the configuration with every default filled in."""
        return blake2b(repr(self.configuration).encode(), digest_size=8).hexdigest()

    def report(self):
        """Return the properties of the scenes that the report shows."""
        return [
            {
                "box": " × ".join(f"{side:g}" for side in scene.box.sides),
                "effects": scene.effects,
                "height": scene.box.height,
                "name": scene.name,
                "width": scene.box.width,
            }
            for scene in self.configuration.scenes
        ]


def _pictures(path, first="pdf"):
    return f"{path}.{first}", f"{path}.png"


def assigned(names, paths):
    """Return arguments NAME=PATH. Paths are the inputs of a job: a module may prefix them."""
    return [f"{name}={path}" for name, path in zip(names, paths, strict=True)]


def braced(paths):
    """Return paths in one folder as a person types them: folder/{a,b}.json; "" without paths."""
    if not paths:
        return ""
    folders, names = zip(*(str(path).rsplit("/", 1) for path in paths), strict=True)
    stems = [name.removesuffix(".json") for name in names]
    listed = f"{{{','.join(stems)}}}" if len(stems) > 1 else stems[0]
    return f"{shlex.quote(folders[0])}/{listed}.json"
