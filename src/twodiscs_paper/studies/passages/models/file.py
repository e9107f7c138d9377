"""A file of N discs on a ring: how far a tagged disc goes, and how often discs hop.

The ring has the same length per disc, ℓ, as the ring of two discs. In the frame of zero momentum a
disc moves along the ring by hops alone, by ℓ at each hop. If hops were uncorrelated, a disc with ν
hops per time in either direction would have D = ν ℓ². A gap for a hop is a fluctuation of the
density, so ν depends on the number of discs. It is counted in the same motion as D.

Before that, discs move with the density of the file. Its mode of the wave number q has the
correlation C(q, t), and S is the relative variance of the number of discs in a long piece. Then

    ⟨x²⟩ = (2 S ℓ/L) Σ over q ≠ 0 of (1 − C(q, t))/q²

on a ring of the length L. Smooth discs conserve momentum. Their density moves as sound of the speed
c, and ⟨x²⟩ = kT ℓ/(m c) t (1 − c t/L) without the part of C that does not move, the heat. Kicks
that draw all velocities anew at a rate γ damp the sound at constant temperature: C″ + γ C′ +
(kT/(m S)) q² C = 0. On a long ring ⟨x²⟩ becomes F √t, with F = 2 ℓ √(S kT/(π m γ)). Rough walls
take the momentum of rough discs, so they too have F √t, with an F that is not known here.
"""

import math
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from twodiscs.dynamics.ensemble import open_block_kicks
from twodiscs.dynamics.many import many_paths
from twodiscs.dynamics.many.all_pairs import HORIZONTAL_HOPS, new_kicks
from twodiscs.points.estimates import Estimate
from twodiscs.sampling.many import many_initial_states
from twodiscs.theory import channel
from twodiscs_paper.studies.estimates import sample_mean


def quotient(values, others):
    """Return ⟨``values``⟩/⟨``others``⟩ of the same replicas as an ``Estimate``.

    The error is that of the ``values`` − ratio × ``others``, so it has their correlation.
    """
    ratio, below = np.mean(values) / np.mean(others), np.mean(others)
    spread = sample_mean((np.asarray(values) - ratio * np.asarray(others)) / below)
    return Estimate(ratio, spread.stderr, spread.n)


#: The waves that S is taken from.
WAVES = 8


class Limit(NamedTuple):
    """A channel of infinitely many discs at kT = 1; all values are per disc.

    ``length`` ℓ is the mean length of the channel and ``softness`` −dℓ/dp its decrease with the
    force p. ``per_height`` is ∂lnV/∂B and ``per_contact`` −∂lnV/∂σ.
    """

    force: float
    length: float
    softness: float
    per_height: float
    per_contact: float


def limit(height, radius, force):
    """Return the ``Limit`` of discs of ``radius`` in a channel, at a ``force`` over kT.

    As N → ∞ at a given p, the force along the channel over kT, V grows by the factor λ/p for each
    disc, with the largest eigenvalue λ of T (Kofke and Post, J. Chem. Phys. 98, 4853 (1993)). The
    second derivative of ln λ is that of perturbation theory, a sum over all eigenvectors: it loses
    no digits, as a difference of lengths would.

    The force is along the channel, in 1/length. In the units of the other rates, kT is 1/D of the
    total energy 1/2, and a rate for each disc is √(kT/π) times ``per_contact`` for collisions and
    √(2 kT/π) times ``per_height`` for walls. The channel has 2r < h ≤ (2 + √3) r.
    """
    sigma, b = 2 * radius, float(Fraction(height) - 2 * Fraction(radius))
    y, weights = channel.graded_nodes(*channel.panel_sizes(b, sigma, force, 2 * force))
    apart, distance, separation, least = channel.node_pairs(b, sigma, y)
    root = np.sqrt(weights)
    kinds = np.exp(-force * apart)
    values, vectors = np.linalg.eigh(root[:, None] * (kinds[0] + kinds[1]) * root)
    psi, value = vectors[:, -1], values[-1]

    def weighted(of):
        return root[:, None] * np.sum(kinds * of, axis=0) * root

    def mean(of):
        return float(psi @ weighted(of) @ psi / value)

    excess = apart - mean(apart)
    mixed = vectors[:, :-1].T @ (weighted(excess) @ psi)
    spread = mean(excess**2) + 2 * float(np.sum(mixed**2 / (value - values[:-1])) / value)
    return Limit(
        force=force,
        length=1 / force + least + mean(apart),
        softness=1 / force**2 + spread,
        per_height=1 / b + force * mean(separation**2 / (b * distance)),
        per_contact=force * mean(sigma / distance),
    )


