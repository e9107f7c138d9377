"""The jobs of the workflow: a module does the work, and this reads and writes the files.

    python -m twodiscs.pipeline.jobs point dynamics.counting --parameters '{"radius": …}' \\
        --output points/dynamics/0.2.json --cost points/cost/dynamics-0.2.json
    python -m twodiscs.pipeline.jobs table studies.tails.measure --parameters '{…}' \\
        --output results/tails.csv
    python -m twodiscs.pipeline.jobs figure figures.radius --parameters '{…}' \\
        --table volume=results/paper/volume.csv --output volume.pdf volume.png

Modules are named from the package on. Those that some jobs run and others do not are found by their
name, those named here too, so that an edit of one of them does not concern the jobs of the others;
``code`` in the workflow says which job runs which. Parameters are one JSON object, or @path of a
file that holds it; their entry ``box`` becomes a ``Box``.
"""

import argparse
import inspect
import json
import os
import sys
import time
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

from twodiscs.model.box import Box
from twodiscs.model.checks import InputError, shown
from twodiscs.pipeline.arguments import Parser, named, parameters, run

#: What parameters must be, in words and as a shape, for the functions that take them check values
#: alone. A shape is a type, a list of one shape, a dict of the keys that are needed or, by ``str``,
#: of any keys, or a choice of shapes.
BOX, RADIUS = {"width": object, "height": object}, int | float | str
CASE = {"box": BOX, "name": str, "event": str, "radii": [RADIUS]}
TEXTS = "a list of texts", [str]
SHAPES = {
    "areas": TEXTS,
    "box": ("a block of width, height and maybe effects", BOX),
    "events": ("a list of texts, or an integer", ([str], int)),
    "first": ("an integer", int),
    "jobs": ("a block of blocks of parameters", {str: {str: object}}),
    "keys": ("a block of lists of texts", {str: [str]}),
    "part": ("a text", str),
    "radii": ("a list of numbers", [RADIUS]),
    "scenes": ("a list or a block of scenes", ([CASE], {str: BOX})),
    "shard_events": ("a number", int | float),
    "stop": ("an integer", int),
    "volume": ("true or false", bool),
    "watched": TEXTS,
}


def module_of(name):
    """Return the module ``name`` of this package; raise ``InputError`` if there is none."""
    parts = name.split(".")
    try:
        if all(part.isidentifier() for part in parts) and find_spec(f"twodiscs.{name}"):
            return import_module(f"twodiscs.{name}")
    except ModuleNotFoundError as error:
        if not f"twodiscs.{name}".startswith(f"{error.name}"):
            raise
    raise InputError(f"module must be one of the package twodiscs, not {name!r}")


def function_of(module, name):
    """Return the function ``name`` of a module; raise ``InputError`` if there is none."""
    found = getattr(module_of(module), name, None)
    if not callable(found):
        raise InputError(f"{module} must have a function {name}, but has none")
    return found


class Tables(dict):
    """The tables of a job, {name: rows}; one that was not given is an ``InputError``."""

    def __missing__(self, name):
        raise InputError(f"the table {name} must be given, as --table {name}=CSV")


def table_of(name, beside=""):
    """Return the ``Table`` called ``name``, of a scene, beside a module or of a study."""
    folders = beside.rpartition(".")[0], f"studies.{name}", f"studies.{name.rpartition('_')[0]}"
    for place in ("comparison.scene_tables", *(f"{folder}.table" for folder in folders)):
        try:
            declared = module_of(place)
        except InputError:
            continue
        for table in vars(declared).values():
            if isinstance(table, type) and hasattr(table, "columns") and table.name() == name:
                return table
    raise InputError(f"there is no table called {name!r}")


def read_tables(texts):
    """Return {name: rows} of the arguments NAME=CSV; a table is called as its file."""
    paths = named(texts, "--table")
    return Tables({name: table_of(Path(path).stem).read(path) for name, path in paths.items()})


