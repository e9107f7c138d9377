"""Which hops are passages: how the hops that follow one another are correlated.

A hop is a passage if the discs do not soon hop back. Transition state theory counts every crossing
of the surface u = 0 of a hop, where u is x1 − x2 or y1 − y2. Their fate is the
reactive flux (Chandler, J. Chem. Phys. 68, 2959 (1978)),

    C(t) = 1 + 2 ⟨Σ s_0 s_k⟩,

over initial states on the surface, weighted by the flux through it: s_0 = ±1 is the direction of
the hop at time 0, s_k that of the hop at time t_k, and the sum has all with 0 < t_k ≤ t. Between
walls hops alternate in direction, and C(t) is the transmission coefficient

    κ(t) = ⟨s_0 sign u(t)⟩,    κ(0) = 1,    κ'(0⁺) = −2 p(0⁺)

with the density p of the intervals between hops. On a ring (one periodic axis) discs may pass each
other in the same direction again and again. The net number n(t) of hops, from initial states of the
invariant measure, has d⟨n²⟩/dt = Γ C(t) with the rate Γ of hops in both directions. At long times n
is a random walk. With the displacement ℓ by a hop and ν = Γ/2 hops per time in each direction,
D/(ν ℓ²) is the limit of C. It is 1 for independent hops (Machta and Zwanzig, Phys. Rev. Lett. 50,
1959 (1983)).

Rare hops come in clusters: n hops with less than a ``gap`` of time between one and the next. A
cluster of odd n is a passage, and since a random hop is in a cluster of n with a weight ∝ n,
passages per hop are

    κ = ⟨1[n odd]/n⟩

over the same initial states, each followed forwards and backwards in time. This has a far smaller
variance than κ(t) where κ is small, κ at most instead of 1.
"""

import math
from typing import NamedTuple

import numpy as np

from twodiscs.dynamics.ensemble import HOPS_PER_BLOCK, LANES, SHORT_SWEEPS
from twodiscs.dynamics.law import END_OF_TIME, WRAP_X, WRAP_Y, crosses, crossing_time
from twodiscs.dynamics.two.follow import follow, relative_motion
from twodiscs.model.checks import InputError
from twodiscs.model.events import EVENT_AXES
from twodiscs.model.scene import hopping_along
from twodiscs.sampling.initial_states import StartSampler, require_initial_states
from twodiscs.sampling.jit import inlined
from twodiscs.sampling.rejection import rejection_sampler
from twodiscs.theory import exact

#: Clusters of this many hops, or more, are in one class. It counts as even, which makes κ too small
#: by less than the fraction of hops in it over their number.
LARGEST_CLUSTER = 2**13

#: The sums at each time after a hop: n = Σ s_0 s_k, n², and N hops.
N_HOP_SUMS = 3


@inlined
def find_hop(before, after, code, axis):
    """Return (whether a flight has a hop, Δ before it, Δ̇) along an axis.

    ``axis`` is (``horizontal``, the code of a jump along it), with True for x and None for y.
    """
    horizontal, jump = axis
    apart, rising = relative_motion(before, horizontal)
    # Half a period apart the separation changes its sign without a hop.
    end = rising if code == jump else relative_motion(after, horizontal)[0]
    return crosses(apart, end), apart, rising


class NetHops(NamedTuple):
    """The experiment: sums over the hops after time 0, at each of the ascending ``times``.

    If ``hopping``, the initial states are on the surface of the hop. The hop at time 0 then has the
    direction s_0 in which they fall through it; otherwise s_0 is 1. ``sums`` are Σ n, Σ n² and Σ N
    over the replicas of each block (blocks, ``N_HOP_SUMS``, times; int64), from the replica
    ``first`` on. N is the number of hops, and n = Σ s_0 s_k.
    """

    times: np.ndarray
    hopping: bool
    axis: tuple
    falls: np.ndarray  # (lanes,), 1 if s_0 is −1, else 0
    rises: np.ndarray  # (lanes,), hops with s_k = 1 minus hops with s_k = −1
    hops: np.ndarray  # (lanes,)
    events: np.ndarray  # (lanes,), wall hits and collisions
    sums: np.ndarray
    first: int
    both_ways: bool | None = None

    def begin(self, i, state):
        """Find the direction of the hop at time 0."""
        falls = 1.0 if self.hopping and relative_motion(state, self.axis[0])[1] < 0.0 else 0.0
        # Zero counts as positive, so a hop that falls is counted after time 0: one too many.
        self.rises[i], self.hops[i], self.falls[i] = falls, -falls, falls
        return self.times[0]

    def note(self, i, before, after, code, time, left):
        """Count a hop in its direction."""
        rises, hops, events = self.rises[i], self.hops[i], self.events[i]
        hop, _, rising = find_hop(before, after, code, self.axis)
        self.rises[i] = rises + (math.copysign(1.0, rising) if hop else 0.0)
        self.hops[i] = hops + (1.0 if hop else 0.0)
        self.events[i] = events + (1.0 if code > END_OF_TIME else 0.0)
        return left

    def ended(self, i, replica, stretch):
        """Add the hops until one of the times; go on to the next one."""
        n = np.int64(self.rises[i] if self.falls[i] == 0.0 else -self.rises[i])
        block = (replica - self.first) // HOPS_PER_BLOCK
        self.sums[block, 0, stretch] += n
        self.sums[block, 1, stretch] += n * n
        self.sums[block, 2, stretch] += np.int64(self.hops[i])
        last = self.times.size - 1
        return self.times[min(stretch + 1, last)] - self.times[stretch]


