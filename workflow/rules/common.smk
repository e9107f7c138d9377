# What the stages share: the scenes, the paths of what is built from them, and the code that builds it.
from hashlib import blake2b

RESULTS = CONFIGURATION.results
MAIN = CONFIGURATION.main  # the scene that the manuscript is about, if there is one
METHODS = ("monte_carlo", "dynamics", "intervals")
KERNELS = {"monte_carlo": "montecarlo", "dynamics": "dynamics", "intervals": "dynamics"}
SCENES = {scene.name: scene for scene in CONFIGURATION.scenes}
PLAIN = [scene for scene in CONFIGURATION.scenes if not scene.effects]

# The Python that runs Snakemake also runs the jobs.
os.environ.update(
    PATH=os.pathsep.join(
        [os.path.dirname(sys.executable), os.environ.get("PATH", os.defpath)]
    )
)


wildcard_constraints:
    scene="|".join(SCENES),
    key=r"[0-9][0-9.e+-]*",


def code(*modules):
    """Return the source files that these modules of the package, or what they import, stand in."""
    return sorted(
        {os.path.relpath(path) for name in modules for path in imported(name)}
    )


def point_files(scene, *methods):
    """Return what the jobs of these methods found, a file for each method and radius."""
    return [
        f"{RESULTS}/{scene.name}/points/{method}/{key}.json"
        for method in methods
        for key in getattr(scene, f"{method}_keys")
    ]


def compiled(scene, method):
    """Return the stamp that says that the kernels of a method are compiled for a scene."""
    kernels = f"{scene.name}/{method}" if scene.effects else KERNELS[method]
    return f"{RESULTS}/.compiled/{kernels}"


def cost_files(scene):
    """Return what the jobs of a scene took, a file for each method and radius."""
    return [
        f"{RESULTS}/{scene.name}/points/cost/{method}-{key}.json"
        for method in METHODS
        for key in getattr(scene, f"{method}_keys")
    ]


def table_files(scene):
    """Return {name: path} of the tables that a scene calls for."""
    measured = {
        "volume": scene.watch.volume,
        "areas": scene.watch.areas,
        "mean_times": scene.watch.mean_times,
        "hop_histogram": scene.watch.hop_histogram,
        "trajectory": scene.watch.trajectory,
        "check": any(point_files(scene, *METHODS)),
        "cost": any(cost_files(scene)),
    }
    names = ["grid", "theory", *(name for name, called in measured.items() if called)]
    return {name: f"{RESULTS}/{scene.name}/{name}.csv" for name in names}


def table_points(scene, table):
    """Return the files of points that a table of a scene is gathered from."""
    takes = {
        "volume": ["monte_carlo"],
        "areas": ["monte_carlo"],
        "mean_times": ["dynamics"],
        "hop_histogram": ["intervals"],
        "check": METHODS,
    }
    return cost_files(scene) if table == "cost" else point_files(scene, *takes[table])


def forecast_file(table):
    """Return the forecast, if there is one and the table is about costs."""
    path = f"{RESULTS}/forecast.csv"
    return [path] if table == "cost" and os.path.exists(path) else []


def table_parameters(scene):
    """Return what the tables of a scene need beside the files that they read."""
    return {"areas": list(scene.watch.areas)} | scene.box_parameters()


def figure_parameters(scene, figure):
    """Return what a figure of a scene needs beside the tables that it reads."""
    box = scene.box_parameters()
    if "trajectory" in FIGURES[figure].tables:
        box["radius"] = scene.watch.trajectory
    return dict(sorted(box.items()))


def figure_files(scene):
    """Return {name: paths} of the figures that a scene calls for."""
    return {
        name: multiext(f"{RESULTS}/{scene.name}/figures/{name}", ".pdf", ".png")
        for name, figure in FIGURES.items()
        if figure.is_called(scene.watch.quantities, scene.effects)
    }


def animation_files(scene):
    """Return the files of the animation of a scene, none if the scene has no trajectory."""
    called = ANIMATION.is_called(scene.watch.quantities, scene.effects)
    path = f"{RESULTS}/{scene.name}/figures/animation"
    return multiext(path, ".gif", ".png") if called else []


def animation_parameters(scene):
    """Return what the animation of a scene needs beside the trajectory."""
    return {
        "height": scene.height,
        "radius": scene.watch.trajectory,
        "width": scene.width,
    }


def shared_results():
    """Return what is built once, as far as the configuration asks for it."""
    made = [getattr(rules, name) for name in CONFIGURATION.shared if name != "report"]
    return [path for rule in made for path in rule.output or rule.input]


def shared_tables():
    """Return the names of the tables that belong to no scene, those behind figures and errata."""
    return list(
        dict.fromkeys(
            ["errata", *(t for entry in SHARED.values() for t in entry.tables)]
        )
    )


def shared_files():
    """Return the tables that belong to no scene, and the figures as the manuscript takes them."""
    return [
        *(f"{RESULTS}/{name}.csv" for name in shared_tables()),
        *(f"{RESULTS}/figures/{name}.pdf" for name in SHARED),
    ]


def shared_figure_files(name):
    """Return the files of a figure that belongs to no scene."""
    return multiext(f"{RESULTS}/figures/{name}", ".pdf", ".png")


def shared_figure_tables(name):
    """Return the tables that a figure of no scene reads: for thresholds, those of a scene, too."""
    read = [f"{RESULTS}/{table}.csv" for table in SHARED[name].tables]
    if name == "thresholds" and MAIN.name in mean_time_tables():
        read.append(mean_time_tables()[MAIN.name])
    return read


def manuscript_parameters():
    """Return what the manuscript needs beside the tables and figures that it reads.

    The hash is that of the configuration with every default filled in.
    """
    return {
        "configuration": blake2b(
            repr(CONFIGURATION).encode(), digest_size=8
        ).hexdigest(),
        "figures": list(SHARED),
        "results": RESULTS,
        "scenes": [
            {
                "figures": list(figure_files(scene)),
                "height": scene.height,
                "name": scene.name,
                "tables": list(table_files(scene)),
                "width": scene.width,
            }
            for scene in PLAIN
        ],
        "tables": shared_tables(),
    }


def stability_parameters(ordinary, hard):
    """Return what is measured: the box, and events at an ordinary and at each hard radius."""
    return {
        "hard": hard,
        "height": MAIN.height,
        "ordinary": ordinary,
        "seed": CONFIGURATION.seed,
        "width": MAIN.width,
    }


def tails_parameters():
    """Return what is measured of the tails: the box, and numbers of starts and replicas."""
    budget = MAIN.event_budget
    return {
        "height": MAIN.height,
        "replicas": min(400_000, max(4_000, budget // 5_000)),
        "samples": min(200, max(2, budget // 10**7)),
        "seed": CONFIGURATION.seed,
        "width": MAIN.width,
    }


def distributions_parameters():
    """Return what is measured of the times to the next hop: scenes, events a radius, root seed."""
    return {
        "events": min(2**23, max(2**16, MAIN.event_budget // 200)),
        "scenes": [
            {
                "event": scene.histogram_event,
                "height": scene.height,
                "name": scene.name,
                "radii": list(scene.watch.hop_histogram),
                "width": scene.width,
            }
            for scene in PLAIN
        ],
        "seed": CONFIGURATION.seed,
    }


def mean_time_tables():
    """Return {name: path} of the mean_times.csv of every scene without effects that has one."""
    files = {scene.name: table_files(scene) for scene in PLAIN}
    return {name: f["mean_times"] for name, f in files.items() if "mean_times" in f}
