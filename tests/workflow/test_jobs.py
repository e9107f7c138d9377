"""Which jobs run after which edit: what depends on the edit, and nothing else."""

import os
import re

from twodiscs_paper.catalogue import STUDIES

FULL, WALLS = "scene=full", "scene=walls"


def expected(*jobs):
    """Return the sorted jobs, each given as its rule and its wildcards."""
    return sorted((rule, tuple(wildcards)) for rule, *wildcards in jobs)


def test_after_a_full_build_there_is_nothing_to_do(complete):
    run = complete.snakemake("--dry-run")
    assert "Nothing to be done" in run.stdout + run.stderr


def test_touched_files_rerun_nothing(built):
    for folder, _, names in os.walk(built.path):
        if ".snakemake" not in folder:
            for name in names:
                os.utime(os.path.join(folder, name))
    run = built.snakemake("--dry-run")
    assert "Nothing to be done" in run.stdout + run.stderr


def test_one_more_radius_runs_one_job_of_each_kind(built):
    built.configure(lambda mapping: mapping["scenes"][0]["radii"].append(0.1234))
    jobs = built.jobs()
    assert [job for job in jobs if any("radius=" in part for part in job[1])] == expected(
        *((stage, FULL, f"stage={stage}", "radius=0.1234") for stage in ("monte_carlo", "dynamics"))
    )
    assert not [job for job in jobs if WALLS in job[1]]
    assert {rule for rule, _ in jobs} == {
        *("monte_carlo", "dynamics", "exact", "table", "check"),
        *("study_table", "figure", "report", "manifest", "provenance"),
        *("configuration", "shared_figure"),
    }


#: Sources that no result depends on, or only through the parameters of jobs.
NO_CODE = {"__init__", "__main__", "arguments", "catalogue", "cli", "configuration"}


def test_the_checksums_are_those_of_all_sources(unbuilt):
    """A folder or module that is added belongs to a group, or to ``NO_CODE``."""
    targets = "all", "paper", "benchmark", *STUDIES
    printed = unbuilt.snakemake("--dry-run", "--forceall", "--", *targets).stdout
    jobs = printed.split("rule code:")[1:]
    listed = {
        path
        for job in jobs
        for path in re.search(r"^    input: (.*)$", job, re.MULTILINE)[1].split(", ")
    }
    source = unbuilt.path / "src"
    paths = {path.relative_to(source) for path in source.rglob("*.py")}
    counted = {path.as_posix() for path in paths if path.with_suffix("").parts[1] not in NO_CODE}
    # Those that draw a figure of a study are inputs of its jobs; the folder of studies has no code.
    drawing = {path for path in counted if re.search("twodiscs_paper/studies/.*/figure", path)}
    counted -= drawing | {"twodiscs_paper/studies/__init__.py"}
    assert listed == {f"src/{path}" for path in counted}


CODE = "\n\nREMARK = 1\n"
DOCUMENTS = [("report",), ("manifest",), ("provenance",)]
COUNTED = {"monte_carlo", "dynamics", "intervals"}


def reasons(checkout, *targets):
    """Return the sentences that a dry run prints as the reasons of its jobs."""
    printed = checkout.snakemake("--dry-run", *targets).stdout
    return [line.strip() for line in printed.splitlines() if "reason:" in line]


def test_edit_of_a_figure_of_a_study_draws_it_again_and_is_named(built):
    path = "src/twodiscs_paper/studies/tails/figure.py"
    built.edit(path, CODE)
    assert built.jobs() == expected(("shared_figure", "figure=tails"), *DOCUMENTS)
    assert any(path in reason for reason in reasons(built, "tails"))


def test_edit_of_a_study_measures_it_again(built):
    built.edit("src/twodiscs_paper/studies/tails/measure.py", CODE)
    assert built.jobs() == expected(
        ("study_table", "table=tails"), ("shared_figure", "figure=tails"), *DOCUMENTS
    )


def test_edit_of_a_document_makes_documents_again(built):
    built.edit("src/twodiscs_paper/pipeline/documents/report.py", CODE)
    assert {rule for rule, _ in built.jobs()} == {"check", "report", "provenance"}


def test_edit_of_the_script_of_points_makes_them_again(built):
    built.edit("workflow/scripts/point.py", "# a remark\n")
    rules = {rule for rule, _ in built.jobs()}
    assert rules > COUNTED
    assert not {"exact", "trajectory"} & rules


