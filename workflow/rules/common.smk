# What the stages share: the scenes, the paths of what is built from them, and the code that builds it.
import json
import sys
from hashlib import blake2b
from itertools import count

from twodiscs.comparison.scene_tables import SCENE_TABLES
from twodiscs.figures.catalogue import ANIMATION, FIGURES
from twodiscs.pipeline.configuration.request import STAGES
from twodiscs.pipeline.sources import fingerprint
from twodiscs.studies.catalogue import STUDIES, STUDY_FIGURES

RESULTS = CONFIGURATION.results
SCENES = {scene.name: scene for scene in CONFIGURATION.scenes}
MAIN = CONFIGURATION.main  # the scene that the manuscript is about, if there is one

# The modules whose kernels scenes without effects share, by the stamp that says they are compiled.
KERNELS = {
    "montecarlo": ["sampling.montecarlo"],
    "dynamics": ["dynamics.counting", "dynamics.intervals", "dynamics.trajectory"],
}

# Who reads a configuration reads this catalogue too, for the names of what is built once. Captions
# are in it and columns of tables, which are of no consequence for what is counted in a scene.
NAMES_ALONE = ("studies.catalogue",)

# The tables of a scene that are gathered from points, and the stages that found those.
GATHERED = {
    "volume": ["monte_carlo"],
    "areas": ["monte_carlo"],
    "mean_times": ["dynamics"],
    "hop_histogram": ["intervals"],
    "check": [*STAGES],
    "cost": [*STAGES],
}

# The Python that runs Snakemake also runs the jobs, which end when it does.
os.environ.update(
    TWODISCS_WORKFLOW=str(os.getpid()),
    PATH=os.pathsep.join(
        [os.path.dirname(sys.executable), os.environ.get("PATH", os.defpath)]
    ),
)


# Longer arguments go into a file: Linux takes 131072 letters in all that a shell is told.
LONG = 30_000


# A radius, or the number of a bundle of them.
KEY = r"[0-9][0-9.e+-]*"


wildcard_constraints:
    scene="|".join(SCENES),
    key=KEY,
    bundle=KEY,


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


def kept(text):
    """Return the path of a file that holds ``text``, which is named by its hash."""
    name = blake2b(text.encode(), digest_size=16).hexdigest()
    path = Path(".snakemake", "parameters", name)
    if not path.exists():
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"{text}\n", encoding="utf-8", newline="\n")
    return str(path)


def as_json(value):
    """Return what a job depends on as one JSON object, its keys sorted.

    For what is too long for a command line it is the @path of a file that holds the object.
    """
    text = json.dumps(dict(sorted(value.items())))
    return text if len(text) < LONG else f"@{kept(text)}"


def about(scene, seed=CONFIGURATION.seed):
    """Return what the record of a job calls the scene and the root seed; None for what is not used."""
    words = {"scene": scene, "seed": seed}
    return ", ".join(f"{k} {v}" for k, v in words.items() if v is not None)


def minutes(stage=None):
    """Return how long a job of a stage, or of the one among its wildcards, may take: more when retried."""
    return lambda w, attempt: attempt * SCENES[w.scene].minutes(
        stage or w.stage, w.get("bundle")
    )


def contents(*paths):
    """Return a hash of files, for inputs whose time stamps may not tell that they were edited."""
    texts = b"".join(Path(p).read_bytes() for p in paths if os.path.exists(p))
    return blake2b(texts, digest_size=8).hexdigest()


def compiled(scene, stage):
    """Return the stamp that says that the kernels of a stage are compiled for a scene."""
    if scene.effects:
        return f"{RESULTS}/.compiled/{scene.name}/{stage}"
    (kernels,) = (name for name, some in KERNELS.items() if STAGES[stage] in some)
    return f"{RESULTS}/.compiled/{kernels}"


def table_files(scene):
    """Return {name: path} of the tables that a scene calls for."""
    return {name: f"{RESULTS}/{scene.name}/{name}.csv" for name in scene.tables}


def figure_files(scene):
    """Return {name: paths} of the figures that a scene calls for."""
    return {
        name: multiext(f"{RESULTS}/{scene.name}/figures/{name}", ".pdf", ".png")
        for name, entry in FIGURES.items()
        if entry.is_called(scene.watch.quantities, scene.effects)
    }


