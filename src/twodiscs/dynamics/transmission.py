"""The run of hops that may be passages, and what their sums say of the transmission coefficient."""

import math
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np

from twodiscs.dynamics.engine import find_engine
from twodiscs.dynamics.ensemble import HOPS_PER_BLOCK
from twodiscs.dynamics.two.hop_clusters import LARGEST_CLUSTER, N_HOP_SUMS
from twodiscs.model.events import EVENT_AXES
from twodiscs.model.scene import Scene
from twodiscs.model.seeds import key, stream_name, stream_seed
from twodiscs.points.base import reached
from twodiscs.points.estimates import Estimate, why_no_error
from twodiscs.sampling.rounds import Run, fixed
from twodiscs.theory import exact

#: A cluster ends if no hop comes for this number of ``box_time``. Hops that follow each other after
#: a tenth of that are still correlated. Hops that come later make κ too large, by about 1e-3 at a
#: distance of 2⁻⁶ from the threshold, where hops are most frequent, and by less elsewhere.
CLUSTER_PAUSE = 48

#: The most passages that may come, on average, within the time that ends a cluster, and the most
#: hops, if they come at random. Below both, κ(t) has a plateau at that time.
MOST_MERGED, MOST_IN_GAP = 0.1, 0.25

#: The times at which κ(t) is recorded, in units of ``box_time``.
KAPPA_TIMES = tuple(float(f"{time:.3g}") for time in np.geomspace(0.1, 10, 21))


def box_time(scene, hop):
    """Return the time that a disc of speed 1 takes across the box along the axis of a ``hop``.

    With N discs it is that across two of N equal parts of the box, at the mean speed of N discs.
    """
    axis = EVENT_AXES[hop]
    length = scene.side(axis) if axis in scene.periodic else float(scene.reach(axis))
    return length * math.sqrt(2 / scene.discs)


def quiet_time(scene, hop, times=CLUSTER_PAUSE):
    """Return the time without a ``hop`` that ends a cluster of them.

    It is a number of ``times`` the ``box_time`` t. With friction γ a separation diffuses, and is
    forgotten after about γt²/5 in the plane; the time is then at least γt²/4. With spins, which
    share the energy, both are longer.
    """
    time, own = box_time(scene, hop), scene.velocity_components / (2 * scene.discs)
    return max(times * time, own * scene.friction * time**2 / 4)


def cluster_coefficient(sizes):
    """Return the fraction of hops that are passages as an ``Estimate``, ⟨1[n odd]/n⟩.

    ``sizes`` are those of ``cluster_sizes``; the last entry, of an even n, has no passages.
    """
    n = np.arange(sizes.size)
    odd, hops = n % 2 == 1, int(sizes.sum())
    mean = float((sizes[odd] / n[odd]).sum()) / hops
    square = float((sizes[odd] / n[odd] ** 2).sum()) / hops
    return Estimate(mean, math.sqrt((square - mean * mean) / hops), hops)


def with_error(estimate, *numbers):
    """Return an ``Estimate``, without its error unless each of the ``numbers`` is large enough.

    The numbers are those of independent hops with each of the results whose mix is the estimate. If
    all of them had the same result, their spread would be 0 although another result is possible.
    """
    return replace(estimate, stderr=None) if why_no_error(min(numbers), "hops") else estimate


def cluster_estimate(sizes):
    """Return the estimate of ``cluster_coefficient``; its error needs odd and even clusters."""
    odd = int(sizes[1:-1:2].sum())
    return with_error(cluster_coefficient(sizes), odd, int(sizes.sum() - sizes[1]))


def time_estimates(sums, replicas):
    """Return the estimates of ``correlations``; an error needs hops that are undone, and others."""
    undone, stayed = sums[1], replicas - np.abs(sums[0])
    estimates = correlations(sums, replicas)
    return [with_error(*of) for of in zip(estimates, undone, stayed, strict=True)]


def correlations(sums, replicas):
    """Return an ``Estimate`` of C = 1 + 2 ⟨Σ s_0 s_k⟩ at each time.

    ``sums`` are those of ``hop_sums`` over all blocks, with a number of ``replicas``. Between walls
    C is ±1 in every replica, so the error is binomial.
    """
    net, square = sums[:2] / replicas
    errors = 2 * np.sqrt((square - net**2) / replicas)
    pairs = zip(net.tolist(), errors.tolist(), strict=True)
    return [Estimate(1 + 2 * value, error, replicas) for value, error in pairs]


def are_rare(scene, hop, mean):
    """Return whether the time that ends a cluster has at most ``MOST_IN_GAP`` hops on average.

    The ``mean`` time is that between hops of two neighbours.
    """
    return quiet_time(scene, hop) <= MOST_IN_GAP * mean


