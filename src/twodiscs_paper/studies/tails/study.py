"""How probable long intervals are."""

from twodiscs.analysis.columns import RADIUS, TEXT, TIME, Column, Table
from twodiscs.figures.scene_figures import DYNAMICS, Figure
from twodiscs_paper.study import AS_ESTIMATE, Study, main_box, scaled


class TailsTable(Table):
    """
    One row per time t: how probable an interval T longer than t is, in the box of the first scene.
    """

    columns = {
        "event": TEXT("the event that begins and ends the interval: a hop or disc_collision"),
        "radius": RADIUS,
        "exact_mean": TIME("exact mean interval"),
        "quantity": TEXT(
            "survival: P(T > t); rate: of the decay of P(T > t); last_ratio: of P(T > t) to its "
            "law, at the last time with an error below a fifth; approach: c of that ratio, if it "
            "is 1 + c (t/τ)^(−1/2); mean_approach: "
            "the same from all times between two; approach_power: the power of t with which that "
            "ratio comes down to 1, fitted between two times; chi2, degrees, chance: χ² of a "
            "constant rate over all times of the fit, its degrees of freedom, and the probability "
            "of a larger χ²"
        ),
        "method": TEXT(
            "counted: intervals that begin within a window; weighted: intervals around starts "
            "that are drawn near motions with long intervals, with exact weights; fit: follows "
            "from other rows"
        ),
        "time": TIME("t; for a rate, where the fit begins"),
        "until": TIME("where the fit ends; empty for survival"),
        "estimate": Column(float, "1/time for a rate", "estimate"),
        "stderr": AS_ESTIMATE(
            "its standard error, from independent blocks; of weighted intervals with the bounds of "
            "strata that have no interval longer than t"
        ),
        "law": AS_ESTIMATE(
            "C/t³ with the exact C, empty if C is 0; for a rate 1/mean, the rate of exponential "
            "intervals"
        ),
    }

    @staticmethod
    def rows(box, samples, replicas, seed):
        """Return the rows for a ``Box`` (see ``measure.rows``)."""
        from twodiscs_paper.studies.tails import measure

        return measure.rows(box, samples, replicas, seed)

    @staticmethod
    def part(weighted, counted):
        """Return the rows of a long run (see ``measure.long_run``)."""
        from twodiscs_paper.studies.tails import measure

        return measure.long_run(weighted, counted)


def _parameters(configuration):
    budget = configuration.study_events
    return {
        **main_box(configuration),
        "replicas": scaled(budget, 20_000, 4_000, 100_000),
        "samples": scaled(budget, 2 * 10**7, 2, 100),
    }


STUDY = Study(
    "tails",
    builds="how probable long intervals are",
    tables=(TailsTable,),
    seconds=10.0,
    order=4,
    figures={
        "tails": Figure(
            "Tails of the times between events",
            DYNAMICS,
            """(a) Probability that the next event takes longer than t, in units of the exact mean
            time τ. Open symbols come from initial states near the motions that last, with exact
            weights, and dots from plain counting. Discs that move almost along an axis pass clear
            of each other for a time ∝ 1/(their drift). The tail therefore falls as C/t³, with the
            exact C (lines), and not exponentially (dashed). (b) The same probabilities divided by
            C/t³. (c) Beyond h/4 no such motion avoids vertical hops: the tail looks exponential,
            but its rate is not 1/τ (dashed). Error bars are one standard error.""",
            tables=("tails",),
        ),
    },
    parameters=_parameters,
)
