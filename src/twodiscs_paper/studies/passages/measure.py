"""Which hops are passages near the radius where they become blocked, and how discs diffuse by them.

With friction of the rate γ, κ depends on x = γ√(εσ): a neck of the width ε = h − 4r has the length
√(εσ), and a pair forgets its velocity within it if x is large.

The distance below that radius is halved from step to step. Two quantities have two estimators each,
which share only the exact rate of hops: κ, by clusters and by κ(t) (``hop_clusters``), and
the coefficient D of diffusion along a ring, by the correlations of hops and by displacements.
"""

import math
from functools import partial
from itertools import pairwise

import numpy as np
from scipy.optimize import curve_fit

from twodiscs.analysis.scores import student_deviate
from twodiscs.dynamics.ensemble import REPLICAS
from twodiscs.dynamics.two import strip
from twodiscs.dynamics.two.hop_clusters import HOPS_OF_BLOCK, cluster_sizes, hop_sums
from twodiscs.measure.transmission import (
    TIMES,
    are_rare,
    box_time,
    cluster_coefficient,
    correlations,
    hop_seed,
    odd_clusters_per_passage,
    plateau,
    quiet_time,
)
from twodiscs.model.events import AXIS, HOPS
from twodiscs.model.scene import Box, Scene
from twodiscs.points import estimates
from twodiscs.points.estimates import Estimate
from twodiscs.theory import exact, laws, weighted
from twodiscs_paper.studies.estimates import LinearFit, sample_mean
from twodiscs_paper.studies.passages.models import file, limit
from twodiscs_paper.study import row

#: Distances below the radius where the hop becomes blocked: halved from the first to the last.
SMOOTH, ROUGH, RING = range(3, 15), range(3, 10), range(3, 7)

#: The moment of inertia of rough discs, if only one is measured.
ONE_INERTIA = 0.5

#: The most hops and the fewest that are followed for one estimate.
MOST_HOPS, FEWEST_HOPS = 2**17, 2**11

#: Replicas for κ over replicas for κ(t), and events for κ over events for other estimates: most
#: events for κ are in pauses, where they cost least.
RECORDED, IN_PAUSES = 4, 3

#: {rough: (factor, power)}: about factor/distance^power wall and disc events belong to a hop. In a
#: neck of the relative length √distance, smooth discs fly and rough discs diffuse.
MET = {False: (2, 0.5), True: (24, 1.0)}

#: The density at 0 is taken from κ at two times; this is about 1 − κ at the first.
FIRST = 0.01

#: On a ring, correlations of hops are summed up for ``AROUND`` times the time that a disc takes
#: around it. Displacements take twice that time, or two mean times between hops if these are
#: longer, in ``FEWEST`` replicas or more.
AROUND, FEWEST = 16, 2**11

#: The fewest blocks behind the error of a rate of hops of rough discs: in a neck their hops come in
#: crowds. Counted over seeds, 466 blocks have the errors that they say; of 128 blocks the spread is
#: 1.5 errors, of 34 blocks 1.6.
FEWEST_ROUGH = 256

#: {rate of kicks: halvings of the distance}.
KICKED = {
    10.0: (5, 6, 8, 10, 12, 14, 16), 40.0: range(6, 17, 2), 160.0: range(8, 17, 2),
    640.0: (8, 12),
}  # fmt: skip

#: With kicks, the least time without a hop that ends a cluster, in ``box_time``. Then the work of
#: an estimate over that of others, the price of a kick in events, the fewest hops, and the blocks
#: of initial states for the rate of hops.
PAUSE, WORK, KICK, FEWEST_KICKED, STRIPS = 12, 4, 4, 2**9, 16

#: Necks are long from this x on: a pair forgets its velocity several times within it.
LONG_NECK = 5

#: Long files: the number of discs, and of replicas; halvings of the distance below h/4 where discs
#: can pass; the rate of kicks, and the time between records, with the thermal speed and h as units;
#: the number of records, and the lags in records.
LONG_FILE, LONG_REPLICAS, OPEN = 128, 32, range(3, 6)
FRICTION, STEP, RECORDS, LAGS = 4.0, 0.5, 128, (1, 2, 4, 8, 16, 32, 64)

