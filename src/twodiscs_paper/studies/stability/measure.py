"""Measure numerically hard cases: theory, draws, times of events, runs, reversal, error bars.

All cases follow from the sides of a box, so the study can be repeated for another box. The hard
radii are a tiny radius, both sides of h/4 and w/4, where a hop becomes blocked, and some radii just
below the largest. Each function yields rows of stability.csv; all numbers follow from the seed.

References are computed with mpmath, from the same doubles that the methods take.
"""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
from mpmath import mp, mpf

from twodiscs.analysis import scores
from twodiscs.analysis.check import comparisons
from twodiscs.analysis.tables import AreasTable, MeanTimesTable, VolumeTable
from twodiscs.dynamics import runs
from twodiscs.dynamics.law import after_event, contact_quotient, two_disc_law, wall_quotient
from twodiscs.dynamics.two.follow import find_events, new_rows, put_state, state_at
from twodiscs.model.checks import LARGEST_INTEGER
from twodiscs.model.events import EVENTS, HOPS
from twodiscs.model.formats import shortest_decimal
from twodiscs.model.scene import Box, Scene
from twodiscs.sampling import montecarlo
from twodiscs.sampling.conditioned import conditioned_sampler
from twodiscs.sampling.initial_states import states
from twodiscs.sampling.jit import compiled
from twodiscs.theory import exact
from twodiscs_paper.reference import DIGITS, exact_numbers
from twodiscs_paper.studies.estimates import LinearFit, sample_mean
from twodiscs_paper.studies.single import advance
from twodiscs_paper.studies.stability.closed_form import closed_form
from twodiscs_paper.study import row

#: Spacing of doubles at 1.
EPSILON = 2.0**-52

#: Bounds for a pass: relative errors of exact numbers, accepted share of the proposals, errors of
#: predicted times in units of ``EPSILON`` × conditioning.
THEORY_BOUND, ACCEPTED_BOUND, TIME_BOUND = 1e-13, 0.2, 8.0

#: Bounds for a pass: |E − 1/2|; gap between the discs and excess beyond a centre's range, in units
#: of the rounding of the box (``box_units``).
ENERGY_BOUND, GAP_BOUND, EXCESS_BOUND = 1e-11, -1e-14, 1e-15

#: The largest |z| that passes.
LARGEST_Z = 5.0

#: The quantities of theory.
CHECKED_QUANTITIES = "volume", "areas", "mean_times"

#: Proposals for a measured share, and for an estimate of volume and areas.
SHARE_PROPOSALS, ESTIMATE_PROPOSALS = 2**18, 2**22

#: Thickness of the shells around surfaces, as in ``montecarlo.shell_thickness``.
SHELL = 0.02

#: Lanes of a run of many events, and events of each lane between two tests of whether it advances.
STATE_LANES, WINDOW_EVENTS = 64, 2**16

#: A lane that needs less than this fraction of the mean time for the events of a window is stuck.
STUCK = 0.01

#: The number of reversed trajectories, and the error of return up to which they retrace their path:
#: half of the digits are then lost.
REVERSED_PATHS, RETURN_ERROR = 4000, 2.0**-26

#: Lengths of reversed paths over the predicted one. From ``FIT_SHARE`` to 1 the error of return is
#: far above a rounding and far below the size of the box, and grows like an exponential.
SHARES, FIT_SHARE = tuple(i / 10 for i in range(1, 13)), 0.4

#: The initial error may be five binary digits larger or smaller than one rounding.
ROUNDINGS = 2.0**5

#: Size of the separation whose growth is measured: its square is a rounding. Events before its
#: growth is measured, and events of a pilot measurement, which sets the length of the paths.
SEPARATION, FORGOTTEN_EVENTS, PILOT_EVENTS = 1e-8, 100, 200


