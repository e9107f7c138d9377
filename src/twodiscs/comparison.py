"""From the points of a scene to the rows of its tables: estimates beside exact values.

A point is what one job found at one radius, a dict as read from its file. Rows are dicts with the
columns that ``tables`` declares, ordered by radius, then as in ``scene.EVENTS``.
"""

import math
from itertools import groupby

from twodiscs import statistics
from twodiscs.scene import EVENTS
from twodiscs.theory import shell_expectation

SUM_RULE = ("disc_collision", "right_wall", "top_wall")


def exact_values(theory):
    """Return {(radius, quantity): exact value or None} from the rows of theory.csv."""
    return {(row["radius"], row["quantity"]): row["exact"] for row in theory}


def _exact(exact, radius, quantity):
    try:
        return exact[radius, quantity]
    except KeyError:
        raise ValueError(f"theory.csv has no {quantity} at radius {radius!r}") from None


def ordered(points):
    """Return ``points`` by radius; raises ``ValueError`` if two of them share one."""
    points = sorted(points, key=lambda point: point["radius"])
    for radius, same in groupby(point["radius"] for point in points):
        if len(list(same)) > 1:
            raise ValueError(f"points must not contain radius {radius!r} twice")
    return points


# Monte Carlo ----------------------------------------------------------------------------------


def _sampled_row(point, quantity, exact, expectation):
    """Return the row of one quantity of a point."""
    part, samples = point["quantities"][quantity], point["samples"]
    hits, measure = part["hits"], part["measure"]
    estimate = statistics.binomial_estimate(hits, samples, measure)
    z, test = statistics.binomial_z(hits, samples, min(expectation / measure, 1.0))
    if exact == 0:
        status = "impossible"
    elif estimate is None:
        status = "none-seen"
    else:
        few = min(hits, samples - hits) < statistics.HONEST
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
        "bias": expectation - exact,
        "status": status,
        "test": test,
    }


def _any_wall_row(radius, point, exact, right, top):
    """Return the row of the whole wall area, 4 (right + top), from the rows of its two parts."""
    samples, hits = point["samples"], (right["hits"], top["hits"])
    measures = [4 * point["quantities"][f"{e}_area"]["measure"] for e in ("right_wall", "top_wall")]
    expectations = [4 * right["expectation"], 4 * top["expectation"]]
    both = point["right_and_top"]
    estimate = statistics.combination(
        {"right": measures[0], "top": measures[1]},
        {"right": hits[0], "top": hits[1]},
        {"right*right": hits[0], "right*top": both, "top*top": hits[1]},
        samples,
    )
    probabilities = [min(e / m, 1.0) for e, m in zip(expectations, measures, strict=True)]
    z, test = statistics.shells_z(hits, both, samples, measures, probabilities)
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


def volume_rows(exact, points):
    """Return the rows of volume.csv from Monte Carlo ``points`` that have the volume."""
    rows = []
    for point in ordered(points):
        if "volume" in point["quantities"]:
            value = _exact(exact, point["radius"], "volume")
            rows.append(_sampled_row(point, "volume", value, value))
    return rows


def area_rows(scene, exact, points, watched=EVENTS):
    """Return the rows of areas.csv from Monte Carlo ``points``, for the ``watched`` events.

    ``scene`` is a ``Scene`` of any radius. With effects the whole wall area has counts of its own.
    Without, it follows from the right and the top wall, which a point therefore has when only the
    whole is watched.
    """
    rows = []
    for point in ordered(points):
        radius, found = point["radius"], {}
        here = scene.with_radius(radius)
        for event in EVENTS:
            quantity = f"{event}_area"
            part = point["quantities"].get(quantity)
            if part:
                value = _exact(exact, radius, quantity)
                expectation = shell_expectation(here, event, part["epsilon"])
                found[event] = _sampled_row(point, quantity, value, expectation)
        if {"right_wall", "top_wall"} <= set(found) and not scene.has_effects:
            value = _exact(exact, radius, "any_wall_area")
            found["any_wall"] = _any_wall_row(
                radius, point, value, found["right_wall"], found["top_wall"]
            )
        rows += [found[event] for event in EVENTS if event in found and event in watched]
    return rows


# Molecular dynamics ---------------------------------------------------------------------------


