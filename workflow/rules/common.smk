# What the stages share: the scenes, the paths of what is built from them, and the code that builds it.
import json
import sys
from dataclasses import replace

from twodiscs.comparison.scene_tables import SCENE_TABLES
from twodiscs.figures.catalogue import ANIMATION, FIGURES
from twodiscs.figures.kit.captions import Shown
from twodiscs.arguments import box_arguments, word, words
from twodiscs_paper.pipeline.configuration.files import (
    GATHERED,
    Files,
    assigned,
    braced,
)
from twodiscs_paper.pipeline.configuration.request import STAGES
from twodiscs_paper.pipeline.jobs.figure import ENTRIES
from twodiscs.model.sources import fingerprint
from twodiscs_paper.catalogue import STUDIES, STUDY_FIGURES
from twodiscs_paper.studies.effects.study import SCENES as EFFECTS

MAIN = CONFIGURATION.main  # the scene that the manuscript is about, if there is one


def source(path):
    """Return where a text of this workflow is: in a checkout, or where Snakemake fetched it to."""
    here = os.path.relpath(os.path.join(str(workflow.current_basedir), "../..", path))
    return here if os.path.exists(here) else workflow.source_path(f"../../{path}")


# The scenes of the configuration by their folders, and those of the study of effects.
EFFECT_FILES = [source(f"config/scenes/{name}.yaml") for name in EFFECTS]
CONFIGURATION = replace(
    CONFIGURATION,
    effect_scenes=[
        load({"seed": CONFIGURATION.seed} | read(file)).scenes[0]
        for file in EFFECT_FILES
    ],
)
SCENES = {scene.name: scene for scene in CONFIGURATION.scenes}
SCENES |= {f"effects/{scene.name}": scene for scene in CONFIGURATION.effect_scenes}

FILES = Files(CONFIGURATION, SCENES)
RESULTS = FILES.folder
CONFIGURED = [scene.name for scene in CONFIGURATION.scenes]

if (days := cost.days(CONFIGURATION.scenes)) > 1:
    days = float(f"{days:.2g}")
    logger.warning(
        f"This configuration takes some {days:g} days of processor time;"
        " snakemake forecast says it better."
    )

# The Python that runs Snakemake also runs the jobs, which end when it does and import nothing from
# the folder that they are run in.
os.environ.update(
    TWODISCS_WORKFLOW=str(os.getpid()),
    TWODISCS_SNAKEFILE=workflow.main_snakefile,
    PYTHONSAFEPATH="1",
    PATH=os.pathsep.join(
        [os.path.dirname(sys.executable), os.environ.get("PATH", os.defpath)]
    ),
)


wildcard_constraints:
    scene="|".join(SCENES),
    stage="|".join(STAGES),
    radius=r"[0-9][0-9.e+-]*",
    part="[a-z_]+",
    first="[0-9]+",
    stop="[0-9]+",


def code(*modules, without=()):
    """Return the fingerprint of the code that a job runs: modules, and all that they import.

    Catalogues are left out: of them a job uses the entry that its parameters name.
    """
    catalogues = (
        "twodiscs.figures.catalogue",
        "twodiscs_paper.catalogue",
        "twodiscs.comparison.scene_tables",
    )
    return fingerprint(*modules, without=(*catalogues, *without))


def box(w):
    """Return the arguments that say what the box of the scene of a job is."""
    scene = SCENES[w.scene] if "scene" in w.keys() else MAIN
    return box_arguments(scene.box) if scene else ""


def minutes(stage=None):
    """Return how long a job of a stage may take, more when it is retried."""
    return lambda w, attempt: attempt * cost.minutes(SCENES[w.scene], stage or w.stage)


def shards_of(stage):
    """Return an input function: the shards of a point of a stage, none where one job does it all."""

    def files(w):
        folder = f"{RESULTS}/{w.scene}/shards/{stage}/{w.radius}"
        pieces = cost.shards(SCENES[w.scene], stage, float(w.radius))
        return [f"{folder}/{part}-{first}-{stop}.json" for part, first, stop in pieces]

    return files


def work_of(stage):
    """Return a function of the wildcards: what the job of a stage at a radius is told."""
    return lambda w: words(SCENES[w.scene].arguments(stage, w.radius))


# The module of each stage is imported by its own jobs alone.
POINT = {
    stage: code(
        "twodiscs_paper.pipeline.jobs.point",
        without=tuple({*STAGES.values()} - {module}),
    )
    for stage, module in STAGES.items()
}


def about(w):
    """Return the scene that a figure is about: the main one, if there is one, for one of none."""
    return SCENES[w.scene] if "scene" in w.keys() else MAIN


def origin(w):
    """Return what a figure says in its metadata of what made it."""
    scene = about(w)
    return (f"scene {scene.name}, " if scene else "") + f"seed {CONFIGURATION.seed}"


def radius_of(w):
    """Return the argument that says the radius of a trajectory, for figures of one."""
    shown = "trajectory" in ENTRIES[w.figure].tables
    return f"--radius {about(w).quantities.trajectory}" if shown else ""


def figure_code(w):
    """Return the fingerprint of the code that draws a figure."""
    return code(
        "twodiscs_paper.pipeline.jobs.figure",
        "twodiscs.figures.kit.style",
        ENTRIES[w.figure].module,
    )


def figure_tables(w, input):
    """Return the tables that a figure reads as arguments."""
    reads = FILES.figure_reads(ENTRIES[w.figure], w.get("scene"))
    return assigned(reads, input.tables)


class Caption:
    """The caption of a figure in Snakemake's report, which is composed when the report prints it.

    The modules of figures take long to import. As an object it is no parameter that reruns a job.
    """

    def __init__(self, w):
        self.figure, self.scene = w.figure, about(w)

    def __str__(self):
        scene = self.scene
        shown = Shown(scene.box, scene.quantities.names) if scene else Shown()
        return ENTRIES[self.figure].caption(shown)


def study_table(table):
    """Return the file of a table of a study, with its place in the report; the errata say more."""
    name = table.name()
    return report(
        ensure(FILES.table(name), non_empty=True),
        caption=f"../report/{'errata' if name == 'errata' else 'shared_table'}.rst",
        category="Tables",
        subcategory="all scenes",
        labels={"table": name, "what a row says": table.meaning()},
    )
