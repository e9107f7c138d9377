"""The table of what the comparisons of all scenes have in common."""

from twodiscs.comparison.tables.base import COUNT, LENGTH, NUMBER, TEXT, Column, Table

SEE_QUANTITY = Column(float, "see quantity")


class Agreement(Table):
    """One row per quantity that follows from the comparisons of several scenes, radii or events."""

    quantity: TEXT
    """
    mean_square: of the scores z of mean times by dynamics; correlation: Pearson's, of the scores z
    of two mean times over the radii of all scenes; error_ratio: the largest error of a bin of
    hop_histogram.csv over that of independent counts, 1 or more; density_at_zero: of the chains of
    hop_histogram.csv, p(0) of p(0) − at² in the first two bins; effects: the largest |z| of mean
    times with effects
    """
    scene: TEXT
    """the scene; empty for all scenes"""
    event: TEXT
    """the event"""
    other: TEXT
    """the event that it is correlated with"""
    radius: LENGTH
    count: COUNT
    """
    scores behind the value; of a correlation, pairs of them; of error_ratio, bins; of effects,
    tests: mean times that can fail and whose count is not the sum of other counts
    """
    estimate: SEE_QUANTITY
    """the value"""
    stderr: NUMBER
    """
    its standard error; of mean_square √(2/count), that of independent standard normal scores
    """

    @classmethod
    def rows(cls, tables):
        """Return the rows for the ``tables`` (see ``measure.rows``)."""
        from twodiscs_paper.studies.agreement import measure

        return [cls.empty(**row) for row in measure.rows(tables)]
