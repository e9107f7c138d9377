# What the stages share: the scenes, the paths of what is built from them, and the code that builds it.
import json
import sys

from twodiscs.comparison.scene_tables import SCENE_TABLES
from twodiscs.figures.catalogue import ANIMATION, FIGURES
from twodiscs.pipeline.arguments import box_arguments, word, words
from twodiscs.pipeline.configuration.files import GATHERED, Files, assigned, braced
from twodiscs.pipeline.configuration.request import STAGES
from twodiscs.sources import fingerprint
from twodiscs.studies.catalogue import STUDIES, STUDY_FIGURES

MAIN = CONFIGURATION.main  # the scene that the manuscript is about, if there is one


def source(path):
    """Return where a text of this workflow is: in a checkout, or where Snakemake fetched it to."""
    here = os.path.relpath(os.path.join(str(workflow.current_basedir), "../..", path))
    return here if os.path.exists(here) else workflow.source_path(f"../../{path}")


# The scenes of the configuration by their folders, and those of the study of effects.
SCENES = {scene.name: scene for scene in CONFIGURATION.scenes}
EFFECTS = []
for folder, _ in STUDIES["effects"].reads(CONFIGURATION).values():
    EFFECTS.append(os.path.basename(folder))
    file = source(f"config/scenes/{EFFECTS[-1]}.yaml")
    (SCENES[folder],) = load({"seed": CONFIGURATION.seed} | read(file)).scenes

FILES = Files(CONFIGURATION, SCENES)
RESULTS = FILES.folder
CONFIGURED = [scene.name for scene in CONFIGURATION.scenes]

if cost.days(CONFIGURATION.scenes) > 1:
    logger.warning(
        f"This configuration takes some {cost.days(CONFIGURATION.scenes):.2g} days of processor time;"
        " snakemake forecast says it better."
    )

# The Python that runs Snakemake also runs the jobs, which end when it does and import nothing from
# the folder that they are run in.
os.environ.update(
    TWODISCS_WORKFLOW=str(os.getpid()),
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
    catalogues = ("figures.catalogue", "studies.catalogue", "comparison.scene_tables")
    return fingerprint(*modules, without=(*catalogues, *without))


def box(w):
    """Return the arguments that say what the box of the scene of a job is."""
    scene = SCENES[w.scene] if "scene" in w.keys() else MAIN
    return box_arguments(scene.box) if scene else ""


def seed(w, stage):
    """Return the seed of the random streams of a job."""
    return SCENES[w.scene].seed_of(stage, w.radius)


def minutes(stage=None):
    """Return how long a job of a stage may take, more when it is retried."""
    return lambda w, attempt: attempt * cost.minutes(SCENES[w.scene], stage or w.stage)
