"""Intervals between hops, bin by bin: hop_histogram.csv."""

from itertools import pairwise

from twodiscs.comparison.points import by_radius
from twodiscs.comparison.tables.base import COUNT, LENGTH, NUMBER, RATE, TEXT, TIME, Table
from twodiscs.comparison.tables.exact import ExactValues


class HopHistogram(Table):
    """One row per radius and bin: intervals between hops, from one crossing to the next."""

    radius: LENGTH
    event: TEXT
    """the hop"""
    bins: TEXT
    """equal, as wide as τ/16 or so; wide: the same intervals, in bins that widen with time"""
    left: TIME
    """lower edge of the bin"""
    right: TIME
    """upper edge of the bin"""
    count: COUNT
    """intervals in the bin"""
    density: RATE
    """count/(intervals × width of the bin)"""
    stderr: RATE
    """
    its standard error from the spread between independent chains, each of 256 successive intervals
    or, of more than two discs, of all that begin within a window of time; empty for an empty bin
    """
    intervals: COUNT
    """intervals in all, those beyond the last bin included"""
    exact_mean: TIME
    """exact mean interval, empty where none is known"""
    mean: TIME
    """mean of all intervals"""
    mean_stderr: TIME
    """its standard error from the spread between independent chains; empty below 100"""
    z: NUMBER

    @staticmethod
    def rows(theory, points):
        """Return the rows of intervals points.

        ``theory`` are the rows of theory.csv, ``points`` is {"intervals": [point, …]}. The mean is
        tested by Student's t over the chains, if there are 100 of them and 1000 intervals.
        """
        exact, rows = ExactValues(theory), []
        for point in by_radius(points.get("intervals", ())):
            mean = _mean(point, exact[point["radius"], f"{point['event']}_time"])
            start = {"radius": point["radius"], "event": point["event"]}
            rows += [start | bin_row | mean for bin_row in _bin_rows(point)]
        return rows


def _mean(point, exact):
    """Return what the rows of a point have of the mean, beside the ``exact`` one or None."""
    from twodiscs.comparison import estimates, scores  # which need numpy and scipy

    z, stderr, intervals = None, point["stderr"] or None, point["intervals"]
    if point["chains"] < estimates.MIN_EVENTS:
        stderr = None
    if stderr and intervals >= scores.NORMAL and exact is not None:
        z = scores.student_deviate((point["mean"] - exact) / stderr, point["chains"] - 1)
    return {
        "intervals": intervals,
        "exact_mean": exact,
        "mean": point["mean"],
        "mean_stderr": stderr,
        "z": z,
    }


def _bin_rows(point):
    """Yield the rows of the bins of a point, equal ones and wide ones."""
    from twodiscs.comparison import estimates

    width, chains, intervals = point["bin_width"], point["chains"], point["intervals"]
    equal = {"edges": range(len(point["counts"]) + 1), **point}
    for bins, histogram in (("equal", equal), ("wide", point["wide"])):
        names = [name for name in ("counts", "squares", "products") if name in histogram]
        columns = pairwise(histogram["edges"]), *(histogram[name] for name in names)
        for (left, right), count, squares, *product in zip(*columns, strict=True):
            per_chain = chains / (intervals * (right - left) * width)
            weights, totals, products = {"n": per_chain}, {"n": count}, {"n*n": squares}
            density = estimates.combination(weights, totals, products, chains)
            if product:
                # The counts are over all intervals of a chain, whose number varies.
                weights |= {"all": -per_chain * count / intervals}
                products |= {"n*all": product[0], "all*all": point["intervals_squared"]}
                totals |= {"all": intervals}
                error = estimates.combination(weights, totals, products, chains).stderr
                density = estimates.Estimate(density.value, error, chains)
            yield {
                "bins": bins,
                "left": left * width,
                "right": right * width,
                "count": count,
                "density": density.value,
                "stderr": density.stderr or None,
            }
