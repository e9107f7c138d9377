"""The check of a scene: comparisons of estimates with the exact theory, and their verdicts.

Each row compares one estimate with the exact theory. `z` is the deviation in standard errors. If
a normal law would not be right, `z` is the standard normal deviate with the same two-sided
probability `p`. A row has `passed` when |z| ≤ `bound`.

The bounds are Bonferroni's. If everything is right, a scene fails with a probability of one in a
thousand at most. Half of it is divided equally among all comparisons at a radius, half among the
statements on all radii. `z_mean` tests whether the scores of one quantity, by one method, have the
mean 0 (√n times their mean). `z_spread` tests whether their variance is 1 (their sum of squares, a
χ² of n degrees): it finds errors that are too small or too large. Both take the scores whose `test`
is `normal`, and are exact for any number of them. Tests of discrete laws are conservative by
design: their scores would look too narrow.

A row without an error bar has the reason in `status`. It is still compared if a bound holds: a
count of 0 fails if hits were expected. If nothing can be compared, `passed` is empty.

If no exact value is known, as in most scenes of more than two discs, nothing is compared with it.
`flux` then compares a mean time of dynamics with the time that follows from volume and area by
Monte Carlo: their ratio is 1. `sum_rule`, the virial theorem, is another test, for any number of
discs between walls.

A row is `independent`, a test, if it could fail and follows from no other row. It is not
independent if its event is certain or impossible, or if it is about the scores of other rows. The
same holds if its count is the sum of other rows' counts in every replica, or if its area or sum
rule is computed from other rows. Tests of one method at one radius have the same samples or
trajectories, so their scores are correlated.
"""

import math
from itertools import groupby

from twodiscs.analysis import scores
from twodiscs.model.events import EVENT_WAYS
from twodiscs.points.estimates import Estimate, sums_of_others, why_no_error
from twodiscs.points.monte_carlo_point import wall_weights
from twodiscs.theory import virial
from twodiscs.theory.exact import replicas_needed
from twodiscs.theory.flux import flux_constant

SUM_RULE_EVENTS = ("disc_collision", "right_wall", "top_wall")

#: Columns that are copied from the values of a comparison.
COPIED_COLUMNS = ("radius", "exact", "estimate", "stderr", "z", "status", "test")


def _comparison(name, quantity, method, values, derived=False):
    """Return a row of check.csv, without a verdict; ``values`` has the columns ``COPIED_COLUMNS``.

    It is ``derived`` if it follows from other rows.
    """
    z = values["z"]
    return {taken: values[taken] for taken in COPIED_COLUMNS} | {
        "comparison": name,
        "quantity": quantity,
        "method": method,
        "p": None if z is None else scores.two_sided_p(z),
        "bound": None,
        "passed": None,
        "independent": z is not None and values["test"] != "certain" and not derived,
    }


def _normal_values(radius, exact, estimate, stderr, z):
    """Return the values of a comparison by a normal law; ``z`` is None without an error bar."""
    status, test = ("too-few", None) if z is None else ("counted", "normal")
    return _values(radius, exact, estimate, stderr, z, status, test)


def _values(*values):
    """Return the ``values`` of a comparison by the names ``COPIED_COLUMNS``."""
    return dict(zip(COPIED_COLUMNS, values, strict=True))


def sum_rule(point):
    """Return the estimate of the sum of virials over 2⟨K⟩, which is 1 (see ``theory.virial``).

    The rates are averages over all replicas of a dynamics ``point``, whether they can reach a wall
    or not. A wall's rate has the hits of all walls and discs that are equal by symmetry.
    """
    scene = point.scene
    rates = {
        e: scene.accessible_fraction(e) / scene.copies(e) / point.duration for e in SUM_RULE_EVENTS
    }
    return point.combination({e: w * rates[e] for e, w in virial.weights(scene).items()})


def _sum_rule(point):
    """Return the comparison of the sum rule for one dynamics point."""
    rule, scene, replicas = sum_rule(point), point.scene, point.replicas
    stderr = z = None
    enough = min(point.counts[event] for event in SUM_RULE_EVENTS) >= scores.NORMAL_EVENTS
    enough = enough and not why_no_error(replicas, "replicas")
    # A run of rough discs may have missed the initial states with very many events.
    if enough and all(replicas >= replicas_needed(scene, e, rule.stderr) for e in SUM_RULE_EVENTS):
        stderr = rule.stderr
        z = scores.student_deviate((rule.value - 1) / stderr, replicas - 1)
    values = _normal_values(scene.radius, 1.0, rule.value, stderr, z)
    return _comparison("sum_rule", "mean_times", "dynamics", values, derived=True)


