# Shared by all stages: the scenes, the paths of their files, and the fingerprints of the code.
import json
import shutil
import sys
from dataclasses import replace

from twodiscs.arguments import box_arguments, words
from twodiscs.comparison.scene_tables import SCENE_TABLES
from twodiscs.figures.catalogue import ANIMATION, FIGURES
from twodiscs.figures.kit.captions import Shown
from twodiscs.model.sources import fingerprint
from twodiscs_paper.catalogue import ENTRIES, STUDIES, STUDY_FIGURES
from twodiscs_paper.configuration.request import (
    GATHERED,
    STAGES,
    assigned,
    braced,
)
from twodiscs_paper.studies.effects.study import SCENES as EFFECTS
from twodiscs_paper.studies.effects.study import boxes

MAIN = CONFIGURATION.main  # the scene that the manuscript is about, if there is one

# Jobs are started as `python`; with -P it does not look for modules in the folder of the run.
found = shutil.which("python")
if os.path.dirname(found or "") != os.path.dirname(sys.executable):
    logger.warning(
        f"Jobs start as python, which is {found} here, and not {sys.executable}, which"
        " runs Snakemake: activate its environment if a job fails."
    )

# The threads of a job that measures speed: all cores, so no other job runs beside it. A report has no cores.
ALL_CORES = workflow.resource_settings.cores or 1


def source(path):
    """Return the path of a text of this workflow: in a checkout, or in the folder that Snakemake fetched.

    In a checkout the path is relative: if the checkout is moved, nothing runs again.
    """
    here = os.path.relpath(os.path.join(str(workflow.current_basedir), "../..", path))
    if os.path.exists(here):
        return local(here)  # not in a storage
    return workflow.source_path(f"../../{path}")


# The scenes of the configuration by their folders, and the scenes of the study of effects.
EFFECT_FILES = [source(f"config/scenes/{name}.yaml") for name in EFFECTS]
CONFIGURATION = replace(
    CONFIGURATION,
    effect_scenes=[
        load({"seed": CONFIGURATION.seed} | read(file)).scenes[0]
        for file in EFFECT_FILES
    ],
)
SCENES = CONFIGURATION.folders
RESULTS = CONFIGURATION.results
CONFIGURED = [scene.name for scene in CONFIGURATION.scenes]

if (days := cost.days(CONFIGURATION.scenes)) > 1:
    days = float(f"{days:.2g}")
    logger.warning(
        f"This configuration takes about {days:g} days of processor time;"
        " snakemake forecast gives a better estimate."
    )


wildcard_constraints:
    scene="|".join(SCENES),
    stage="|".join(STAGES),
    radius=r"[0-9][0-9.e+-]*",
    part="[a-z_]+",
    first="[0-9]+",
    stop="[0-9]+",


# Modules that compute nothing. A job uses only the entry of a catalogue that its parameters name. The
# other modules refuse input, read arguments, draw a bar or name sources.
NOT_COMPUTING = (
    "twodiscs.figures.catalogue",
    "twodiscs_paper.catalogue",
    "twodiscs.comparison.scene_tables",
    "twodiscs.arguments",
    "twodiscs.comparison.measured.progress",
    "twodiscs.model.checks",
    "twodiscs.model.plugins",
    "twodiscs.model.sources",
)


def code(*modules, without=()):
    """Return the fingerprint of the code that a job runs: modules, and all that they import."""
    return fingerprint(*modules, without=(*NOT_COMPUTING, *without))


def box(w):
    """Return the arguments for the box of the scene of a job."""
    scene = SCENES[w.scene] if "scene" in w.keys() else MAIN
    return box_arguments(scene.box) if scene else []


def minutes(stage=None):
    """Return the limit of time of a job of a stage, longer with each retry."""
    return lambda w, attempt: attempt * cost.minutes(SCENES[w.scene], stage or w.stage)


def shards_of(stage):
    """Return an input function: the shards of a point of a stage, none if one job does all its work."""

    def files(w):
        folder = f"{RESULTS}/{w.scene}/shards/{stage}/{w.radius}"
        pieces = cost.shards(SCENES[w.scene], stage, float(w.radius))
        return [f"{folder}/{part}-{first}-{stop}.json" for part, first, stop in pieces]

    return files


def work_of(stage):
    """Return a function of the wildcards: the arguments of the job of a stage at a radius."""
    return lambda w: words(SCENES[w.scene].arguments(stage, w.radius))


def point_code(stage=None):
    """Return a function of the wildcards: the fingerprint of the code that makes a point or a shard.

    Only the jobs of a stage import the module of the stage. Points are made without the estimates
    that follow from them.
    """

    def of_job(w):
        run = STAGES[stage or w.stage]
        others = tuple({*STAGES.values()} - {run})
        others += ("twodiscs.points.estimates",)
        return code("twodiscs_paper.pipeline.jobs.point", without=others)

    return of_job


def says(table):
    """Return the labels of a table in Snakemake's report."""
    return {"table": table.name(), "what a row says": table.meaning()}


def about(w):
    """Return the scene of a figure; for a figure without a scene the main scene, or None."""
    return SCENES[w.scene] if "scene" in w.keys() else MAIN


def origin(w):
    """Return the origin of a figure for its metadata."""
    scene = about(w)
    start = f"scene {scene.name}, " if scene else ""
    return f"{start}seed {CONFIGURATION.seed}, code {figure_code(w)}"


def radius_of(w):
    """Return the arguments for the radius of a trajectory, for figures of a trajectory."""
    has_trajectory = "trajectory" in ENTRIES[w.figure].tables
    return ["--radius", str(about(w).quantities.trajectory)] if has_trajectory else []


def figure_code(w):
    """Return the fingerprint of the code that draws a figure."""
    return code(
        "twodiscs_paper.pipeline.jobs.figure",
        "twodiscs.figures.kit.style",
        ENTRIES[w.figure].module,
    )


def figure_tables(w, input):
    """Return the tables that a figure reads as arguments."""
    reads = CONFIGURATION.figure_reads(ENTRIES[w.figure], w.get("scene"))
    return assigned(reads, input.tables)


class Caption:
    """The caption of a figure in Snakemake's report, which is composed when the report prints it.

    The modules of figures take long to import. An object is no parameter that reruns a job.
    """

    def __init__(self, w):
        self.figure, self.scene = w.figure, about(w)

    def __str__(self):
        scene = self.scene
        shown = Shown(scene.box, scene.quantities.names) if scene else Shown()
        return ENTRIES[self.figure].caption(shown)


# The studies that the scenes allow, and their parts.
ALLOWED = {
    name: study for name, study in STUDIES.items() if MAIN or not study.about_plain
}
PARTS = {name: study.parts(CONFIGURATION) for name, study in ALLOWED.items()}


def of_study(w):
    """Return the study of a job."""
    return ALLOWED[w.study]


def study_code(w):
    """Return the fingerprint of the code that makes the table of a study, or a part of the table."""
    return code(
        "twodiscs_paper.pipeline.jobs.study",
        of_study(w).tables[0].__module__,
    )


def figure_files(figure):
    """Return the files of a figure in all scenes."""
    return [CONFIGURATION.figures(scene).get(figure, []) for scene in CONFIGURED]
