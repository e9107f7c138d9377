"""Mean times by molecular dynamics, beside the exact values: mean_times.csv."""

from twodiscs.comparison.tables.base import (
    COUNT,
    ERGODIC_COMPONENTS,
    NUMBER,
    RADIUS,
    TEST,
    TEXT,
    TIME,
    Table,
    by_radius,
)
from twodiscs.comparison.tables.theory import ExactValues


class MeanTimes(Table):
    """
    One row per radius and event: the mean time between events, exact and by dynamics. If a hop is
    measured in a strip, check.csv also compares the count from ordinary initial states.
    """

    columns = {
        "radius": RADIUS,
        "event": TEXT("the event"),
        "exact": TIME(
            "exact mean time; empty if the event is impossible or no exact value is known"
        ),
        "estimate": TIME(
            "copies · T/(share · ⟨N⟩) with ⟨N⟩ = count/replicas, in a strip the mean over strata "
            "of the initial states; empty without a count"
        ),
        "stderr": TIME(
            "standard error from the spread between replicas, in a strip from the spread within "
            "strata; empty if there are too few events for one"
        ),
        "z": NUMBER(
            "standard normal deviate of the mean count, which is unbiased for every T; positive "
            "if the time is too long"
        ),
        "count": COUNT(
            "events counted in all replicas; for walls with all events that are equal by symmetry"
        ),
        "ergodic_components": ERGODIC_COMPONENTS,
        "replicas": COUNT("independent trajectories"),
        "duration": TIME("length T of a replica"),
        "relative_stderr": NUMBER("stderr/estimate"),
        "target": NUMBER("relative standard error that was asked for"),
        "status": TEXT(
            "reached: the target; budget: stopped by the event budget; too-few: no error bar, "
            "because of under 100 replicas or 100 effective events (clusters count once), or too "
            "few initial states to find the rare ones of rough discs with very many events; "
            "none-seen: no event; impossible: blocked by geometry"
        ),
        "bound": TIME(
            "without a count: lower bound on the mean time at 95 %, with an allowance for "
            "clusters of four events"
        ),
        "test": TEST,
        "starts": TEXT(
            "initial states. invariant: in all of configuration space, so that dynamics alone "
            "gives the time; strip: next to the surface of a rare hop, in an exactly known share "
            "of configuration space, so that the share comes from theory and the test is about "
            "the flux through the surface"
        ),
        "share": NUMBER("share of configuration space from which the initial states are drawn"),
        "copies": COUNT(
            "events that count as one, on average: for a wall, the pairs of a disc and a wall "
            "that are equal by symmetry and that a trajectory can reach"
        ),
    }

    @staticmethod
    def rows(box, theory, points):
        """Return the rows of dynamics points, for the events that they counted.

        ``theory`` are the rows of theory.csv, ``points`` is {"dynamics": [point, …]}. A rare hop
        has the row of its strip; ``rows_without_strips`` has its counts from all initial states.
        """
        return [
            _row(scene, event, point, exact, point.count(event))
            for scene, event, point, exact in _counted(box, theory, points)
        ]


def rows_without_strips(box, theory, points):
    """Return the rows that hops with a strip would have without it, as ``MeanTimes.rows`` does."""
    return [
        _row(scene, event, point, exact, point.everywhere(event))
        for scene, event, point, exact in _counted(box, theory, points)
        if point.in_strip(event)
    ]


def _counted(box, theory, points):
    """Yield (scene, event, point, exact mean time) for the events that dynamics points counted."""
    exact = ExactValues(theory)
    for point in by_radius(points.get("dynamics", ())):
        scene = box.scene(point.radius)
        for event in point.counted:
            yield scene, event, point, exact[point.radius, f"{event}_time"]


def _row(scene, event, point, exact, count):
    """Return the row of an event of a ``point`` from a ``Count`` of it."""
    from twodiscs.comparison import scores  # which needs numpy and scipy
    from twodiscs.points.estimates import has_error_bar
    from twodiscs.theory.exact import replicas_needed

    target, copies = point.target[event], scene.multiplicity(event)
    estimate, bound = count.estimate(copies), None
    if target is None or (count.share == 1 and point.in_strip(event)):
        status = "counted"
    else:
        status = "reached" if estimate and estimate.relative_stderr <= target else "budget"
    z, test = scores.mean_time_z(*count.sums, count.time(copies), exact, count.mean)
    if not scene.is_possible(event):
        z, test = scores.impossible_z(count.count)
        estimate, status = None, "impossible"
    elif estimate is None:
        status, bound = "none-seen", count.bound()
    elif not has_error_bar(*count.sums):
        status = "too-few"
    if count.share == 1 and scene.is_possible(event):
        errors = [target or 1.0, estimate.relative_stderr if estimate else 1.0]
        if count.replicas < replicas_needed(scene, event, min(errors)):
            # The run may have missed the rare initial states with very many events, and its sample
            # would not show that.
            status, z, test, bound = "too-few" if estimate else status, None, None, None
    with_error = estimate if status != "too-few" else None
    return {
        "radius": point.radius,
        "event": event,
        "exact": exact,
        "estimate": estimate and estimate.value,
        "stderr": with_error and with_error.stderr,
        "z": z,
        "count": count.count,
        "ergodic_components": scene.ergodic_components,
        "replicas": count.replicas,
        "duration": count.duration,
        "relative_stderr": with_error and with_error.relative_stderr,
        "target": target,
        "status": status,
        "bound": bound,
        "test": test,
        "starts": "invariant" if count.share == 1 else "strip",
        "share": count.share,
        "copies": copies,
    }
