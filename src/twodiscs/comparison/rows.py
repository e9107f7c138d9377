"""From the points of a scene to the rows of its tables: estimates beside exact values.

A point is what one job found at one radius, a dict as read from its file. Rows are dicts with the
columns that ``scene_tables`` declares, ordered by radius, then as in ``EVENTS``.
"""

from itertools import groupby, pairwise

from twodiscs.comparison import estimates, scores
from twodiscs.model.checks import InputError
from twodiscs.model.events import EVENTS
from twodiscs.sampling.strata import mean_of
from twodiscs.theory.exact import shell_expectation


def exact_values(theory):
    """Return {(radius, quantity): exact value or None} from the rows of theory.csv."""
    return {(row["radius"], row["quantity"]): row["exact"] for row in theory}


def _exact(exact, radius, quantity):
    try:
        return exact[radius, quantity]
    except KeyError:
        raise InputError(f"theory.csv has no {quantity} at radius {radius!r}") from None


def ordered(points):
    """Return ``points`` by radius; raises ``InputError`` if two of them share one."""
    points = sorted(points, key=lambda point: point["radius"])
    for radius, same in groupby(point["radius"] for point in points):
        if len(list(same)) > 1:
            raise InputError(f"points must not contain radius {radius!r} twice")
    return points


# Monte Carlo ----------------------------------------------------------------------------------


def _sampled_row(point, quantity, exact, expectation):
    """Return the row of one quantity of a point."""
    part, samples = point["quantities"][quantity], point["samples"]
    hits, measure = part["hits"], part["measure"]
    estimate = estimates.binomial_estimate(hits, samples, measure)
    z, test = scores.binomial_z(hits, samples, min(expectation / measure, 1.0))
    if exact == 0:
        status = "impossible"
    elif estimate is None:
        status = "none-seen"
    else:
        few = min(hits, samples - hits) < estimates.HONEST
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


def _any_wall_row(point, exact, right, top):
    """Return the row of the whole wall area, 4 (right + top), from the rows of its two parts."""
    samples, hits = point["samples"], (right["hits"], top["hits"])
    measures = [4 * point["quantities"][f"{e}_area"]["measure"] for e in ("right_wall", "top_wall")]
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
            found["any_wall"] = _any_wall_row(point, value, found["right_wall"], found["top_wall"])
        rows += [found[event] for event in EVENTS if event in found and event in watched]
    return rows


# Molecular dynamics ---------------------------------------------------------------------------


def _mean_time_row(scene, event, point, exact, strip=None):
    """Return the row of an event from the counts of a ``point``, or of a ``strip`` of it."""
    mean = octaves = None
    if strip is None:
        octaves = point.get("octaves", {}).get(event)
        count, squares = point["counts"][event], point["products"][f"{event}*{event}"]
        status = point["status"][event] if event not in point["strips"] else "counted"
        strip = point | {"share": 1.0}
    else:
        count, squares, status = strip["count"], strip["squares"], strip["status"]
        mean = mean_of(**strip["strata"])
    replicas, duration, copies = strip["replicas"], strip["duration"], scene.copies(event)
    # So long a time would see as many, were starts anywhere, and each wall its own event.
    whole = duration * copies / strip["share"]
    estimate = bound = None
    z, test = scores.mean_time_z(count, squares, replicas, whole, exact, mean)
    if exact is None:
        status = "impossible"
    elif not count:
        status, bound = "none-seen", estimates.mean_time_bound(replicas, whole / copies)
    else:
        estimate = estimates.mean_time(count, squares, replicas, whole, mean)
        if not estimates.is_honest(count, squares, replicas, octaves):
            status = "too-few"
            if estimates.is_honest(count, squares, replicas):
                z = test = None  # no law is known for bursts of which the largest are yet to come
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
        "starts": "invariant" if strip["share"] == 1 else "strip",
        "share": strip["share"],
        "copies": copies,
    }


def mean_time_rows(scene, exact, points):
    """Return the rows of mean_times.csv from dynamics ``points``, for the events they counted.

    A rare hop has the row of its strip; what starts anywhere saw of it is in ``seen_anyway``.
    """
    return [
        _mean_time_row(here, event, point, time, point["strips"].get(event))
        for here, event, point, time in _counted(scene, exact, points)
    ]


def seen_anyway(scene, exact, points):
    """Return rows as in mean_times.csv of the hops that have one from a strip, without it."""
    return [
        _mean_time_row(here, event, point, time)
        for here, event, point, time in _counted(scene, exact, points)
        if event in point["strips"]
    ]


def _counted(scene, exact, points):
    """Yield (scene, event, point, exact mean time) of what ``points`` counted."""
    for point in ordered(points):
        here = scene.with_radius(point["radius"])
        for event in EVENTS:
            if event in point["counts"]:
                yield here, event, point, _exact(exact, point["radius"], f"{event}_time")


def histogram_rows(exact, points):
    """Return the rows of hop_histogram.csv from intervals ``points``.

    The mean is tested by Student's t over the chains, if there are 100 of them and 1000 intervals.
    """
    rows = []
    for point in ordered(points):
        event, intervals = point["event"], point["intervals"]
        exact_mean = _exact(exact, point["radius"], f"{event}_time")
        z, stderr = None, point["stderr"]
        if point["chains"] < estimates.HONEST or not stderr:
            stderr = None
        elif intervals >= scores.NORMAL and exact_mean is not None:
            t = (point["mean"] - exact_mean) / stderr
            z = scores.student_deviate(t, point["chains"] - 1)
        common = {
            "intervals": intervals,
            "exact_mean": exact_mean,
            "mean": point["mean"],
            "mean_stderr": stderr,
            "z": z,
        }
        rows += [
            {"radius": point["radius"], "event": event, **row, **common} for row in _bin_rows(point)
        ]
    return rows


def _bin_rows(point):
    """Yield the rows of the bins of a point, equal ones and wide ones."""
    width, chains = point["bin_width"], point["chains"]
    equal = {"edges": range(len(point["counts"]) + 1), **point}
    for bins, one in (("equal", equal), ("wide", point["wide"])):
        parts = zip(pairwise(one["edges"]), one["counts"], one["squares"], strict=True)
        for (left, right), count, squares in parts:
            per_chain = chains / (point["intervals"] * (right - left) * width)
            sums = {"n": per_chain}, {"n": count}, {"n*n": squares}
            density = estimates.combination(*sums, chains)
            yield {
                "bins": bins,
                "left": left * width,
                "right": right * width,
                "count": count,
                "density": density.value,
                "stderr": density.stderr or None,
            }


def cost_rows(points, forecast):
    """Return the rows of cost.csv from pairs (stage, radius, point), by stage and radius.

    ``forecast`` is {(stage, radius): seconds}, as far as there was one. The last row is the total
    of what was forecast, if anything was.
    """
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
