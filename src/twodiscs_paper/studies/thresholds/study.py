"""The laws where a hop becomes blocked."""

from twodiscs.figures.catalogue import DYNAMICS, Entry
from twodiscs_paper.studies.thresholds.table import Thresholds
from twodiscs_paper.study import Study


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
    tables=(Thresholds,),
    seconds=4.0,
    order=6,
    figures={
        "thresholds": Entry(
            "Power laws where events die out",
            DYNAMICS,
            """
            Mean times near the radius at which their event ends, r = r_c − δ with r_c = w/4
            for vertical hops, h/4 for horizontal ones and the largest radius for all else:
            event-driven molecular dynamics (symbols) and exact (lines). (a) Times between
            hops against their leading laws ∝ δ⁻² (dashed), and mean first passages from a
            random moment (crosses); slopes are those of inertial and of diffusive motion.
            (b) Times over their leading laws, of exponent −2 for hops that become blocked
            and 1 for what vanishes: how near the limit these are reached. Full symbols are
            from starts in a strip around the hop's surface: there the flux is measured, and
            no waiting time. Error bars are one standard error.
            """,
            "twodiscs_paper.studies.thresholds.figure",
            tables=("distributions", "thresholds"),
            main_tables=("mean_times",),
        ),
    },
    parameters=lambda configuration: {
        "scenes": {scene.name: scene.box.parameters() for scene in configuration.plain}
    },
    reads=_reads,
)
