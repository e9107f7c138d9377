"""Mean times by molecular dynamics, beside the exact values: mean_times.csv."""

from twodiscs.comparison.points import by_radius
from twodiscs.comparison.tables.base import COUNT, LENGTH, NUMBER, TEXT, TIME, Table
from twodiscs.comparison.tables.exact import ExactValues
from twodiscs.model.events import EVENTS


class MeanTimes(Table):
    """
    One row per radius and event: the mean time between events, exact and by dynamics. If a hop is
    measured in a strip, check.csv also compares the count from ordinary initial states.
    """

    radius: LENGTH
    event: TEXT
    """the event"""
    exact: TIME
    """exact mean time; empty where the event is impossible, and where no exact value is known"""
    estimate: TIME
    """
    copies · T/(share · ⟨N⟩) with ⟨N⟩ = count/replicas, in a strip with its mean over strata of the
    starts; empty where none was seen
    """
    stderr: TIME
    """
    standard error from the spread between replicas, in a strip from that within strata; empty when
    too few to be honest
    """
    z: NUMBER
    """
    standard normal deviate, positive when the time is too long; of the mean count, which is
    unbiased for every T
    """
    count: COUNT
    """events counted in all replicas; for walls with all that symmetry makes equal"""
    ergodic_components: COUNT
    replicas: COUNT
    """independent trajectories"""
    duration: TIME
    """length T of a replica"""
    relative_stderr: NUMBER
    """stderr/estimate"""
    target: NUMBER
    """relative standard error asked for"""
    status: TEXT
    """
    reached: the target; budget: stopped by the event budget; too-few: under 100 replicas or 100
    effective events (clusters count once), or too few initial states to show the crowds of events
    of rough discs, no honest error; none-seen; impossible: blocked by geometry
    """
    bound: TIME
    """
    where none was seen: lower bound on the mean time at 95 %, allowing for clusters of four events
    """
    test: TEXT
    starts: TEXT
    """
    invariant: anywhere, so that dynamics alone gives the time; strip: next to the surface of a rare
    hop, in an exactly known share of configuration space, so that the share is theory's and the
    flux through the surface is tested
    """
    share: NUMBER
    """share of configuration space that starts come from"""
    copies: COUNT
    """
    events that count as one, on average: of a wall, the pairs of a disc and a wall that are equal
    by symmetry and within reach
    """

    @staticmethod
    def rows(box, theory, points):
        """Return the rows of dynamics points, for the events that they counted.

        ``theory`` are the rows of theory.csv, ``points`` is {"dynamics": [point, …]}. A rare hop
        has the row of its strip; what starts anywhere saw of it is in ``seen_anywhere``.
        """
        return [
            _row(scene, event, point, exact, point["strips"].get(event))
            for scene, event, point, exact in _counted(box, theory, points)
        ]


def seen_anywhere(box, theory, points):
    """Return the rows that hops with a strip would have without it, as ``MeanTimes.rows`` does."""
    return [
        _row(scene, event, point, exact)
        for scene, event, point, exact in _counted(box, theory, points)
        if event in point["strips"]
    ]


def _counted(box, theory, points):
    """Yield (scene, event, point, exact mean time) of what dynamics points counted."""
    exact = ExactValues(theory)
    for point in by_radius(points.get("dynamics", ())):
        scene = box.scene(point["radius"])
        for event in EVENTS:
            if event in point["counts"]:
                yield scene, event, point, exact[point["radius"], f"{event}_time"]


def _row(scene, event, point, exact, strip=None):
    """Return the row of an event from the counts of a ``point``, or of a ``strip`` of it."""
    from twodiscs.comparison import estimates, scores  # which need numpy and scipy
    from twodiscs.sampling.blocks.strata import mean_of
    from twodiscs.theory.exact import replicas_needed

    mean, octaves, target = None, None, point["target"][event]
    if strip is None:
        octaves = point.get("octaves", {}).get(event)
        count, squares = point["counts"][event], point["products"][f"{event}*{event}"]
        status = point["status"][event] if event not in point["strips"] else "counted"
        strip = point | {"share": 1.0}
    else:
        count, squares, status = strip["count"], strip["squares"], strip["status"]
        mean = mean_of(**strip["strata"])
    replicas, duration, copies = strip["replicas"], strip["duration"], scene.multiplicity(event)
    # So long a time would see as many, were starts anywhere, and each wall its own event.
    whole = duration * copies / strip["share"]
    estimate = bound = None
    z, test = scores.mean_time_z(count, squares, replicas, whole, exact, mean)
    if not scene.is_possible(event):
        z, test = scores.impossible_z(count)
        status = "impossible"
    elif not count:
        status, bound = "none-seen", estimates.mean_time_bound(replicas, whole / copies)
    else:
        estimate = estimates.mean_time(count, squares, replicas, whole, mean)
        if not estimates.has_error_bar(count, squares, replicas, octaves):
            status = "too-few"
            if estimates.has_error_bar(count, squares, replicas):
                z = test = None  # no law is known for bursts of which the largest are yet to come
    if strip["share"] == 1 and scene.is_possible(event):
        error = min(target, estimate.relative_stderr) if estimate else target
        if replicas < replicas_needed(scene, event, error):
            # The run may have missed the crowds, and its sample would not show that.
            status, z, test, bound = "too-few" if count else status, None, None, None
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
        "target": target,
        "status": status,
        "bound": bound,
        "test": test,
        "starts": "invariant" if strip["share"] == 1 else "strip",
        "share": strip["share"],
        "copies": copies,
    }
