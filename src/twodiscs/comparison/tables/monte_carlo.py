"""What Monte Carlo samples, beside the exact values: volume.csv and areas.csv."""

from twodiscs.comparison.points import by_radius
from twodiscs.comparison.tables.base import COUNT, LENGTH, NUMBER, TEXT, Column, Table
from twodiscs.comparison.tables.exact import ExactValues
from twodiscs.model.events import EVENTS
from twodiscs.theory.exact import shell_expectation

AS_QUANTITY = Column(float, "as quantity")
VOLUME, AREA = Column(float, "length⁴"), Column(float, "length³")


class Sampled(Table):
    """What Monte Carlo estimates of a quantity at a radius, beside the exact value."""

    radius: LENGTH
    quantity: TEXT
    """volume, or <event>_area"""
    method: TEXT
    """
    monte_carlo: rejection from the prism; conditioned: draws that keep to where the discs fit,
    where less than one in 64 of the prism does; areas by a thin shell. insertion: of more than two
    discs, one by one, each sample with a weight; areas without a shell
    """
    exact: AS_QUANTITY
    """exact value"""
    estimate: AS_QUANTITY
    """measure × hits/samples, of insertions measure × mean weight; empty without a hit"""
    stderr: AS_QUANTITY
    """
    binomial standard error, of insertions that of the weights; empty below 100 hits or misses
    """
    z: NUMBER
    samples: COUNT
    """configurations drawn from the prism, or proposed"""
    hits: COUNT
    """configurations that count; of insertions the effective number (Σw)²/Σw², rounded"""
    epsilon: LENGTH
    """
    thickness of the shell in configuration space (to either side, for a hop), × √mass where masses
    differ; empty for the volume and, without effects, for any_wall_area = 4 (right + top), which
    joins two shells
    """
    expectation: AS_QUANTITY
    """exact expectation of the estimate; z is against it"""
    bias: AS_QUANTITY
    """expectation − exact: what the thickness of the shell adds"""
    status: TEXT
    """
    sampled; too-few: under 100 hits or misses, no honest error; none-seen; impossible: blocked by
    geometry
    """
    test: TEXT


class Volume(Sampled):
    """
    One row per radius: the volume of configuration space, exact and by Monte Carlo. In a field it
    is weighted with the invariant density; for balls it is in length⁶, for N discs in length^2N.
    """

    exact: VOLUME
    estimate: VOLUME
    stderr: VOLUME
    expectation: VOLUME
    bias: VOLUME

    @staticmethod
    def rows(theory, points):
        """Return the rows of the Monte Carlo points that have the volume.

        ``theory`` are the rows of theory.csv, ``points`` is {"monte_carlo": [point, …]}.
        """
        exact = ExactValues(theory)
        return [
            _row_of(point, "volume", *2 * [exact[point["radius"], "volume"]])
            for point in by_radius(points.get("monte_carlo", ()))
            if "volume" in point["quantities"]
        ]


class Areas(Sampled):
    """
    One row per radius and event: the area of the event's surface, exact and by Monte Carlo. A shell
    of finite thickness is not a surface, so its exact expectation has a column. In a field areas
    are weighted as the flux is; for balls they are in length⁵, for N discs in length^(2N − 1).
    """

    exact: AREA
    estimate: AREA
    stderr: AREA
    expectation: AREA
    bias: AREA

    @staticmethod
    def rows(box, theory, points, areas=EVENTS):
        """Return the rows of Monte Carlo points, for the events of which ``areas`` are asked for.

        Arguments are as in ``Volume.rows``. With effects the whole wall area has counts of its
        own. Without, it follows from the right and the top wall, which a point therefore has when
        only the whole is watched.
        """
        exact, rows = ExactValues(theory), []
        for point in by_radius(points.get("monte_carlo", ())):
            radius, sampled = point["radius"], {}
            scene = box.scene(radius)
            if point["method"] == "insertion":
                rows += _inserted_rows(scene, point, exact, areas)
                continue
            for event in EVENTS:
                quantity = f"{event}_area"
                part = point["quantities"].get(quantity)
                if part:
                    expectation = shell_expectation(scene, event, part["epsilon"])
                    value = exact[radius, quantity]
                    sampled[event] = _sampled_row(point, quantity, value, expectation)
            if {"right_wall", "top_wall"} <= sampled.keys() and "right_and_top" in point:
                value = exact[radius, "any_wall_area"]
                parts = sampled["right_wall"], sampled["top_wall"]
                sampled["any_wall"] = _any_wall_row(point, value, *parts)
            rows += [sampled[event] for event in EVENTS if event in sampled and event in areas]
        return rows


def _row_of(point, quantity, exact, expectation):
    if point["method"] == "insertion":
        return _weighted_row(point, quantity, exact)
    return _sampled_row(point, quantity, exact, expectation)


def _inserted_rows(scene, point, exact, areas):
    """Return the rows of the areas of a point of insertions, which are unbiased."""
    rows = []
    for event in EVENTS:
        quantity = f"{event}_area"
        if event in areas and quantity in point["quantities"]:
            rows.append(_weighted_row(point, quantity, exact[scene.radius, quantity]))
        elif event in areas and event == "any_wall":
            rows += _all_walls_row(scene, point, exact[scene.radius, quantity])
    return rows


