"""The transmission coefficient of a hop: the fraction of hops that are passages, with its error."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from twodiscs.dynamics.engine import find_engine
from twodiscs.dynamics.ensemble import HOPS_PER_BLOCK
from twodiscs.dynamics.two.hop_clusters import LARGEST_CLUSTER, N_HOP_SUMS
from twodiscs.measure.result import Result, note_of_number, progress_bar
from twodiscs.model.calls import checked_call
from twodiscs.model.checks import check_choice, check_count, check_integer
from twodiscs.model.events import EVENT_AXES, HOPS
from twodiscs.model.formats import texts_with_error
from twodiscs.model.scene import Scene, check_scene
from twodiscs.model.seeds import key, stream_name, stream_seed
from twodiscs.points.base import reached
from twodiscs.points.estimates import LEAST_EVENTS, Estimate
from twodiscs.sampling.rounds import fixed, run_all_in_rounds
from twodiscs.theory import exact

if TYPE_CHECKING:
    import pandas as pd

    from twodiscs import Hop

#: A cluster ends if no hop comes for this number of ``box_time``. Hops that follow each other after
#: a tenth of that are still correlated. Hops that come later make κ too large, by about 1e-3 at a
#: distance of 2⁻⁶ from the threshold, where hops are most frequent, and by less elsewhere.
QUIET = 48

#: The most passages that may come, on average, within the time that ends a cluster, and the most
#: hops, if they come at random. Below both, κ(t) has a plateau at that time.
MOST_MERGED, MOST_IN_GAP = 0.1, 0.25

#: The times at which κ(t) is recorded, in units of ``box_time``.
TIMES = tuple(float(f"{time:.3g}") for time in np.geomspace(0.1, 10, 21))


def box_time(scene, hop):
    """Return the time that a disc of speed 1 takes across the box along the axis of a ``hop``.

    With N discs it is that across two of N equal parts of the box, at the mean speed of N discs.
    """
    axis = EVENT_AXES[hop]
    length = scene.side(axis) if axis in scene.periodic else float(scene.reach(axis))
    return length * math.sqrt(2 / scene.discs)


def quiet_time(scene, hop, times=QUIET):
    """Return the time without a ``hop`` that ends a cluster of them.

    It is a number of ``times`` the ``box_time`` t. With friction γ a separation diffuses, and is
    forgotten after about γt²/5 in the plane; the time is then at least γt²/4. With spins, which
    share the energy, both are longer.
    """
    time, own = box_time(scene, hop), scene.velocity_components / (2 * scene.discs)
    return max(times * time, own * scene.friction * time**2 / 4)


def cluster_coefficient(sizes):
    """Return the fraction of hops that are passages as an ``Estimate``, ⟨1[n odd]/n⟩.

    ``sizes`` are those of ``cluster_sizes``.
    """
    n = np.arange(sizes.size)
    odd, hops = (n % 2 == 1) & (n < sizes.size - 1), int(sizes.sum())
    mean = float((sizes[odd] / n[odd]).sum()) / hops
    square = float((sizes[odd] / n[odd] ** 2).sum()) / hops
    return Estimate(mean, math.sqrt((square - mean * mean) / hops), hops)


def with_error(estimate, *numbers):
    """Return an ``Estimate``, without its error unless each of the ``numbers`` is large enough.

    The numbers are those of independent hops with each of the results whose mix is the estimate. If
    all of them had the same result, their spread would be 0 although another result is possible.
    """
    return estimate if min(numbers) >= LEAST_EVENTS else replace(estimate, stderr=None)


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


@dataclass(frozen=True, repr=False)
class Transmission(Result):
    """The fraction of hops of one kind that are passages; ``transmission`` returns one.

    Parameters
    ----------
    scene : Scene
        The scene.
    hop : str
        "vertical_hop" or "horizontal_hop".
    coefficient : Estimate or None
        The fraction κ with its error, None if hops are so frequent that κ(t) has no plateau. The
        error is None unless at least 100 hops are passages and at least 100 are in clusters of two
        or more.
    gap : float
        The pause: the time without a hop that ends a cluster.
    clusters : dict
        {n: number of hops in clusters of n}, empty if hops are too frequent for clusters.
    exact_mean : float or None
        The mean time τ between hops, of any pair; None if no exact value is known.
    neighbour_mean : float
        The mean time between hops of two neighbours: τ for two discs. For more discs in a box it is
        (N − 1) τ, and it has an error of about one per cent if τ is not known.
    times : tuple of float
        The times of the curve.
    curve : list of Estimate
        The fractions κ(t) at these times; an error needs 100 hops that are undone by then and 100
        others.
    settings : dict, optional
        {argument: value} beside the scene.
    components : dict, optional
        The components of its run, from which it goes on.
    note : str, optional
        The difference between the work that was asked for and the work that was done.

    Examples
    --------
    >>> found = td.transmission(td.Scene(1.5, 1.0, 0.246), "horizontal_hop", 2**12, seed=1)
    >>> found.passage_time.value > found.exact_mean
    True
    """

    scene: Scene
    hop: str
    coefficient: Estimate | None
    gap: float
    clusters: dict[int, int]
    exact_mean: float | None
    neighbour_mean: float
    times: tuple[float, ...]
    curve: list[Estimate]
    settings: dict[str, object] = field(default_factory=dict)
    components: dict[str, dict] = field(default_factory=dict, compare=False)
    note: str | None = None

    kind = "transmission"

    def _again(self, settings, options):
        return run_transmission(self.scene, **settings, **options, resume_from=self.components)

    @property
    def passage_time(self) -> Estimate | None:
        """The mean time between passages τ/κ, an ``Estimate``; None without κ or an exact τ."""
        kappa, mean = self.coefficient, self.exact_mean
        if kappa is None or mean is None:
            return None
        error = None if kappa.stderr is None else mean * kappa.stderr / kappa.value**2
        return Estimate(mean / kappa.value, error, kappa.n)

    @property
    def uncorrected(self) -> float | None:
        """Odd clusters over hops, None without clusters; κ corrects it for merged passages."""
        odd = sum(hops / n for n, hops in self.clusters.items() if n % 2)
        return odd / sum(self.clusters.values()) if self.clusters else None

    def frame(self) -> pd.DataFrame:
        """Return κ(t) as a table.

        Returns
        -------
        DataFrame
            One row per time, with the columns kappa and stderr, NaN if there is no error.

        Examples
        --------
        >>> found = td.transmission(td.Scene(1.5, 1.0, 0.246), "horizontal_hop", 2**12, seed=1)
        >>> found.frame().shape
        (21, 2)
        """
        import pandas as pd

        rows = [(t, e.value, e.stderr) for t, e in zip(self.times, self.curve, strict=True)]
        frame = pd.DataFrame(rows, columns=["time", "kappa", "stderr"], dtype=float)
        return frame.set_index("time")

    def _texts(self) -> pd.DataFrame:
        """Return the texts of the printed table, one row for each quantity."""
        import pandas as pd

        name, kappa, passage = self.hop.replace("_", " "), self.coefficient, self.passage_time
        if kappa is None:
            why = f"too frequent, with a mean time of {self.neighbour_mean:.4g}; .frame() has κ(t)"
            lines = [(f"{name}s", why)]
        else:
            merged = texts_with_error(self.uncorrected, kappa.stderr)[0]
            lines = [
                (f"fraction of {name}s that are passages", str(kappa)),
                (f"if passages within {self.gap:.4g} are merged", merged),
            ]
        if passage is not None:
            exact = texts_with_error(self.exact_mean, passage.stderr)[0]
            lines += [
                ("mean time between hops, exact", exact),
                ("mean time between passages", str(passage)),
            ]
        return pd.DataFrame(lines, columns=["quantity", "value"])


def component_runs(scene, hop, mean, gap, times, blocks, name, seed):
    """Return {"times": run} for ``blocks`` of hops, and "clusters", too, if hops are rare."""
    seeds = {what: hop_seed(scene, hop, name, seed, what) for what in ("clusters", "times")}
    engine = find_engine(scene)
    events = HOPS_PER_BLOCK * engine.expected_event_rate(scene)
    work = engine.work_per_event(scene) * engine.chain_cost_ratio(scene)

    def clusters(first, stop):
        sizes, _ = engine.cluster_sizes(scene, hop, gap, stop - first, seeds["clusters"], first)
        return (sizes,)

    def curve(first, stop):
        sums, _ = engine.hop_sums(scene, hop, times, stop - first, seeds["times"], first)
        return (sums.sum(axis=0),)

    runs = {"times": fixed(curve, blocks, times[-1] * events, work)}
    if are_rare(scene, hop, mean):
        runs["clusters"] = fixed(clusters, blocks, 2 * gap * events, work)
    return runs


@checked_call
def transmission(
    scene: Scene,
    hop: Hop,
    hops: float = 2**17,
    *,
    seed: int = 1,
    name: str | None = None,
    cores: int = 1,
    progress: bool | None = None,
) -> Transmission:
    """Measure the fraction of hops of one kind that are passages, that is, not soon undone.

    Let t be the time that a disc of speed 1 takes along the box. There is a coefficient κ if hops
    are rare, at most one in 200 to 500 t. Hops count as independent after a pause of 48 t, with
    friction γ of γt²/4 or more: the time in which discs that diffuse forget their order (half as
    long again for rough discs). κ is corrected for passages that are merged, because they follow
    each other within a pause. It misses that a hop is undone after a longer pause. This makes κ
    too large by about 1e-3 for hops of this frequency, and by less for rarer hops; the error does
    not include it.

    With N > 2 discs a hop is undone by the next hop of the same pair. t is then the time that a
    disc of the mean speed takes across the room of two discs, t √(2/N) of the box, and hops are
    those of two neighbours.

    Parameters
    ----------
    scene : Scene
        The box, its discs, at most 19, and their effects.
    hop : str
        "vertical_hop" or "horizontal_hop", along an axis with walls; of more than two discs also
        along a ring.
    hops : float, default 2¹⁷
        Hops to follow, forwards and backwards in time for κ, forwards for the curve: an integer
        from 1 on. It is rounded up to whole blocks.
    seed, name, cores, progress : optional
        See ``help(twodiscs)``.

    Returns
    -------
    Transmission
        The coefficient κ, the fraction of hops that are passages, with its error; the mean time
        between passages of any pair, in time, if the rate of hops is known exactly; and the curve
        κ(t), in ``frame()``. ``more(hops=…)`` goes on from it.

    Raises
    ------
    InputError
        For a hop that is blocked; for two discs along a periodic axis, and for more across a ring;
        for 20 discs or more, or so large ones that a hop has almost no room among the others.

    Examples
    --------
    >>> rare = td.Scene(1.5, 1.0, 0.246)
    >>> 0.5 < td.transmission(rare, "horizontal_hop", 2**12, seed=1).coefficient.value < 1
    True
    """
    return run_transmission(scene, hop, hops, seed, name, cores, progress)


def run_transmission(scene, hop, hops, seed, name, cores=1, progress=None, resume_from=None):
    """Return the ``Transmission`` of ``transmission``, which goes on from ``resume_from``."""
    engine = find_engine(check_scene(scene))
    engine.require_coefficient(scene, check_choice("hop", hop, HOPS))
    blocks = -(-check_count("hops", hops, most=10**9) // HOPS_PER_BLOCK)
    seed = check_integer("seed", seed, 0)
    mean, gap = exact.mean_times(scene)[hop], quiet_time(scene, hop)
    neighbour_mean, others = engine.neighbours(scene, hop)
    times = tuple(box_time(scene, hop) * time for time in TIMES)
    given = scene, hop, neighbour_mean, gap, times, blocks, stream_name(scene, name), seed
    settings = {"hop": hop, "hops": int(hops), "seed": seed, "name": name}
    with progress_bar(progress, f"transmission r = {scene.radius:g}") as progress:
        ranges = run_all_in_rounds(component_runs(*given), progress, cores, resume_from)
    components = {name: {"sums": sums} for name, sums in ranges.items()}
    ((sums,), _), clusters, kappa = reached(ranges["times"]), {}, None
    if "clusters" in ranges:
        (sizes,), _ = reached(ranges["clusters"])
        sizes = sizes.reshape(LARGEST_CLUSTER + 1)  # raises for sums of another form
        clusters = {n: int(number) for n, number in enumerate(sizes) if number}
        law = partial(odd_clusters_per_passage, others=others)
        kappa = plateau(cluster_estimate(sizes), gap, neighbour_mean, law)
    curve = time_estimates(sums.reshape(N_HOP_SUMS, len(times)), blocks * HOPS_PER_BLOCK)
    note = note_of_number("hops", settings["hops"], blocks * HOPS_PER_BLOCK)
    return Transmission(
        scene, hop, kappa, gap, clusters, mean, neighbour_mean, times, curve, settings, components,
        note,
    )  # fmt: skip
