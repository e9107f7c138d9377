"""The tables of a scene: their columns, and how their rows follow from exact values and points."""

import math
from functools import partial

from twodiscs.analysis import check, scores
from twodiscs.analysis.columns import (
    COUNT,
    ERGODIC_COMPONENTS,
    LENGTH,
    NUMBER,
    RADIUS,
    RATE,
    SECONDS,
    SEE_QUANTITY,
    TEST,
    TEXT,
    TIME,
    TRUTH,
    Column,
    Table,
    Z,
)
from twodiscs.model.events import EVENTS
from twodiscs.model.formats import format_number, format_seconds, round_up
from twodiscs.points.estimates import LEAST_EVENTS, is_enough, why_no_error
from twodiscs.theory import exact as theory

#: A run that reaches an error below this one has the 100 effective events of an error bar.
COARSE_ERROR = 0.1


def select_stage(points, stage):
    """Return the ``points`` of a ``stage`` in the order of radii."""
    return sorted((p for p in points if p.stage == stage), key=lambda point: point.radius)


def row_quantity(row):
    """Return the quantity of a ``row`` of a table, as theory.csv names it."""
    return row["quantity"] if "quantity" in row else f"{row['event']}_time"


class GridTable(Table):
    """One row per radius that the scene computes."""

    columns = {
        "radius": RADIUS,
        "regime": TEXT("all-hops, vertical-hops, horizontal-hops or no-hops"),
        "ergodic_components": COUNT(
            "disjoint parts of configuration space; empty if not known, for more than two discs"
        ),
        "largest_radius": LENGTH(
            "largest radius at which the discs fit, as far as an arrangement of them is known"
        ),
    }

    @staticmethod
    def rows(box, radii):
        """Return the rows of a ``Box``, one for each radius."""
        scenes = map(box.scene, radii)
        return [{name: getattr(scene, name) for name in GridTable.columns} for scene in scenes]


class TheoryTable(Table):
    """One row per radius and quantity: the exact values."""

    columns = {
        "radius": RADIUS,
        "quantity": TEXT("volume, <event>_area or <event>_time"),
        "exact": Column(
            float,
            "length⁴, length³ or time",
            "exact value, empty if none is known; if the event is impossible, the area is 0 and "
            "the time is empty",
        ),
    }

    @staticmethod
    def rows(box, radii):
        """Return the rows of a ``Box``, radius by radius."""
        rows = []
        for radius in radii:
            numbers = theory.exact(box.scene(radius))
            values = {"volume": numbers["volume"]}
            values |= {f"{event}_area": area for event, area in numbers["areas"].items()}
            values |= {f"{event}_time": time for event, time in numbers["mean_times"].items()}
            rows += [{"radius": radius, "quantity": q, "exact": x} for q, x in values.items()]
        return rows


# Monte Carlo --------------------------------------------------------------------------------------


def _sampled_columns(unit):
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


class VolumeTable(Table):
    """
    One row per radius: the volume of configuration space, exact and by Monte Carlo. In a field the
    invariant density weights it. For balls it is in length⁶, for N discs in length^2N.
    """

    columns = _sampled_columns("length⁴")

    @staticmethod
    def rows(points):
        """Return the rows of the Monte Carlo points that have the volume."""
        rows = []
        for point in select_stage(points, "monte_carlo"):
            if sampled := point.sampled("volume"):
                value = theory.volume(point.scene)
                rows.append(_sampled_row(point, "volume", sampled, value, value))
        return rows


class AreasTable(Table):
    """
    One row per radius and event: the area of the event's surface, exact and by Monte Carlo. A shell
    of finite thickness is not a surface, so its exact expectation has a column. In a field areas
    have the weight of the flux. For balls they are in length⁵, for N discs in length^(2N − 1).
    """

    columns = _sampled_columns("length³")

    @staticmethod
    def rows(points, events=EVENTS):
        """Return the rows of Monte Carlo points for these ``events``.

        With effects the area of all walls is sampled. Without, it follows from the right and the
        top wall, so a point has these two even if only the area of all walls is asked for.
        """
        wanted = [event for event in EVENTS if event in events]
        found = (
            _area_row(p, event) for p in select_stage(points, "monte_carlo") for event in wanted
        )
        return [row for row in found if row]