def test_edit_of_how_figures_look_redraws_all_of_them_and_computes_nothing(built):
    drawn = [job for job in built.results() if job.endswith(".png")]
    built.edit("src/twodiscs/figures/style.py", CODE)
    jobs = built.jobs()
    assert {rule for rule, _ in jobs} == {
        *("figure", "shared_figure", "animate", "report", "manifest", "provenance"),
    }
    assert len(jobs) == len(drawn) + len(DOCUMENTS)


def test_edit_of_columns_makes_tables_again_and_computes_nothing(built):
    built.edit("src/twodiscs/comparison/table.py", CODE)
    rules = {rule for rule, _ in built.jobs()}
    assert {"exact", "trajectory", "table", "check", "figure", "study_table"} <= rules
    assert not COUNTED & rules


def test_edit_of_the_physics_reruns_all_points_and_what_follows_and_is_named(built):
    path = "src/twodiscs/dynamics/law.py"
    everything = built.jobs("--forceall")
    built.edit(path, CODE)
    assert {*everything} - {*built.jobs()} == {("configuration", ())}
    assert any(path in reason for reason in reasons(built))


def test_results_are_kept_after_an_edit_that_does_not_matter(built):
    """By ``--touch``, and the next edit is noticed."""
    path = "src/twodiscs/dynamics/law.py"
    point = built.path / "results/full/points/dynamics/0.2.json"
    content = point.read_bytes()
    built.edit(path, "# a remark\n")
    built.snakemake("--cores", "1", "--touch")
    assert built.jobs() == []
    assert point.read_bytes() == content
    built.edit(path, CODE)
    assert {rule for rule, _ in built.jobs()} >= COUNTED


def test_tighter_accuracy_reruns_dynamics_of_that_scene(built):
    built.configure(lambda mapping: mapping["scenes"][0].update(accuracy=9e-4))
    jobs = built.jobs()
    rules = {rule for rule, _ in jobs}
    assert len([job for job in jobs if job[0] == "dynamics"]) == 3
    assert not {"monte_carlo", "intervals", "trajectory", "exact"} & rules
    assert not [job for job in jobs if WALLS in job[1]]


def test_another_spelling_of_a_number_reruns_nothing(built):
    text = built.configuration.read_text()
    for old, new in (("1e-3", "0.001"), ("2e7", "20000000"), ("height: 1.0", "height: 1")):
        assert old in text
        text = text.replace(old, new)
    built.configuration.write_text(text)
    assert {rule for rule, _ in built.jobs()} <= {"configuration", "check", "report", "provenance"}


def test_a_third_box_leaves_the_others_alone(built):
    third = {"name": "third", "box": {"width": 1, "height": 2}, "radii": [0.1]}
    built.configure(lambda mapping: mapping["scenes"].append(third))
    jobs = built.jobs()
    assert {part for _, wildcards in jobs for part in wildcards if "scene" in part} == {
        "scene=third"
    }
    assert len([job for job in jobs if job[0] == "dynamics"]) == 1


def test_a_scene_that_watches_wall_times_runs_nothing_else(planned):
    jobs = [job for job in planned if WALLS in job[1]]
    assert {rule for rule, _ in jobs} == {
        *("exact", "dynamics", "table", "figure"),
    }
    drawn = {part for rule, wildcards in jobs for part in wildcards if part.startswith("figure=")}
    assert "figure=mean_wall_time" in drawn
    assert not {f"figure={name}" for name in ("mean_hop_time", "hop_histogram", "volume")} & drawn


def test_a_figure_is_a_target_by_its_name(unbuilt):
    scenes = {"volume": [FULL], "model": [FULL, WALLS], "mean_wall_time": [FULL, WALLS]}
    drawn = [job for job in unbuilt.jobs(*scenes) if job[0] == "figure"]
    assert drawn == expected(
        *(("figure", scene, f"figure={name}") for name in scenes for scene in scenes[name])
    )


def test_a_drawing_needs_no_simulation(unbuilt):
    jobs = unbuilt.jobs("results/full/figures/model.pdf")
    assert [rule for rule, _ in jobs] == ["figure"]


def test_draft_does_not_touch_the_results_of_the_default(built):
    before = built.results()
    jobs = built.jobs("--configfile", "config/draft.yaml", "--", "check")
    assert ("check", ()) in jobs
    assert built.results() == before
