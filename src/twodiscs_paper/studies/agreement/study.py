"""Statistics over the comparisons of all scenes."""

from twodiscs.analysis.columns import COUNT, NUMBER, RADIUS, TEXT, Table
from twodiscs_paper.study import SEE_QUANTITY, Study


class AgreementTable(Table):
    """One row per quantity that follows from the comparisons of several scenes, radii or events."""

    columns = {
        "quantity": TEXT(
            "mean_square: of the scores z of mean times by dynamics; error_ratio: the largest "
            "error of a bin of hop_histogram.csv over the error of independent counts, 1 or more; "
            "density_at_zero: of chains in hop_histogram.csv, p(0) of p(0) − at² in the first two "
            "bins; effects: the largest |z| of mean times with effects; third_virial: B₃/B₂² of "
            "hard discs, from exact volumes"
        ),
        "scene": TEXT("the scene; empty for all scenes"),
        "event": TEXT("the event"),
        "radius": RADIUS,
        "count": COUNT(
            "scores behind the value; for error_ratio, bins; for effects, tests: mean times that "
            "can fail and whose count is not the sum of other counts"
        ),
        "estimate": SEE_QUANTITY("the value"),
        "stderr": NUMBER(
            "its standard error; for mean_square √(2/count), as for independent standard normal "
            "scores"
        ),
    }

    @staticmethod
    def rows(tables):
        """Return the rows for the ``tables`` (see ``measure.rows``)."""
        from twodiscs_paper.studies.agreement import measure

        return measure.rows(tables)


def _reads(configuration):
    return {
        f"{scene.name}/{table}": (scene.name, table)
        for scene in configuration.plain
        for table in ("check", "hop_histogram")
        if table in scene.tables
    } | {"effects": (None, "effects")}


STUDY = Study(
    "agreement",
    builds="how large deviations from the exact values are",
    tables=(AgreementTable,),
    seconds=2.0,
    order=8,
    reads=_reads,
)