def _has_shape(value, shape):
    if isinstance(shape, tuple):
        return any(_has_shape(value, one) for one in shape)
    if isinstance(shape, list):
        return isinstance(value, list) and all(_has_shape(one, shape[0]) for one in value)
    if not isinstance(shape, dict):
        return isinstance(value, shape)
    if not isinstance(value, dict):
        return False
    needed = dict.fromkeys(value, shape[str]) if str in shape else shape
    known = shape is not BOX or value.keys() <= {*BOX, "effects"}
    return known and all(key in value and _has_shape(value[key], needed[key]) for key in needed)


def checked(given, *needed):
    """Return the parameters ``given``; raise ``InputError`` for a missing one or another shape."""
    for name in needed:
        if name not in given:
            raise InputError(f"parameters must have {name}, but have {', '.join(given) or 'none'}")
    for name in SHAPES.keys() & given.keys():
        what, shape = SHAPES[name]
        if not _has_shape(given[name], shape):
            raise InputError(f"{name} must be {what}, not {shown(given[name])}")
    return given


def call(function, given, **more):
    """Call ``function`` with the parameters ``given``, a ``box`` made of those of that name.

    Arguments in ``more`` are passed if the function takes them. Raises ``InputError`` for
    parameters that it does not take, and for missing ones.
    """
    given = checked(given)
    if "box" in given:
        given = given | {"box": Box(**given["box"])}
    signature = inspect.signature(function)
    given = given | {name: v for name, v in more.items() if name in signature.parameters}
    try:
        bound = signature.bind(**given)
    except TypeError as error:
        raise InputError(f"parameters of {function.__module__}: {error}") from None
    return function(*bound.args, **bound.kwargs)


def write_json(path, content):
    """Write ``content`` with sorted keys, one entry a line; floats keep all their digits."""
    with open(path, "w", encoding="utf-8") as file:
        json.dump(content, file, sort_keys=True, indent=1, allow_nan=False)
        file.write("\n")


def progress(start):
    """Return a reporter that logs what a job has done and the time that is left.

    It takes a text and the work that is left, over the work that is done.
    """

    def report(done, left):
        seconds = left * (time.process_time() - start)
        print(f"{done}, about {seconds:.0f} s left", file=sys.stderr)

    return report


def point(options):
    """Write what a module finds at one radius, and what it took in processor time."""
    work, given = function_of(options.module, "job"), parameters(options.parameters)
    start = time.process_time()
    result = call(work, given, report=progress(start))
    seconds = time.process_time() - start
    write_json(options.output[0], result)
    if options.cost:
        events = result[module_of(options.module).WORK]
        write_json(options.cost, {"events": events, "seconds": seconds})


def bundle(options):
    """Write the points of a module at several radii, each as a job of its own would.

    They go to the folder above that of the output, which holds {key: SHA-256 of the point}. Those
    that are there already, made of the same, stay: only what is missing is done, unless the
    variable TWODISCS_ANEW is set.
    """
    record, found = module_of("pipeline.results.record"), {}
    jobs = checked(parameters(options.parameters), "jobs")["jobs"]
    record.claim(Path(options.output[0]).absolute(), jobs)
    anew = os.environ.get("TWODISCS_ANEW")
    for key, given in jobs.items():
        one = point_of(options, key, job="point", parameters=json.dumps(given))
        if anew or not record.is_made([*one.output, one.cost], made_by(one)):
            point(one)
            keep_record(one, {})
        found[key] = record.digest(*one.output)
    write_json(options.output[0], found)


def point_of(options, key, **changes):
    """Return the options of a job of one point, given those of the job of its bundle."""
    bundle = Path(options.output[0]).absolute()
    found, cost = module_of("pipeline.results.record").points_of(bundle, key)
    cost.parent.mkdir(parents=True, exist_ok=True)
    return argparse.Namespace(**vars(options) | {"output": [found], "cost": cost} | changes)


# A point in shards: its work in pieces that are jobs of their own, see ``sampling.rounds``. A plan
# says which pieces the points of a scene need, as far as those that are there can tell.


def shard_of(part, first, stop):
    """Return the name of the shard that does a piece of a part of a point."""
    return f"{part}-{first}-{stop}"


