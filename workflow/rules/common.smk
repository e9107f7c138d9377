# Shared by all stages: the scenes, the files of the workflow, and the code of the jobs.
import inspect
import json
import re
import sys
from dataclasses import replace
from pathlib import Path

import twodiscs
from twodiscs.dynamics.stages import POINT_TABLES, STAGES
from twodiscs.figures.scene_figures import ANIMATION, FIGURES
from twodiscs_paper.catalogue import (
    ALL_FIGURES,
    STUDIES,
    STUDY_FIGURES,
    STUDY_TABLES,
    is_reproducible,
)
from twodiscs_paper.studies.effects.study import SCENES as EFFECTS
from twodiscs_paper.studies.effects.study import boxes

MAIN = CONFIGURATION.main  # the scene that the manuscript is about, if there is one

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
of_effects = [read(source(f"config/scenes/{name}.yaml")) for name in EFFECTS]
of_effects = [load({"seed": CONFIGURATION.seed} | block).scenes[0] for block in of_effects]
CONFIGURATION = replace(CONFIGURATION, effect_scenes=of_effects)
SCENES = CONFIGURATION.folders
RESULTS = CONFIGURATION.results
CONFIGURED = [scene.name for scene in CONFIGURATION.scenes]

# The command that pages name: it builds this configuration if it is complete, else that of this folder. A path has
# one form, whether the command line or a Snakefile names it: another text would make the report again.
RUN = "".join(
    f"twodiscs run {shlex.quote(os.path.relpath(path))}" for path in workflow.configfiles[-1:]
)
if RUN in ("", f"twodiscs run {os.path.join('config', 'config.yaml')}"):
    RUN = "snakemake --cores 1"

# The studies that the scenes allow, and their parts.
ALLOWED = {name: study for name, study in STUDIES.items() if MAIN or not study.about_plain}
PARTS = {name: study.parts(CONFIGURATION) for name, study in ALLOWED.items()}

# The studies by the names of their tables.
MADE_BY = {table.name(): study for study in ALLOWED.values() for table in study.tables}

# Jobs read this file, too, and need no forecast.
if workflow.is_main_process and (days := job_cost.days(CONFIGURATION.scenes)) > 1:
    logger.warning(
        f"This configuration takes about {float(f'{days:.2g}'):g} days of processor time."
    )

if any(re.fullmatch("--dry-?run|-[a-z]*n[a-z]*", word) for word in sys.argv):
    for sentence in job_cost.shortfalls(CONFIGURATION):
        logger.warning(sentence)

# The folder of the Python packages.
PACKAGES = Path(twodiscs.__file__).parents[1]


def modules(*patterns):
    """Return the sources that match any of some patterns, sorted."""
    found = {path for pattern in patterns for path in PACKAGES.glob(pattern)}
    return [local(os.path.relpath(path)) for path in sorted(found)]


def study_folder(study):
    """Return the folder of the sources of a study below ``PACKAGES``."""
    return study.tables[0].__module__.rpartition(".")[0].replace(".", "/")


def study_figures(study):
    """Return the sources that draw the figures of a study."""
    return modules(f"{study_folder(study)}/figure*.py")


# The sources that jobs run, by groups. An edit reruns all jobs that have its group among their inputs.
PHYSICS = ("model", "theory", "sampling", "dynamics", "points")
CODE = {
    "physics": modules(
        *(f"twodiscs/{part}/**/*.py" for part in PHYSICS), "twodiscs_paper/pipeline/points.py"
    ),
    "tables": modules("twodiscs/analysis/*.py", "twodiscs/measure/*.py"),
    "figures": modules(
        *(f"twodiscs/figures/*.{kind}" for kind in ("py", "mplstyle", "html")),
        "twodiscs_paper/draw.py",
    ),
    "documents": modules(  # with the captions, and the names of the lines that they explain
        "twodiscs/figures/scene_figures.py",
        "twodiscs/figures/curves.py",
        "twodiscs_paper/pipeline/**/*.py",
    ),
    "benchmark": modules("twodiscs_paper/benchmark.py"),
}
# Modules that several studies import.
SHARED = modules(
    "twodiscs_paper/study.py", "twodiscs_paper/studies/*.py", "twodiscs_paper/reference.py"
)