def _area_row(point, event):
    """Return the row of an ``event``, None if the point does not have its area."""

    scene, quantity = point.scene, f"{event}_area"
    sampled = point.sampled(quantity)
    if sampled is None and event == "any_wall":
        sampled = point.all_walls()
    if sampled is None:
        return None
    value = theory.areas(scene)[event]
    if point.method == "insertion":
        return _sampled_row(point, quantity, sampled, value, value)
    if sampled.epsilon is not None:
        expectation = theory.shell_expectation(scene, event, sampled.epsilon)
        return _sampled_row(point, quantity, sampled, value, expectation)
    # By symmetry, 4 times the sum over two shells, which overlap.
    walls = {wall: point.quantities[f"{wall}_area"] for wall in ("right_wall", "top_wall")}
    hits, measures = zip(*((part.hits, 4 * part.measure) for part in walls.values()), strict=True)
    expectations = [
        4 * theory.shell_expectation(scene, wall, walls[wall].epsilon) for wall in walls
    ]
    probabilities = [e / m for e, m in zip(expectations, measures, strict=True)]
    score = scores.shells_z(hits, point.right_and_top, point.samples, measures, probabilities)
    return _sampled_row(point, quantity, sampled, value, sum(expectations), score)


def _sampled_score(point, quantity, sampled, expectation):
    """Return (z, test) of a quantity of a point against its exact ``expectation``."""

    estimate = sampled.estimate
    if expectation is None:
        return None, None
    if point.method != "insertion":
        probability = min(expectation / point.quantities[quantity].measure, 1.0)
        return scores.binomial_z(sampled.hits, point.samples, probability)
    if expectation == 0:
        z, test = scores.impossible_z(0 if estimate is None else 1)
        return abs(z), test
    if sampled.enough < scores.NORMAL_EVENTS:
        return None, None
    t = (estimate.value - expectation) / estimate.stderr
    return scores.student_deviate(t, estimate.n - 1), "normal"


def _sampled_row(point, quantity, sampled, exact, expectation, score=None):
    """Return the row of a quantity of a point, whose counts are ``sampled``."""

    estimate = sampled.estimate
    z, test = score or _sampled_score(point, quantity, sampled, expectation)
    if exact == 0:
        status = "impossible"
    elif estimate is None:
        status = "none-seen"
    else:
        status = "too-few" if why_no_error(sampled.enough, "hits") else "sampled"
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


# Molecular dynamics -------------------------------------------------------------------------------


class MeanTimesTable(Table):
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
    def rows(points, without_strips=False):
        """Return the rows of dynamics points, for the events that they counted.

        A rare hop has the row of its strip. The rows ``without_strips`` are those of rare hops
        alone, with their counts from all initial states.
        """
        return [
            _mean_time_row(p, event, p.everywhere(event) if without_strips else p.count(event))
            for p in select_stage(points, "dynamics")
            for event in p.counted
            if event in p.strips or not without_strips
        ]


def _mean_time_row(point, event, count):
    """Return the row of an event of a ``point`` from a ``Count`` of it."""

    scene, exact = point.scene, theory.mean_times(point.scene)[event]
    target, copies = point.target[event], scene.copies(event)
    estimate, bound = count.estimate(copies), None
    if target is None or (count.share == 1 and event in point.strips):
        status = "counted"
    else:
        status = "reached" if estimate and estimate.relative_stderr <= target else "budget"
    z, test = scores.mean_time_z(*count.sums, count.time(copies), exact, count.mean)
    if not scene.is_possible(event):
        z, test = scores.impossible_z(count.count)
        estimate, status = None, "impossible"
    elif estimate is None:
        status, bound = "none-seen", count.bound()
    elif not is_enough(*count.sums, exact and count.time(copies) / exact):
        status = "too-few"
    if count.share == 1 and scene.is_possible(event):
        errors = [target or 1.0, estimate.relative_stderr if estimate else 1.0]
        if count.replicas < theory.replicas_needed(scene, event, min(errors)):
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


