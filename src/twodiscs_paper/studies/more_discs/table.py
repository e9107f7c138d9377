"""The table of the mean times of more than two discs."""

from twodiscs.comparison.tables.base import COUNT, LENGTH, NUMBER, TEXT, Column, Table

AS_EXACT = Column(float, "as exact")


class MoreDiscs(Table):
    """
    One row per number of discs, radius and event, in boxes whose width is in proportion to the
    number of discs, at the energy per disc of two of them.
    """

    discs: COUNT
    """number of discs"""
    width: LENGTH
    height: LENGTH
    radius: LENGTH
    theory: TEXT
    """
    which theory has exact values: plain, three, channel, or none where none is known
    """
    states: TEXT
    """how initial states are drawn: rejection and channel are exact, chain is tested"""
    event: TEXT
    """
    collisions and hops of any pair of discs, one disc at one wall; virial: the sum of rates that is
    1
    """
    exact: Column(float, "time, 1 for virial")
    """exact mean time over all initial conditions; empty where none is known"""
    monte_carlo: AS_EXACT
    """that of volume and area by insertion"""
    monte_carlo_stderr: AS_EXACT
    """its standard error"""
    dynamics: AS_EXACT
    """that of counts of events"""
    dynamics_stderr: AS_EXACT
    """its standard error"""
    z: NUMBER
    """
    standard normal deviate of dynamics from the exact value, or from Monte Carlo where none is
    known
    """

    @staticmethod
    def rows(events, samples, seed):
        """Return the rows of so many ``events`` and ``samples`` for each scene."""
        from twodiscs_paper.studies.more_discs import measure

        return list(measure.rows(events, samples, seed))
