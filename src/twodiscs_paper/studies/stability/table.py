"""The tables of numerical stability."""

from twodiscs.comparison.tables.base import COUNT, LENGTH, NUMBER, TEXT, TRUTH, Column, Table

SEE_QUANTITY = Column(float, "see quantity")


class Stability(Table):
    """
    One row per number that says how a method behaves in a numerically hard case, for the box of the
    first scene.
    """

    part: TEXT
    """
    theory: relative errors against 50 digits; sampling: accepted share of the proposals; estimates:
    conditioned Monte Carlo; times: errors of predicted times; dynamics: worst of a run; reversal:
    reversed velocities, and the Lyapunov exponent; coverage: of 95 % intervals
    """
    quantity: TEXT
    """
    what is measured. theory: of areas and mean_times the worst one. times: error in units of 2⁻⁵² ×
    conditioning. dynamics: energy_error, the largest |E − 1/2|; smallest_gap, of |Δx| − 2r, and
    excess, the largest of a centre beyond its range, both in units of the largest power of two in
    the side of the box; lanes_lost, trajectories that ended up infinite or stuck. reversal:
    exponent, per event; return_error, after count events and back; events_retraced, until it is
    2⁻²⁶. coverage: the event
    """
    method: TEXT
    """stable, or closed-form in plain doubles; conditioned draws, or rejection from the prism"""
    case: TEXT
    """
    ordinary, tiny (1e-9 of the shorter side), or the limit nearby: h/4, w/4, largest radius. times:
    how the discs approach. reversal: from the way out and back (return), or from a small separation
    """
    radius: LENGTH
    distance: NUMBER
    """radius/limit − 1, for the limit that case names"""
    count: COUNT
    """samples, cases, events or repetitions behind the value"""
    value: SEE_QUANTITY
    """what was seen; empty where nothing can be said"""
    exact: SEE_QUANTITY
    """what it should be, apart from random and rounding errors"""
    stderr: SEE_QUANTITY
    """standard error of the value"""
    z: NUMBER
    low: SEE_QUANTITY
    """smallest value that passes"""
    high: SEE_QUANTITY
    """largest value that passes"""
    status: TEXT
    """
    estimates: as in areas.csv; coverage: counted, or too-few where intervals are not shown;
    reversal: long where the path stays exact for more than 2000 events
    """
    passed: TRUTH
    """whether low ≤ value ≤ high and |z| ≤ 5, as far as they are given; empty without any"""

    @classmethod
    def rows(cls, box, seed, ordinary, hard):
        """Return all rows of a plain ``Box`` (see ``measure.rows``)."""
        from twodiscs_paper.studies.stability import measure

        return [cls.empty(**row) for row in measure.rows(box, seed, ordinary, hard)]


class LongRuns(Stability):
    """As stability.csv, the rows on dynamics alone, from the longest runs."""

    @classmethod
    def rows(cls, box, seed, ordinary, hard):
        """Return the rows of a plain ``Box`` (see ``measure.dynamics_rows``)."""
        from twodiscs_paper.studies.stability import measure

        return [cls.empty(**row) for row in measure.dynamics_rows(box, seed, ordinary, hard)]