class Clusters(NamedTuple):
    """The experiment: how many hops follow each other with less than a ``gap`` between them.

    The initial states are on the surface of the hop, and paths go forwards and backwards. ``sizes``
    counts the clusters by their hops (int64); its last entry takes all that are larger.
    """

    gap: float
    axis: tuple
    most: float  # hops of the last entry
    falls: np.ndarray  # (lanes,), 1 if the separation falls at time 0, else 0
    hops: np.ndarray  # (lanes,)
    events: np.ndarray  # (lanes,), wall hits and collisions
    sizes: np.ndarray
    both_ways: bool | None = True

    def begin(self, i, state):
        """Begin a cluster with the hop at time 0."""
        # Zero counts as positive, so a hop that falls will be counted: begin without it.
        falls = 1.0 if relative_motion(state, self.axis[0])[1] < 0.0 else 0.0
        self.hops[i], self.falls[i] = 1.0 - falls, falls
        return self.gap

    def note(self, i, before, after, code, time, left):
        """Count a hop, and wait for the next one for the gap."""
        hops, events = self.hops[i], self.events[i]
        hop, apart, rising = find_hop(before, after, code, self.axis)
        hops += 1.0 if hop else 0.0
        self.hops[i], self.events[i] = hops, events + (1.0 if code > END_OF_TIME else 0.0)
        left = self.gap - (time - crossing_time(apart, rising)) if hop else left
        return left if hops < self.most else 0.0

    def ended(self, i, replica, stretch):
        """Go on from the reversed initial state; after that count the cluster."""
        if stretch == 0:
            # The hop at time 0 has been counted. Reversed, it falls if it rose.
            self.hops[i] -= 1.0 - self.falls[i]
        else:
            self.sizes[min(np.int64(self.hops[i]), self.sizes.size - 1)] += 1
        return -self.gap * (1 - stretch)


# From a scene to the experiment ------------------------------------------------------------------


def require_coefficient(scene, hop):
    """Raise ``InputError`` unless the hops of a ``Scene`` can have a transmission coefficient."""
    require_initial_states(scene)
    if EVENT_AXES[hop] in scene.periodic:
        raise InputError(
            f"hop {hop!r} must be between walls for a transmission coefficient, but its axis is "
            "periodic"
        )
    if not scene.is_possible(hop):
        raise InputError(
            f"hop {hop!r} must be open for passages, but is blocked at radius {scene.radius!r}"
        )


def neighbours(scene, hop):
    """Return the mean time between two hops, and that no other pair shares a disc."""
    return exact.mean_times(scene)[hop], 0


def _axis(hop):
    return (None, WRAP_Y) if EVENT_AXES[hop] == "y" else (True, WRAP_X)


def _followed(experiment, scene, hop, blocks, seed, first, on_surface=True):
    """Follow the hops of an ``experiment`` and return the number of wall hits and collisions."""
    sampler = StartSampler(None, rejection_sampler(scene))
    if on_surface:
        sampler = StartSampler(
            None, rejection_sampler(scene, hop, 0.0), surface="xy".index(EVENT_AXES[hop])
        )
    stop, shape = first + blocks, (HOPS_PER_BLOCK, LANES, SHORT_SWEEPS)
    follow(experiment, scene, sampler, seed, first, stop, *shape)
    return int(experiment.events.sum())


def hop_sums(scene, hop, times, blocks, seed, first=0, on_surface=True):
    """Return (sums, events) of ``blocks`` blocks of ``HOPS_PER_BLOCK`` initial states each.

    ``sums`` (blocks, ``N_HOP_SUMS``, times; integers) have Σ n, Σ n² and Σ N at the ascending
    ``times``, lengths over unit speed, as in ``NetHops``. Initial states are on the surface of the
    ``hop``, weighted by the flux through it, or of the invariant measure unless ``on_surface``. The
    blocks are those from the ``first`` one on of the streams of ``seed``.
    """
    times = np.array(times, float)
    scene, hop = hopping_along(scene, hop, "x")
    sums, begin = np.zeros((blocks, N_HOP_SUMS, times.size), np.int64), first * HOPS_PER_BLOCK
    net = NetHops(times, on_surface, _axis(hop), *np.zeros((4, LANES)), sums, begin)
    return sums, _followed(net, scene, hop, blocks, seed, first, on_surface)


def cluster_sizes(scene, hop, gap, blocks, seed, first=0):
    """Return (sizes, events): how many hops are in a cluster of 0, 1, 2 … hops.

    ``sizes`` (``LARGEST_CLUSTER`` + 1 integers) are over ``blocks`` blocks of ``HOPS_PER_BLOCK``
    hops, each a random one; the last has all larger clusters. A cluster ends where no hop comes for
    a time ``gap``. Arguments are otherwise as for ``hop_sums``.
    """
    scene, hop = hopping_along(scene, hop, "x")
    most, sizes = float(LARGEST_CLUSTER), np.zeros(LARGEST_CLUSTER + 1, np.int64)
    clusters = Clusters(float(gap), _axis(hop), most, *np.zeros((3, LANES)), sizes)
    return sizes, _followed(clusters, scene, hop, blocks, seed, first)
