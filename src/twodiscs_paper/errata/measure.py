"""Which formulas of the source are right and which are wrong, with the evidence.

Each of the ``statements`` is computed as printed and compared with the truth, which is integrated
to fifty digits. This is done in several boxes and at several radii of every regime for which it is
stated. The ratio of the two gives the verdict. Measurements have a veto: if Monte Carlo or dynamics
contradicts the truth, there is no table. If they can distinguish printed from true, they are
quoted.
"""

import math
from dataclasses import dataclass

from mpmath import mp, mpf

from twodiscs.model.checks import InputError
from twodiscs.model.scene import Scene
from twodiscs.theory.numerics.reference import DIGITS, QUANTITIES, MpScene
from twodiscs_paper.errata.statements import GENERAL, LIMITS, NEAR, REGIMES, SAME, STATEMENTS

#: The box of the source's figures, in which ratios are reported.
WIDTH, HEIGHT = 1.5, 1.0

#: Exact values of theory.csv must agree with the quadrature to this accuracy.
STABLE = 1e-12

#: The number of standard errors at which a measurement counts against a formula, or stops the job.
AGAINST, VETO = 5, 6

#: The largest relative standard error of a measurement that is used, and that supports a formula.
PRECISE = 0.02


# Measurements -------------------------------------------------------------------------------------


def _relative(rows):
    """Yield (row, measured over exact, its error) of rows with a small enough error."""
    for row in rows:
        if row["exact"] and row["stderr"] and row["stderr"] <= PRECISE * row["exact"]:
            value = row["estimate"] - row.get("bias", 0.0)
            yield row, value / row["exact"], row["stderr"] / row["exact"]


def measurements(tables):
    """Return {(quantity, radius): {method: (measured/exact, its error)}} from rows of tables.

    ``tables`` maps volume, areas and mean_times, each of which may be missing, to rows. With the
    exact volume, areas measure times and times measure areas. With the exact area of disc
    collisions, their mean time measures the volume. The bias by the thickness of shells is
    subtracted.
    """
    quotients = {}

    def add(quantity, row, method, factor, error):
        quotients.setdefault((quantity, row["radius"]), {})[method] = factor, error

    for row, factor, error in _relative(tables.get("volume", ())):
        add("volume", row, "Monte Carlo", factor, error)
    for row, factor, error in _relative(tables.get("areas", ())):
        add(row["quantity"], row, "Monte Carlo", factor, error)
        time = row["quantity"].removesuffix("_area") + "_time"
        add(time, row, "Monte Carlo", 1 / factor, error / factor**2)
    for row, factor, error in _relative(tables.get("mean_times", ())):
        event = row["event"]
        add(f"{event}_time", row, "dynamics", factor, error)
        add(f"{event}_area", row, "dynamics", 1 / factor, error / factor**2)
        if event == "disc_collision":
            add("volume", row, "dynamics", factor, error)
    return quotients


# Verdicts -----------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Finding:
    """The result for one regime or limit: the ratio printed/true, and the measurements by method.

    A measurement is a ratio measured/true of the printed quantity, with its error. Claims and
    undefined values have no ratio.
    """

    right: bool
    ratio: mpf | None
    radius: float | None
    measured: dict


def _ratio(statement, q):
    """Return printed over true, or None if the printed value is no real number."""
    try:
        printed = statement.printed(q)
    except ZeroDivisionError:
        return None
    real = mp.isfinite(printed) and mp.im(printed) == 0
    return mp.re(printed) / statement.true(q) if real else None


def _tabled_radius(name, quantity, quotients):
    """Return the radius of the tables that represents a regime or limit, or None without one.

    It is the radius nearest to the limit, or nearest to the radius to report, if possible one at
    which both methods measured the quantity.
    """
    radii = [radius for measured, radius in quotients if measured == quantity]
    if name in LIMITS:
        _, limit, side = LIMITS[name]
        away = {radius: side * (radius - limit(MpScene.of(WIDTH, HEIGHT, 0))) for radius in radii}
        return min((radius for radius in radii if away[radius] > 0), key=away.get, default=None)
    target = REGIMES[name][0][2]
    return min(
        (radius for radius in radii if Scene(WIDTH, HEIGHT, radius).regime == name),
        key=lambda radius: (-len(quotients[quantity, radius]), abs(radius - target), radius),
        default=None,
    )


def _boxes(name, tabled):
    """Return the boxes of a regime or limit, first the box to report, and the radius to report."""
    if name is None:
        return [MpScene.of(*box) for box in GENERAL], None
    if name in REGIMES:
        (width, height, radius), *others = REGIMES[name]
        radius = tabled or radius
        return [MpScene.of(*box) for box in ((width, height, radius), *others)], radius
    sides, limit, side = LIMITS[name]
    outlines = [MpScene.of(*box, 0) for box in sides]
    boxes = [box._replace(r=limit(box) + side * NEAR) for box in outlines]
    return boxes, float(limit(outlines[0])) if sides[0] == (WIDTH, HEIGHT) else None


