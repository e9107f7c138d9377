"""How each effect changes the mean times, and its cost."""

from twodiscs.figures.catalogue import DYNAMICS, Entry
from twodiscs_paper.studies.effects.table import Effects, EffectsCost, EffectsCurves
from twodiscs_paper.study import Study

#: The files of config/scenes, a scene each.
SCENES = ("balls", "channel", "field", "rough", "torus", "unequal")


def boxes(configuration):
    """Return the scenes, {name: parameters of a box}."""
    return {scene.name: scene.box.parameters() for scene in configuration.effect_scenes}


def _parameters(configuration):
    return {"scenes": boxes(configuration), "seed": configuration.seed}


def _reads(configuration):
    return {
        f"{scene.name}/mean_times": (f"effects/{scene.name}", "mean_times")
        for scene in configuration.effect_scenes
    }


STUDY = Study(
    "effects",
    families=("plain", "effects"),
    builds="how each effect changes the mean times, and its cost",
    tables=(Effects, EffectsCost, EffectsCurves),
    seconds=40.0,
    order=7,
    figures={
        "effects": Entry(
            "Mean times with effects",
            DYNAMICS,
            "twodiscs_paper.studies.effects.figure",
            tables=("effects", "effects_cost", "effects_curves"),
        ),
    },
    parameters=_parameters,
    reads=_reads,
    about_plain=False,
    timed=("effects_cost",),
)
