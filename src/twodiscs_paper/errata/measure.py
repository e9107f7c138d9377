"""Which formulas of the source are right and which are wrong.

Each of the ``statements`` is computed as printed and compared with the truth, which is integrated
to fifty digits. This is done in several boxes and at several radii of every regime for which it is
stated. The ratio of the two gives the verdict. The same true values are compared with counts in
check.csv, radius by radius.
"""

from mpmath import mp

from twodiscs_paper.errata.statements import GENERAL, LIMIT_STEP, LIMITS, REGIMES, SAME, STATEMENTS
from twodiscs_paper.reference import DIGITS, MpScene
from twodiscs_paper.study import row


def printed_ratio(statement, q):
    """Return printed over true, or None if the printed value is no real number."""
    try:
        printed = statement.printed(q)
    except ZeroDivisionError:
        return None
    return mp.re(printed) / statement.true(q) if mp.im(printed) == 0 else None


def reported_boxes(name):
    """Return the boxes of a regime or limit, first the box to report, and the radius to report."""
    if name is None:
        return [MpScene.of(*box) for box in GENERAL], None
    if name in REGIMES:
        return [MpScene.of(*box) for box in REGIMES[name]], REGIMES[name][0][2]
    sides, limit, side = LIMITS[name]
    outlines = [MpScene.of(*box, 0) for box in sides]
    boxes = [box._replace(r=limit(box) + side * LIMIT_STEP) for box in outlines]
    # Ratios are reported in the box of the source's figures.
    return boxes, float(limit(outlines[0])) if sides[0] == (1.5, 1.0) else None


def finding(statement, name):
    """Return (right, ratio, radius) of a statement in one regime or limit, or without a radius.

    Claims and undefined values have no ratio.
    """
    boxes, radius = reported_boxes(name)
    if statement.is_claim:
        return all(map(statement.printed, boxes)), None, radius
    ratios = [printed_ratio(statement, q) for q in boxes]
    right = all(ratio is not None and abs(ratio - 1) < SAME for ratio in ratios)
    return right, ratios[0], radius


def judge(statement):
    """Return the row of errata.csv on one ``Statement``.

    If the statement fails, the row is about the first regime or limit in which it does.
    """
    with mp.workdps(DIGITS):
        findings = [finding(statement, name) for name in statement.where or (None,)]
    right = [found[0] for found in findings]
    _, ratio, radius = findings[right.index(False) if False in right else 0]
    return row(
        {},
        label=statement.label,
        number=statement.number or None,
        place=statement.place,
        verdict="right" if all(right) else "right-in-range" if any(right) else "wrong",
        severity=statement.severity,
        ratio=None if ratio is None else float(ratio),
        radius=radius,
        correction=statement.correction,
    )


def rows():
    """Return the rows of errata.csv, in the order of the source."""
    return [judge(statement) for statement in STATEMENTS]
