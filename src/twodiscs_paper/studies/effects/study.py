"""How each effect changes the mean times, and its cost."""

from twodiscs.analysis.columns import (
    COUNT,
    HEIGHT,
    LENGTH,
    NUMBER,
    TEST,
    TEXT,
    TIME,
    WIDTH,
    Column,
    Table,
    Z,
)
from twodiscs.figures.scene_figures import DYNAMICS, Figure
from twodiscs_paper.study import AS_EXACT, Study


class EffectsTable(Table):
    """One row per scene with effects, radius and quantity, beside discs without effects."""

    columns = {
        "scene": TEXT("its name, which is the name of its file in config/scenes"),
        "width": WIDTH,
        "height": HEIGHT,
        "effects": TEXT(
            "the effects of the scene, as a JSON object; never_met_share also has rows of smooth "
            "discs"
        ),
        "radius": LENGTH("radius of disc 1"),
        "quantity": TEXT(
            "<event>_time; never_met_share: share of starts whose discs do not meet within duration"
        ),
        "exact": TIME("exact mean time; empty if the event is impossible"),
        "plain": AS_EXACT(
            "exact mean time of plain discs of this radius, empty if it does not exist; for "
            "never_met_share 2[A²(B − 2r)₊⁴ + B²(A − 2r)₊⁴]/(πVt²), the long-time limit for plain "
            "discs"
        ),
        "estimate": AS_EXACT("as in mean_times.csv; for never_met_share count/replicas"),
        "stderr": AS_EXACT("its standard error; empty if events are too few for an error bar"),
        "z": Z,
        "count": COUNT("events counted, or starts that have not met"),
        "replicas": COUNT("independent trajectories in which the event can occur"),
        "duration": TIME("length T of a replica"),
        "status": TEXT(
            "reached, budget, too-few, none-seen, impossible: as in mean_times.csv; sampled: a "
            "share with its error"
        ),
        "test": TEST,
        "starts": TEXT("where initial states come from, as in mean_times.csv"),
        "share": NUMBER("share of configuration space from which initial states are drawn"),
    }

    @staticmethod
    def rows(tables, scenes, seed):
        """Return the rows of ``scenes`` (see ``measure.rows``)."""
        from twodiscs_paper.studies.effects import measure

        return measure.rows(tables, scenes, seed)


class EffectsCostTable(Table):
    """The rows of benchmark.csv on effects, from a short run."""

    columns = {
        "benchmark": TEXT("the name of the measurement"),
        "variant": TEXT(
            "the engine or method. effects: the scene of config/scenes, friction or all effects; "
            "without_effects: a package whose sources have no effects; plain: a scene without "
            "effects; plain_walls: the same without detection of hops"
        ),
        "value": Column(float, "see unit", "median over the repetitions"),
        "unit": TEXT("unit of the value"),
        "ratio": NUMBER("how many times better than the baseline of the same run"),
        "instructions": COUNT("effects: machine instructions of the compiled kernel"),
    }

    @staticmethod
    def rows(tables, scenes):
        """Return the rows of ``scenes``; once the ``tables`` are made, all kernels are compiled."""
        from twodiscs_paper.studies.effects import price

        return price.rows(scenes, **price.QUICK_OPTIONS)


class Benchmark(EffectsCostTable):
    """One row per benchmark and variant, all variants of a benchmark measured in one run."""


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
    builds="how each effect changes the mean times, and its cost",
    tables=(EffectsTable, EffectsCostTable),
    seconds=40.0,
    order=7,
    figures={
        "effects": Figure(
            "Mean times with effects",
            DYNAMICS,
            """Mean times of scenes with one effect or two, divided by the mean times of plain discs
            in the same box at the same radius (of disc 1) and total energy: exact (lines) and by
            event-driven molecular dynamics (symbols). The events are (a) vertical hops, (b) disc
            collisions and (c) hits of any disc on any wall, up to the largest radius of plain
            discs. Error bars are one standard error; they are hidden if they are smaller than the
            symbols. Vertical lines mark h/4 and w/4, where hops of plain discs become blocked, and
            their largest radius. The torus has neither hops nor walls. Residuals z beneath are in
            standard errors, with guide lines at ±2 and ±5. (d) Processor time per wall hit or disc
            collision at r = 0.2, divided by the time in a copy of the package from which all
            effects are removed (numbers beside the symbols), and the number of machine instructions
            of the compiled kernel. Leaving a periodic cell, or a kick of friction, takes time but
            is not counted.""",
            tables=("effects", "effects_cost"),
        ),
    },
    parameters=_parameters,
    reads=_reads,
    about_plain=False,
    timed=("effects_cost",),
)
