"""The laws where a hop becomes blocked."""

from twodiscs.analysis.columns import COUNT, HEIGHT, NUMBER, SCENE, TEXT, WIDTH, Column, Table
from twodiscs.figures.scene_figures import DYNAMICS, Figure
from twodiscs_paper.study import AS_ESTIMATE, Study


class ThresholdsTable(Table):
    """
    One row per fitted power law: mean times near a limiting radius r_c, τ = C δ^p with δ = r_c − r,
    weighted least squares in ln τ against ln δ.
    """

    columns = {
        "scene": SCENE,
        "width": WIDTH,
        "height": HEIGHT,
        "event": TEXT("the event"),
        "quantity": TEXT("mean_time, or first_passage: ⟨F⟩ of distributions.csv"),
        "form": TEXT(
            "plain: times as measured; reduced: over the regular factor τ_exact/(C δ^p), which "
            "tends to 1 at r_c"
        ),
        "points": COUNT("radii fitted: all within 0.2 r_c and beyond other limits"),
        "parameter": TEXT("exponent p, or coefficient C at the exact exponent"),
        "estimate": Column(float, "of C: time/length^p", "fitted value"),
        "stderr": AS_ESTIMATE("its standard error"),
        "curve": AS_ESTIMATE(
            "the same fit to the exact times at the same radii; empty for first_passage"
        ),
        "law": AS_ESTIMATE("exact value at the limit"),
        "z": NUMBER("(estimate − curve)/stderr"),
        "chi2": NUMBER("sum of squared residuals in standard errors"),
        "degrees": COUNT("degrees of freedom of chi2"),
        "p": NUMBER("probability of a larger χ² if the power law holds over the window"),
    }

    @staticmethod
    def rows(tables, scenes):
        """Return the rows of ``scenes`` (see ``measure.rows``)."""
        from twodiscs_paper.studies.thresholds import measure

        return measure.rows(tables, scenes)


def _reads(configuration):
    times = {
        f"{scene.name}/mean_times": (scene.name, "mean_times")
        for scene in configuration.plain
        if "mean_times" in scene.tables
    }
    return {"distributions": (None, "distributions")} | times


STUDY = Study(
    "thresholds",
    builds="the laws where a hop becomes blocked",
    tables=(ThresholdsTable,),
    seconds=4.0,
    order=6,
    figures={
        "thresholds": Figure(
            "Power laws where events die out",
            DYNAMICS,
            """Mean times near the radius at which their event ends, r = r_c − δ. For vertical hops
            r_c = w/4, for horizontal ones h/4, and for all other events the largest radius. (a)
            Times between hops by event-driven molecular dynamics (circles and squares), exact
            (lines) and by their limiting laws ∝ δ⁻² (dashed), and mean first passages from a random
            moment (crosses). Grey lines have the slopes of inertial and of diffusive motion. (b)
            Times divided by their limiting laws, which have the exponent −2 for hops that become
            blocked and 1 for events that end with the largest radius. Full symbols come from
            initial states in a strip around the surface of the hop, where the flux is measured and
            not the waiting time. Error bars are one standard error.""",
            tables=("distributions", "thresholds"),
            main_tables=("mean_times",),
        ),
    },
    parameters=lambda configuration: {
        "scenes": {scene.name: scene.box.parameters() for scene in configuration.plain}
    },
    reads=_reads,
)