def judged(start, quantity, value, low=None, high=None, z=None, **cells):
    """Return a row of stability.csv on a measured ``value``, and whether it passes.

    It passes if it is within ``low`` and ``high`` and |z| ≤ 5, as far as these are given. Without
    any of them, or without a value, ``passed`` is empty; but a bound may have a z without a value.
    """
    passed = None
    if (value is not None or z) and any(bound is not None for bound in (low, high, z)):
        passed = (
            (low is None or value >= low)
            and (high is None or value <= high)
            and (z is None or abs(z) <= LARGEST_Z)
        )
    bounds = {"low": low, "high": high, "z": z, "passed": passed}
    return row(start | bounds, quantity=quantity, value=value, **cells)


def radius_cells(part, case, radius=None, distance=None):
    """Return the cells that rows on one radius have in common."""
    return {"part": part, "case": case, "radius": radius, "distance": distance}


def other_seed(seed, i):
    """Return the ``i``-th seed after ``seed``, for independent measurements."""
    return (seed + i) % (LARGEST_INTEGER + 1)


# Radii ------------------------------------------------------------------------------------------


def limits(box):
    """Return {name: radius} of the limits of a plain ``Box``: "h/4", "w/4", "largest radius".

    A threshold is left out if discs do not fit there; if both hops end at the same radius, its name
    is "h/4".
    """
    names = {box.threshold(hop): name for hop, name in zip(HOPS, ("w/4", "h/4"), strict=True)}
    by_name = {names[radius]: radius for radius in box.thresholds}
    return dict(sorted(by_name.items())) | {"largest radius": box.largest_radius}


def beside(box, distances):
    """Yield (name, distance, radius) for all ``limits`` and signed relative ``distances``.

    Radii that do not fit are left out.
    """
    for name, limit in limits(box).items():
        for distance in distances:
            radius = limit * (1 + distance)
            if box.fits(radius):
                yield name, distance, radius


def hard_radii(box):
    """Return a list of (name, distance, radius): an ordinary radius first, then the hard ones.

    ``distance`` is relative to the limit with this name, None if the name is not a limit.
    """
    short = box.shortest
    near = [
        case
        for case in beside(box, (-1e-3, -1e-6, -1e-9, 1e-9))
        if case[0] == "largest radius" or abs(case[1]) == 1e-9
    ]
    return [("ordinary", None, short / 5), ("tiny", None, short * 1e-9), *near]


def ordinary_radii(box):
    """Return ascending radii away from all limits.

    Three are below the first limit, where both hops are open, and one between further limits.

    For the box 1.5 × 1 they are 0.05, 0.2, 0.24, 0.3 and 0.38.
    """
    ends = sorted([0.0, *limits(box).values()])
    between = [(ends[0], ends[1], share) for share in (0.2, 0.8, 0.96)]
    between += [
        (*pair, share) for pair, share in zip(pairwise(ends[1:]), (0.4, 0.55), strict=False)
    ]
    radii = []
    for low, high, share in between:
        radius = low + share * (high - low)
        radii.append(shortest_decimal(radius, 0.1 * (high - low) * share))
    return radii


# Theory -----------------------------------------------------------------------------------------


def relative_error(values, true_values):
    """Return the largest |value/true − 1|, or ∞ if a value differs from a true 0 or None."""
    worst = 0.0
    with mp.workdps(DIGITS):
        for name, value in values.items():
            true = true_values.get(name)
            if not true:
                worst = max(worst, math.inf if value else 0.0)
            else:
                worst = max(worst, float(abs(mpf(value) - true) / abs(true)))
    return worst


def theory_rows(box):
    """Yield the errors of the exact numbers and of the closed forms near every limit."""
    distances = [10.0**-k for k in range(1, 15)]
    for case, distance, radius in beside(box, [-d for d in distances] + distances):
        if case == "largest radius" and abs(distance) < 1e-12:
            continue
        scene = box.scene(radius)
        true = exact_numbers(scene)
        stable = {"volume": exact.volume(scene)}, exact.areas(scene), exact.mean_times(scene)
        closed = closed_form(scene)
        plain = {"volume": closed["volume"]}, closed["areas"]
        start = radius_cells("theory", case, radius, distance)
        for quantity, values, due in zip(CHECKED_QUANTITIES, stable, true, strict=True):
            error = relative_error(values, due)
            yield judged(start, quantity, error, high=THEORY_BOUND, method="stable")
        for quantity, values, due in zip(CHECKED_QUANTITIES, plain, true, strict=False):
            yield judged(start, quantity, relative_error(values, due), method="closed-form")


