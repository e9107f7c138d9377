"""Every estimate against the exact theory: check.csv."""

from functools import partial

from twodiscs.comparison.tables.base import LENGTH, NUMBER, TEST, TEXT, TRUTH, Column, Table, Z
from twodiscs.comparison.tables.hop_histogram import HopHistogram
from twodiscs.comparison.tables.mean_times import MeanTimes, rows_without_strips
from twodiscs.comparison.tables.monte_carlo import Areas, Volume
from twodiscs.model.events import EVENTS

#: A unit that depends on the row.
SEE_QUANTITY = partial(Column, float, "see quantity")


class Check(Table):
    """One row per comparison with the exact theory."""

    columns = {
        "comparison": TEXT(
            "volume, area, mean_time, hop_interval, sum_rule, and over all radii z_mean and "
            "z_spread; if no exact mean time is known flux, the time of dynamics over the time of "
            "Monte Carlo"
        ),
        "quantity": TEXT("the quantity that is compared"),
        "radius": LENGTH("radius of the discs; empty for a statement on all radii"),
        "method": TEXT(
            "monte_carlo, conditioned, insertion, dynamics, strip (starts next to a rare hop) or "
            "intervals"
        ),
        "exact": SEE_QUANTITY("exact value; for an area, the shell's expectation"),
        "estimate": SEE_QUANTITY("estimate; empty where there is none"),
        "stderr": SEE_QUANTITY("its standard error; empty where there is none"),
        "z": Z,
        "p": NUMBER("probability of a |z| as large, or larger, if all is right"),
        "bound": NUMBER("largest |z| that passes"),
        "passed": TRUTH("whether |z| ≤ bound; empty where nothing can be compared"),
        "independent": TRUTH(
            "whether the row is a test, which could fail and follows from no other row: false for "
            "certain results, for counts that are sums of other counts (any_wall of right_wall "
            "and top_wall), for values computed from other rows (any_wall_area of two shells, the "
            "sum rule) and for z_mean and z_spread"
        ),
        "status": TEXT("status of the estimate in its own table"),
        "test": TEST,
    }

    @staticmethod
    def rows(box, theory, points, areas=EVENTS):
        """Return the comparisons of all points of a scene, with verdicts (see ``check``).

        ``theory`` are the rows of theory.csv, ``points`` is {stage: [point, …]}, and ``areas`` are
        the events of which areas are asked for.
        """
        from twodiscs.comparison import check  # which needs numpy and scipy

        compared = check.comparisons(
            box,
            Volume.rows(theory, points),
            Areas.rows(box, theory, points, areas),
            MeanTimes.rows(box, theory, points) + rows_without_strips(box, theory, points),
            HopHistogram.rows(theory, points),
            points.get("dynamics", ()),
            points.get("monte_carlo", ()),
        )
        return check.check_rows(compared)