#: The lags between which displacements give F, and those between which they give D.
SINGLE, HOPPED = (16, 64), (16, 32)

#: Blocks of pairs of discs for c.
LIMIT_BLOCKS = 512

#: The number of distances in a fit, each half of the one before: four octaves.
LAST = 5

#: The columns that identify one hop, near one threshold, of discs with one moment of inertia.
HOP = ("scene", "width", "height", "event", "discs", "moment_of_inertia")


def coefficients_at_times(sums):
    """Return the estimates of ``correlations`` from ``sums``, a row for each block of hops."""
    return correlations(sums.sum(axis=0), sums.shape[0] * HOPS_OF_BLOCK)


def order_correlation(x):
    """Return (κ(t)/κ, its derivative), e^(−2x), for x passages in the time on average."""
    left = math.exp(-2 * x)
    return left, -2 * left


def thresholds(box):
    """Return {hop: radius where it becomes blocked} of a plain ``Box``.

    Hops that stay possible up to the largest radius are left out.
    """
    limits = {hop: box.threshold(hop) for hop in HOPS}
    return {hop: radius for hop, radius in limits.items() if radius in box.thresholds}


def radius_at(limit, halvings):
    """Return the radius 2^−``halvings`` below a ``limit``, relative to it."""
    return limit * (1 - 2.0**-halvings)


def blocks_for(scene, distance, time, events):
    """Return how many blocks of hops take about ``events``, if hops are followed for ``time``."""
    factor, power = MET[scene.moment_of_inertia is not None]
    price = time * exact.event_rate(scene) + factor / distance**power
    return int(min(max(events / price, FEWEST_HOPS), MOST_HOPS)) // HOPS_OF_BLOCK


def scene_at(box, hop, halvings, **effects):
    """Return the ``Scene`` in a plain ``Box`` at a distance below the radius that blocks a hop."""
    return Box(box.width, box.height, **effects).scene(radius_at(box.threshold(hop), halvings))


def slope_time(scene, hop):
    """Return (time at which the slope of κ is measured, density of intervals at 0).

    The time is None if discs that turn round so late do not find the neck again.
    """
    density = laws.density_at_zero(scene, hop)
    time = FIRST / (2 * density)
    found = time <= math.sqrt(scene.contact_distance * scene.clearance(hop))
    return time if found else None, density


def compared(found, reference, blocks=None):
    """Return the cells of a comparison of an ``Estimate`` with a ``reference``.

    The reference is an exact number, or an ``Estimate`` by another method. If the error comes from
    a number of independent ``blocks``, the deviate follows Student's law.
    """
    if not isinstance(reference, Estimate):
        reference = Estimate(reference, 0.0, 1)
    z = (found.value - reference.value) / math.hypot(found.stderr, reference.stderr)
    return {
        "reference": reference.value,
        "reference_stderr": reference.stderr or None,
        "z": student_deviate(z, blocks - 1) if blocks else z,
        "test": "normal",
    }


def hop_cells(name, scene, hop, distance):
    """Return the cells that rows on a ``hop`` of a ``Scene`` have in common."""
    return {
        "scene": name,
        "width": scene.width,
        "height": scene.height,
        "periodic": scene.periodic or None,
        "event": hop,
        "discs": scene.discs,
        "radius": scene.radius,
        "distance": distance,
        "moment_of_inertia": scene.moment_of_inertia,
        "friction": scene.friction or None,
    }


def passing_rate(scene, hop):
    """Return the rate at which the discs pass each other in a ``hop``, in both directions together.

    Between walls it is that of an event. On a periodic axis it is the rate at which the separation
    to the nearest image changes its sign at 0.
    """
    periodic = AXIS[hop] in scene.periodic
    return weighted.passing_rate(scene, hop) if periodic else exact.rate(scene, hop)


