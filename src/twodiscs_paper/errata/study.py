"""Corrections to the source: printed formulas against quadrature to fifty digits."""

from twodiscs.analysis.columns import LENGTH, NUMBER, TEXT, Table
from twodiscs_paper.study import Study


class ErrataTable(Table):
    """One row per displayed formula of arXiv:1908.04749, or a claim of its text: is it right?"""

    columns = {
        "label": TEXT("its label in the source, or a short name"),
        "number": TEXT(
            "number of the equation in the PDF of arXiv, as LaTeX counts it; empty if it has none"
        ),
        "place": TEXT("section or appendix"),
        "verdict": TEXT(
            "right; wrong; right-in-range: right in some of the regimes for which it is stated"
        ),
        "severity": TEXT(
            "of a fault: major (numbers are wrong), minor (a range or a part is wrong), slip "
            "(nothing else becomes wrong by it)"
        ),
        "ratio": NUMBER(
            "printed/true, in the first regime where the formula fails, if it fails; empty for "
            "claims and if the printed value is no real number"
        ),
        "radius": LENGTH(
            "radius of the ratio, in the box 1.5 × 1; for a limit the limiting radius; empty if "
            "the radius does not matter, or if another box decides"
        ),
        "correction": TEXT("the right formula, or a remark; formulas stand between backticks"),
    }

    @staticmethod
    def rows():
        """Return the rows in the order of the source."""
        from twodiscs_paper.errata import measure

        return measure.rows()


STUDY = Study(
    "errata",
    builds="which formulas of the source are right",
    tables=(ErrataTable,),
    seconds=3.0,
    order=1,
)