def _pieces(options, key, names):
    """Return {part: sums of its pieces} of the point ``key``, from the files of its shards."""
    found = {}
    for name in names:
        text = Path(options.points[0], key, f"{name}.json").read_text(encoding="utf-8")
        found.setdefault(name.split("-")[0], []).extend(json.loads(text))
    return found


def _runs(options, given):
    return call(function_of(options.module, "runs"), given)


def shard(options):
    """Write the sums of a piece of the work of a module at one radius, and what it took."""
    piece = "part", "first", "stop"
    given = checked(parameters(options.parameters), *piece)
    part, first, stop = (given.pop(name) for name in piece)
    start = time.process_time()
    runs = _runs(options, given)
    if part not in runs:
        raise InputError(f"part must be one of {', '.join(runs)}, not {part!r}")
    run = runs[part]
    write_json(options.output[0], module_of("sampling.rounds").piece(run, first, stop))
    write_json(options.cost, {"seconds": time.process_time() - start})


def plan(options):
    """Write {key: names of the shards} that points need: those of ``keys``, and what they miss."""
    given = checked(parameters(options.parameters), "jobs", "keys", "shard_events")
    needed, rounds = {}, module_of("sampling.rounds")
    for key, job in given["jobs"].items():
        names = given["keys"].get(key, [])
        found = _pieces(options, key, names)
        new = [
            shard_of(part, *piece)
            for part, one in _runs(options, job).items()
            for piece in rounds.pieces(
                one, given["shard_events"], rounds.followed(one, found.get(part, []))[1]
            )
        ]
        needed[key] = list(dict.fromkeys([*names, *new]))
    write_json(options.output[0], needed)


def merge(options):
    """Write what a module finds at one radius, given its shards, and what all of them took.

    The output is a bundle of that point alone.
    """
    given, rounds = checked(_given(options), "keys"), module_of("sampling.rounds")
    if len(keys := given.pop("keys")) != 1:
        raise InputError(f"keys must name one point, not {len(keys)}")
    ((key, names),) = keys.items()
    start = time.process_time()
    found, done = _pieces(options, key, names), {}
    for part, one in _runs(options, given).items():
        done[part], needed = rounds.followed(one, found.get(part, []))
        if needed > done[part].blocks:
            raise InputError(f"the shards of {part} at radius {key} end too early")
    result = call(function_of(options.module, "merged"), given, done=done)
    record, one = module_of("pipeline.results.record"), point_of(options, key)
    record.claim(Path(options.output[0]).absolute(), [key])
    write_json(one.output[0], result)
    costs = [Path(options.points[0], key, "cost", f"{name}.json") for name in names]
    seconds = time.process_time() - start
    seconds += sum(json.loads(path.read_text(encoding="utf-8"))["seconds"] for path in costs)
    events = result[module_of(options.module).WORK]
    write_json(one.cost, {"events": events, "seconds": seconds})
    keep_record(one, inputs_of(options))
    write_json(options.output[0], {key: record.digest(*one.output)})


def table(options):
    """Write the table that a module makes of its parameters, of other tables and of points."""
    work = function_of(options.module, options.function)
    if "points" in inspect.signature(work).parameters and not options.points:
        raise InputError(f"{options.function} needs --points")
    start = time.process_time()
    rows = call(
        work,
        parameters(options.parameters),
        tables=read_tables(options.table),
        points=options.points,
        report=progress(start),
    )
    (path,) = options.output
    table_of(Path(path).stem, options.module).write(path, rows)


def _given(options):
    """Return the parameters of a job, with those of the file of keys."""
    more = parameters(f"@{options.keys}") if options.keys else {}
    return parameters(options.parameters) | more


def inputs_of(options):
    """Return {name: paths} of the files that a job reads; raise ``InputError`` for a damaged one.

    Those are the files that are no longer what their own jobs wrote.
    """
    found = {name: [path] for name, path in named(options.table, "--table").items()}
    for path in map(Path, options.points):
        if path.is_file():
            found.setdefault("points", []).append(path)
            continue
        for stage, keys in checked(_given(options)).get("keys", {}).items():
            cost = options.function == "cost_rows"
            names = [f"cost/{stage}-{key}" if cost else f"{stage}/{key}" for key in keys]
            found[stage] = [path / f"{name}.json" for name in names]
    for path in (path for paths in found.values() for path in paths):
        module_of("pipeline.results.record").require(path)
    return found


