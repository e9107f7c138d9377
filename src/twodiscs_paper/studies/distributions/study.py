"""How intervals between hops are distributed."""

from twodiscs.analysis.columns import COUNT, HEIGHT, NUMBER, RADIUS, SCENE, TEXT, TIME, WIDTH, Table
from twodiscs.figures.scene_figures import DYNAMICS, Figure
from twodiscs_paper.study import AS_ESTIMATE, SEE_QUANTITY, Study, scaled


class DistributionsTable(Table):
    """
    One row per scene, radius and quantity: how the times to the next hop are distributed, from a
    hop (intervals T) and from a random moment (first passages F). Every T and every F has its own
    initial state.
    """

    columns = {
        "scene": SCENE,
        "width": WIDTH,
        "height": HEIGHT,
        "radius": RADIUS,
        "event": TEXT("the hop"),
        "exact_mean": TIME("exact mean interval τ"),
        "quantity": TEXT(
            "mean: of T; squared_cv: CV² = ⟨T²⟩/τ² − 1; first_passage: ⟨F⟩, or ⟨min(F, c)⟩ if "
            "last is c; density_at_zero: p(0) of p(0) − at² in the first two bins of T; hazard: "
            "rate of hops at a time since the last hop, ln[P(T > first)/P(T > last)]/(last − "
            "first); rate: one hazard fitted by maximum likelihood to all bins from four mean "
            "times on, with longer intervals censored; trend: β of a hazard ∝ t^β in these bins; "
            "plateau: the rate again, if the hazard is constant within the errors; falling, "
            "falling_without_drift: if it is not constant, the hazard in the last two fifths of "
            "the time that the data reach, for hops that drifting discs avoid and for other hops"
        ),
        "first": TIME("where the bin or the fit begins"),
        "last": TIME("where it ends; for first_passage the cut c"),
        "count": COUNT(
            "intervals or first passages; for a fit or bin, the intervals that end in it"
        ),
        "estimate": SEE_QUANTITY("estimate: a time, 1/time or a number"),
        "stderr": AS_ESTIMATE("its standard error"),
        "reference": AS_ESTIMATE(
            "mean: τ; squared_cv: 1, as for an exponential law; first_passage: ⟨T²⟩/(2τ) = τ(1 + "
            "CV²)/2, or with a cut ⟨T² − (T − c)₊²⟩/(2τ), as measured; density_at_zero: exact; "
            "rate: 1/τ, as for exponential intervals; trend: 0"
        ),
        "reference_stderr": AS_ESTIMATE("its standard error, if the reference is measured"),
        "z": NUMBER(
            "(estimate − reference)/error; for a rate, how far intervals are from exponential at "
            "all times; empty if a cubic tail gives F and T² an infinite variance: see the row "
            "with the cut"
        ),
        "chi2": NUMBER("Pearson's χ² of a constant hazard"),
        "degrees": COUNT("degrees of freedom of chi2"),
        "p": NUMBER(
            "rate: probability of a larger χ² if the hazard is constant; trend: of a larger |z|. "
            "If neither is small, the data show a plateau"
        ),
    }

    @staticmethod
    def rows(scenes, seed, events):
        """Return the rows of ``scenes`` (see ``measure.rows``)."""
        from twodiscs_paper.studies.distributions import measure

        return measure.rows(scenes, seed, events)


def _parameters(configuration):
    return {
        "events": scaled(configuration.study_events, 400, 2**16, 2**22),
        "scenes": [
            {
                "box": scene.box.parameters(),
                "event": scene.histogram["event"],
                "name": scene.name,
                "radii": list(scene.quantities.hop_histogram),
            }
            for scene in configuration.plain
        ],
        "seed": configuration.seed,
    }


STUDY = Study(
    "distributions",
    builds="how intervals between hops are distributed",
    tables=(DistributionsTable,),
    seconds=10.0,
    order=5,
    figures={
        "distributions": Figure(
            "Rate of hops since the last one",
            DYNAMICS,
            """(a) Rate of hops at a time t after the last hop, in units of the exact mean time τ.
            An exponential distribution would have the dashed line. The rate starts from the exact
            density at 0 (thick dashes), of hops that one bounce undoes. It jumps at the time from
            which both discs may have bounced, t = √2 (h − 2r) for vertical hops. Thick lines are
            constant rates fitted to all intervals after four mean times. They are dotted if the
            rate is not constant there (by χ² or by a trend, at the level of 1e-3). The rates of
            small discs go on falling, towards the rate of a cubic tail, 3τ/t (dash-dotted). (b)
            Mean time from a random moment to the next hop (open symbols), and its value from the
            intervals, τ(1 + CV²)/2 (dots), with CV their coefficient of variation. Error bars are
            one standard error.""",
            tables=("distributions",),
        ),
    },
    parameters=_parameters,
)