def _weighted_row(point, quantity, exact):
    """Return the row of a quantity of a point of insertions."""
    from twodiscs.comparison import estimates

    part, unit, samples = point["quantities"][quantity], point["unit"], point["samples"]
    sums = part["sum"], part["squares"], unit, samples
    estimate, effective = estimates.weighted_estimate(*sums, part["measure"])
    misses = estimates.effective_misses(*sums)
    return _of_estimate(point, quantity, exact, estimate, effective, misses)


def _all_walls_row(scene, point, exact):
    """Return the row of all walls, 2N of each axis with walls, in a list; or none of them."""
    from twodiscs.comparison import estimates

    walls = [f"{wall}_area" for wall in ("right_wall", "top_wall") if wall in scene.events]
    if not {*walls} <= point["quantities"].keys():
        return []
    weights = {wall: scene.multiplicity(wall.removesuffix("_area")) for wall in walls}
    sums = [
        (point["quantities"][w]["sum"], point["quantities"][w]["squares"], point["unit"])
        for w in walls
    ]
    misses = min(estimates.effective_misses(*one, point["samples"]) for one in sums)
    found = estimates.sampled_sum(point, weights)
    return [_of_estimate(point, "any_wall_area", exact, *found, misses)]


def _of_estimate(point, quantity, exact, estimate, effective, misses):
    """Return the row of an unbiased estimate with effective numbers of samples and of misses."""
    from twodiscs.comparison import estimates, scores

    z = test = None
    status = "sampled" if min(effective, misses) >= estimates.MIN_EVENTS else "too-few"
    if exact == 0:
        z, test = scores.impossible_z(0 if estimate is None else 1)
        z, status = abs(z), "impossible"
    elif estimate is None:
        status = "none-seen"
    elif exact is not None and min(effective, misses) >= scores.NORMAL:
        z = scores.student_deviate((estimate.value - exact) / estimate.stderr, estimate.n - 1)
        test = "normal"
    return {
        "radius": point["radius"],
        "quantity": quantity,
        "method": point["method"],
        "exact": exact,
        "estimate": estimate and estimate.value,
        "stderr": estimate.stderr if status == "sampled" else None,
        "z": z,
        "samples": point["samples"],
        "hits": round(effective),
        "epsilon": None,
        "expectation": exact,
        "bias": None if exact is None else 0.0,
        "status": status,
        "test": test,
    }


def _sampled_row(point, quantity, exact, expectation):
    """Return the row of a quantity of a point."""
    from twodiscs.comparison import estimates, scores  # which need numpy and scipy

    part, samples = point["quantities"][quantity], point["samples"]
    hits, measure = part["hits"], part["measure"]
    estimate = estimates.binomial_estimate(hits, samples, measure)
    z = test = None
    if expectation is not None:
        z, test = scores.binomial_z(hits, samples, min(expectation / measure, 1.0))
    if exact == 0:
        status = "impossible"
    elif estimate is None:
        status = "none-seen"
    else:
        few = min(hits, samples - hits) < estimates.MIN_EVENTS
        status = "too-few" if few else "sampled"
    return {
        "radius": point["radius"],
        "quantity": quantity,
        "method": point["method"],
        "exact": exact,
        "estimate": estimate and estimate.value,
        "stderr": estimate.stderr if status == "sampled" else None,
        "z": z,
        "samples": samples,
        "hits": hits,
        "epsilon": part["epsilon"],
        "expectation": expectation,
        "bias": None if exact is None else expectation - exact,
        "status": status,
        "test": test,
    }


def _any_wall_row(point, exact, right, top):
    """Return the row of the whole wall area, 4 (right + top), from the rows of its two parts."""
    from twodiscs.comparison import estimates, scores

    samples, hits = point["samples"], (right["hits"], top["hits"])
    measures = [
        4 * point["quantities"][f"{wall}_area"]["measure"] for wall in ("right_wall", "top_wall")
    ]
    expectations = [4 * right["expectation"], 4 * top["expectation"]]
    both = point["right_and_top"]
    estimate = estimates.combination(
        {"right": measures[0], "top": measures[1]},
        {"right": hits[0], "top": hits[1]},
        {"right*right": hits[0], "right*top": both, "top*top": hits[1]},
        samples,
    )
    probabilities = [min(e / m, 1.0) for e, m in zip(expectations, measures, strict=True)]
    z, test = scores.shells_z(hits, both, samples, measures, probabilities)
    statuses = {right["status"], top["status"]}
    status = next(s for s in ("none-seen", "too-few", "sampled") if s in statuses)
    return {
        **right,
        "quantity": "any_wall_area",
        "exact": exact,
        "estimate": None if status == "none-seen" else estimate.value,
        "stderr": estimate.stderr if status == "sampled" else None,
        "z": z,
        "hits": sum(hits),
        "epsilon": None,
        "expectation": sum(expectations),
        "bias": sum(expectations) - exact,
        "status": status,
        "test": test,
    }
