"""Two spheres in a cylindrical pore: their rates of events, and κ with friction.

In the neck the room across is L = ε + (u² − w²)/2σ, with w = σθ/2 for the angle θ by which the
spheres are not opposite to each other, and two slacks have the measure L²/2. Both u and w diffuse
with 1/(3γ). If Φ changes by 1 from one side to the other, ∇(L² ∇Φ) = 0, so ψ = LΦ is harmonic,
because L is: ψ = Re √(W² − 1) ε/2 with W = 1 + (u + iw)²/2εσ. The conductance is π/4, and the
resistance 64√2/(15π) √(εσ). Over the flux of transition state theory, κ x → 75π²/1024.
"""

import math
from itertools import pairwise

import numpy as np

from twodiscs.dynamics.transmission import cluster_coefficient
from twodiscs.model.seeds import stream_seed
from twodiscs.points.estimates import Estimate
from twodiscs_paper.studies.estimates import sample_mean
from twodiscs_paper.studies.passages.models import pore
from twodiscs_paper.studies.passages.near import compared, radius_at
from twodiscs_paper.studies.passages.parts.with_friction import LONG_NECK, local_exponent
from twodiscs_paper.study import row

#: The radius of the pore, and its lengths for rates and for κ: ends have a share √(εσ)/length in κ.
PORE_RADIUS, SHORT_PORE, LONG_PORE = 1.0, 3.0, 32.0

#: Radii of spheres for rates, the time and the number of independent initial states.
COUNTED_RADII, RUN_TIME, PORE_REPLICAS = (0.2, 0.4, 0.48), 16.0, 2**17

#: {rate of kicks: halvings of the distance}, and blocks of crossings for κ.
PORE_HALVINGS, PORE_BLOCKS = {1.0: (8, 12, 16), 60.0: (6, 8)}, 2**8

#: κ x where the separation and the angle diffuse.
PORE_LIMIT = 75 * math.pi**2 / 1024


def one_pore(length, sphere, friction, seed):
    """Return (its ``Pore``, the cells that its rows have in common, a seed of its streams)."""
    model, limit = pore.Pore.of(length, PORE_RADIUS, sphere), PORE_RADIUS / 2
    cells = {"scene": "pore", "width": length, "height": 2 * PORE_RADIUS, "event": "horizontal_hop"}
    cells |= {"discs": 2, "radius": sphere, "distance": 1 - sphere / limit}
    cells |= {"friction": friction or None, "exact_mean": 1 / float(pore.rates(model)[pore.HOP])}
    return model, cells, np.uint64(stream_seed(seed, f"pore {friction}", "passages", repr(sphere)))


def in_pore(seed):
    """Yield the rows of spheres in a pore: rates, κ, κ x of long necks and powers of τ/κ."""
    for sphere in COUNTED_RADII:
        model, cells, stream = one_pore(SHORT_PORE, sphere, 0.0, seed)
        counts = pore.count_events(model, 0.0, RUN_TIME, stream, PORE_REPLICAS)
        events = ("horizontal_hop", "disc_collision", "right_wall", "top_wall")
        found = zip(events, pore.rates(model).tolist(), sample_mean(counts / RUN_TIME), strict=True)
        for event, rate, one in found:
            own = {"event": event, "exact_mean": 1 / rate, "quantity": "rate", "method": "states"}
            yield row(cells | own, one, time=RUN_TIME, replicas=one.n, **compared(one, rate))
    for friction, halvings in PORE_HALVINGS.items():
        measured = []
        for n in halvings:
            model, cells, stream = one_pore(
                LONG_PORE, radius_at(PORE_RADIUS / 2, n), friction, seed
            )
            far = model.sigma
            sizes, counts = pore.cluster_sizes(model, friction, far, stream, 0, PORE_BLOCKS)
            kappa, hops = cluster_coefficient(sizes), {"replicas": int(sizes.sum())}
            x = friction * math.sqrt((2 * model.breadth - model.sigma) * model.sigma)
            own = {"method": "clusters", "events": int(counts[1:].sum())}
            yield row(cells | own | hops, kappa, quantity="coefficient")
            mean = cells["exact_mean"] / kappa.value
            time = Estimate(mean, mean * kappa.stderr / kappa.value, kappa.n)
            yield row(cells | own | hops, time, quantity="passage_time")
            if x > LONG_NECK:
                scaled = Estimate(kappa.value * x, kappa.stderr * x, kappa.n)
                limit = {"quantity": "scaled_coefficient", "reference": PORE_LIMIT}
                yield row(cells | {"method": "clusters"} | hops | limit, scaled)
            measured.append(((kappa, x), cells))
        for (before, _), (after, cells) in pairwise(measured):
            power = local_exponent(before, after, -5 / 2)
            yield row(cells, power, quantity="local_exponent", method="fit", replicas=2)
