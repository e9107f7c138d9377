"""Which jobs an edit reruns.

Without these tests an edit could leave what depends on it, or rerun what does not.
"""

import os
import re
from pathlib import Path

import pytest
from checkout import REPOSITORY, first
from commands import python
from test_layout import FILES, imported_modules, imports_of

from twodiscs_paper.catalogue import STUDIES
from twodiscs_paper.studies.effects.study import SCENES

FULL, WALLS = "scene=full", "scene=walls"


#: The jobs of a study: rules with their wildcards.
MEASURED = {"study_table": "table=tails", "shared_figure": "figure=tails"}

#: {table of a study: the study}
STUDY_OF = {table.name(): study.name for study in STUDIES.values() for table in study.tables}


def expected(*jobs):
    """Return jobs, each given as its rule and its wildcards."""
    return {(rule, tuple(wildcards)) for rule, *wildcards in jobs}


def test_after_a_full_build_and_if_files_are_touched_there_is_nothing_to_do(built):
    for path in built.path.rglob("*"):
        if ".snakemake" not in path.parts and path.is_file():
            os.utime(path)
    environment = os.environ | {"PYTHONPATH": first(str(built.path / "src"))}
    words = "-X", "importtime", "-m", "snakemake", "--dry-run"
    run = python(*words, cwd=built.path, env=environment, check=True)
    assert "Nothing to be done" in run.stdout + run.stderr
    imported = {line.rpartition(" ")[2] for line in run.stderr.splitlines()}
    assert "twodiscs.theory.exact" in imported
    assert not {"numba", "scipy.special", "matplotlib", "mpmath"} & imported


def test_one_more_radius_runs_one_job_of_each_kind(built):
    built.configure(lambda mapping: mapping["scenes"][0]["radii"].append(0.1234))
    jobs = built.jobs()
    assert {job for job in jobs if any("radius=" in part for part in job[1])} == expected(
        *((stage, FULL, f"stage={stage}", "radius=0.1234") for stage in ("monte_carlo", "dynamics"))
    )
    assert not [job for job in jobs if WALLS in job[1]]
    assert {rule for rule, _ in jobs} == {
        *("monte_carlo", "dynamics", "exact", "table", "check", "figure", "configuration"),
        "study_table",
    } | DOCUMENTS


#: Sources that no result depends on, or only through the parameters of jobs.
NO_CODE = {"__init__", "__main__", "catalogue", "cli", "configuration"}

#: The modules that a job runs in another process.
SPAWNED = {"src/twodiscs_paper/studies/effects/engine_without_effects.py"}

#: Modules that are imported without an effect on a table: the start of a job, titles and captions.
NO_NUMBER = {"src/twodiscs_paper/pipeline/job.py"}
NO_NUMBER |= {f"src/twodiscs/figures/{name}.py" for name in ("scene_figures", "curves")}

#: The modules that import every study and every figure of a study: a job uses one of them, and
#: no build counts calibration again.
REGISTRIES = {
    ("twodiscs_paper", "catalogue"), ("twodiscs_paper", "draw"),
    ("twodiscs_paper", "studies", "stability", "calibration"),
}  # fmt: skip


@pytest.fixture(scope="module")
def planned_files(unbuilt):
    """The jobs of all targets: [(rule, inputs, first output)]."""
    targets = "all", "paper", "benchmark", "explorer", *STUDIES
    printed = unbuilt.snakemake("--dry-run", "--forceall", "--", *targets).stdout
    job = r"^(?:local)?rule (\w+):\n    input: (.*)\n    output: ([^,\n]*)"
    found = re.findall(job, printed, re.MULTILINE)
    return [(rule, {*inputs.split(", ")}, output) for rule, inputs, output in found]


@pytest.fixture(scope="module")
def groups(planned_files):
    """The sources of the groups of code by their checksums."""
    return {output: inputs for rule, inputs, output in planned_files if rule == "code"}


def test_the_checksums_are_also_those_of_files_that_no_job_imports(groups):
    """Styles, templates, and a module that runs in another process."""
    paths = [*(REPOSITORY / "src").rglob("*.mplstyle"), *(REPOSITORY / "src").rglob("*.html")]
    files = {path.relative_to(REPOSITORY).as_posix() for path in paths}
    assert SPAWNED | files <= set().union(*groups.values())


def test_a_job_has_the_code_that_its_script_imports(planned_files, groups):
    """An import in a function counts, too, and so do the imports of the module that it names.

    A file of a group that no job with the group imports would rerun them all without a reason.
    """
    names = {path.relative_to(REPOSITORY).as_posix(): module for module, path in FILES.items()}
    paths = {module: path for path, module in names.items()}
    lacking, needless = set(), {group: {*files} for group, files in groups.items()}
    for rule, inputs, output in planned_files:
        sums = inputs & groups.keys()
        if "workflow/scripts/study.py" in inputs:  # a part is in the folder of its study
            study = STUDY_OF.get(Path(output).stem, Path(output).parent.name)
            assert study in {Path(one).stem for one in sums}, output
        own = inputs.union(*(groups[one] for one in sums if Path(one).stem in STUDIES))
        todo = {names[path] for path in own & names.keys() if path.endswith("/study.py")}
        scripts = [path for path in inputs if path.startswith("workflow/scripts/")]
        todo = todo.union(*(imported_modules(REPOSITORY / script) for script in scripts))
        reached = set()
        while scripts and todo:
            reached.add(module := todo.pop())
            if module not in REGISTRIES and module[1] not in NO_CODE:
                todo |= imports_of(module) - reached
        code = {paths[module] for module in reached if module[1] not in NO_CODE}
        for group in sums:
            needless[group] -= code
        code = {path for path in code - NO_NUMBER if not path.endswith("__init__.py")}
        lacking |= {(rule, path) for path in code - inputs.union(*(groups[one] for one in sums))}
    assert lacking == set()
    unused = set().union(*needless.values()) - SPAWNED
    assert [path for path in unused if path.endswith(".py") and "__init__" not in path] == []