class Density(NamedTuple):
    """The density of a file: S, and the speed c of sound over the thermal speed √(kT/m)."""

    variance: float
    speed: float | None


def exact_density(height, radius, per_disc):
    """Return the ``Density`` of an ordered channel with a length ``per_disc``, by theory.

    With the force p over kT and the length ℓ(p) of the channel for each disc, S = −ℓ′(p)/ℓ². At
    constant entropy the discs, with two components of velocity each, have c² = ℓ² p² + 1/S.
    """

    def length(log_force):
        return limit(height, radius, math.exp(log_force)).length

    low, high = -math.log(per_disc) - 1, 20.0
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if length(middle) > per_disc else (low, middle)
    force = math.exp(low)
    variance = limit(height, radius, force).softness / per_disc**2
    return Density(variance, math.sqrt((per_disc * force) ** 2 + 1 / variance))


def measured_density(scene, places):
    """Return S as an ``Estimate``, from ``places`` (times, N, replicas) on a ring.

    S is the limit for long waves. The variances of the ``WAVES`` longest ones differ from it by a
    term in q², which is fitted.
    """
    numbers = np.arange(1, WAVES + 1)
    waves = [np.exp(2j * math.pi / scene.width * k * places).sum(axis=1) for k in numbers]
    sizes = [(np.abs(wave) ** 2).mean(axis=0) / scene.discs for wave in waves]
    return sample_mean(np.polyfit(numbers**2, sizes, 1)[1])


def thermal_speed(scene):
    """Return √(kT/m) at the total energy 1/2, which all components of velocity share."""
    return 1 / math.sqrt(scene.velocity_components)


def sound(scene, density, time):
    """Return ⟨x²⟩ of smooth discs at a ``time``, from sound alone.

    It is None once sound has gone around half of the ring: from then on it brings the discs back.
    """
    around = density.speed * thermal_speed(scene) * time / scene.width
    size = scene.width**2 / scene.discs / density.speed**2
    return size * around * (1 - around) if around <= 0.5 else None


