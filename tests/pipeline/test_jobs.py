"""The jobs of the workflow: what each of them writes, and one sentence for what makes no sense."""

import json
import sys
from importlib import import_module

import numpy as np
import pytest
from fabricated import BOX, RADII, Laws, command, scenes, store, theory_rows

from twodiscs.comparison.rows import exact_values, volume_rows
from twodiscs.comparison.scene_tables import SCENE_TABLES, Check, Theory, Volume
from twodiscs.figures.catalogue import FIGURES
from twodiscs.model.box import Box
from twodiscs.pipeline import jobs
from twodiscs.pipeline.configuration.request import STAGES
from twodiscs.studies.catalogue import STUDIES, STUDY_TABLES

PLACE = {"box": BOX.parameters(), "radius": 0.2, "seed": 1}
POINTS = {
    "monte_carlo": PLACE | {"areas": ["top_wall"], "samples": 1, "shell": 0.02, "volume": True},
    "dynamics": PLACE | {"accuracy": {"any_wall": 0.1}, "event_budget": 1},
    "intervals": PLACE | {"event": "vertical_hop", "intervals": 1},
}


@pytest.fixture
def run(monkeypatch, tmp_path):
    """Return a function that runs a job in an empty folder and returns its exit status."""
    monkeypatch.chdir(tmp_path)
    return lambda *words: command(monkeypatch, jobs, *words)


# Points ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("stage", STAGES)
def test_a_point_is_what_its_module_finds(run, tmp_path, stage):
    module, given = import_module(f"twodiscs.{STAGES[stage]}"), POINTS[stage]
    words = ["--output", "a.json", "--cost", "cost.json"]
    assert run("point", STAGES[stage], "--parameters", given, *words) == 0
    found = json.loads((tmp_path / "a.json").read_text())
    assert found == json.loads(json.dumps(module.job(**given | {"box": BOX})))
    assert list(found) == sorted(found)
    cost = json.loads((tmp_path / "cost.json").read_text())
    assert cost.keys() == {"events", "seconds"}
    assert cost["events"] == found[module.WORK] > 0
    assert cost["seconds"] > 0


def test_parameters_may_be_in_a_file_and_say_all_that_counts(run, tmp_path):
    (tmp_path / "given.json").write_text(json.dumps(POINTS["dynamics"]))
    for name in ("one", "two"):
        words = "--parameters", "@given.json", "--output", f"{name}.json"
        assert run("point", "dynamics.counting", *words) == 0
    other = POINTS["dynamics"] | {"seed": 2}
    assert run("point", "dynamics.counting", "--parameters", other, "--output", "other.json") == 0
    one, two, other = ((tmp_path / f"{name}.json").read_text() for name in ("one", "two", "other"))
    assert one == two != other


def test_a_bundle_is_its_points_and_does_what_is_missing(run, tmp_path, monkeypatch):
    """The points of a bundle, their records too, are those of jobs of their own."""
    given = {repr(r): POINTS["dynamics"] | {"radius": r} for r in RADII}
    points = tmp_path / "points" / "dynamics"

    def bundle(jobs):
        words = ["--parameters", {"jobs": jobs}, "--about", "scene paper"]
        output = points / "bundles" / "b.json"
        assert run("bundle", "dynamics.counting", *words, "--output", output) == 0
        files = [*points.glob("0*.json"), *points.glob(".record/0*.json")]
        assert json.loads(output.read_text()).keys() == jobs.keys()
        return {path.relative_to(points): path.read_bytes() for path in files}

    (points / "bundles").mkdir(parents=True)
    first, *others = given
    bundle({first: given[first]})
    stamp = (points / f"{first}.json").stat().st_mtime_ns
    whole = bundle(given)
    assert (points / f"{first}.json").stat().st_mtime_ns == stamp
    # What was edited, has another parameter or has lost what it took is made again.
    for key in others[:2]:
        (points / f"{key}.json").write_text("{}")
    (points.parent / "cost" / f"dynamics-{others[2]}.json").unlink()
    assert bundle(given) == whole
    assert (points.parent / "cost" / f"dynamics-{others[2]}.json").exists()
    assert bundle(given | {first: given[first] | {"seed": 2}}) != whole
    assert bundle(given) == whole
    # Who forces a job wants all of it.
    stamp = (points / f"{first}.json").stat().st_mtime_ns
    monkeypatch.setenv("TWODISCS_ANEW", "1")
    assert bundle(given) == whole
    assert (points / f"{first}.json").stat().st_mtime_ns > stamp
    monkeypatch.delenv("TWODISCS_ANEW")

    key = others[0]
    (points / f"{key}.json").unlink()
    words = ["--parameters", given[key], "--about", "scene paper"]
    words += ["--output", points / f"{key}.json"]
    assert run("point", "dynamics.counting", *words) == 0
    assert bundle(given) == whole