def made_by(options):
    """Return what makes the files of a job."""
    made = {"about": options.about, "code": options.code, "job": options.job}
    made |= {"function": options.function, "module": options.module}
    return made | {"parameters": parameters(options.parameters) if options.parameters else {}}


def keep_record(options, inputs):
    """Record what made the files of a job."""
    paths = [*options.output, *([options.cost] if options.cost else [])]
    module_of("pipeline.results.record").write(paths, inputs, **made_by(options))


def origin(options):
    """Return a line that says what made a figure: the scene, the seed, and hashes of the rest."""
    record = module_of("pipeline.results.record")
    tables = [path for _, path in sorted(named(options.table, "--table").items())]
    words = [
        options.about,
        f"code {options.code}",
        f"parameters {record.short(options.parameters)}",
    ]
    words += [f"tables {record.digest(*tables)[:16]}"] if tables else []
    return "twodiscs: " + ", ".join(filter(None, words))


def figure(options):
    """Draw the figure of a module."""
    draw = function_of(options.module, "draw")
    given, tables = parameters(options.parameters), read_tables(options.table)
    style = module_of("figures.kit.style")
    with style.context():
        drawn = call(draw, given, tables=tables)
        for path in options.output:
            style.save(drawn, path, origin(options))


def animation(options):
    """Draw the animation of a trajectory."""
    animate = function_of(options.module, "animate")
    given, tables = parameters(options.parameters), read_tables(options.table)
    style = module_of("figures.kit.style")
    with style.context():
        call(animate, given, rows=tables["trajectory"], paths=options.output)


def kernels(options):
    """Compile the kernels of modules, those of a scene or those of all plain ones."""
    given = parameters(options.parameters) if options.parameters else {}
    for name in options.module.split(","):
        call(function_of(name, "compile_kernels"), given)
    Path(options.output[0]).touch()


def verdict(options):
    """Write a line per scene if every comparison passed; otherwise print failures and return 1."""
    judge = function_of(options.module, "verdict")
    if not options.table:
        raise InputError("verdict needs --table, the check table of a scene or of several")
    failures, text = judge(read_tables(options.table))
    if failures:
        print("\n".join(failures), file=sys.stderr)
        return 1
    print(text, end="")
    Path(options.output[0]).write_text(text, encoding="utf-8", newline="\n")
    return 0


JOBS = {
    "point": point,
    "bundle": bundle,
    "shard": shard,
    "plan": plan,
    "merge": merge,
    "table": table,
    "figure": figure,
    "animation": animation,
    "kernels": kernels,
    "verdict": verdict,
}


def main():
    parser = Parser(prog="twodiscs.pipeline.jobs", description="Do one job of the workflow.")
    parser.add_argument("job", choices=JOBS)
    parser.add_argument("module", help="the module that does the work, named from the package on")
    parser.add_argument("--function", default="rows", help="what makes the rows of a table")
    parser.add_argument("--parameters", help="all that the job depends on, JSON or @path")
    parser.add_argument("--table", nargs="*", default=[], metavar="NAME=CSV")
    parser.add_argument(
        "--points", nargs="*", default=[], metavar="PATH", help="points, or folders"
    )
    parser.add_argument("--keys", metavar="JSON", help="a file that says which points there are")
    parser.add_argument("--output", nargs="+", required=True, metavar="FILE")
    parser.add_argument("--cost", metavar="JSON", help="where to write the work and the seconds")
    parser.add_argument("--about", help="the scene and the root seed, for the record")
    parser.add_argument("--code", help="the fingerprint of the sources, for the record")
    options = parser.parse_args()
    if options.parameters is None and options.job not in ("kernels", "verdict"):
        raise InputError(f"{options.job} needs --parameters")
    inputs = inputs_of(options)
    status = JOBS[options.job](options)
    if not status and options.job != "kernels":
        keep_record(options, inputs)
    return status


if __name__ == "__main__":
    run(main)
