"""How accurate each method is where arithmetic has it hard."""

from twodiscs.figures.catalogue import Entry
from twodiscs.figures.kit.captions import Sentence
from twodiscs_paper.studies.stability.table import LongRuns, Stability
from twodiscs_paper.study import Study, main_box, scaled


def _parameters(times):
    def parameters(configuration):
        ordinary = times * scaled(configuration.main.event_budget, 2, 10**7, 10**9)
        return {**main_box(configuration), "hard": ordinary // 10, "ordinary": ordinary}

    return parameters


STUDY = Study(
    "stability",
    builds="how accurate each method is in numerically hard cases",
    tables=(Stability,),
    seconds=30.0,
    order=3,
    figures={
        "stability": Entry(
            "Numerically hard cases",
            "5 Numerical stability",
            (
                """
                How the methods behave at hard radii; dashed lines are what is asked for. (a)
                Relative error of volume and areas in double precision below the largest
                radius, and (b) on both sides of the radii where a hop becomes blocked: closed
                forms, and the worst of volume, areas and mean times as computed here. (c)
                Share of proposed configurations that is accepted, by rejection from the prism
                and by the draws that trajectories start from. (d) Residuals of volume and
                areas estimated by those draws. (e) Worst of a long run: error of the energy,
                overlap of the discs, centres beyond their range. (f) Worst error of predicted
                times to a contact (circles) and to a wall (squares), against 50 digits, for
                many ways to approach. (g) Velocities are reversed after n events: error of
                return after n more, over the binary digits that the Lyapunov exponent λ per
                event costs; the line is one rounding that grows at this rate. The legend says
                after how many events half of the digits are lost, and in brackets after how
                many they should be. (h) Share of 95 % intervals that cover the exact mean
                time, over independent repetitions. Rows without a symbol were not run.
                """,
                Sentence(
                    "Crosses are events too rare for an interval.",
                    mark=lambda row: row["part"] == "coverage" and row["value"] is None,
                ),
            ),
            "twodiscs_paper.studies.stability.figure",
            tables=("stability",),
        ),
    },
    parameters=_parameters(1),
)

LONG_RUNS = Study(
    "long_runs",
    builds="`stability` of the dynamics over ten times the events",
    tables=(LongRuns,),
    seconds=200.0,
    order=8,
    parameters=_parameters(10),
    shared=False,
)