# Sampling ---------------------------------------------------------------------------------------


def conditioned_point(scene, quantities, proposals, seed):
    """Return a point of this number of conditioned draws, whole blocks."""
    sampler = montecarlo.conditioned(scene, quantities, SHELL, seed)
    blocks = proposals // sampler.block
    return sampler.point({(0, blocks): [sampler.count(0, blocks)]})


def sampling_rows(box, seed):
    """Yield the accepted shares of rejection from the prism and of the conditioned draws."""
    radii = [("ordinary", None, radius) for radius in ordinary_radii(box)]
    radii += hard_radii(box)[1:2]
    radii += beside(box, [-(10.0**-k) for k in range(1, 13)])
    for i, (case, distance, radius) in enumerate(radii):
        scene = box.scene(radius)
        draw, volume = conditioned_sampler(scene), exact.volume(scene)
        prism = volume / (scene.range_x * scene.range_y) ** 2
        due = min(volume / 2 / draw.mass, 1.0)
        point = conditioned_point(scene, ["volume"], SHARE_PROPOSALS, other_seed(seed, i))
        hits, samples = point.quantities["volume"].hits, point.samples
        start = radius_cells("sampling", case, radius, distance)
        yield judged(start, "accepted_share", prism, method="prism")
        z, _ = scores.binomial_z(hits, samples, due)
        found = {"method": "conditioned", "count": samples, "exact": due}
        yield judged(start, "accepted_share", hits / samples, low=ACCEPTED_BOUND, z=z, **found)


def estimate_rows(box, seed):
    """Yield estimates of volume and areas at all radii, by conditioned draws."""
    radii = [("ordinary", None, radius) for radius in ordinary_radii(box)]
    radii += hard_radii(box)[1:]
    for i, (case, distance, radius) in enumerate(radii):
        scene = box.scene(radius)
        quantities = ["volume", *(f"{event}_area" for event in EVENTS)]
        point = conditioned_point(scene, quantities, ESTIMATE_PROPOSALS, other_seed(seed, i))
        start = radius_cells("estimates", case, radius, distance) | {"method": "conditioned"}
        for found in VolumeTable.rows([point]) + AreasTable.rows([point]):
            kept = {"stderr": found["stderr"], "z": found["z"], "status": found["status"]}
            kept |= {"count": found["samples"], "exact": found["expectation"]}
            yield judged(start, found["quantity"], found["estimate"], **kept)


# Times of events --------------------------------------------------------------------------------


def exact_contact(dx, dy, du, dv, sigma):
    """Return (time to contact, its conditioning) to 50 digits, or (None, None) without a contact.

    The conditioning is Σ |p ∂t/∂p| over the five inputs p: the change of the time, to first order,
    if each input has a relative error of one.
    """
    with mp.workdps(50):
        dx, dy, du, dv, sigma = map(mpf, (dx, dy, du, dv, sigma))
        a, b, c = du**2 + dv**2, dx * du + dy * dv, dx**2 + dy**2 - sigma**2
        discriminant = b**2 - a * c
        if b >= 0 or discriminant <= 0:
            return None, None
        root = mp.sqrt(discriminant)
        time = c / (root - b)
        along_x, along_y = dx + du * time, dy + dv * time
        slopes = dx * along_x, dy * along_y, du * time * along_x, dv * time * along_y, sigma**2
        return time, sum(map(abs, slopes)) / root