def test_the_manuscript_is_made_again_after_an_edit_of_a_file_that_its_texts_read(planned_files):
    (inputs,) = (inputs for rule, inputs, _ in planned_files if rule == "paper")
    reads = r'\b(?:import|read|yaml|bibliography)\b[ (]+"([^"]*\.\w+)"'
    texts = "".join(path.read_text("utf-8") for path in REPOSITORY.glob("paper/*.typ"))
    found = {os.path.normpath(f"paper/{path}") for path in re.findall(reads, texts)}
    assert {"paper/read.typ", "CITATION.cff", "paper/long_run/far/mean_times.csv"} <= found
    assert found <= inputs


DOCUMENTS = {"report", "manifest", "provenance"}
COUNTED = {"monte_carlo", "dynamics", "intervals"}
DRAWN = {"figure", "shared_figure", "animate"}
TABLES = {"exact", "trajectory", "table", "check", "figure", "study_table"}

#: (Edited file, rules that run, rules that do not, all others if None).
EDITS = [
    ("src/twodiscs_paper/studies/tails/figure.py", {"shared_figure"} | DOCUMENTS, None),
    ("src/twodiscs_paper/studies/tails/measure.py", {*MEASURED} | DOCUMENTS, None),
    ("src/twodiscs_paper/pipeline/documents/report.py", {"check", "report", "provenance"}, None),
    ("workflow/scripts/point.py", COUNTED, {"exact", "trajectory"}),
    ("src/twodiscs/figures/style.py", DRAWN | DOCUMENTS, None),
    ("src/twodiscs/analysis/tables.py", TABLES, COUNTED),
]


@pytest.fixture(scope="module")
def everything(complete):
    """All jobs of the build."""
    return {*complete.jobs("--forceall")}


@pytest.mark.parametrize(("path", "run", "kept"), EDITS, ids=[path for path, *_ in EDITS])
def test_an_edit_reruns_what_depends_on_it_and_is_named(built, everything, path, run, kept):
    built.edit(path, "\n\nREMARK = 1\n")
    jobs = {*built.jobs()}
    rules = {rule for rule, _ in jobs}
    assert run <= rules
    assert not rules & (kept or {rule for rule, _ in everything} - run)
    assert re.search(rf"reason:.*{path}", built.printed)
    if "tails" in path:
        assert jobs - expected(*((rule,) for rule in DOCUMENTS)) == expected(
            *((rule, wildcard) for rule, wildcard in MEASURED.items() if rule in run)
        )
    else:  # all jobs of the rules, of all scenes
        assert {job for job in everything if job[0] in run & (COUNTED | DRAWN)} <= jobs


def test_other_events_that_are_timed_leave_the_areas(built):
    built.configure(lambda mapping: mapping["scenes"][0]["watch"].update(mean_times=["top_wall"]))
    tables = [wildcards for rule, wildcards in built.jobs() if rule == "table"]
    assert {*tables} == {(FULL, f"table={name}") for name in ("mean_times", "check", "cost")}


def test_an_edit_of_a_scene_with_effects_counts_that_one_again(built):
    built.edit("config/scenes/field.yaml", "# a remark\n")
    assert not built.jobs()
    built.replace("config/scenes/field.yaml", "accuracy: draft", "accuracy: 2e-2")
    jobs = built.jobs()
    counted = [wildcards for rule, wildcards in jobs if rule == "dynamics"]
    assert counted == [("scene=effects/field", "stage=dynamics", "radius=0.3")]
    assert {rule for rule, _ in jobs} == {"dynamics", "table", *MEASURED} | DOCUMENTS


def test_a_figure_is_a_target_by_its_name(unbuilt):
    scenes = {"volume": [FULL], "model": [FULL, WALLS], "mean_wall_time": [FULL, WALLS]}
    drawn = {job for job in unbuilt.jobs(*scenes) if job[0] == "figure"}
    assert drawn == expected(
        *(("figure", scene, f"figure={name}") for name in scenes for scene in scenes[name])
    )
    # A drawing needs no simulation, and the explorer no points.
    jobs = unbuilt.jobs("explorer", "results/full/figures/model.pdf")
    assert [rule for rule, _ in jobs] == ["explorer", "figure"]


def test_effects_are_a_target_that_counts_every_scene_as_any_other(unbuilt):
    jobs = unbuilt.jobs("effects", "--cores", "3")
    # The job that measures seconds has all cores, so no other one runs beside it.
    assert re.findall(r"wildcards: (.*)\n    threads: 3", unbuilt.printed) == ["table=effects_cost"]
    rules = {"dynamics", "table"}
    assert {rule for rule, _ in jobs} == rules | {"effects", "study_table", "shared_figure"}
    for rule in rules:
        scenes = {words[0] for name, words in jobs if name == rule}
        assert scenes == {f"scene=effects/{name}" for name in SCENES}
    tables = (("study_table", f"table=effects{end}") for end in ("", "_cost"))
    assert expected(*tables, ("shared_figure", "figure=effects")) <= {*jobs}
