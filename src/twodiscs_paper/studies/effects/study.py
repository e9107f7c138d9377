"""What each effect does to the mean times, and what it costs."""

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
    builds="what each effect does to the mean times, and what it costs",
    tables=(Effects, EffectsCost, EffectsCurves),
    seconds=80.0,
    order=7,
    figures={
        "effects": Entry(
            "What each effect does",
            DYNAMICS,
            """
            Mean times of scenes with one effect or two, over those of plain discs in the
            same box at the same radius (of disc 1) and total energy, up to the largest
            radius of these: exact (lines) and by event-driven molecular dynamics
            (symbols; error bars of one standard error are hidden where smaller), for (a)
            vertical hops, (b) disc collisions and (c) hits of any disc on any wall.
            Vertical lines mark h/4 and w/4, where hops of plain discs become blocked, and
            their largest radius. The torus has neither hops nor walls. Residuals z
            beneath are in standard errors, with guide lines at ±2 and ±5. (d) Processor
            time per wall hit or disc collision at r = 0.2, relative to that of plain
            discs with all events watched; to leave a periodic cell takes as much time as
            an event, but is none.
            """,
            "twodiscs_paper.studies.effects.figure",
            tables=("effects", "effects_cost", "effects_curves"),
        ),
    },
    parameters=_parameters,
    reads=_reads,
    about_plain=False,
    timed=("effects_cost",),
)