def _mean_time_row(scene, event, point, exact):
    count, replicas = point["counts"][event], point["eligible"][event]
    squares, duration = point["products"][f"{event}*{event}"], point["duration"]
    estimate = bound = z = test = None
    if replicas:
        z, test = statistics.mean_time_z(count, squares, replicas, duration, exact)
    if exact is None:
        status = "impossible"
    elif not count:
        status = "none-seen"
        bound = statistics.mean_time_bound(replicas, duration) if replicas else None
    else:
        estimate = statistics.mean_time(count, squares, replicas, duration)
        honest = statistics.is_honest(count, squares, replicas)
        status = point["status"][event] if honest else "too-few"
    shown = estimate if status != "too-few" else None
    return {
        "radius": point["radius"],
        "event": event,
        "exact": exact,
        "estimate": estimate and estimate.value,
        "stderr": shown and shown.stderr,
        "z": z,
        "count": count,
        "ergodic_components": scene.ergodic_components,
        "replicas": replicas,
        "duration": duration,
        "relative_stderr": shown and shown.relative_stderr,
        "target": point["target"][event],
        "status": status,
        "bound": bound,
        "test": test,
    }


def mean_time_rows(scene, exact, points):
    """Return the rows of mean_times.csv from dynamics ``points``, for the events they counted."""
    return [
        _mean_time_row(
            scene.with_radius(point["radius"]),
            event,
            point,
            _exact(exact, point["radius"], f"{event}_time"),
        )
        for point in ordered(points)
        for event in EVENTS
        if event in point["counts"]
    ]


def histogram_rows(exact, points):
    """Return the rows of hop_histogram.csv from intervals ``points``.

    The mean is tested by Student's t over the chains, if there are 100 of them and 1000 intervals.
    """
    rows = []
    for point in ordered(points):
        event, width, intervals = point["event"], point["bin_width"], point["intervals"]
        exact_mean = _exact(exact, point["radius"], f"{event}_time")
        z, stderr = None, point["stderr"]
        if point["chains"] < statistics.HONEST or not stderr:
            stderr = None
        elif intervals >= statistics.NORMAL and exact_mean is not None:
            t = (point["mean"] - exact_mean) / stderr
            z = statistics.student_deviate(t, point["chains"] - 1)
        for i, count in enumerate(point["counts"]):
            density = statistics.binomial_estimate(count, intervals, 1 / width)
            rows.append(
                {
                    "radius": point["radius"],
                    "event": event,
                    "left": i * width,
                    "right": (i + 1) * width,
                    "count": count,
                    "density": density.value if density else 0.0,
                    "stderr": density and density.stderr,
                    "intervals": intervals,
                    "exact_mean": exact_mean,
                    "mean": point["mean"],
                    "mean_stderr": stderr,
                    "z": z,
                }
            )
    return rows


def cost_rows(points, forecast=None):
    """Return the rows of cost.csv from pairs (stage, radius, point), by stage and radius.

    ``forecast`` is {(stage, radius): seconds}, as far as there was one. The last row is the total
    of what was forecast, if anything was.
    """
    forecast = forecast or {}
    rows = [
        _cost_row(stage, radius, point["events"], point["seconds"], forecast.get((stage, radius)))
        for stage, radius, point in sorted(points, key=lambda item: item[:2])
    ]
    known = [row for row in rows if row["forecast_seconds"]]
    if known:
        sums = (
            sum(row[name] for row in known) for name in ("events", "seconds", "forecast_seconds")
        )
        rows.append(_cost_row("total", None, *sums))
    return rows


def _cost_row(stage, radius, events, seconds, forecast):
    return {
        "stage": stage,
        "radius": radius,
        "events": events,
        "seconds": seconds,
        "forecast_seconds": forecast,
        "ratio": seconds / forecast if forecast else None,
    }


# Check ----------------------------------------------------------------------------------------


def _comparison(name, quantity, method, values):
    """Return a row of check.csv, without a verdict; ``values`` has the columns not named here."""
    z = values["z"]
    return {
        "comparison": name,
        "quantity": quantity,
        "radius": values["radius"],
        "method": method,
        "exact": values["exact"],
        "estimate": values["estimate"],
        "stderr": values["stderr"],
        "z": z,
        "p": None if z is None else statistics.two_sided_p(z),
        "bound": None,
        "passed": None,
        "status": values["status"],
        "test": values["test"],
    }


