"""One kind of hop near the radius where it becomes blocked: its measurements and their rows.

The distance below that radius is halved from step to step. Two quantities have two estimators each,
which share only the exact rate of hops: κ, by clusters and by κ(t) (``hop_clusters``), and
the coefficient D of diffusion along a ring, by the correlations of hops and by displacements.
"""

import math

import numpy as np

from twodiscs.analysis.scores import student_deviate
from twodiscs.dynamics.ensemble import REPLICAS
from twodiscs.dynamics.transmission import (
    KAPPA_TIMES,
    are_rare,
    box_time,
    cluster_coefficient,
    correlations,
    hop_seed,
    odd_clusters_per_passage,
    plateau,
    quiet_time,
)
from twodiscs.dynamics.two import strip
from twodiscs.dynamics.two.hop_clusters import HOPS_PER_BLOCK, cluster_sizes, hop_sums
from twodiscs.model.events import EVENT_AXES, HOPS
from twodiscs.model.scene import Box
from twodiscs.points import estimates
from twodiscs.points.estimates import Estimate
from twodiscs.theory import exact, laws, weighted
from twodiscs_paper.studies.estimates import sample_mean
from twodiscs_paper.study import row

#: The moment of inertia of rough discs, if only one is measured.
ONE_INERTIA = 0.5

#: The most hops and the fewest that are followed for one estimate.
MOST_HOPS, FEWEST_HOPS = 2**17, 2**11

#: {rough: (factor, power)}: about factor/distance^power wall and disc events belong to a hop. In a
#: neck of the relative length √distance, smooth discs fly and rough discs diffuse.
EVENTS_OF_HOP = {False: (2, 0.5), True: (24, 1.0)}

#: On a ring, correlations of hops are summed up for ``ROUNDS`` times the time that a disc takes
#: around it. Displacements take twice that time, or two mean times between hops if these are
#: longer.
ROUNDS = 16

#: The fewest blocks behind the error of a rate of hops of rough discs: in a neck their hops come in
#: crowds. Counted over seeds, 466 blocks have the errors that they say; of 128 blocks the spread is
#: 1.5 errors, of 34 blocks 1.6.
FEWEST_ROUGH = 256


def coefficients_at_times(sums):
    """Return the estimates of ``correlations`` from ``sums``, a row for each block of hops."""
    return correlations(sums.sum(axis=0), sums.shape[0] * HOPS_PER_BLOCK)


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


def affordable_blocks(events, price, fewest=FEWEST_HOPS):
    """Return how many blocks of hops, or of replicas, take about ``events`` at a ``price`` each."""
    return int(min(max(events / price, fewest), MOST_HOPS)) // HOPS_PER_BLOCK


def blocks_for(scene, distance, time, events):
    """Return how many blocks of hops take about ``events``, if hops are followed for ``time``."""
    factor, power = EVENTS_OF_HOP[scene.moment_of_inertia is not None]
    price = time * exact.event_rate(scene) + factor / distance**power
    return affordable_blocks(events, price)


def scene_at(box, hop, halvings, **effects):
    """Return the ``Scene`` in a plain ``Box`` at a distance below the radius that blocks a hop."""
    return Box(box.width, box.height, **effects).scene(radius_at(box.threshold(hop), halvings))


def slope_time(scene, hop):
    """Return (time at which the slope of κ is measured, density of intervals at 0).

    The time is None if discs that turn round so late do not find the neck again.
    """
    density = laws.density_at_zero(scene, hop)
    # The density at 0 is taken from κ at two times; this is about 1 − κ at the first.
    time = 0.01 / (2 * density)
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


def sparse(sizes):
    """Return pairs [n, number] of the ``sizes`` of clusters that are not zero, for JSON."""
    return [[n, int(number)] for n, number in enumerate(sizes) if number]


def dense(pairs, of):
    """Return the array of ``of`` sizes from the pairs of ``sparse``."""
    sizes = np.zeros(of, np.int64)
    for n, number in pairs:
        sizes[n] = number
    return sizes


def passing_rate(scene, hop):
    """Return the rate at which the discs pass each other in a ``hop``, in both directions together.

    Between walls it is that of an event. On a periodic axis it is the rate at which the separation
    to the nearest image changes its sign at 0.
    """
    periodic = EVENT_AXES[hop] in scene.periodic
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
        times = sorted({*([gap] if kappa else []), *(box * time for time in KAPPA_TIMES)})
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
        around = ROUNDS * box_time(self.scene, self.hop)
        rate = exact.event_rate(self.scene)
        blocks = blocks_for(self.scene, 2.0**-self.halvings, around, events)
        sums, simulated = hop_sums(self.scene, self.hop, [around], blocks, self._seed("times"))
        (correlated,) = coefficients_at_times(sums)
        yield self.row("diffusion", "hops", correlated, around, events=simulated)
        time = max(around, self.mean)
        blocks = affordable_blocks(events, rate * 2 * time)
        sums, simulated = hop_sums(
            self.scene, self.hop, [time, 2 * time], blocks, self._seed("states"), on_surface=False
        )
        per_time = sums / (HOPS_PER_BLOCK * time)
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