class NearThreshold:
    """One kind of hop at one radius: its measurements and their rows."""

    def __init__(self, name, scene, hop, halvings, seed):
        self.name, self.scene, self.hop, self.seed = name, scene, hop, seed
        self.mean, self.halvings = 1 / passing_rate(scene, hop), halvings
        self.start = hop_cells(name, scene, hop, 2.0**-halvings) | {"exact_mean": self.mean}

    def _seed(self, what):
        inertia = self.scene.moment_of_inertia
        kind = f"{self.scene.periodic} {inertia}" if not self.scene.is_plain else ""
        kind += f" {self.scene.friction}" if self.scene.friction else ""
        return hop_seed(self.scene, self.hop, f"{self.name} {kind}", self.seed, what)

    def row(self, quantity, method, found, time=None, reference=None, events=None):
        """Return a row; ``reference`` is an exact number, or an ``Estimate`` by another method.

        If the method is ``states``, the error comes from ``found.n`` independent blocks.
        """
        cells = {"quantity": quantity, "method": method, "time": time, "events": events}
        if reference is not None:
            cells |= compared(found, reference, found.n if method == "states" else None)
        return row(self.start, found, replicas=found.n, **cells)

    def clusters(self, blocks):
        """Return (κ or None, its rows)."""
        gap = quiet_time(self.scene, self.hop)
        if not are_rare(self.scene, self.hop, self.mean):
            return None, []
        found = cluster_sizes(self.scene, self.hop, gap, blocks, self.cluster_seed)
        return self.cluster_rows(*found, gap)

    @property
    def cluster_seed(self):
        """The seed of the streams that clusters are drawn from."""
        return self._seed("clusters")

    def cluster_rows(self, sizes, events, gap):
        """Return (κ or None, the rows of it) from what ``cluster_sizes`` returns for a ``gap``."""
        found = cluster_coefficient(sizes)
        kappa = plateau(found, gap, self.mean, odd_clusters_per_passage)
        if kappa is None:
            return None, []
        time = Estimate(self.mean / kappa.value, self.mean * kappa.stderr / kappa.value**2, kappa.n)
        coefficient = self.row("coefficient", "clusters", kappa, gap, events=events)
        return kappa, [
            coefficient | {"uncorrected": found.value},
            self.row("passage_time", "clusters", time, gap),
        ]

    def curve(self, blocks, kappa):
        """Yield the rows of κ(t), and of its plateau against ``kappa`` if ``kappa`` is known."""
        gap = quiet_time(self.scene, self.hop)
        box, own = box_time(self.scene, self.hop), []
        times = sorted({*([gap] if kappa else []), *(box * time for time in TIMES)})
        sums, events = hop_sums(self.scene, self.hop, times, blocks, self._seed("times"))
        for time, estimate in zip(times, coefficients_at_times(sums), strict=True):
            if time == gap:
                own.append(estimate)
            else:
                yield self.row("correlation", "hops", estimate, time)
        flat = plateau(own[0], gap, self.mean, order_correlation) if kappa else None
        if flat:
            yield self.row("plateau", "hops", flat, gap, kappa, events)

    def slope(self, blocks):
        """Yield the row of −dκ/dt at 0⁺ against its exact value 2 p(0⁺), for plain scenes.

        At short times κ(t) = 1 − 2 p t + a t². Its values at t and 2t, from independent replicas,
        give p.
        """
        time, density = slope_time(self.scene, self.hop)
        if time is None:
            return
        parts = []
        for n in (1, 2):
            sums, _ = hop_sums(self.scene, self.hop, [n * time], blocks, self._seed(f"slope {n}"))
            parts.append(coefficients_at_times(sums)[0])
        early, late = parts
        value = (4 * (1 - early.value) - (1 - late.value)) / (2 * time)
        error = math.hypot(4 * early.stderr, late.stderr) / (2 * time)
        estimate = Estimate(value, error, early.n + late.n)
        yield self.row("slope", "hops", estimate, time, 2 * density)

    def diffusion(self, events):
        """Yield the rows of the rate of hops and of D/(ν ℓ²), on a ring."""
        around = AROUND * box_time(self.scene, self.hop)
        rate = exact.event_rate(self.scene)
        blocks = blocks_for(self.scene, 2.0**-self.halvings, around, events)
        sums, simulated = hop_sums(self.scene, self.hop, [around], blocks, self._seed("times"))
        (correlated,) = coefficients_at_times(sums)
        yield self.row("diffusion", "hops", correlated, around, events=simulated)
        time = max(around, self.mean)
        blocks = int(min(max(events / (rate * 2 * time), FEWEST), MOST_HOPS)) // HOPS_OF_BLOCK
        sums, simulated = hop_sums(
            self.scene, self.hop, [time, 2 * time], blocks, self._seed("states"), on_surface=False
        )
        per_time = sums / (HOPS_OF_BLOCK * time)
        counted = sample_mean(per_time[:, 2, 1] / 2)
        rate = self.row("rate", "states", counted, 2 * time, 1 / self.mean, simulated)
        if self.scene.moment_of_inertia is not None and blocks < FEWEST_ROUGH:
            rate |= dict.fromkeys(("stderr", "z", "test"))
        yield rate
        # Displacements in the second half of the time no longer depend on the start.
        moved = sample_mean((per_time[:, 1, 1] - per_time[:, 1, 0]) * self.mean)
        yield self.row("diffusion", "states", moved, 2 * time, correlated)

    def rate(self, blocks):
        """Return the row of the rate of hops, counted in its strip."""
        around = strip.choose_strip(self.scene, self.hop)
        stream = np.uint64(self._seed("rate"))
        sums, events = strip.run_blocks(self.scene, self.hop, around, stream, 0, blocks)
        fractions = strip.stratum_fractions(self.scene, self.hop, around)
        per_time = around.fraction / (2 * around.time)
        mean, error = (per_time * part for part in estimates.stratified_mean(fractions, *sums))
        found = Estimate(mean, error, blocks * REPLICAS)
        return self.row("rate", "states", found, 2 * around.time, 1 / self.mean, int(events))