def flux_time(event, point):
    """Return the mean time between events that follows from volume and area of a point.

    It is an ``Estimate`` from a point of insertions: the rate is c_D/2 × area/volume from each side
    of the surface, see ``theory``. It is None if the error is not known or the point lacks one.
    """
    scene = point.scene
    weights = wall_weights(scene) if event == "any_wall" else {f"{event}_area": 1.0}
    if not weights.keys() <= point.quantities.keys():
        return None
    ratio = point.ratio(weights)
    if ratio is None:
        return None
    rate = EVENT_WAYS[event] / 2 * flux_constant(scene.velocity_components) * ratio.value
    return Estimate(1 / rate, ratio.relative_stderr / rate, ratio.n)


def _flux(row, point, derived):
    """Return the comparison of a mean time of dynamics with volume and area by Monte Carlo.

    ``row`` is the row of the time in mean_times.csv, ``point`` a point of insertions.
    """
    sampled = flux_time(row["event"], point)
    ratio = stderr = z = None
    if sampled is not None and row["stderr"] is not None:
        ratio = row["estimate"] / sampled.value
        relative = row["relative_stderr"], sampled.relative_stderr
        stderr = ratio * math.hypot(*relative)
        if max(relative) ** 2 * scores.NORMAL_EVENTS <= 1:
            z = (ratio - 1) / stderr
    values = _normal_values(point.radius, 1.0, ratio, stderr, z)
    return _comparison("flux", f"{row['event']}_time", "dynamics", values, derived)


def comparisons(volume, areas, times, histogram, points):
    """Return a comparison for every estimate at a radius, without verdicts.

    ``volume``, ``areas``, ``times`` and ``histogram`` are rows of the tables. The ``points`` of
    dynamics name the counts that are sums of others. They also give the sum rule of virials, if its
    three events were counted. If no exact mean time is known, volume and area in the points of
    Monte Carlo give the time to compare with.
    """
    rows, dynamics = [], [point for point in points if point.stage == "dynamics"]
    for name, table in (("volume", volume), ("area", areas)):
        for row in table:
            values = {**row, "exact": row["expectation"]}
            joined = row["quantity"] == "any_wall_area" and row["epsilon"] is None  # two shells
            rows.append(_comparison(name, row["quantity"], row["method"], values, joined))
    summed = {
        (point.radius, event)
        for point in dynamics
        for event in sums_of_others(point.counts, point.products, point.replicas)
    }
    inserted = {p.radius: p for p in points if getattr(p, "method", None) == "insertion"}
    for row in times:
        method = "dynamics" if row["starts"] == "invariant" else row["starts"]
        derived = method == "dynamics" and (row["radius"], row["event"]) in summed
        rows.append(_comparison("mean_time", f"{row['event']}_time", method, row, derived))
        unknown = row["exact"] is None and row["status"] != "impossible"
        if unknown and (point := inserted.get(row["radius"])):
            rows.append(_flux(row, point, derived))
    for (radius, event), bins in groupby(histogram, key=lambda row: (row["radius"], row["event"])):
        row = next(bins)
        mean = (row[name] for name in ("exact_mean", "mean", "mean_stderr", "z"))
        values = _normal_values(radius, *mean)
        if row["exact_mean"] is None:
            values["status"] = "counted"
        rows.append(_comparison("hop_interval", f"{event}_interval", "intervals", values))
    for point in dynamics:
        if set(SUM_RULE_EVENTS) <= set(point.counts) and virial.weights(point.scene):
            rows.append(_sum_rule(point))
    return sorted(rows, key=lambda row: row["radius"])


def distributions(rows):
    """Return, for each quantity and method, whether its scores over radii look standard normal.

    Each of them has two comparisons, ``z_mean`` and ``z_spread``. They take the scores that are
    normal, from two radii or more.
    """
    groups = {}
    for row in rows:
        if row["test"] == "normal":
            groups.setdefault((row["quantity"], row["method"]), []).append(row["z"])
    tests = []
    for (quantity, method), z in groups.items():
        n = len(z)
        if n > 1:
            mean, size = math.fsum(z) / n, math.sqrt(math.fsum(x * x for x in z) / n)
            mean = _values(None, 0.0, mean, 1 / math.sqrt(n), scores.z_mean(z), None, "normal")
            size = _values(None, 1.0, size, None, scores.z_spread(z), None, "chi-square")
            for name, values in (("z_mean", mean), ("z_spread", size)):
                tests.append(_comparison(name, quantity, method, values, derived=True))
    return tests


def judged(rows):
    """Return ``rows`` with verdicts, by Bonferroni's bound for half of ``FALSE_ALARM``."""
    tested = sum(row["z"] is not None for row in rows)
    bound = scores.bonferroni_bound(tested, scores.FALSE_ALARM / 2) if tested else None
    return [
        row if row["z"] is None else {**row, "bound": bound, "passed": abs(row["z"]) <= bound}
        for row in rows
    ]


def check_rows(rows):
    """Return the rows of check.csv: the comparisons ``rows`` and their distributions, judged.

    The probability that any of them fails although all is right is at most ``FALSE_ALARM``. Half of
    it is for the comparisons at a radius, half for the distributions.
    """
    return judged(rows) + judged(distributions(rows))