def odd_clusters_per_passage(x, others=0):
    """Return (odd clusters per passage, its derivative) for x passages in a gap on average.

    A cluster goes on after a passage with a probability q, and there are 1 − q clusters for each
    passage: those of odd n are (1 − q) Σ q^(n−1) = (1 − q)/(1 + q). Passages of ``others``, each at
    the same rate, make the pair neighbours no more: q = (1 − e^(−(1 + others) x))/(1 + others).
    """
    grown = math.exp((1 + others) * x)
    left = (others * grown + 1) / ((others + 2) * grown - 1)
    return left, -2 * (1 + others) ** 2 * grown * (left / (others * grown + 1)) ** 2


def plateau(estimate, time, mean, law):
    """Return κ, corrected for the passages in a ``time``, from an ``Estimate`` of κ(``time``).

    Passages come independently, at the rate κ/τ for the ``mean`` time τ between hops. The ``law``
    gives the factor by which they reduce the estimate, and its derivative, like
    ``odd_clusters_per_passage``. The result is None if the time has more than ``MOST_MERGED``
    passages.
    """
    value, x = estimate.value, estimate.value * time / mean
    if value <= 0 or x > MOST_MERGED:
        return None
    for _ in range(50):  # converges, because x is small
        value = estimate.value / law(value * time / mean)[0]
    x = value * time / mean
    factor, derivative = law(x)
    error = estimate.stderr
    error = None if error is None else error / (factor + x * derivative)
    return Estimate(value, error, estimate.n)


def hop_seed(scene, hop, name, seed, what):
    """Return the seed of the streams of a ``hop``; ``name`` is the name of its scene."""
    return stream_seed(seed, f"{name} {hop} {what}", "passages", key(scene.radius))


@dataclass(frozen=True)
class TransmissionRun(Run):
    """Hops that are followed for the curve κ(t) and, if they are rare, in clusters for κ.

    The fields are the arguments of the call; ``hops`` are rounded up to whole blocks.
    """

    scene: Scene
    hop: str
    hops: int
    seed: int
    name: str | None

    def __post_init__(self):
        find_engine(self.scene).clusters.require_coefficient(self.scene, self.hop)

    @cached_property
    def _neighbours(self):
        return find_engine(self.scene).clusters.neighbours(self.scene, self.hop)

    @property
    def _gap(self):
        return quiet_time(self.scene, self.hop)

    @property
    def _times(self):
        return tuple(box_time(self.scene, self.hop) * time for time in KAPPA_TIMES)

    @cached_property
    def components(self):
        """The ``SequentialRun`` of all blocks, {"times": run}; of rare hops also "clusters"."""
        scene, hop, engine = self.scene, self.hop, find_engine(self.scene)
        given = scene, hop, stream_name(scene, self.name), self.seed
        clusters_seed, times_seed = (hop_seed(*given, what) for what in ("clusters", "times"))
        blocks = -(-self.hops // HOPS_PER_BLOCK)
        events = HOPS_PER_BLOCK * engine.rates.expected_event_rate(scene)
        work = engine.rates.work_per_event(scene) * engine.rates.chain_cost_ratio(scene)

        def clusters(first, stop):
            given = self._gap, stop - first, clusters_seed, first
            return engine.clusters.cluster_sizes(scene, hop, *given)[:1]

        def curve(first, stop):
            sums, _ = engine.clusters.hop_sums(
                scene, hop, self._times, stop - first, times_seed, first
            )
            return (sums.sum(axis=0),)

        runs = {"times": fixed(curve, blocks, self._times[-1] * events, work)}
        if are_rare(scene, hop, self._neighbours[0]):
            runs["clusters"] = fixed(clusters, blocks, 2 * self._gap * events, work)
        return runs

    def point(self, ranges):
        """Return estimates by their names in ``Transmission``, from {component: ranges}."""
        ((sums,), blocks), clusters, kappa = reached(ranges["times"]), {}, None
        sums = sums.reshape(N_HOP_SUMS, len(KAPPA_TIMES))  # raises for sums of another form
        mean, others = self._neighbours
        if "clusters" in ranges:
            (sizes,), _ = reached(ranges["clusters"])
            sizes = sizes.reshape(LARGEST_CLUSTER + 1)
            clusters = {n: int(number) for n, number in enumerate(sizes) if number}
            law = partial(odd_clusters_per_passage, others=others)
            kappa = plateau(cluster_estimate(sizes), self._gap, mean, law)
        return {
            "coefficient": kappa,
            "gap": self._gap,
            "clusters": clusters,
            "exact_mean": exact.mean_times(self.scene)[self.hop],
            "neighbour_mean": mean,
            "times": self._times,
            "curve": time_estimates(sums, blocks * HOPS_PER_BLOCK),
            "components": {name: {"sums": sums} for name, sums in ranges.items()},
        }