def animation_files(scene):
    """Return the files of the animation of a scene, none if the scene has no trajectory."""
    called = ANIMATION.is_called(scene.watch.quantities, scene.effects)
    path = f"{RESULTS}/{scene.name}/figures/animation"
    return multiext(path, ".gif", ".png") if called else []


def study_table(table):
    """Return the file of a table of a study, with its place in the report; the errata say more."""
    name = table.name()
    return report(
        ensure(f"{RESULTS}/{name}.csv", non_empty=True),
        caption=f"../report/{'errata' if name == 'errata' else 'shared_table'}.rst",
        category="Tables",
        subcategory="all scenes",
        labels={"table": name, "what a row says": table.meaning()},
    )


def study_files(name):
    """Return the tables of a study and its figures, as PDF and as PNG."""
    study = STUDIES[name]
    figures = [
        multiext(f"{RESULTS}/figures/{figure}", ".pdf", ".png")
        for figure in study.figures
    ]
    return [*(f"{RESULTS}/{table.name()}.csv" for table in study.tables), *figures]


def named_tables(names, paths):
    """Return the arguments NAME=CSV of tables.

    Paths come from the input of a job: who uses this workflow as a module may have prefixed them.
    """
    return [f"{name}={path}" for name, path in zip(names, paths, strict=True)]


def gathered_points(scene, table):
    """Return the bundles of points that a table of a scene is gathered from."""
    return [
        f"{RESULTS}/{scene.name}/points/{stage}/bundles/{name}.json"
        for stage in GATHERED[table]
        for name in scene.bundles[stage]
    ]


def points_folder(path):
    """Return the folder ``points`` that the file of a point, or of a bundle of them, is in."""
    return str(next(folder for folder in Path(path).parents if folder.name == "points"))


def tables_beside(scene, table):
    """Return {name: path} of the tables that another one needs; of a forecast, if there is one."""
    if table != "cost":
        return {"theory": f"{RESULTS}/{scene}/theory.csv"}
    path = f"{RESULTS}/forecast.csv"
    return {"forecast": path} if os.path.exists(path) else {}


def figure_job(scene, entry):
    """Return what a figure of a scene depends on beside its tables."""
    given = {"box": scene.box.parameters(), **entry.options}
    if "trajectory" in entry.tables:
        given["radius"] = scene.watch.trajectory
    return given


def figure_tables(folder, entry):
    """Return {name: path} of the tables that a figure of the scene in ``folder`` reads."""
    return {name: f"{folder}/{name}.csv" for name in entry.tables}


def study_figure_tables(entry):
    """Return {name: path} of the tables that a figure of a study reads."""
    found = figure_tables(RESULTS, entry)
    for name in entry.main_tables:
        if MAIN and name in MAIN.tables:
            found[name] = table_files(MAIN)[name]
    return found


def study_tables(study):
    """Return {name: path} of the tables that a study reads."""
    return {
        name: f"{RESULTS}/{scene}/{table}.csv" if scene else f"{RESULTS}/{table}.csv"
        for name, (scene, table) in study.reads(CONFIGURATION).items()
    }


def shared_tables():
    """Return the names of the tables that belong to no scene, those of all studies."""
    return [
        table.name()
        for study in STUDIES.values()
        if study.shared
        for table in study.tables
    ]


def manuscript_job(results):
    """Return what the manuscript needs beside what it reads in the folder ``results``.

    The hash is that of the configuration with every default filled in.
    """
    return {
        "configuration": blake2b(
            repr(CONFIGURATION).encode(), digest_size=8
        ).hexdigest(),
        "figures": list(STUDY_FIGURES),
        "results": results,
        "scenes": [
            {
                "figures": list(figure_files(scene)),
                "height": scene.box.height,
                "name": scene.name,
                "tables": list(scene.tables),
                "width": scene.box.width,
            }
            for scene in CONFIGURATION.plain
        ],
        "seed": CONFIGURATION.seed,
        "tables": shared_tables(),
    }


def report_scenes():
    """Return what the report says of the scenes."""
    return [
        {
            "box": " × ".join(
                f"{side:g}"
                for side in (
                    scene.box.width,
                    scene.box.height,
                    scene.effects.get("depth"),
                )
                if side
            ),
            "effects": scene.effects,
            "height": scene.box.height,
            "name": scene.name,
            "width": scene.box.width,
        }
        for scene in SCENES.values()
    ]


# Points that are cut into shards; what asks for which is in shards.smk.
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
