# What the stages share: the scenes, the paths of what is built from them, and the code that builds it.
import json
import sys
from hashlib import blake2b
from itertools import count

from twodiscs.comparison.scene_tables import SCENE_TABLES
from twodiscs.figures.catalogue import ANIMATION, FIGURES
from twodiscs.pipeline.configuration.files import (
    GATHERED,
    KERNELS,
    Files,
    as_json,
    contents,
    figure_job,
    kept,
    named_tables,
    shared_tables,
)
from twodiscs.pipeline.configuration.request import STAGES
from twodiscs.model.sources import fingerprint
from twodiscs.studies.catalogue import STUDIES, STUDY_FIGURES

FILES = Files(CONFIGURATION, BUILT)
RESULTS = FILES.folder
SCENES = {scene.name: scene for scene in CONFIGURATION.scenes}
MAIN = CONFIGURATION.main  # the scene that the manuscript is about, if there is one

# Who reads a configuration reads this catalogue too, for the names of what is built once. Captions
# are in it and columns of tables, which are of no consequence for what is counted in a scene.
NAMES_ALONE = ("studies.catalogue",)

# The Python that runs Snakemake also runs the jobs, which end when it does.
os.environ.update(
    TWODISCS_WORKFLOW=str(os.getpid()),
    PATH=os.pathsep.join(
        [os.path.dirname(sys.executable), os.environ.get("PATH", os.defpath)]
    ),
)


NUMBER, KEY = "[0-9]+", r"[0-9][0-9.e+-]*"


wildcard_constraints:
    scene="|".join(SCENES),
    table="|".join(GATHERED),
    kernels="|".join(KERNELS),
    stage="|".join(STAGES),
    # A radius, or the number of a bundle of them.
    key=KEY,
    bundle=KEY,
    # A plan of shards; a shard, by its part of the work and its pieces of that; names of shards.
    round=NUMBER,
    part="[a-z_]+",
    first=NUMBER,
    stop=NUMBER,
    name="[0-9a-f]+",


def one_of(names):
    """Return the pattern of a wildcard that is one of ``names``; without any nothing matches."""
    return "|".join(names) or "(?!)"


def log_of(name):
    """Return the path of the log of a job."""
    return f"{RESULTS}/logs/{name}.log"


def benchmark_of(name):
    """Return the path of what Snakemake measures of a job."""
    return f"{RESULTS}/benchmarks/{name}.tsv"


def code(*modules, without=()):
    """Return the fingerprint of modules that a job runs, and of all that they import.

    To be named are those that ``jobs`` finds by their name: what does the work, and besides how a
    figure looks and how tables are read, or the columns of the table that is written.
    """
    return fingerprint("pipeline.jobs", *modules, without=without)


def figure_code(module):
    """Return the fingerprint of what draws a figure."""
    return code(module, "comparison.tables", "figures.kit.style")


def table_code(module, table):
    """Return the fingerprint of what makes a table, a class, and of what declares its columns."""
    return code(module, table.__module__.partition(".")[2])


def about(scene, seed=CONFIGURATION.seed):
    """Return what the record of a job calls the scene and the root seed; None for what is not used."""
    words = {"scene": scene, "seed": seed}
    return ", ".join(f"{k} {v}" for k, v in words.items() if v is not None)


def minutes(stage=None):
    """Return how long a job of a stage, or of the one among its wildcards, may take: more when retried."""
    return lambda w, attempt: attempt * SCENES[w.scene].minutes(
        stage or w.stage, w.get("bundle")
    )


def drawn(w):
    """Return the scene that a figure is about: the main one, if there is one, for one of no scene."""
    return SCENES.get(w.get("scene"), MAIN)


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


SHARDS = f"{RESULTS}/{{scene}}/points/shards/{{stage}}"


def planned(scene, stage, rounds=None):
    """Return {key: names of the shards} that plans ask for: so many of them, or all there are."""
    names = {}
    for n in count(1) if rounds is None else range(1, rounds + 1):
        job = checkpoints.plan.get(scene=scene, stage=stage, round=n)
        found = json.loads(Path(job.output.plan).read_text(encoding="utf-8"))
        if found == names:
            break
        names = found
    return names


def shard_files(scene, stage, keys):
    """Return the files of shards; ``keys`` is {key: their names}."""
    folder = SHARDS.format(scene=scene, stage=stage)
    return [
        f"{folder}/{key}/{name}.json" for key, names in keys.items() for name in names
    ]


def needed(w):
    """Return {key: names of the shards} of the point of these wildcards."""
    return {w.key: planned(w.scene, w.stage)[w.key]}


def needed_before(w):
    """Return {key: names of the shards} that the plans before the one of these wildcards ask for."""
    return planned(w.scene, w.stage, int(w.round) - 1)


def names_of(scene, stage, key):
    """Return the path of the names of the shards of a point."""
    job = json.dumps(SCENES[scene].job(stage, key)) + code(STAGES[stage])
    name = blake2b(job.encode(), digest_size=8).hexdigest()
    return f"{SHARDS.format(scene=scene, stage=stage)}/{key}/needed/{name}.json"