def _confirm(quantity, radius, measured, exact):
    """Return the true value; raise ``InputError`` if theory.csv or a measurement differs."""
    true = QUANTITIES[quantity](MpScene.of(WIDTH, HEIGHT, radius))
    stable = exact.get((radius, quantity))
    if stable is not None and abs(stable / true - 1) > STABLE:
        raise InputError(
            f"theory.csv must have {quantity} {float(true)!r} at radius {radius!r}, not {stable!r}"
        )
    for method, (factor, error) in measured.items():
        if abs(factor - 1) > VETO * error:
            raise InputError(
                f"{method} must agree with the truth, but finds {format_value(factor, error)} of "
                f"the {quantity} at radius {radius!r}"
            )
    return true


def _find(statement, name, quotients, exact):
    """Return the ``Finding`` on a statement for one regime or limit, or without a radius."""
    tabled = _tabled_radius(name, statement.quantity, quotients) if statement.quantity else None
    boxes, radius = _boxes(name, tabled)
    if statement.is_claim:
        return Finding(all(map(statement.printed, boxes)), None, radius, {})
    ratios = [_ratio(statement, q) for q in boxes]
    right = all(ratio is not None and abs(ratio - 1) < SAME for ratio in ratios)
    measured = {}
    if tabled:
        factors = quotients[statement.quantity, tabled]
        true = _confirm(statement.quantity, tabled, factors, exact)
        # A relative deviation of the total is a larger relative deviation of a part. For a limit,
        # the ratio to the truth is measured at a radius nearby and carried over.
        lever = 1
        if name in REGIMES:
            lever = true / (statement.share * statement.true(boxes[0]))
        for method, (factor, error) in sorted(factors.items()):
            by = method if name in REGIMES else f"{method} at {tabled!r}"
            measured[by] = 1 + (factor - 1) * lever, error * abs(lever)
    return Finding(right, ratios[0], radius, measured)


def format_value(value, error):
    """Return a value with its error in units of the last digit, as 0.9996(3)."""
    exponent = math.floor(math.log10(error))
    if round(error / 10.0**exponent) == 10:
        exponent += 1
    digits = max(-exponent, 0)
    return f"{value:.{digits}f}({error * 10.0**digits:.0f})"


def _evidence(finding):
    """Return the evidence: theory, and every measurement that can distinguish printed from true."""
    parts = ["theory"]
    for method, (value, error) in finding.measured.items():
        if finding.ratio is None:
            continue
        if finding.ratio == 0:
            if value > AGAINST * error:
                parts.append(f"{method} {float(value / error):.0f} standard errors from 0")
            continue
        value, error = float(value / finding.ratio), float(error / abs(finding.ratio))
        differs = abs(value - 1) > AGAINST * error
        if error <= PRECISE if finding.right else differs:
            parts.append(f"{method} {format_value(value, error)}")
    return "; ".join(parts)


def judge(statement, quotients=None, exact=None):
    """Return the row of errata.csv on one ``Statement``.

    ``quotients`` is the result of ``measurements``; ``exact`` maps (radius, quantity) to the values
    of theory.csv. If the statement fails, the row is about the first regime or limit in which it
    does. Raises ``InputError`` if a measurement or theory.csv contradicts the truth.
    """
    with mp.workdps(DIGITS):
        findings = [
            _find(statement, name, quotients or {}, exact or {})
            for name in statement.where or (None,)
        ]
        first = next((finding for finding in findings if not finding.right), findings[0])
        right = [finding.right for finding in findings]
        verdict = "right" if all(right) else "right-in-range" if any(right) else "wrong"
        return {
            "label": statement.label,
            "number": statement.number or None,
            "place": statement.place,
            "verdict": verdict,
            "severity": statement.severity,
            "ratio": None if first.ratio is None else float(first.ratio),
            "radius": first.radius,
            "correction": statement.correction,
            "decided_by": _evidence(first),
        }


def rows(tables, box):
    """Return the rows of errata.csv, in the order of the source.

    ``tables`` maps theory, volume, areas and mean_times to the rows of a scene in this ``Box``;
    each may be missing. Tables of another box than the source's are not used: then only theory
    decides. Raises ``InputError`` as ``judge`` does.
    """
    if (box.width, box.height) != (WIDTH, HEIGHT):
        tables = {}
    quotients = measurements(tables)
    exact = {(row["radius"], row["quantity"]): row["exact"] for row in tables.get("theory", ())}
    return [judge(statement, quotients, exact) for statement in STATEMENTS]
