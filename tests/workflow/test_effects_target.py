"""Effects as a target: the mean times of the scenes of config/scenes, and its files."""

from twodiscs_paper.studies.effects.study import SCENES

FILES = sorted(SCENES)
FIGURE = ("shared_figure", ("figure=effects",))
TABLES = ("effects", "effects_cost", "effects_curves")
MADE = [*(("study_table", (f"table={name}",)) for name in TABLES), FIGURE]


def of_effects(jobs, rule):
    """Return the scenes of the study that have jobs of a ``rule``."""
    parts = (part for name, wildcards in jobs for part in wildcards if name == rule)
    return sorted({part.partition("effects/")[2] for part in parts if "=effects/" in part})


def test_the_target_counts_every_scene_as_any_other(unbuilt):
    jobs = unbuilt.jobs("effects")
    assert {rule for rule, _ in jobs} == {
        *("dynamics", "exact", "table", "effects", "study_table", "shared_figure"),
    }
    for rule in ("dynamics", "exact", "table"):
        assert of_effects(jobs, rule) == FILES
    assert {*MADE} <= {*jobs}


def test_it_is_part_of_all(planned):
    assert {*MADE} <= {*planned}


def test_edit_of_a_scene_counts_that_one_again(built):
    built.edit("config/scenes/torus.yaml", "# a remark\n")
    assert not built.jobs()
    built.replace("config/scenes/torus.yaml", "accuracy: draft", "accuracy: 2e-2")
    jobs = built.jobs()
    counted = [wildcards for rule, wildcards in jobs if rule == "dynamics"]
    assert counted == [("scene=effects/torus", "stage=dynamics", "radius=0.3")]
    assert {rule for rule, _ in jobs} == {
        *("dynamics", "table", "study_table", "manifest"),
        *FOLLOWING,
    }


#: The files that are made from the tables of the study.
FOLLOWING = {"shared_figure", "report", "provenance"}