def with_shared(paths):
    """Return some sources with those of ``SHARED`` that they import, and that these import."""
    text = "".join(Path(path).read_text(encoding="utf-8") for path in paths)
    rest = [path for path in SHARED if path not in paths]
    more = [path for path in rest if re.search(rf"twodiscs_paper.*\b{Path(path).stem}\b", text)]
    return with_shared([*paths, *more]) if more else sorted(paths)


for name, study in STUDIES.items():
    own = modules(f"{study_folder(study)}/**/*.py")
    CODE[name] = with_shared([path for path in own if path not in study_figures(study)])

# Calls of the face, the build, and the comparison with expected results: no job with one
# of these groups imports them, so their edit must not rerun it.
FACE = modules(
    *(
        f"twodiscs/measure/{name}.py"
        for name in ("intervals", "load", "observe", "pressure", "scan", "transmission")
    ),
    "twodiscs/dynamics/averages.py",
    "twodiscs/figures/plot.py",
    "twodiscs_paper/pipeline/build.py",
    "twodiscs_paper/pipeline/results/verify.py",
)
CODE = {group: [path for path in paths if path not in FACE] for group, paths in CODE.items()}


def sums(*groups):
    """Return the files of checksums of groups of sources."""
    return [f"{RESULTS}/code/{group}.sha256" for group in groups]


def code(script, *groups):
    """Return the code of a job as inputs: its script, and the checksums of groups of sources."""
    return [source(f"workflow/scripts/{script}.py"), *sums(*groups)]


wildcard_constraints:
    scene="|".join(SCENES),
    stage="|".join(STAGES),
    radius=r"[0-9][0-9.e+-]*",
    component="[a-z_]+",
    first="[0-9]+",
    stop="[0-9]+",
    group="|".join(CODE),


def box(w):
    """Return the parameters of the box of a job: of its scene, or of the main scene; or None."""
    scene = SCENES[w.scene] if "scene" in w.keys() else MAIN
    return scene.box.parameters() if scene else None


def minutes(w, attempt):
    """Return the limit of time of a job at one radius, longer with each retry."""
    return attempt * job_cost.minutes(SCENES[w.scene], w.stage)


def shards(w):
    """Return the shards of a point, none if one job does all its work."""
    folder = f"{RESULTS}/{w.scene}/shards/{w.stage}/{w.radius}"
    shards = job_cost.shards(SCENES[w.scene], w.stage, float(w.radius))
    return [f"{folder}/{component}-{first}-{stop}.json" for component, first, stop in shards]


# {figure: {name: path}} of the long runs that figures read. Snakemake resolves the paths of sources while it reads
# this file, not in functions of wildcards.
FIGURE_LONG_RUNS = {
    figure: {name: source(path) for name, path in entry.long_runs.items()}
    for figure, entry in ALL_FIGURES.items()
}


def figure_reads(w):
    """Return {name: path} of the tables that a figure reads, long runs that are kept among them."""
    return (
        CONFIGURATION.figure_reads(ALL_FIGURES[w.figure], w.get("scene"))
        | FIGURE_LONG_RUNS[w.figure]
    )


def radius(w):
    """Return the radius of the trajectory that a figure shows, None for other figures."""
    shown = "trajectory" in ALL_FIGURES[w.figure].tables
    return SCENES[w.scene].quantities.trajectory if shown else None


def own_code(w):
    """Return the code of the figure of a study that is not that of all figures: of its study."""
    studies = [one for one in STUDIES.values() if w.figure in one.figures]
    drawn = [path for study in studies for path in study_figures(study)]
    return [*drawn, *sums(*(study.name for study in studies))]


def study_reads(w):
    """Return {name: path} of the tables that the function ``rows`` of a table takes, if it takes any."""
    takes = inspect.signature(STUDY_TABLES[w.table].rows).parameters
    return CONFIGURATION.study_reads(MADE_BY[w.table]) if "tables" in takes else {}
