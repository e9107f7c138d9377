"""Intervals between hops, bin by bin: hop_histogram.csv."""

from twodiscs.comparison.tables.base import COUNT, RADIUS, RATE, TEXT, TIME, Table, Z, by_radius
from twodiscs.comparison.tables.theory import ExactValues


class HopHistogram(Table):
    """One row per radius and bin: intervals between hops, from one crossing to the next."""

    columns = {
        "radius": RADIUS,
        "event": TEXT("the hop"),
        "bins": TEXT(
            "equal: bins about as wide as τ/16; wide: the same intervals in bins that widen with "
            "time"
        ),
        "left": TIME("lower edge of the bin"),
        "right": TIME("upper edge of the bin"),
        "count": COUNT("intervals in the bin"),
        "density": RATE("count/(intervals × width of the bin)"),
        "stderr": RATE(
            "its standard error from the spread between independent chains; a chain has 256 "
            "successive intervals or, for more than two discs, all that begin within a window of "
            "time; empty for an empty bin"
        ),
        "intervals": COUNT("number of all intervals, including those beyond the last bin"),
        "exact_mean": TIME("exact mean interval, empty if none is known"),
        "mean": TIME("mean of all intervals"),
        "mean_stderr": TIME(
            "its standard error from the spread between independent chains; empty below 100"
        ),
        "z": Z,
    }

    @staticmethod
    def rows(theory, points):
        """Return the rows of intervals points.

        ``theory`` are the rows of theory.csv, ``points`` is {"intervals": [point, …]}. The mean is
        tested by Student's t over the chains, if there are 100 of them and 1000 intervals.
        """
        exact, rows = ExactValues(theory), []
        for point in by_radius(points.get("intervals", ())):
            mean = _mean(point, exact[point.radius, f"{point.event}_time"])
            start = {"radius": point.radius, "event": point.event}
            for one in point.bins():
                found = one._asdict()
                density = found.pop("density")
                found |= {"density": density.value, "stderr": density.stderr or None}
                rows.append(start | found | mean)
        return rows


def _mean(point, exact):
    """Return the columns about the mean of a point; the ``exact`` mean may be None."""
    from twodiscs.comparison import scores  # which needs numpy and scipy
    from twodiscs.points.estimates import MIN_EVENTS

    z, mean = None, point.estimate("mean")
    stderr = mean.stderr or None if mean.n >= MIN_EVENTS else None
    if stderr and point.intervals >= scores.NORMAL and exact is not None:
        z = scores.student_deviate((mean.value - exact) / stderr, mean.n - 1)
    return {
        "intervals": point.intervals,
        "exact_mean": exact,
        "mean": mean.value,
        "mean_stderr": stderr,
        "z": z,
    }
