"""What Monte Carlo samples, beside the exact values: volume.csv and areas.csv."""

from functools import partial

from twodiscs.comparison.tables.base import (
    COUNT,
    LENGTH,
    RADIUS,
    TEST,
    TEXT,
    Column,
    Table,
    Z,
    by_radius,
)
from twodiscs.comparison.tables.theory import ExactValues
from twodiscs.model.events import EVENTS
from twodiscs.theory.exact import shell_expectation


def _columns(unit):
    """Return the columns of a sampled quantity of this ``unit``."""
    as_quantity = partial(Column, float, unit)
    return {
        "radius": RADIUS,
        "quantity": TEXT("volume, or <event>_area"),
        "method": TEXT(
            "monte_carlo: rejection from the prism; conditioned: draws from the part of the prism "
            "in which the discs can fit, if fewer than one in 64 draws from the whole prism do; "
            "both have areas by a thin shell. insertion: more than two discs, one by one, each "
            "sample with a weight; areas without a shell"
        ),
        "exact": as_quantity("exact value"),
        "estimate": as_quantity(
            "measure × hits/samples, for insertions measure × mean weight; empty without a hit"
        ),
        "stderr": as_quantity(
            "binomial standard error, for insertions from the weights; empty below 100 hits or "
            "misses"
        ),
        "z": Z,
        "samples": COUNT("configurations drawn from the prism, or proposed"),
        "hits": COUNT(
            "configurations that count; for insertions the effective number (Σw)²/Σw², rounded"
        ),
        "epsilon": LENGTH(
            "thickness of the shell in configuration space (to either side, for a hop), × √mass "
            "if masses differ; empty for the volume and, without effects, for any_wall_area = 4 "
            "(right + top), which has two shells"
        ),
        "expectation": as_quantity("exact expectation of the estimate; z is against it"),
        "bias": as_quantity("expectation − exact, the effect of the thickness of the shell"),
        "status": TEXT(
            "sampled; too-few: under 100 hits or misses, no error bar; none-seen: no hit; "
            "impossible: blocked by geometry"
        ),
        "test": TEST,
    }


class Volume(Table):
    """
    One row per radius: the volume of configuration space, exact and by Monte Carlo. In a field the
    invariant density weights it. For balls it is in length⁶, for N discs in length^2N.
    """

    columns = _columns("length⁴")

    @staticmethod
    def rows(theory, points):
        """Return the rows of the Monte Carlo points that have the volume.

        ``theory`` are the rows of theory.csv, ``points`` is {"monte_carlo": [point, …]}.
        """
        exact, rows = ExactValues(theory), []
        for point in by_radius(points.get("monte_carlo", ())):
            if sampled := point.sampled("volume"):
                value = exact[point.radius, "volume"]
                rows.append(_row(point, "volume", sampled, value, value))
        return rows


class Areas(Table):
    """
    One row per radius and event: the area of the event's surface, exact and by Monte Carlo. A shell
    of finite thickness is not a surface, so its exact expectation has a column. In a field areas
    have the weight of the flux. For balls they are in length⁵, for N discs in length^(2N − 1).
    """

    columns = _columns("length³")

    @staticmethod
    def rows(box, theory, points, areas=EVENTS):
        """Return the rows of Monte Carlo points for the events ``areas``.

        Arguments are as in ``Volume.rows``. With effects the area of all walls is sampled. Without,
        it follows from the right and the top wall, so a point has these two even if only the area
        of all walls is asked for.
        """
        exact, rows = ExactValues(theory), []
        for point in by_radius(points.get("monte_carlo", ())):
            scene = box.scene(point.radius)
            for event in EVENTS:
                if event in areas:
                    rows += _area_rows(scene, point, event, exact)
        return rows


def _area_rows(scene, point, event, exact):
    """Return a list with the row of an ``event``, empty if the point does not have its area."""
    from twodiscs.comparison import scores  # which needs numpy and scipy

    quantity = f"{event}_area"
    sampled = point.sampled(quantity)
    if sampled is None and event == "any_wall":
        sampled = point.all_walls(scene)
    if sampled is None:
        return []
    value = exact[scene.radius, quantity]
    if point.method == "insertion":
        return [_row(point, quantity, sampled, value, value)]
    if sampled.epsilon is not None:
        expectation = shell_expectation(scene, event, sampled.epsilon)
        return [_row(point, quantity, sampled, value, expectation)]
    # By symmetry, 4 times the sum over two shells, which overlap.
    walls = {wall: point.quantities[f"{wall}_area"] for wall in ("right_wall", "top_wall")}
    hits, measures = zip(*((part.hits, 4 * part.measure) for part in walls.values()), strict=True)
    expectations = [4 * shell_expectation(scene, wall, walls[wall].epsilon) for wall in walls]
    probabilities = [min(e / m, 1.0) for e, m in zip(expectations, measures, strict=True)]
    score = scores.shells_z(hits, point.right_and_top, point.samples, measures, probabilities)
    return [_row(point, quantity, sampled, value, sum(expectations), score)]


def _score(point, quantity, sampled, expectation):
    """Return (z, test) of a quantity of a point against its exact ``expectation``."""
    from twodiscs.comparison import scores

    estimate = sampled.estimate
    if expectation is None:
        return None, None
    if point.method != "insertion":
        probability = min(expectation / point.quantities[quantity].measure, 1.0)
        return scores.binomial_z(sampled.hits, point.samples, probability)
    if expectation == 0:
        z, test = scores.impossible_z(0 if estimate is None else 1)
        return abs(z), test
    if estimate is None or sampled.enough < scores.NORMAL:
        return None, None
    t = (estimate.value - expectation) / estimate.stderr
    return scores.student_deviate(t, estimate.n - 1), "normal"


def _row(point, quantity, sampled, exact, expectation, score=None):
    """Return the row of a quantity of a point, whose counts are ``sampled``."""
    from twodiscs.points.estimates import MIN_EVENTS

    estimate = sampled.estimate
    z, test = score or _score(point, quantity, sampled, expectation)
    if exact == 0:
        status = "impossible"
    elif estimate is None:
        status = "none-seen"
    else:
        status = "too-few" if sampled.enough < MIN_EVENTS else "sampled"
    return {
        "radius": point.radius,
        "quantity": quantity,
        "method": point.method,
        "exact": exact,
        "estimate": estimate and estimate.value,
        "stderr": estimate.stderr if status == "sampled" else None,
        "z": z,
        "samples": point.samples,
        "hits": sampled.hits,
        "epsilon": sampled.epsilon,
        "expectation": expectation,
        "bias": None if exact is None else expectation - exact,
        "status": status,
        "test": test,
    }