def textbook_quotient(dx, dy, _dz, du, dv, _dw, sigma):
    """Return (gap, speed, whether the discs approach) by the textbook: (−b − √(b² − ac))/a."""
    a, b, c = du * du + dv * dv, dx * du + dy * dv, dx * dx + dy * dy - sigma * sigma
    discriminant = b * b - a * c
    return -b - math.sqrt(discriminant) if discriminant > 0 else math.nan, a, b < 0


def contact_error(dx, dy, du, dv, sigma, quotient=contact_quotient):
    """Return the error of the predicted time to contact over ``EPSILON`` × conditioning.

    It is None if roundings of the inputs decide between hit and miss. It is infinite if a contact
    is missed, or predicted without a contact. The ``quotient`` predicts it.
    """
    gap, speed, approach = quotient(dx, dy, None, du, dv, None, sigma)
    impact, graze = abs(dx * dv - dy * du), sigma * math.hypot(du, dv)
    if abs(impact - graze) <= 8 * EPSILON * (abs(dx * dv) + abs(dy * du) + graze):
        return None
    true, conditioning = exact_contact(dx, dy, du, dv, sigma)
    hit = bool(approach and speed > 0 and not math.isnan(gap))
    if true is None or not hit:
        return 0.0 if hit == (true is not None) else math.inf
    return float(abs(mpf(max(gap / speed, 0.0)) - true) / (EPSILON * conditioning))


def wall_error(position, velocity, limit):
    """Return the relative error of the predicted time to a wall over ``EPSILON``."""
    gap, speed = wall_quotient(position, velocity, limit)
    with mp.workdps(50):
        true = (mpf(math.copysign(limit, velocity)) - mpf(position)) / mpf(velocity)
        return float(abs(mpf(gap) / mpf(speed) - true) / (EPSILON * true))


def approaches(sigma, generator, cases):
    """Return {name: list of (dx, dy, du, dv)} of discs whose contact is hard to predict."""

    def draw(distance, impact, speed=(-3, 0)):
        """Draw discs at ``distance`` (σ) whose closest approach is ``impact`` (σ)."""
        angle = generator.uniform(0, 2 * math.pi, cases)
        fast = 10 ** generator.uniform(*speed, cases)
        along = np.sqrt(distance**2 - impact**2)
        c, s = np.cos(angle), np.sin(angle)
        columns = (
            -sigma * (along * c + impact * s),
            sigma * (impact * c - along * s),
            fast * c,
            fast * s,
        )
        return [tuple(map(float, state)) for state in zip(*columns, strict=True)]

    def power(low, high):
        return 10 ** generator.uniform(low, high, cases)

    anywhere = generator.uniform(-0.9, 0.9, cases)
    return {
        "from anywhere": draw(1 + power(-3, 1), anywhere),
        "head-on": draw(1 + power(-3, 1), 0.0 * anywhere),
        "grazing": draw(1 + power(-1, 1), 1 - power(-15, -2)),
        "almost in contact": draw(1 + power(-15, -8), anywhere),
        "almost at relative rest": draw(1 + power(-3, 1), anywhere, speed=(-12, -6)),
        "from very far": draw(power(3, 9), anywhere),
    }


def time_rows(box, seed, cases=400):
    """Yield the worst errors of predicted contacts and wall hits."""
    generator = np.random.default_rng(seed)
    radius = ordinary_radii(box)[1]
    for case, flights in approaches(2 * radius, generator, cases).items():
        start = radius_cells("times", case)
        for method, quotient, bound in (
            ("stable", contact_quotient, TIME_BOUND),
            ("textbook", textbook_quotient, None),
        ):
            errors = [contact_error(*state, 2 * radius, quotient) for state in flights]
            known = [error for error in errors if error is not None]
            # A contact that the textbook misses has no time, and does not count.
            times = [error for error in known if bound or math.isfinite(error)]
            cells = {"high": bound, "method": method, "count": len(times)}
            yield judged(start, "contact_time", max(times), **cells)

    half = box.width / 2 - radius
    for case, powers in (("from anywhere", (-12, 0)), ("velocity almost 0", (-323, -307))):
        positions = half * generator.uniform(-1, 1, cases)
        velocities = generator.choice([-1, 1], cases) * 10 ** generator.uniform(*powers, cases)
        errors = [
            wall_error(float(position), float(velocity), half)
            for position, velocity in zip(positions, velocities, strict=True)
        ]
        cells = {"high": TIME_BOUND, "method": "stable", "count": cases}
        yield judged(radius_cells("times", case), "wall_time", max(errors), **cells)