def test_a_long_job_says_what_it_has_done_and_what_is_left(run, capsys):
    assert run("point", "dynamics.counting", "--parameters", POINTS["dynamics"],
               "--output", "a.json") == 0  # fmt: skip
    said = capsys.readouterr().err.splitlines()
    assert said
    assert all(line.endswith(" s left") and "of the target" in line for line in said)


# Tables ---------------------------------------------------------------------------------------


def exact_table(path, function="theory_rows", radii=RADII):
    """Return the words that make theory.csv, or another exact table."""
    given = {"box": BOX.parameters(), "radii": list(radii)}
    return ("table", "theory.exact", "--function", function, "--parameters", given,
            "--output", path)  # fmt: skip


def test_a_table_is_what_its_function_returns(run, tmp_path):
    assert run(*exact_table("theory.csv")) == 0
    assert Theory.read(tmp_path / "theory.csv") == theory_rows()
    assert run(*exact_table("grid.csv", "grid_rows")) == 0
    found = SCENE_TABLES["grid"].read(tmp_path / "grid.csv")
    assert [row["radius"] for row in found] == list(RADII)


def test_a_table_is_made_of_points_and_of_other_tables(run, tmp_path):
    rng = np.random.default_rng(1)
    points = {f"{s.radius!r}": Laws(s).monte_carlo(rng, 10**6) for s in scenes()}
    store(tmp_path / "points" / "monte_carlo", points)
    Theory.write(tmp_path / "theory.csv", theory_rows())
    given = {"box": BOX.parameters(), "keys": {"monte_carlo": list(points)}}
    words = ("--function", "volume_rows", "--parameters", given, "--points", "points")
    status = run("table", "comparison.gather", *words, "--table", "theory=theory.csv",
                 "--output", "volume.csv")  # fmt: skip
    assert status == 0
    expected = volume_rows(exact_values(theory_rows()), list(points.values()))
    assert Volume.read(tmp_path / "volume.csv") == expected


@pytest.mark.parametrize("name", SCENE_TABLES | STUDY_TABLES)
def test_every_table_is_found_by_its_name(name):
    known = (SCENE_TABLES | STUDY_TABLES)[name]
    beside = next((s.code for s in STUDIES.values() if known in s.tables), "")
    assert jobs.table_of(name, beside) is known
    if name != "long_runs":  # that no other job reads
        assert jobs.table_of(name) is known


def test_verdict_writes_a_line_a_scene_or_names_what_failed(run, tmp_path, capsys):
    good = Check.empty(comparison="volume", quantity="volume", method="monte_carlo", radius=0.1)
    good |= {"z": 0.5, "bound": 4.0, "passed": True, "independent": True}
    bad = good | {"radius": 0.2, "z": 9.0, "passed": False}
    for scene, rows in {"a": [good], "b": [good, bad]}.items():
        (tmp_path / scene).mkdir()
        Check.write(tmp_path / scene / "check.csv", rows)
    words = ("verdict", "pipeline.results.verdict", "--table", "a=a/check.csv")
    assert run(*words, "--output", "check.passed") == 0
    text = (tmp_path / "check.passed").read_text()
    assert text.startswith("a: 1 comparisons passed, 1 of them independent tests, largest |z| 0.5;")
    assert capsys.readouterr().out == text
    assert run(*words, "b=b/check.csv", "--output", "other") == 1
    said = capsys.readouterr().err
    assert said == (
        "b: volume of volume at radius 0.2 by monte_carlo has z = 9, beyond the bound 4\n"
    )
    assert not (tmp_path / "other").exists()


# Figures and kernels --------------------------------------------------------------------------


def test_a_figure_is_written_to_every_path_and_the_same_bytes_again(run, tmp_path):
    given = {"box": BOX.parameters()}
    for folder in ("one", "two"):
        (tmp_path / folder).mkdir()
        paths = [f"{folder}/model.pdf", f"{folder}/model.png"]
        assert run("figure", "figures.geometry.model", "--parameters", given,
                   "--output", *paths) == 0  # fmt: skip
    for name, start in (("model.pdf", b"%PDF"), ("model.png", b"\x89PNG")):
        drawn = (tmp_path / "one" / name).read_bytes()
        assert drawn.startswith(start)
        assert (tmp_path / "two" / name).read_bytes() == drawn


