"""κ with friction of the rate γ, which depends on x = γ√(εσ).

A neck of the width ε = h − 4r has the length √(εσ), and a pair forgets its velocity within it if x
is large.
"""

import math

import numpy as np

from twodiscs.dynamics.transmission import quiet_time
from twodiscs.dynamics.two.hop_clusters import cluster_sizes
from twodiscs.model.events import EVENT_AXES
from twodiscs.model.scene import Box
from twodiscs.points.estimates import Estimate
from twodiscs.theory import exact
from twodiscs_paper.studies.passages.models import plane
from twodiscs_paper.studies.passages.near import NearThreshold, affordable_blocks, scene_at
from twodiscs_paper.study import row

#: {rate of kicks: halvings of the distance}.
NECK_HALVINGS = {
    10.0: (5, 6, 8, 10, 12, 14, 16), 40.0: range(6, 17, 2), 160.0: range(8, 17, 2),
    640.0: (8, 12),
}  # fmt: skip

#: With kicks, the least time without a hop that ends a cluster, in ``box_time``. Then the work of
#: an estimate over that of others, the price of a kick in events, the fewest hops, and the blocks
#: of initial states for the rate of hops.
PAUSE, WORK, KICK_EVENTS, FEWEST_KICKED, STRIPS = 12, 4, 4, 2**9, 16

#: Necks are long from this x on: a pair forgets its velocity several times within it.
LONG_NECK = 5

#: b of ``scaling_law``. For small x one kick decides. With λ = L/ε = 1 + u²/2εσ it sends the pair
#: over u = 0 with the probability P = (1 − √(1 − λ⁻²))/2, from where the pair came with the same
#: probability. So 1 − κ = 4γ∫₀^∞ λ² P² du/⟨|u̇|⟩ = √2π x/5.
B = 4 / 3 - math.sqrt(2) * math.pi / 5

#: The next coefficient of ``scaling_law``, as κ of the limit has it: "scaling_second" of the table.
SECOND = 0.055


def one_friction(name, box, friction, halvings, events, seed):
    """Yield the rows of discs with ``friction`` at distances below h/4, the largest one first."""
    measured = []
    for n in halvings:
        scene = scene_at(box, "horizontal_hop", n, friction=friction)
        near = NearThreshold(name, scene, "horizontal_hop", n, seed)
        gap = cluster_pause(scene, near.hop)
        price = 2 * gap * (exact.event_rate(scene) + KICK_EVENTS * friction)
        blocks = affordable_blocks(WORK * events, price, FEWEST_KICKED)
        found = cluster_sizes(scene, near.hop, gap, blocks, near.cluster_seed)
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
    """Return κ x of two smooth discs between walls that diffuse: 3/4 if the neck is short."""
    reach = float(scene.reach(EVENT_AXES[hop]))
    return plane.scaled_coefficient(reach, scene.clearance(hop), scene.contact_distance)


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
            yield near.row("local_exponent", "fit", local_exponent(before, (kappa, x), -2))
        before = kappa, x


def local_exponent(before, after, power):
    """Return the exponent of τ/κ as an ``Estimate``, from two pairs (κ, x), the larger x first.

    τ goes as ε to the ``power``, and x as √ε.
    """
    (far, start), (kappa, x) = before, after
    length = math.log(start / x)
    slope = math.log(kappa.value / far.value) / length
    error = math.hypot(far.stderr / far.value, kappa.stderr / kappa.value) / length
    return Estimate(abs(slope) / 2 + power, error / 2, 2)


def scaling_law(x, limit=3 / 4):
    """Return κ of a scaled friction x: 1/κ = x/``limit`` + 1/(1 + b x + c x²), with b of ``B``.

    It is 1 for small x with the exact slope, and ``limit``/x for large x, which diffusion has.
    """
    return 1 / (x / limit + 1 / (1 + B * x + SECOND * x**2))


def scaling_fits(rows):
    """Yield b of ``scaling_law``, χ² of κ with friction from it, and the largest deviation."""
    own = [row for row in rows if row["quantity"] == "coefficient" and row["friction"]]
    if not own:
        return
    hops = [(row_scene(row), row["event"]) for row in own]
    x, limit = np.array([(scaled_friction(*hop), diffusive_limit(*hop)) for hop in hops]).T
    kappa, error = np.array([(row["estimate"], row["stderr"]) for row in own]).T
    law = scaling_law(x, limit)
    off, start = kappa / law - 1, {"event": own[0]["event"], "discs": 2, "method": "fit"}
    yield row(start, quantity="scaling_constant", estimate=B, replicas=len(own))
    chi2 = float((((kappa - law) / error) ** 2).sum())
    yield row(start, quantity="scaling_chi2", estimate=chi2, replicas=len(own))
    worst = np.abs(off).argmax()
    start |= {name: own[worst][name] for name in ("distance", "friction")}
    largest = Estimate(float(off[worst]), float(error[worst] / law[worst]), 1)
    yield row(start, largest, quantity="scaling_deviation")


def row_scene(row):
    """Return the ``Scene`` of two discs between walls of a ``row`` of passages.csv."""
    return Box(row["width"], row["height"], friction=row["friction"] or 0.0).scene(row["radius"])


def with_friction(name, box, events, seed):
    """Yield the rows of the passages of two smooth discs with friction."""
    for friction, halvings in NECK_HALVINGS.items():
        yield from one_friction(name, box, friction, halvings, events, seed)