# Long runs --------------------------------------------------------------------------------------


@compiled
def audit(starts, windows, window, law, shortest):
    """Run the lanes that begin at ``starts`` (8, lanes) for ``windows`` × ``window`` events each.

    Returns for each lane, over the states after its events: the smallest |Δx|², the largest
    |2E − 1|, the largest |x| and |y| of a centre, and whether the lane is lost. A lane is lost if
    it is not finite, or if the events of a window take less than the time ``shortest``.
    """
    lanes = starts.shape[1]
    rows = new_rows(lanes, law)
    for i in range(lanes):
        put_state(rows, i, starts[:, i], law)
    times, codes, elapsed = np.zeros(lanes), np.zeros(lanes), np.zeros(lanes)
    endless, nearest, energy = np.full(lanes, np.inf), np.full(lanes, np.inf), np.zeros(lanes)
    far_x, far_y = np.zeros(lanes), np.zeros(lanes)
    lost = np.zeros(lanes, np.bool_)
    for _ in range(windows):
        elapsed[:] = 0.0
        for _ in range(window):
            find_events(rows, endless, times, codes, law)
            for i in range(lanes):
                elapsed[i] += times[i]
                state = after_event(state_at(rows, i, law), times[i], codes[i], law)
                put_state(rows, i, state, law)
                x, y, z, w, p, q, r, s = state
                square = (x - z) * (x - z) + (y - w) * (y - w)
                nearest[i] = min(nearest[i], square)
                energy[i] = max(energy[i], abs(p * p + q * q + r * r + s * s - 1.0))
                far_x[i] = max(far_x[i], abs(x), abs(z))
                far_y[i] = max(far_y[i], abs(y), abs(w))
        for i in range(lanes):
            total = elapsed[i]
            for component in state_at(rows, i, law):
                total += component
            lost[i] |= not (np.isfinite(total) and elapsed[i] >= shortest)
    return nearest, energy, far_x, far_y, lost


def box_units(scene):
    """Return the powers of two at or below width and height, the scale of rounding in the box."""
    return tuple(2.0 ** (math.frexp(side)[1] - 1) for side in (scene.width, scene.height))


