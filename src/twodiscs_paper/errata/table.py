"""The table of corrections to the source."""

from twodiscs.comparison.tables.base import LENGTH, NUMBER, TEXT, Table


class Errata(Table):
    """One row per displayed formula of arXiv:1908.04749, or a claim of its text: is it right?"""

    label: TEXT
    """its label in the source, or a short name"""
    number: TEXT
    """of the equation in the PDF of arXiv, as LaTeX counts it; empty where it has none"""
    place: TEXT
    """section or appendix"""
    verdict: TEXT
    """right; wrong; right-in-range: right in some of the regimes that it is stated for"""
    severity: TEXT
    """
    of what is not right: major (numbers come out wrong), minor (a range or a part is), slip
    (nothing else is wrong for it)
    """
    ratio: NUMBER
    """
    printed/true, where it fails if it does; empty for claims and where what is printed is no real
    number
    """
    radius: LENGTH
    """
    radius of the ratio, in the box 1.5 × 1; of a limit the radius that is approached; empty where
    it does not matter, or where another box decides
    """
    correction: TEXT
    """what is right instead, or what else to know; formulas stand between backticks"""
    decided_by: TEXT
    """
    theory (quadrature to 50 digits), and each method that can tell, with its ratio measured/printed
    and the error of the last digit (its distance from 0 where 0 is printed). Areas and times
    measure each other by the exact volume; where a part is printed, the rest is taken as exact; the
    ratio for a limit is measured at the radius given and carried over by theory
    """

    @staticmethod
    def rows(tables, box):
        """Return the rows in the order of the source (see ``measure.rows``)."""
        from twodiscs_paper.errata import measure

        return measure.rows(tables, box)