def _normal_values(radius, exact, estimate, stderr, z):
    """Return the values of a comparison by a normal law, made only where the error is honest."""
    status, test = ("too-few", None) if z is None else ("counted", "normal")
    return {
        "radius": radius,
        "exact": exact,
        "estimate": estimate,
        "stderr": stderr,
        "z": z,
        "status": status,
        "test": test,
    }


def _sum_rule(scene, point):
    """Return the comparison of the sum rule for one dynamics point, at the radius of ``scene``."""
    counts, replicas = point["counts"], point["replicas"]
    rule = statistics.sum_rule(scene, point["duration"], replicas, counts, point["products"])
    enough = min(counts[event] for event in SUM_RULE) >= statistics.NORMAL
    stderr = z = None
    if enough and replicas >= statistics.HONEST and rule.stderr:
        stderr = rule.stderr
        z = statistics.student_deviate((rule.value - 1) / stderr, replicas - 1)
    values = _normal_values(scene.radius, 1.0, rule.value, stderr, z)
    return _comparison("sum_rule", "mean_times", "dynamics", values)


def comparisons(scene, volume, areas, times, histogram, dynamics):
    """Return one comparison for every estimate at a radius, without verdicts.

    ``volume``, ``areas``, ``times`` and ``histogram`` are rows of the tables, ``dynamics`` the
    points, for the sum rule of plain scenes wherever its three events were counted.
    """
    rows = []
    for name, table in (("volume", volume), ("area", areas)):
        for row in table:
            values = {**row, "exact": row["expectation"]}
            rows.append(_comparison(name, row["quantity"], row["method"], values))
    for row in times:
        rows.append(_comparison("mean_time", f"{row['event']}_time", "dynamics", row))
    for (radius, event), bins in groupby(histogram, key=lambda row: (row["radius"], row["event"])):
        row = next(bins)
        values = _normal_values(
            radius, row["exact_mean"], row["mean"], row["mean_stderr"], row["z"]
        )
        rows.append(_comparison("hop_interval", f"{event}_interval", "intervals", values))
    for point in ordered(dynamics):
        if set(SUM_RULE) <= set(point["counts"]) and not scene.has_effects:
            rows.append(_sum_rule(scene.with_radius(point["radius"]), point))
    return sorted(rows, key=lambda row: row["radius"])


def distributions(rows):
    """Return, for each quantity and method, whether its scores over radii look standard normal.

    Two comparisons each, ``z_mean`` and ``z_spread``, of the scores that a normal law gave, at two
    radii or more.
    """
    groups = {}
    for row in rows:
        if row["test"] == "normal":
            groups.setdefault((row["quantity"], row["method"]), []).append(row["z"])
    found = []
    for (quantity, method), z in groups.items():
        n = len(z)
        if n > 1:
            mean = {
                "exact": 0.0,
                "estimate": math.fsum(z) / n,
                "stderr": 1 / math.sqrt(n),
                "z": statistics.z_mean(z),
                "test": "normal",
            }
            spread = {
                "exact": 1.0,
                "estimate": math.sqrt(math.fsum(x * x for x in z) / n),
                "stderr": None,
                "z": statistics.z_spread(z),
                "test": "chi-square",
            }
            for name, values in (("z_mean", mean), ("z_spread", spread)):
                values |= {"radius": None, "status": None}
                found.append(_comparison(name, quantity, method, values))
    return found


def judged(rows, alarm):
    """Return ``rows`` with verdicts, by Bonferroni's bound for a false-alarm probability."""
    tested = sum(row["z"] is not None for row in rows)
    bound = statistics.bonferroni_bound(tested, alarm) if tested else None
    return [
        row if row["z"] is None else {**row, "bound": bound, "passed": abs(row["z"]) <= bound}
        for row in rows
    ]


def check_rows(rows, alarm=statistics.FALSE_ALARM):
    """Return the rows of check.csv: the comparisons ``rows`` and their distributions, judged.

    The probability that any of them fails although all is right is at most ``alarm``, half of it
    for the comparisons at a radius and half for the distributions.
    """
    return judged(rows, alarm / 2) + judged(distributions(rows), alarm / 2)
