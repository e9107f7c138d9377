"""Corrections to the source, with the evidence for each."""

from twodiscs.comparison.tables.base import LENGTH, NUMBER, TEXT, Table
from twodiscs_paper.study import Study


class Errata(Table):
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
        "decided_by": TEXT(
            "theory (quadrature to 50 digits), and each method that can distinguish printed from "
            "true, with its ratio measured/printed and the error of the last digit (if 0 is "
            "printed, its distance from 0). With the exact volume, areas and times measure each "
            "other; if only a part is printed, the rest is taken as exact; the ratio for a limit "
            "is measured at the given radius and carried over by theory"
        ),
    }

    @staticmethod
    def rows(tables, box):
        """Return the rows in the order of the source (see ``measure.rows``)."""
        from twodiscs_paper.errata import measure

        return measure.rows(tables, box)


def _reads(configuration):
    main, wanted = configuration.main, ("theory", "volume", "areas", "mean_times")
    return {name: (main.name, name) for name in wanted if name in main.tables}


STUDY = Study(
    "errata",
    builds="which formulas of the source are right, with the evidence",
    tables=(Errata,),
    seconds=3.0,
    order=1,
    parameters=lambda configuration: {"box": configuration.main.box.parameters()},
    reads=_reads,
)