def test_a_figure_reads_its_tables(run, tmp_path):
    row = Volume.empty(quantity="volume", method="monte_carlo", status="sampled", z=0.5)
    exact = {r["radius"]: r["exact"] for r in theory_rows() if r["quantity"] == "volume"}
    rows = [
        row | {"radius": r, "exact": x, "estimate": x, "stderr": 1e-3} for r, x in exact.items()
    ]
    Volume.write(tmp_path / "volume.csv", rows)
    given = {"box": PLACE["box"], **FIGURES["volume"].options}
    words = ("figure", "figures.radius", "--parameters", given, "--output", "volume.png")
    assert run(*words, "--table", "volume=volume.csv") == 0
    assert (tmp_path / "volume.png").stat().st_size > 10_000


@pytest.mark.parametrize("given", [(), ("--parameters", {"box": BOX.parameters()})])
def test_kernels_of_modules_are_compiled_before_the_stamp_is_written(run, tmp_path, given):
    assert run("kernels", "dynamics.counting,dynamics.intervals", *given, "--output", "done") == 0
    assert (tmp_path / "done").read_bytes() == b""


# What makes no sense --------------------------------------------------------------------------


def words(job, module, given, *more):
    """Return the words of a job that ought to write the file ``output``."""
    return [job, module, "--parameters", given, *more, "--output", "output"]


def counting(**changes):
    return words("point", "dynamics.counting", POINTS["dynamics"] | changes)