def one_hop(name, box, hop, halvings, inertia, events, seed):
    """Yield the rows of one hop of a plain ``Box`` at distances that are halved.

    ``inertia`` is the moment of inertia of rough discs, None for smooth discs. An estimate may take
    about ``events`` wall and disc events, κ ``IN_PAUSES`` times as many.
    """
    for n in halvings:
        scene = scene_at(box, hop, n, moment_of_inertia=inertia)
        near, both = NearThreshold(name, scene, hop, n, seed), 2 * quiet_time(scene, hop)
        blocks = blocks_for(scene, 2.0**-n, both, IN_PAUSES * events)
        kappa, rows = near.clusters(blocks)
        yield from rows
        yield from near.curve(max(blocks // RECORDED, FEWEST_HOPS // HOPS_OF_BLOCK), kappa)
        if inertia is None:
            yield from near.slope(MOST_HOPS // HOPS_OF_BLOCK)


def one_friction(name, box, friction, halvings, events, seed):
    """Yield the rows of discs with ``friction`` at distances below h/4, the largest one first."""
    measured = []
    for n in halvings:
        scene = scene_at(box, "horizontal_hop", n, friction=friction)
        near = NearThreshold(name, scene, "horizontal_hop", n, seed)
        gap = cluster_pause(scene, near.hop)
        price = 2 * gap * (exact.event_rate(scene) + KICK * friction)
        hops = min(max(WORK * events / price, FEWEST_KICKED), MOST_HOPS)
        found = cluster_sizes(scene, near.hop, gap, int(hops) // HOPS_OF_BLOCK, near.cluster_seed)
        kappa, rows = near.cluster_rows(*found, gap)
        yield from rows
        if n == halvings[0]:
            yield near.rate(STRIPS)
        measured.append((near, kappa))
    yield from local_exponents(measured)


def cluster_pause(scene, hop):
    """Return the time without a hop that ends a cluster: with little friction it is shorter."""
    return quiet_time(scene, hop, PAUSE) if scene.friction else quiet_time(scene, hop)


def scaled_friction(scene, hop):
    """Return x = γ√(εσ) of a ``Scene``."""
    return scene.friction * math.sqrt(scene.clearance(hop) * scene.contact_distance)


def diffusive_limit(scene, hop):
    """Return κ x of two smooth discs between walls whose separation diffuses through the neck.

    It is 3/4 for a short neck. The density of the separation u has the factor A − |u|, which adds
    the share 2√(2εσ)/(πA) to the resistance of the neck.
    """
    length = math.sqrt(2 * scene.clearance(hop) * scene.contact_distance)
    return 3 / 4 / (1 + 2 * length / (math.pi * float(scene.reach(AXIS[hop]))))


def local_exponents(measured):
    """Yield κ x of long necks against its limit, and exponents of τ/κ between two distances.

    ``measured`` are pairs (``NearThreshold``, κ) with friction, the largest distance first. τ goes
    as ε⁻² times a factor that is regular at the threshold. Without this factor the exponent is
    −2 + |d ln κ/d ln x|/2.
    """
    before = None
    for near, kappa in measured:
        if kappa is None:
            before = None
            continue
        x = scaled_friction(near.scene, near.hop)
        if x >= LONG_NECK:
            product = Estimate(kappa.value * x, kappa.stderr * x, kappa.n)
            limit = diffusive_limit(near.scene, near.hop)
            yield near.row("scaled_coefficient", "clusters", product) | {"reference": limit}
        if before:
            far, length = before[0], math.log(before[1] / x)
            slope = math.log(kappa.value / far.value) / length
            error = math.hypot(far.stderr / far.value, kappa.stderr / kappa.value) / length
            yield near.row("local_exponent", "fit", Estimate(abs(slope) / 2 - 2, error / 2, 2))
        before = kappa, x


def one_ring(name, box, inertia, events, seed):
    """Yield the rows of diffusion along x, where a ``Box`` is closed to a ring."""
    for n in RING:
        scene = scene_at(box, "horizontal_hop", n, periodic="x", moment_of_inertia=inertia)
        yield from NearThreshold(name, scene, "horizontal_hop", n, seed).diffusion(events)


def file_scene(box, discs, radius, inertia=None):
    """Return the ``Scene`` of ``discs`` on a ring, and the unit of its times, h over v_th."""
    scene = Scene(
        box.width / 2 * discs, box.height, radius, discs=discs, periodic="x",
        moment_of_inertia=inertia,
    )  # fmt: skip
    return scene, box.height / file.thermal_speed(scene)


def one_long_file(name, box, radius, frictions, seed, inertia=None, replicas=LONG_REPLICAS):
    """Yield the rows of one long file, which is open at a ``radius`` below h/4, else blocked.

    It is followed with each of ``frictions``: None, or the rate of kicks. Rough discs have an
    ``inertia``, I/(m r²), and no law, because their F is not known. Squares of lengths are over ℓ².
    An open file has a row of the ``density`` from its first motion, which is without kicks.
    """
    limit, per_disc = box.height / 4, box.width / 2
    is_open, variance = radius < limit, None
    scene, unit = file_scene(box, LONG_FILE, radius, inertia)
    start = hop_cells(name, scene, "horizontal_hop", 1 - radius / limit)
    for friction in frictions:
        rate = start["friction"] = None if friction is None else friction / unit
        kind = friction if inertia is None else f"rough {inertia}"
        stream = hop_seed(scene, "horizontal_hop", name, seed, f"long file {kind} states")

        def make_row(quantity, method, found, lag=None, **more):
            more["time"] = None if lag is None else lag * STEP * unit
            return row(start, found, quantity=quantity, method=method, replicas=found.n, **more)

        places, hops = file.recorded(scene, STEP * unit, RECORDS, replicas, stream, rate)
        numbers = file.order(places, scene.width)
        ordered = file.ordered_places(places, numbers, scene.width)
        moved, whole_file = (file.squares(x, LAGS) / per_disc**2 for x in (places, ordered))
        steps = file.squares(numbers, LAGS)
        if is_open and variance is None:
            variance = file.measured_density(scene, places)
            yield make_row("density", "states", variance)

        def law(lag, rate=rate, variance=variance and variance.value):
            if inertia or (rate is None and variance):
                return None
            return file.law(scene, rate, lag * STEP * unit, variance)

        for k, lag in enumerate(LAGS):
            yield make_row("displacement", "states", sample_mean(moved[k]), lag)
            if is_open:
                yield make_row("order", "states", sample_mean(steps[k]), lag)
            yield make_row("file", "states", sample_mean(whole_file[k]), lag, reference=law(lag))
        if rate is not None:
            early, late = (LAGS.index(lag) for lag in SINGLE)
            root = math.sqrt(SINGLE[0] * STEP * unit)
            found = sample_mean((whole_file[late] - whole_file[early]) / root)
            due = (law(SINGLE[1]) - law(SINGLE[0])) / root
            # F is ∝ √S.
            error = due * variance.stderr / variance.value / 2 if variance else 0.0
            cells = compared(found, Estimate(due, error, 1), found.n)
            yield make_row("single_file", "states", found, SINGLE[1], **cells)
        if is_open:
            per_time = hops / (RECORDS * STEP * unit)
            yield make_row("rate", "states", sample_mean(per_time))
            early, late = (LAGS.index(lag) for lag in HOPPED)
            walked = (steps[late] - steps[early]) / ((HOPPED[1] - HOPPED[0]) * STEP * unit)
            yield make_row("diffusion", "order", file.quotient(walked, per_time), HOPPED[1])


def in_the_limit(seed):
    """Yield the row of c, the number of 1 − κ = c σ^(2/3) ε^(1/3)/A for smooth discs."""
    c = limit.amplitude(LIMIT_BLOCKS, seed)
    yield row({"discs": 2, "quantity": "amplitude", "method": "limit"}, c, replicas=c.n)


def near_threshold(name, box, hop, inertias, events, seed):
    """Yield the rows of a ``hop`` of a plain ``Box`` near the radius where it becomes blocked.

    ``inertias`` are the moments of inertia of rough discs.
    """
    yield from one_hop(name, box, hop, SMOOTH, None, events, seed)
    for inertia in inertias:
        yield from one_hop(name, box, hop, ROUGH, inertia, events, seed)


def on_ring(name, box, events, seed):
    """Yield the rows of two discs on a ring, smooth and rough."""
    for inertia in (None, ONE_INERTIA):
        yield from one_ring(name, box, inertia, 6 * events, seed)


def with_friction(name, box, events, seed):
    """Yield the rows of the passages of two smooth discs with friction."""
    for friction, halvings in KICKED.items():
        yield from one_friction(name, box, friction, halvings, events, seed)


def in_long_file(name, box, blocked, seed):
    """Yield the rows of long files with friction that are blocked at the radii ``blocked``."""
    for radius in blocked:
        yield from one_long_file(name, box, radius, [FRICTION], seed)


# Long runs --------------------------------------------------------------------------------------


def long_run_thresholds(one):
    """Yield pairs (``NearThreshold``, pause) of a threshold ``one`` of a long run.

    The distance is halved ``every`` times from one to the next, once if this is not given. The
    ``pauses`` of the configuration are over that of the build.
    """
    box = Box(one["width"], one["height"])
    for halvings in range(one["first"], one["last"] + 1, one.get("every", 1)):
        effects = {"friction": one.get("friction", 0.0), "moment_of_inertia": one.get("inertia")}
        scene = scene_at(box, one["hop"], halvings, **effects)
        near = NearThreshold(one["name"], scene, one["hop"], halvings, one["seed"])
        for pause in one.get("pauses", [1]):
            yield near, pause * cluster_pause(scene, near.hop)


def cluster_counts(one):
    """Return {"events", "of", "sizes"} for each of the distances of a threshold ``one``.

    ``sizes`` are pairs [n, how many of the hops are in a cluster of n], without those of none;
    "of" is how many sizes are told apart.
    """
    found, blocks = [], -(-one["hops"] // HOPS_OF_BLOCK)
    for near, gap in long_run_thresholds(one):
        sizes, events = cluster_sizes(near.scene, near.hop, gap, blocks, near.cluster_seed)
        pairs = [[n, int(hops)] for n, hops in enumerate(sizes) if hops]
        found.append({"events": int(events), "of": len(sizes), "sizes": pairs})
    return found


def cluster_rows(one, counts):
    """Return the rows of passages.csv on a threshold ``one`` from its ``cluster_counts``."""
    measured, found = [], []
    for (near, gap), count in zip(long_run_thresholds(one), counts, strict=True):
        sizes = np.zeros(count["of"], np.int64)
        for n, hops in count["sizes"]:
            sizes[n] = hops
        kappa, own = near.cluster_rows(sizes, count["events"], gap)
        measured.append((near, kappa))
        found += own
    if "pauses" in one:  # at one distance
        return found
    if "friction" in one:
        return [*found, *local_exponents(measured)]
    return [*found, *fits(found)]


def long_run(thresholds):
    """Return the rows of many hops at ``thresholds``, at distances that no build goes down to."""
    return long_run_rows(thresholds, {one["name"]: cluster_counts(one) for one in thresholds})


def long_run_rows(thresholds, counts):
    """Return the rows of passages.csv on ``thresholds`` from {name: its ``cluster_counts``}."""
    found = [row for one in thresholds for row in cluster_rows(one, counts[one["name"]])]
    return [*found, *scaling_fits(found)]


def scaling_law(x, b, limit=3 / 4):
    """Return κ of a scaled friction x: 1/κ = x/``limit`` + 1/(1 + b x), with a number ``b``.

    It is 1 for small x, and ``limit``/x for large x, which is what diffusion has.
    """
    return 1 / (x / limit + 1 / (1 + b * x))


def scaling_fits(rows):
    """Yield b of ``scaling_law``, fitted to κ with friction, χ², and the largest deviation of κ."""
    own = [row for row in rows if row["quantity"] == "coefficient" and row["friction"]]
    if not own:
        return
    hops = [(row_scene(row), row["event"]) for row in own]
    x, limit = np.array([(scaled_friction(*hop), diffusive_limit(*hop)) for hop in hops]).T
    kappa, error = np.array([(row["estimate"], row["stderr"]) for row in own]).T
    fitted, covariance = curve_fit(
        partial(scaling_law, limit=limit), x, kappa, 0.5, error, absolute_sigma=True
    )
    law = scaling_law(x, *fitted, limit)
    off, start = kappa / law - 1, {"event": own[0]["event"], "discs": 2, "method": "fit"}
    constant = Estimate(float(fitted[0]), math.sqrt(covariance[0, 0]), len(own))
    yield row(start, constant, quantity="scaling_constant", replicas=len(own))
    chi2 = float((((kappa - law) / error) ** 2).sum())
    yield row(start, quantity="scaling_chi2", estimate=chi2, replicas=len(own))
    worst = np.abs(off).argmax()
    start |= {name: own[worst][name] for name in ("distance", "friction")}
    largest = Estimate(float(off[worst]), float(error[worst] / law[worst]), 1)
    yield row(start, largest, quantity="scaling_deviation")


def row_scene(row):
    """Return the ``Scene`` of two discs between walls of a ``row`` of passages.csv."""
    return Box(row["width"], row["height"], friction=row["friction"] or 0.0).scene(row["radius"])


def displacements(name, width, height, blocked, seed, replicas):
    """Yield the rows of a long run of ``replicas`` of long files, without and with friction.

    They are blocked at the first of the radii ``blocked``, or open; rough discs are blocked. At the
    other radii they are blocked and have friction, as in a build.
    """
    box, opened = Box(width, height), [radius_at(height / 4, n) for n in OPEN]
    files = [(radius, [None, FRICTION], None) for radius in (blocked[0], *opened)]
    files.append((blocked[0], [None], ONE_INERTIA))
    files += [(radius, [FRICTION], None) for radius in blocked[1:]]
    for radius, frictions, inertia in files:
        yield from one_long_file(name, box, radius, frictions, seed, inertia, replicas)


def file_counts(one, run):
    """Return the counts of a file ``one`` of a long ``run``, a list for each replica.

    They are the hops of all pairs, and for each pause the passages, both between the margins; then
    the hops in all the time, and for both lags Σ n² over the discs and all pairs of times, n the
    places by which a disc has moved in the order.
    """
    box, found = Box(run["width"], run["height"]), []
    scene, unit = file_scene(box, one["discs"], radius_at(box.height / 4, one["halvings"]))
    rate = one["friction"] / unit if "friction" in one else None
    step, number = run["step"] * unit, run["records"]
    window = run["margin"] * unit, number * step - run["margin"] * unit
    kind = f"long run {one['discs']} {one.get('friction')}"
    seed = hop_seed(scene, "horizontal_hop", run["name"], run["seed"], kind)
    for places, times, pairs in file.logged(scene, step, number, one["replicas"], seed, rate):
        counted = [file.passages(times, pairs, window, gap * unit) for gap in run["pauses"]]
        numbers = file.order(places, scene.width)
        moved = [int(((numbers[lag:] - numbers[:-lag]) ** 2).sum()) for lag in run["lags"]]
        found.append([counted[0][0], [each for _, each in counted], times.size, moved])
    return found


def file_rows(one, run, counts):
    """Yield the rows of passages.csv on a file ``one`` of a long ``run`` from its ``counts``.

    κ is that of the first pause that is long against a flight, corrected for the passages of the
    pair and of its neighbours in it. D/(ν ℓ²) over κ is the last row.
    """
    box = Box(run["width"], run["height"])
    scene, unit = file_scene(box, one["discs"], radius_at(box.height / 4, one["halvings"]))
    start = hop_cells(run["name"], scene, "horizontal_hop", 2.0 ** -one["halvings"])
    start["friction"] = one["friction"] / unit if "friction" in one else None
    hops, passed, total, moved = (np.array([count[k] for count in counts]) for k in range(4))
    discs, duration = one["discs"], run["records"] * run["step"] * unit
    per_time = 2 * total / (discs * duration)
    rate = sample_mean(per_time)
    yield row(start, rate, quantity="rate", method="states", replicas=rate.n)
    steps = [
        moved[:, k] / (discs * (run["records"] + 1 - lag)) for k, lag in enumerate(run["lags"])
    ]
    walked = (steps[1] - steps[0]) / ((run["lags"][1] - run["lags"][0]) * run["step"] * unit)
    moves = file.quotient(walked, per_time)
    time = run["lags"][1] * run["step"] * unit
    yield row(start, moves, quantity="diffusion", method="order", time=time, replicas=moves.n)
    for k, pause in enumerate(run["pauses"]):
        found = file.quotient(passed[:, k], hops)
        # Two discs take part in a hop, and each has two neighbours.
        kappa = plateau(
            found, pause * unit, 2 / rate.value, partial(odd_clusters_per_passage, others=2)
        )
        if kappa:
            cells = {"method": "clusters", "time": pause * unit, "replicas": kappa.n}
            yield row(start, kappa, quantity="coefficient", uncorrected=found.value, **cells)


def long_files(files, **run):
    """Yield the rows of a long ``run`` of ``files`` of several numbers of discs on a ring."""
    for one in files:
        yield from file_rows(one, run, file_counts(one, run))


# The table --------------------------------------------------------------------------------------


def fits(rows):
    """Yield the powers of ``rows`` of passages.csv, as powers of the distance.

    The power is that of 1 − κ for smooth discs, and of κ for rough discs, both without friction. It
    is taken from each distance of a hop and the one before, and from the last ``LAST`` distances.
    There is no power if a value is not positive.
    """
    hops = {}
    for one in rows:
        if one["quantity"] == "coefficient" and one["friction"] is None:
            hops.setdefault(tuple(one[name] for name in HOP), []).append(one)
    for found in hops.values():
        found.sort(key=lambda one: -one["distance"])
        steps = [("exponent", pair) for pair in pairwise(found)]
        for quantity, last in [*steps, ("last_exponent", found[-LAST:])]:
            is_rough = last[0]["moment_of_inertia"] is not None
            values = [one["estimate"] if is_rough else 1 - one["estimate"] for one in last]
            if len(last) < 2 or min(values) <= 0:
                continue
            x = [math.log(one["distance"]) for one in last]
            y = [math.log(value) for value in values]
            errors = [one["stderr"] / value for one, value in zip(last, values, strict=True)]
            kept = {name: last[-1][name] for name in (*HOP, "radius", "distance", "exact_mean")}
            slope = LinearFit(x, y, errors).slope
            yield row(kept, slope, quantity=quantity, method="fit", replicas=len(last))


#: The parts of passages.csv.
PARTS = {
    part.__name__: part
    for part in (
        near_threshold, on_ring, with_friction, in_long_file, in_the_limit, long_run, displacements,
        long_files,
    )
}  # fmt: skip