def shortfall(rows, budget, events=None, seconds=None, ends="ended", what="events"):
    """Return a sentence on the largest error that was not reached, None if all were.

    ``rows`` are of mean_times.csv, or have its event, target, relative_stderr and status, or those
    of a quantity. The run had a number of ``events`` (or ``what`` else) within its ``budget``, None
    for a day, and took some ``seconds``.
    """
    missed = [
        row
        for row in rows
        if row["target"]
        and (
            row["status"] == "budget"
            or (row["status"] in ("too-few", "none-seen") and row["target"] < COARSE_ERROR)
        )
    ]
    if not missed:
        return None
    worst = max(missed, key=lambda row: (row["relative_stderr"] or math.inf) / row["target"])
    limit = f"budget of {format_number(budget, '.3g')} {what}" if budget else "limit of a day"
    more = ((worst["relative_stderr"] or math.inf) / worst["target"]) ** 2
    asked = format_number(worst["target"], "g")
    text = f"You asked for an error of {asked}, but the {limit} {ends} the run "
    if not math.isfinite(more):
        replicas = worst.get("replicas", LEAST_EVENTS)
        if events and (why := why_no_error(replicas, "replicas")):
            # Half more, because replicas come in whole blocks.
            enough = 1.5 * LEAST_EVENTS / replicas * events
            return f"{text}after {why}. A budget of {round_up(enough)} is enough."
        seen = f"events {worst['event']}" if "event" in worst else f"hits for {worst['quantity']}"
        if "replicas" in worst and events and events < (budget or math.inf) / 2:
            # Rough discs near a threshold need initial states for the error that they reach, and a
            # run to a larger one ends before it has them.
            return (
                f"You asked for an error of {asked}, but the run of {round_up(events)} {what} has "
                f"too few {seen} for an error. A smaller error or a larger budget gives more."
            )
        return f"{text}with too few {seen} for an error."
    text = f"{text}at {round_up(worst['relative_stderr'])} ({row_quantity(worst)})."
    if not events:
        return text
    # Other components may not use their shares of a budget. An error has an error: a fifth more.
    enough = 1.2 * max(events, budget or 0) * more
    text += f" A budget of {round_up(enough)} is enough"
    return f"{text}; it takes {format_seconds(seconds * more)}." if seconds else f"{text}."


class HopHistogramTable(Table):
    """One row per radius and bin: intervals between hops, from one crossing to the next."""

    columns = {
        "radius": RADIUS,
        "event": TEXT("the hop"),
        "bins": TEXT(
            "equal: bins about as wide as τ/16; wide: the same intervals in bins that widen with "
            "time; own: bins with given edges"
        ),
        "left": TIME("lower edge of the bin"),
        "right": TIME("upper edge of the bin"),
        "count": COUNT("intervals in the bin"),
        "density": RATE("count/(intervals × width of the bin)"),
        "stderr": RATE(
            "its standard error from the spread between independent chains; a chain has 256 "
            "successive intervals or, for more than two discs, all that begin within a window of "
            "time; empty for an empty bin"
        ),
        "intervals": COUNT("number of all intervals, including those beyond the last bin"),
        "exact_mean": TIME("exact mean interval, empty if none is known"),
        "mean": TIME("mean of all intervals"),
        "mean_stderr": TIME(
            "its standard error from the spread between independent chains; empty below 100"
        ),
        "z": Z,
    }

    @staticmethod
    def rows(points):
        """Return the rows of intervals points.

        The mean is tested by Student's t over the chains, if there are 100 of them. A chain has 256
        intervals or more.
        """
        rows = []
        for point in select_stage(points, "intervals"):
            mean = _mean_interval(point)
            start = {"radius": point.radius, "event": point.event}
            for each in point.bins():
                density = {"density": each.density.value, "stderr": each.density.stderr or None}
                rows.append(start | each._asdict() | density | mean)
        return rows


def _mean_interval(point):
    """Return the columns about the mean of a point; its exact mean may be None."""

    z, exact = None, theory.mean_times(point.scene)[point.event]
    stderr = None if why_no_error(point.chains, "chains") else point.stderr or None
    if stderr and exact is not None:
        z = scores.student_deviate((point.mean - exact) / stderr, point.chains - 1)
    known = {"intervals": point.intervals, "exact_mean": exact}
    return known | {"mean": point.mean, "mean_stderr": stderr, "z": z}


def trajectory_columns(discs):
    """Return the columns for a number of ``discs``."""
    numbers = range(1, discs + 1)
    return {
        "time": TIME("time of the event"),
        **{
            f"{axis}{disc}": LENGTH(f"disc {disc}, from the centre of the box")
            for disc in numbers
            for axis in "xy"
        },
        "event": TEXT("name of the event; a wall hit has the axis of the wall and the disc"),
        **{f"z{disc}": LENGTH(f"ball {disc}; empty in the plane") for disc in numbers},
        "first": COUNT(
            "the disc of the event, or the first of two; empty if the event has no disc"
        ),
        "second": COUNT("the second of the two discs of the event; empty if there is none"),
    }