def damped(scene, variance, friction, time):
    """Return ⟨x²⟩ at a ``time`` with kicks at the rate ``friction``, from waves of N discs."""
    n = scene.discs
    q = 2 * math.pi / scene.width * np.arange(1, n // 2 + 1)
    # The two solutions exp(−s t) of the equation for C.
    root = np.sqrt(friction**2 / 4 - (thermal_speed(scene) * q) ** 2 / variance + 0j)
    fast, slow = friction / 2 + root, friction / 2 - root
    correlation = (fast * np.exp(-slow * time) - slow * np.exp(-fast * time)) / (2 * root)
    parts = (1 - correlation.real) / q**2
    parts[-1] /= 1 + (n % 2 == 0)
    return 4 * variance / n * float(parts.sum())


@lru_cache(maxsize=8)
def _exact_density(scene):
    return exact_density(scene.height, scene.radius, scene.width / scene.discs)


def law(scene, friction, time, variance=None):
    """Return ⟨x²⟩/ℓ² at a ``time`` by theory, with kicks at the rate ``friction`` or None.

    Without a ``variance`` S the discs must be in an ordered channel, whose theory is exact. Smooth
    discs with a ``variance`` have no law: the speed of sound is not known. They also have none
    once ``sound`` comes back around the ring.
    """
    per_disc = scene.width / scene.discs
    if friction is None:
        moved = sound(scene, _exact_density(scene), time)
    else:
        moved = damped(scene, variance or _exact_density(scene).variance, friction, time)
    return moved and moved / per_disc**2


def recorded(scene, step, number, replicas, seed, friction):
    """Return the places of discs along a ring at ``number`` + 1 times, ``step`` apart, and hops.

    Places have the shape (times, N, replicas), and go on beyond the ends of the ring. Hops are how
    often a disc changed order with another one in all that time, a mean over the discs of each
    replica. If ``friction`` is given, all velocities are drawn anew at the times of a Poisson
    process of this rate.
    """
    moving = scene if friction is None else replace(scene, friction=friction)
    states, laps = (
        many_initial_states.states(scene, replicas, seed),
        np.zeros((2 * scene.discs, replicas)),
    )
    hops = np.zeros(replicas)
    places = np.empty((number + 1, scene.discs, replicas))
    places[0] = states[: scene.discs]
    kicks = open_block_kicks(new_kicks(moving, replicas), seed)
    for k in range(1, number + 1):
        many_paths.advance_all(moving, states, laps, step, kicks, hops)
        places[k] = states[: scene.discs] + scene.width * laps[: scene.discs]
    return places, 2 * hops / scene.discs


def logged(scene, step, number, replicas, seed, friction):
    """Yield (places, times, pairs) of each replica: ``recorded``, with the time of each hop.

    Places have the shape (times, N, 1). A pair is a number of two discs.
    """
    moving = scene if friction is None else replace(scene, friction=friction)
    path, n = many_paths.Followed(moving, ("horizontal_hop",)), scene.discs
    states = many_initial_states.states(scene, replicas, seed)
    for replica in range(replicas):
        path.start(states[:, replica : replica + 1], seed, replica)
        places, times, pairs = [states[:n, replica]], [], []
        for _ in range(number):
            for log, order in path.go_on(step):
                hops = order[log.classes[order] == HORIZONTAL_HOPS]
                times.append(log.times[hops])
                pairs.append(log.discs[hops].min(axis=1) * n + log.discs[hops].max(axis=1))
            places.append(path.motion.x + scene.width * path.laps[0])
        yield np.array(places)[:, :, None], np.concatenate(times), np.concatenate(pairs)


def hop_correlations(places, times, pairs, lags, until):
    """Return [hops, Σ s₀ s_k with the same disc, Σ s₀ s_k with others] over all hops of all discs.

    A disc hops in the direction s = ±1 with another one. A hop counts if it comes before the time
    ``until``, and then its later hops within each of the ascending ``lags``; sums are lists.
    ``places`` (N,) are those at the time 0; neighbours in the order of the ring exchange places.
    """
    n, ranks = places.size, np.argsort(np.argsort(places))
    discs, others = np.divmod(pairs, n)
    signs = np.empty(times.size, np.int64)
    for k, (i, j) in enumerate(zip(discs, others, strict=True)):
        signs[k] = 1 if (ranks[j] - ranks[i]) % n == 1 else -1
        ranks[i], ranks[j] = ranks[j], ranks[i]
    times, signs = np.tile(times, 2), np.append(signs, -signs)
    discs, others = np.append(discs, others), np.append(others, discs)
    by_disc = np.lexsort((times, discs))
    times, signs, discs, others = (x[by_disc] for x in (times, signs, discs, others))
    sums = np.zeros((2, len(lags) + 1), np.int64)
    for k in range(1, times.size):
        apart = times[k:] - times[:-k]
        near = (discs[k:] == discs[:-k]) & (times[:-k] < until) & (apart <= lags[-1])
        if not near.any():
            break
        places = (others[k:] != others[:-k])[near].astype(int), np.searchsorted(lags, apart[near])
        np.add.at(sums, places, (signs[k:] * signs[:-k])[near])
    return [int((times < until).sum()), *sums[:, :-1].cumsum(axis=1).tolist()]


def order(places, length):
    """Return the number of each disc in the order along a ring, not folded, at each time.

    Exchanges of neighbours change it. The mean over all discs is that at the first time.
    """
    laps = np.floor(places / length)
    ranks = np.argsort(np.argsort(places - laps * length, axis=1), axis=1)
    numbers = (ranks + places.shape[1] * laps).astype(np.int64)
    totals = numbers.sum(axis=1, keepdims=True)
    # A disc that passes the seam shifts all numbers by one.
    return numbers - (totals - totals[0]) // places.shape[1]


def ordered_places(places, numbers, length):
    """Return the places of what is first, second … in the ``order``, instead of those of discs."""
    n, found = places.shape[1], np.empty_like(places)
    np.put_along_axis(found, numbers % n, places - numbers // n * length, axis=1)
    return found


def squares(values, lags):
    """Return the mean squares of differences of ``values`` (times, N, replicas), (lags, replicas).

    A lag is a number of times. Means are over discs and all pairs of times. All discs together rest
    if they conserve their momentum. Otherwise their motion counts: in the sum over waves above it
    is the wave q = 0, without which a ring is not a piece of a long file.
    """
    return np.array([((values[lag:] - values[:-lag]) ** 2).mean(axis=(0, 1)) for lag in lags])