def run(scene, number, seed):
    """Simulate at least ``number`` events and return a dict of their number and the errors.

    Keys: events; energy_error, the largest |E − 1/2|; smallest_gap, the smallest |Δx| − σ, and
    excess, the largest distance of a centre beyond its range, both in ``box_units``; lanes_lost.
    """
    per_lane = -(-number // STATE_LANES)
    windows = -(-per_lane // WINDOW_EVENTS)
    window = -(-per_lane // windows)
    law = two_disc_law(scene)
    nearest, energy, far_x, far_y, lost = audit(
        states(scene, STATE_LANES, seed), windows, window, law,
        STUCK * window / exact.event_rate(scene),
    )  # fmt: skip
    unit_x, unit_y = box_units(scene)
    excess = max(
        (float(far_x.max()) - law.half_x1) / unit_x, (float(far_y.max()) - law.half_y1) / unit_y
    )
    return {
        "events": windows * window * STATE_LANES,
        "energy_error": float(energy.max()) / 2,
        "smallest_gap": (math.sqrt(nearest.min()) - law.sigma) / max(unit_x, unit_y),
        "excess": excess,
        "lanes_lost": int(np.count_nonzero(lost)),
    }


def dynamics_rows(box, seed, ordinary, hard):
    """Yield the errors in runs of ``ordinary`` events, and of ``hard`` events at hard radii."""
    bounds = {
        "energy_error": {"high": ENERGY_BOUND},
        "smallest_gap": {"low": GAP_BOUND},
        "excess": {"high": EXCESS_BOUND},
        "lanes_lost": {"high": 0.0},
    }
    for i, (case, distance, radius) in enumerate(hard_radii(box)):
        number = ordinary if case == "ordinary" else hard
        found = run(box.scene(radius), number, other_seed(seed, i))
        start = radius_cells("dynamics", case, radius, distance) | {"count": found["events"]}
        for quantity, bound in bounds.items():
            yield judged(start, quantity, float(found[quantity]), **bound)


# Extreme scenes ---------------------------------------------------------------------------------

PAPER_SCENE = Scene(1.5, 1.0, 0.2)


def _hardly_fitting(width, height, distance, discs=2, **effects):
    """Return a scene at the relative ``distance`` below its largest radius."""
    box = Box(width, height, discs=discs, **effects)
    return box.scene(box.largest_radius * (1 - distance))


#: Scenes for a sceptic: each effect at its extremes, discs that hardly fit, very long boxes.
EXTREMES = {
    "1e6 by 1e-6": Scene(1e6, 1e-6, 2e-7),
    "1e-6 by 1e6": Scene(1e-6, 1e6, 2e-7),
    "mass ratio 1e3": replace(PAPER_SCENE, radius_ratio=0.5, mass_ratio=1e3),
    "mass ratio 1e-3": replace(PAPER_SCENE, radius_ratio=0.5, mass_ratio=1e-3),
    "radius ratio 1e3": replace(PAPER_SCENE, radius=2e-4, radius_ratio=1e3, mass_ratio=2.0),
    "radius ratio 1e-3": replace(PAPER_SCENE, radius_ratio=1e-3, mass_ratio=2.0),
    "inertia 1e-3": replace(PAPER_SCENE, moment_of_inertia=1e-3),
    "inertia 1": replace(PAPER_SCENE, moment_of_inertia=1.0),
    "friction 1e-6": replace(PAPER_SCENE, friction=1e-6),
    "friction 1e4": replace(PAPER_SCENE, friction=1e4),
    "field 1e-9": replace(PAPER_SCENE, field=1e-9),
    "field 5": replace(PAPER_SCENE, field=5.0),
    "depth 1e6": replace(PAPER_SCENE, depth=1e6),
    "depth 2r(1 + 1e-4)": replace(PAPER_SCENE, depth=0.4 * (1 + 1e-4)),
    "torus, hardly fits": _hardly_fitting(1.5, 1.0, 1e-2, periodic="xy"),
    "3 discs, hardly fit": _hardly_fitting(1.5, 1.0, 1e-6, discs=3),
    "16 discs, hardly fit": _hardly_fitting(4.0, 4.0, 2e-2, discs=16),
    "16 discs in a channel": Scene(9.92, 0.6, 0.29, discs=16),
}

#: The relative error asked for in them, and the events: most kicks of strong friction are no event.
EXTREME_ERROR, EXTREME_EVENTS, KICKED = 1e-2, 2 * 10**6, {"friction 1e4": 10**8}


def extreme_rows(seed, scenes=EXTREMES):
    """Yield the mean times in extreme ``scenes``, and the sum rule of virials, by dynamics.

    A count without a normal law is tested by a bound. If the bound says nothing, z is empty.
    """
    for i, (case, scene) in enumerate(scenes.items()):
        events = KICKED.get(case, EXTREME_EVENTS)
        target = dict.fromkeys(scene.events, EXTREME_ERROR)
        point = runs.DynamicsRun(scene, target, events, other_seed(seed, i)).run()
        times = MeanTimesTable.rows([point])
        start = radius_cells(
            "extremes", case, scene.radius, scene.radius / scene.largest_radius - 1
        )
        for found in comparisons([], [], times, [], [point]):
            if found["test"] == "certain":
                continue
            z = found["z"] if found["test"] == "normal" else found["z"] or None
            kept = {name: found[name] for name in ("exact", "stderr", "status", "method")}
            quantity = "virial" if found["comparison"] == "sum_rule" else found["quantity"]
            yield judged(start, quantity, found["estimate"], z=z, count=point.events, **kept)


# Reversal ---------------------------------------------------------------------------------------


@compiled
def separation(state, other, law):
    """Return the distance of two states: positions over the half-ranges, velocities as they are."""
    dx1, dy1, dx2, dy2, du1, dv1, du2, dv2 = (
        state[0] - other[0], state[1] - other[1], state[2] - other[2], state[3] - other[3],
        state[4] - other[4], state[5] - other[5], state[6] - other[6], state[7] - other[7],
    )  # fmt: skip
    x = (dx1 * dx1 + dx2 * dx2) / (law.half_x1 * law.half_x1)
    y = (dy1 * dy1 + dy2 * dy2) / (law.half_y1 * law.half_y1)
    return math.sqrt(x + y + du1 * du1 + dv1 * dv1 + du2 * du2 + dv2 * dv2)


@compiled
def turned_back(state):
    """Return the state with all velocities reversed."""
    x1, y1, x2, y2, u1, v1, u2, v2 = state
    return x1, y1, x2, y2, -u1, -v1, -u2, -v2


@compiled
def return_errors(starts, number, law):
    """Follow each start for ``number`` events, reverse it, follow it back and return its errors.

    The way back has the same number of events. The first of them is immediate, and the last one is
    followed by the flight that led to the first event of the way out.
    """
    errors = np.empty(starts.shape[1])
    for i in range(errors.size):
        start = state_at(starts, i, law)
        state, first, _ = advance(start, law)
        for _ in range(number - 1):
            state, _, _ = advance(state, law)
        state = turned_back(state)
        for _ in range(number):
            state, _, _ = advance(state, law)
        x1, y1, x2, y2, u1, v1, u2, v2 = state
        end = (
            x1 + u1 * first, y1 + v1 * first, x2 + u2 * first, y2 + v2 * first, u1, v1, u2, v2
        )  # fmt: skip
        errors[i] = separation(turned_back(end), start, law)
    return errors


@compiled
def growth(starts, forgotten, measured, small, law):
    """Return by which factor a ``small`` separation from each start grows, NaN if events differ.

    It grows for ``forgotten`` events first, which the factor leaves out, then for ``measured``
    events. After every event the neighbour is put back to the distance ``small``, along the line
    that joins the two (Benettin, Galgani and Strelcyn, Phys. Rev. A 14, 2338 (1976)). The two are
    compared after the same event; if their events differ, the factor is NaN.
    """
    factors = np.empty(starts.shape[1])
    for i in range(factors.size):
        state = state_at(starts, i, law)
        x1, y1, x2, y2, u1, v1, u2, v2 = state
        x, y = small * law.half_x1, small * law.half_y1
        other = (
            x1 - 0.3 * x, y1 + 0.4 * y, x2 + 0.2 * x, y2 - 0.3 * y,
            u1 + 0.5 * small, v1 - 0.4 * small, u2 - 0.3 * small, v2 + 0.4 * small,
        )  # fmt: skip
        factors[i] = 1.0
        for k in range(forgotten + measured):
            state, _, code = advance(state, law)
            other, _, same = advance(other, law)
            if code != same:
                factors[i] = np.nan
                break
            distance = separation(state, other, law)
            if k >= forgotten:
                factors[i] *= distance / small
            back = small / distance
            x1, y1, x2, y2, u1, v1, u2, v2 = state
            p1, q1, p2, q2, r1, s1, r2, s2 = other
            other = (
                x1 + (p1 - x1) * back, y1 + (q1 - y1) * back,
                x2 + (p2 - x2) * back, y2 + (q2 - y2) * back,
                u1 + (r1 - u1) * back, v1 + (s1 - v1) * back,
                u2 + (r2 - u2) * back, v2 + (s2 - v2) * back,
            )  # fmt: skip
    return factors


def reversal_rows(box, seed):
    """Yield how many events reversed velocities retrace, and how many the exponent predicts.

    Errors begin at a rounding, 2⁻⁵³, and grow like exp(λn) with the number n of events, where λ is
    the exponent per event. They reach ``RETURN_ERROR`` after ln(``RETURN_ERROR`` · 2⁵³)/λ events.
    The measured number passes if it corresponds to an initial error between 2⁻⁵³/``ROUNDINGS`` and
    ``ROUNDINGS`` · 2⁻⁵³. In a long box the upper bound is multiplied by the ratio of its sides.
    Errors of return are geometric means over ``REVERSED_PATHS`` independent trajectories. The
    exponent comes from the growth of a separation over the same events of such trajectories.
    Trajectories from the invariant measure may remember their start for long, so their first events
    are no fair sample of all events.
    """
    digits = math.log(RETURN_ERROR / 2.0**-53)
    long = max(box.sides) / min(box.sides)
    for radius in ordinary_radii(box):
        scene = box.scene(radius)
        law = two_disc_law(scene)

        def exponent(forgotten, measured, scene=scene, law=law):
            starts = states(scene, REVERSED_PATHS, seed)
            factors = growth(starts, forgotten, measured, SEPARATION, law)
            return sample_mean(np.log(factors[np.isfinite(factors)]) / measured)

        there, back = (radius_cells("reversal", case, radius) for case in ("separation", "return"))
        expected = exponent(FORGOTTEN_EVENTS, PILOT_EVENTS).value
        # The longest path to reverse; if a smaller exponent allows more, the row has no value.
        if expected < digits / 2000:
            yield judged(back, "events_retraced", None, status="long")
            continue
        expected = digits / expected
        first = round(FIT_SHARE * expected)
        rate = exponent(first, round(expected) - first)
        predicted = digits / rate.value
        yield judged(there, "exponent", rate.value, stderr=rate.stderr, count=REVERSED_PATHS)

        log_errors = {}  # the logarithm of the error of return by the number of events
        numbers = sorted({max(1, round(share * expected)) for share in SHARES})
        for block, number in enumerate(numbers, start=1):
            starts = states(scene, REVERSED_PATHS, seed, block)
            # A way back without any rounding is possible; it counts as an eighth of a rounding.
            off = np.maximum(return_errors(starts, number, law), 2.0**-56)
            log_errors[number] = log = sample_mean(np.log(off))
            value = math.exp(log.value)
            yield judged(back, "return_error", value, count=number, stderr=value * log.stderr)

        fitted = [
            (n, e.value, e.stderr) for n, e in log_errors.items() if first <= n <= round(expected)
        ]
        slope = LinearFit(*zip(*fitted, strict=True)).slope
        z = (slope.value - rate.value) / math.hypot(slope.stderr, rate.stderr)
        found = {"exact": rate.value, "stderr": slope.stderr, "count": REVERSED_PATHS}
        yield judged(back, "exponent", slope.value, z=z, **found)
        logs = [log.value for log in log_errors.values()]
        yield judged(
            back,
            "events_retraced",
            float(np.interp(math.log(RETURN_ERROR), logs, numbers)),
            low=predicted - math.log(ROUNDINGS * long) / rate.value,
            high=predicted + math.log(ROUNDINGS) / rate.value,
            count=REVERSED_PATHS,
            exact=predicted,
        )


# All rows ---------------------------------------------------------------------------------------


def rows(box, seed, ordinary, hard):
    """Yield all rows of stability.csv for a plain ``Box``.

    ``ordinary`` and ``hard`` are the numbers of events of the runs at ordinary and at hard radii.
    """
    yield from theory_rows(box)
    yield from sampling_rows(box, seed)
    yield from estimate_rows(box, seed)
    yield from time_rows(box, seed)
    yield from dynamics_rows(box, seed, ordinary, hard)
    yield from extreme_rows(seed)
    yield from reversal_rows(box, seed)