class TrajectoryTable(Table):
    """
    One row per event of one trajectory, in order: the centres of all discs at the event. Along
    periodic axes centres go on beyond the cell.
    """

    columns = trajectory_columns(2)

    @classmethod
    def present_columns(cls, names):
        """Return the columns; their ``names`` say how many discs there are."""
        discs = sum(name[0] == "x" and name[1:].isdigit() for name in names)
        return trajectory_columns(max(discs, 2))

    @staticmethod
    def rows(box, radius, seed):
        """Return the events of one trajectory in a ``Box``, in order."""
        from twodiscs.dynamics.paths import follow_trajectory  # which compiles
        from twodiscs.sampling.initial_states import components

        scene, rows = box.scene(radius), []
        parts, columns = components(scene), trajectory_columns(scene.discs)
        for time, event, first, second, state in follow_trajectory(scene, seed).events():
            known = dict(zip(parts, state, strict=True))
            known |= {"time": time, "event": event, "first": first, "second": second}
            rows.append({name: known.get(name) for name in columns})
        return rows


# Checks and cost ----------------------------------------------------------------------------------


class CheckTable(Table):
    """One row per comparison with the exact theory."""

    columns = {
        "comparison": TEXT(
            "volume, area, mean_time, hop_interval, sum_rule, and over all radii z_mean and "
            "z_spread; if no exact mean time is known flux, the time of dynamics over the time of "
            "Monte Carlo"
        ),
        "quantity": TEXT("the quantity that is compared"),
        "radius": LENGTH("radius of the discs; empty for a statement on all radii"),
        "method": TEXT(
            "monte_carlo, conditioned, insertion, dynamics, strip (starts next to a rare hop) or "
            "intervals"
        ),
        "exact": SEE_QUANTITY("exact value; for an area, the shell's expectation"),
        "estimate": SEE_QUANTITY("estimate; empty where there is none"),
        "stderr": SEE_QUANTITY("its standard error; empty where there is none"),
        "z": Z,
        "p": NUMBER("probability of a |z| as large, or larger, if all is right"),
        "bound": NUMBER("largest |z| that passes"),
        "passed": TRUTH("whether |z| ≤ bound; empty where nothing can be compared"),
        "independent": TRUTH(
            "whether the row is a test, which could fail and follows from no other row: false for "
            "certain results, for counts that are sums of other counts (any_wall of right_wall "
            "and top_wall), for values computed from other rows (any_wall_area of two shells, the "
            "sum rule) and for z_mean and z_spread"
        ),
        "status": TEXT("status of the estimate in its own table"),
        "test": TEST,
    }

    @staticmethod
    def rows(points, events=EVENTS):
        """Return the comparisons of all ``points`` of a scene, with verdicts (see ``check``).

        Areas are those of the ``events``.
        """
        compared = check.comparisons(
            VolumeTable.rows(points),
            AreasTable.rows(points, events),
            MeanTimesTable.rows(points) + MeanTimesTable.rows(points, without_strips=True),
            HopHistogramTable.rows(points),
            points,
        )
        return check.check_rows(compared)


class CostTable(Table):
    """One row per job: its time and work. It is the only table of a scene that no run repeats."""

    columns = {
        "stage": TEXT("monte_carlo, dynamics or intervals"),
        "radius": RADIUS,
        "events": COUNT("events simulated, configurations or intervals drawn"),
        "seconds": SECONDS(
            "processor time of the work of the job and of its shards; empty if it is not known"
        ),
    }

    @staticmethod
    def rows(points, seconds):
        """Return the rows of the jobs of ``points`` by stage and radius.

        ``seconds`` is {(stage, radius): time}, as far as known.
        """
        return [
            {
                "stage": point.stage,
                "radius": point.radius,
                "events": point.work,
                "seconds": seconds.get((point.stage, point.radius)),
            }
            for point in sorted(points, key=lambda point: (point.stage, point.radius))
        ]


# All tables ---------------------------------------------------------------------------------------


#: {name: table}
SCENE_TABLES = {
    table.name(): table
    for table in (
        GridTable,
        TheoryTable,
        VolumeTable,
        AreasTable,
        MeanTimesTable,
        HopHistogramTable,
        CheckTable,
        CostTable,
        TrajectoryTable,
    )
}