OF_BOX = {"box": PLACE["box"]}
MISTAKES = {
    "no job": ([], "the following arguments are required: job, module, --output"),
    "an unknown job": (words("draw", "x", {}), "argument job: invalid choice: 'draw'"),
    "half an option": (["point", "x", "--out", "output"], "are required: --output"),
    "no output": (["point", "x", "--parameters", "{}"], "are required: --output"),
    "no parameters": (["point", "x", "--output", "output"], "point needs --parameters"),
    "a bundle of nothing": (
        words("bundle", "dynamics.counting", {}), "parameters must have jobs, but"
    ),
    "a bundle of no block": (
        words("bundle", "dynamics.counting", {"jobs": ["0.2"]}),
        "jobs must be a block of blocks of parameters, not ['0.2']",
    ),
    "a plan for nothing": (
        words("plan", "dynamics.counting", {"jobs": {}}, "--points", "p"),
        "parameters must have keys, but have jobs",
    ),
    "no part": (
        words("shard", "dynamics.counting", POINTS["dynamics"], "--cost", "c"),
        "parameters must have part, but have",
    ),
    "another part": (
        words(
            "shard", "dynamics.counting",
            POINTS["dynamics"] | {"part": "half", "first": 0, "stop": 1}, "--cost", "c",
        ),
        "part must be one of all, not 'half'",
    ),
    "a merge of nothing": (
        words("merge", "dynamics.counting", POINTS["dynamics"], "--points", "p"),
        "parameters must have keys, but have",
    ),
    "a merge of two": (
        words("merge", "dynamics.counting", {"keys": {"0.1": [], "0.2": []}}, "--points", "p"),
        "keys must name one point, not 2",
    ),
    "no module": (words("point", "nothing", {}), "module must be one of the package twodiscs"),
    "another package": (words("point", "os", {}), "module must be one of the package twodiscs"),
    "no module but a class": (words("point", "model.box.Box", {}), "module must be one of"),
    "a module above": (words("point", "..model", {}), "module must be one of the package"),
    "no function": (words("point", "theory.exact", {}), "theory.exact must have a function job"),
    "no JSON": (words("point", "dynamics.counting", "{'a': 1}"), "must be a JSON object"),
    "no object": (words("point", "dynamics.counting", "[1]"), "must be a JSON object"),
    "no number": (words("point", "dynamics.counting", '{"a": NaN}'), "must be a JSON object"),
    "no file": (words("point", "dynamics.counting", "@no.json"), "no.json: No such file"),
    "too few": (words("point", "dynamics.counting", {}), "missing a required argument: 'box'"),
    "too many": (counting(mass=1), "got an unexpected keyword argument 'mass'"),
    "no box": (counting(box=3), "box must be a block of width, height and maybe effects, not 3"),
    "null for a box": (counting(box=None), "box must be a block of width, height and"),
    "half a box": (counting(box={"width": 1}), "box must be a block of width, height and maybe"),
    "radii of no list": (
        words("table", "theory.exact", OF_BOX | {"radii": None},
              "--function", "grid_rows"),
        "radii must be a list of numbers, not None",
    ),
    "keys of another kind": (
        words("table", "comparison.gather", {"keys": {"dynamics": [None]}},
              "--function", "cost_rows", "--points", "no"),
        "keys must be a block of lists of texts, not {'dynamics': [None]}",
    ),
    "a scene of another kind": (
        words("table", "studies.distributions.measure", {"scenes": [{}], "seed": 1}),
        "scenes must be a list or a block of scenes, not [{}]",
    ),
    "an unknown effect": (
        counting(box=PLACE["box"] | {"effects": {"wind": 1}}),
        "effects must be a dict of some of depth",
    ),
    "a radius too large": (counting(radius=0.4), "radius 0.4 does not fit"),
    "a seed of another kind": (counting(seed="1"), "seed must be an integer"),
    "an event that is no hop": (
        words("point", "dynamics.intervals", POINTS["intervals"] | {"event": "top_wall"}),
        "event must be one of vertical_hop, horizontal_hop, not 'top_wall'",
    ),
    "a function of another name": (
        words("table", "theory.exact", OF_BOX | {"radii": [0.1]}),
        "theory.exact must have a function rows",
    ),
    "no such table": (exact_table("output"), "there is no table called 'output'"),
    "a path without a name": (
        words("table", "studies.thresholds.measure", {}, "--table", "theory.csv"),
        "--table must be given as NAME=VALUE, not 'theory.csv'",
    ),
    "a table that is not there": (
        words("verdict", "pipeline.results.verdict", {}, "--table", "a=no/check.csv"),
        "no/check.csv: No such file or directory",
    ),
    "no table for a verdict": (
        words("verdict", "pipeline.results.verdict", {}),
        "verdict needs --table, the check table of a scene or of several",
    ),
    "a table that is needed": (
        words("figure", "figures.hop_histogram", OF_BOX),
        "the table hop_histogram must be given, as --table hop_histogram=CSV",
    ),
    "a trajectory that is needed": (
        words("animation", "figures.motion.animation", OF_BOX | {"radius": 0.2}),
        "the table trajectory must be given, as --table trajectory=CSV",
    ),
    "points that are needed": (
        words("table", "comparison.gather", {"keys": {}}, "--function", "cost_rows"),
        "cost_rows needs --points",
    ),
    "points that are not there": (
        words("table", "comparison.gather", {"keys": {"dynamics": ["0.1"]}},
              "--function", "cost_rows", "--points", "no"),
        "no/cost/dynamics-0.1.json: No such file or directory",
    ),
    "a figure of another kind": (
        words("figure", "figures.geometry.model", OF_BOX),
        "path must be a .pdf, .png or .svg file, not 'output'",
    ),
    "no kernels": (words("kernels", "theory.exact", {}), "must have a function compile_kernels"),
}  # fmt: skip


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_one_sentence_and_status_2(run, tmp_path, capsys, mistake):
    given, sentence = MISTAKES[mistake]
    assert run(*given) == 2
    shown = capsys.readouterr()
    assert shown.out == ""
    assert shown.err.startswith("error: ")
    assert sentence in shown.err
    assert shown.err.count("\n") == 1
    assert [*tmp_path.iterdir()] == []


def test_a_package_that_is_not_installed_is_no_mistake_of_the_caller(tmp_path, monkeypatch):
    import twodiscs

    (tmp_path / "broken.py").write_text("import surely_not_installed\n")
    monkeypatch.setattr(twodiscs, "__path__", [*twodiscs.__path__, str(tmp_path)])
    with pytest.raises(ModuleNotFoundError, match="surely_not_installed"):
        jobs.module_of("broken")
    assert "twodiscs.broken" not in sys.modules


def test_a_box_is_made_of_its_parameters_and_given_only_what_is_taken():
    def work(box, radius, report=None):
        return box, radius, report

    effects = {"field": 1.0}
    given = {"box": {"width": 2, "height": 1, "effects": effects}, "radius": 0.1}
    assert jobs.call(work, given, report=3, tables={}) == (Box(2, 1, effects), 0.1, 3)
