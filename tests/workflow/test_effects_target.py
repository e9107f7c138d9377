"""Effects as a target: a job for each file of config/scenes, and what is made of them."""

from checkout import REPOSITORY

FILES = sorted(path.stem for path in (REPOSITORY / "config" / "scenes").glob("*.yaml"))
POINTS = [("effects_point", (f"file={name}",)) for name in FILES]
FIGURE = ("shared_figure", ("figure=effects",))
MADE = [("effects_cost", ()), ("effects_table", ()), FIGURE]


def effects(jobs):
    """Return the jobs about effects."""
    return [job for job in jobs if job[0].startswith("effects_") or job == FIGURE]


def test_the_target_is_a_job_for_each_scene_and_what_is_made_of_them(unbuilt):
    jobs = unbuilt.jobs("effects")
    assert jobs == sorted([*POINTS, *MADE, ("effects", ()), ("compile", ("kernels=dynamics",))])


def test_it_is_part_of_all(planned):
    assert effects(planned) == sorted([*POINTS, *MADE])


def test_edit_of_a_scene_counts_that_one_again(built):
    built.edit("config/scenes/torus.yaml", "# a remark\n")
    jobs = built.jobs()
    assert [job for job in jobs if job[0] == "effects_point"] == [
        ("effects_point", ("file=torus",))
    ]
    assert FIGURE in jobs
    assert {rule for rule, _ in jobs} == {
        *("effects_point", "effects_table", "effects_cost", "shared_figure"),
        *("paper", "report", "manifest", "provenance"),
    }
