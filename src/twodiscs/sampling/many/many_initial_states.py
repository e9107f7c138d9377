"""Initial states of N discs, from the invariant measure: centres are drawn in one of three ways.

Velocities are uniform on a sphere. A state is a column of x of all discs, then y, u and v, of rough
discs also their spins s, as the speeds rω of their surfaces.

* ``rejection``: N centres are drawn; after an overlap all are drawn again. Exact. The acceptance is
  V/(AB)^N, and the method is used if it is at least ``LEAST_FREE_FRACTION``.
* ``channel``: in an ordered channel heights have the density (A − S)₊^N, S = Σ d. A Markov chain
  proposes them cell by cell, with weights that are not below exp(−c d). They are accepted with the
  rest of the ratio. Positions along the channel are then order statistics. Exact at every density.
* ``chain``: otherwise ``CHAIN_SWEEPS`` sweeps of trial moves of one disc at a time, which begin at
  the widest known arrangement; each state has a new chain. From ``CELL_DISCS`` discs on, event
  chains (``chains``) take their place. Not exact: tests compare its states with rejection and
  channels, if these can be used, and with chains of other lengths. If discs cannot go from one
  arrangement to another, it stays near the known one.

Counts of events may take successive states of one chain, which cost a part of a new chain. Those
states have the same law, and all that follow are closer to it. A chain of event chains goes on from
the end of the last trajectory. Neighbours in a chain are almost independent: the study of
calibration has the mean squares of scores.

The arithmetic is + − × / and √ only.
"""

import math
from functools import lru_cache
from time import monotonic
from typing import NamedTuple

import numpy as np

from twodiscs.model.many_geometry import CELL_DISCS, arrangement, is_ordered
from twodiscs.sampling.conditioned import draw_in_disc
from twodiscs.sampling.jit import compiled, inlined, optional
from twodiscs.sampling.many import chains, insertions
from twodiscs.sampling.many.cell_grid import CellGrid, make_grid
from twodiscs.sampling.many.insertions import is_free, ring_separation
from twodiscs.sampling.streams import next_bits, open_stream, signed_uniform, uniform
from twodiscs.sampling.threads import call_in_thread, draw_in_calls
from twodiscs.theory import channel

#: The least free fraction of (AB)^N for rejection, which then takes less time than a chain.
LEAST_FREE_FRACTION = 1e-3

#: Sweeps of a chain, and the least number of sizes of its moves; each is half of the one before.
CHAIN_SWEEPS, LEAST_SCALES = 4000, 8

#: The sweeps to a new state over those to the next state of a chain of roomy discs. More crowded
#: discs forget slowly where they were, so each state has a new chain; few discs have longer moves,
#: and a limit of their own. Density relaxes slowly along a box of more discs than
#: ``LONG_BOX_DISCS``.
STATE_SWEEPS, CROWDING, FEW_CROWDING, LONG_BOX_DISCS = 8, 3, 5, 32

#: Gaps between numbers that are sorted (M. Ciura, Lect. Notes Comput. Sci. 2138, 106 (2001)).
SHELL_GAPS = 1750, 701, 301, 132, 57, 23, 10, 4, 1

#: The most discs for rejection of heights in a channel: with more, too few would be accepted.
MOST_REJECTED = 64


class Cells(NamedTuple):
    """Proposals of heights in a channel with m cells across (see ``propose_heights``)."""

    ends: np.ndarray  # (m + 1,), from the middle of the channel
    weights: np.ndarray  # (m, m), of a pair of cells
    backward: np.ndarray  # (N, m): Σ over the cells of all discs that follow
    room: float  # A − (N − 1) d₀
    least: float  # d₀
    scale: float  # makes the N factors of the ratio at most 1 in the geometric mean
    turned: bool  # whether the channel is along y


class Chain(NamedTuple):
    """A chain from an arrangement (2, N), its number of sweeps, and the number of sizes of moves.

    After ``between`` more sweeps it gives the next state; if they are 0, that has a new chain. With
    a ``grid`` there are event chains: their number is ``sweeps``, their mean length ``length``.
    """

    centres: np.ndarray
    sweeps: int
    between: int
    scales: int
    length: float = 0.0
    grid: CellGrid | None = None


class Initial(NamedTuple):
    """The constants of a scene for draws of states; ``cells`` and ``chain`` may be None."""

    discs: int
    half_x: float
    half_y: float
    sigma: float
    ring_x: float | None  # the period along x, None between walls
    ring_y: float | None
    cells: Cells | None
    chain: Chain | None
    rows: int  # of a state
    spin: float | None  # √(m r²/I) of rough discs, None if smooth


@lru_cache(maxsize=1024)
def method(scene):
    """Return the method that draws the centres of a ``Scene``: "channel", "rejection" or "chain".

    A block of insertions, always the same one, gives the free fraction of (AB)^N. If discs hardly
    fit, its result is too small, maybe 0.
    """
    if is_ordered(scene) or (not scene.periodic and is_ordered(scene.turned())):
        return "channel"
    if scene.discs >= CELL_DISCS:
        return "chain"
    return "rejection" if insertions.free_fraction(scene) >= LEAST_FREE_FRACTION else "chain"


def make_initial(scene, by=None, *, contacts=0):
    """Return the ``Initial`` of a ``Scene``, by its ``method`` unless another one is named.

    Each state has a new chain, unless a number of ``contacts`` is given, the most of each disc on
    the way to the next state of ``CELL_DISCS`` discs or more in a square.
    """
    by = by or method(scene)
    return Initial(
        scene.discs, scene.range_x / 2, scene.range_y / 2, scene.contact_distance,
        *insertions.periods(scene),
        _cells(scene) if by == "channel" else None,
        _chain(scene, contacts) if by == "chain" or scene.discs > MOST_REJECTED else None,
        (4 if scene.moment_of_inertia is None else 5) * scene.discs, spin_factor(scene),
    )  # fmt: skip


def spin_factor(scene):
    """Return √(m r²/I) of the rough discs of a ``Scene``, None if they are smooth."""
    return None if scene.moment_of_inertia is None else 1 / math.sqrt(scene.moment_of_inertia)


def _chain(scene, contacts=0):
    # The smallest moves are a fraction of the free length that is left to the discs.
    tightness = max(scene.range_x, scene.range_y) / (scene.largest_radius - scene.radius)
    scales = min(62, max(LEAST_SCALES, 2 + math.frexp(tightness)[1]))
    centres, grid = np.array(arrangement(scene)).T.copy(), large_grid(scene)
    if grid is None:
        between = _between(scene, CHAIN_SWEEPS // 2) if contacts else 0
        return Chain(centres, CHAIN_SWEEPS, between, scales)
    number, length = chains.plan(scene)
    aspect = max(scene.width, scene.height) / min(scene.width, scene.height)
    most = contacts * aspect**2 * scene.discs / chains.CONTACTS_PER_CHAIN
    between = _between(scene, number, most) if contacts else 0
    return Chain(centres, number, between, scales, _rounded(length), grid)


def _between(scene, sweeps, most=math.inf):
    """Return the part of the ``sweeps`` to the next state of a chain; 0 if discs are crowded."""
    limit = CROWDING if scene.discs >= CELL_DISCS else FEW_CROWDING
    along = max(scene.width, scene.height) * math.sqrt(scene.discs / (scene.width * scene.height))
    crowding = chains.crowding(scene)
    share = crowding / STATE_SWEEPS * max(1.0, along / LONG_BOX_DISCS) ** 2
    between = math.ceil(min(share * sweeps, most))
    return between if crowding <= limit and between < sweeps else 0


def large_grid(scene):
    """Return the ``CellGrid`` of a ``Scene`` of at least ``CELL_DISCS`` discs; None for fewer."""
    return make_grid(scene) if scene.discs >= CELL_DISCS else None


def _rounded(value):
    """Return ``value`` with 30 binary digits: the same on every machine."""
    mantissa, exponent = math.frexp(value)
    return math.ldexp(round(math.ldexp(mantissa, 30)), exponent - 30)


def _cells(scene):
    turned = not is_ordered(scene)
    scene = scene.turned() if turned else scene
    known = channel.make_channel(scene)
    n, b, room = scene.discs, scene.range_y, known.room
    tilt = _rounded(channel.saddle(known)[0])
    # d − d₀ grows by B/d₀ for a length off a corner at most. Over all discs the weights of cells
    # are then some e² above those of heights; far off, cells may be wider.
    steepest = b / known.least
    fine = 2 / (n * tilt * steepest)
    ends, width = [0.0], fine
    while ends[-1] < b / 2:
        width = fine if ends[-1] * tilt * steepest < 4 else 1.15 * width
        ends.append(ends[-1] + min(width, b / 24))
    # From the wall to the middle, scaled to half of the height.
    ends = [end / ends[-1] * b / 2 for end in ends]
    ends = np.array([end - b / 2 for end in ends] + [b / 2 - end for end in reversed(ends[:-1])])
    # (room − x)^N ≤ (N/c)^N e^{c (room − x) − N}, c the tilt. ``bound`` is the N-th root at x = 0.
    bound = _rounded(n / tilt * math.exp(tilt * room / n - 1))
    cells = len(ends) - 1
    weights, backward = np.empty((cells, cells)), np.ones((n, cells))
    sizes = scene.contact_distance, b, known.least
    call_in_thread(fill_cells, ends, tilt, *sizes, weights, backward)
    return Cells(ends, weights, backward, room, known.least, (1 - 2.0**-20) / bound, turned)


@compiled
def fill_cells(ends, tilt, sigma, height, least, weights, backward):
    """Fill ``weights`` (m, m) and ``backward`` (N, m), whose last row is 1."""
    cells, discs = weights.shape[0], backward.shape[0]
    for k in range(cells):
        for l in range(cells):
            # Two cells have the least d at their far ends.
            far = max(ends[k + 1] - ends[l], ends[l + 1] - ends[k])
            z = tilt * excess(far, sigma, height, least)
            # The weight is (1 + z/64)^(−64), which is not below exp(−z).
            weight = 1.0 / (1.0 + z / 64)
            for _ in range(6):
                weight *= weight
            weights[k, l] = weight
    for i in range(discs - 2, -1, -1):
        largest = 0.0
        for k in range(cells):
            total = 0.0
            for l in range(cells):
                total += weights[k, l] * (ends[l + 1] - ends[l]) * backward[i + 1, l]
            backward[i, k] = total
            largest = max(largest, total)
        for k in range(cells):
            backward[i, k] /= largest


@inlined
def excess(separation, sigma, height, least):
    """Return d − d₀ of two discs whose heights differ by ``separation`` ≥ 0."""
    d = math.sqrt((sigma - separation) * (sigma + separation))
    return (height - separation) * (height + separation) / (d + least)


# Velocities --------------------------------------------------------------------------------------


@inlined
def sort(values):
    """Sort an array in place, as D. L. Shell does (Commun. ACM 2, 30 (1959))."""
    for gap in SHELL_GAPS:
        for i in range(gap, values.size):
            value, j = values[i], i
            while j >= gap and values[j - gap] > value:
                values[j] = values[j - gap]
                j -= gap
            values[j] = value


@optional(lambda velocities, row, ring: None)
def subtract_mean(velocities, row, ring):
    """Subtract their mean from a ``row`` of ``velocities`` (2, N), along a periodic axis."""
    n, mean = velocities.shape[1], 0.0
    for i in range(n):
        mean += velocities[row, i]
    mean /= n
    for i in range(n):
        velocities[row, i] -= mean


@optional(lambda velocities, ring: None)
def scale_energy(velocities, ring):
    """Scale ``velocities`` (2, N) to the energy 1/2."""
    n, total = velocities.shape[1], 0.0
    for i in range(n):
        total += velocities[0, i] * velocities[0, i] + velocities[1, i] * velocities[1, i]
    scale = 1.0 / math.sqrt(total)
    for i in range(n):
        velocities[0, i] *= scale
        velocities[1, i] *= scale


@inlined
def keep_still(velocities, ring_x, ring_y):
    """Make the momenta along periodic axes 0, at the energy 1/2."""
    subtract_mean(velocities, 0, ring_x)
    subtract_mean(velocities, 1, ring_y)
    scale_energy(velocities, ring_y if ring_x is None else ring_x)


@optional(lambda discs, spin: (np.empty((2, discs)), np.empty(discs - 1)))
def velocity_memory(discs, spin):
    """Return arrays (velocities, cuts) for ``draw_velocities``."""
    return np.empty((2, 2 * discs)), np.empty(2 * discs - 1)


@optional(lambda velocities, ring_x, ring_y, spin: keep_still(velocities, ring_x, ring_y))
def keep_spins(velocities, ring_x, ring_y, spin):
    """Scale ``velocities`` and spins of rough discs, (2, 2N), to the energy 1/2.

    Columns from N on have a spin in their first row; the second row is not used.
    """
    n, total = velocities.shape[1] // 2, 0.0
    for i in range(n):
        total += velocities[0, i] * velocities[0, i] + velocities[1, i] * velocities[1, i]
        total += velocities[0, n + i] * velocities[0, n + i]
    scale = 1.0 / math.sqrt(total)
    for i in range(n):
        velocities[0, i] *= scale
        velocities[1, i] *= scale
        velocities[0, n + i] *= scale * spin


@optional(lambda velocities, spins, l, spin: None)
def put_spins(velocities, spins, l, spin):
    """Put the spins of rough discs into column ``l`` of ``spins`` (N, …), unless it is None."""
    for i in range(spins.shape[0]):
        spins[i, l] = velocities[0, spins.shape[0] + i]


@optional(lambda states, discs, spin: None)
def spins_in(states, discs, spin):
    """Return the spins in ``states`` (5N, …), None for smooth discs."""
    return states[4 * discs :]


@compiled
def draw_velocities(state, velocities, cuts, ring_x, ring_y, spin=None):
    """Fill ``velocities`` (2, N) uniformly on the unit sphere, without momentum on periodic axes.

    The energies of N discs in the plane are uniform on their simplex: they are the spacings of
    N − 1 sorted uniform numbers (``cuts``). All directions have the same probability. Rough discs
    are drawn as 2N discs, half of whose components are not used (``keep_spins``); their walls take
    momentum along a ring.
    """
    n = velocities.shape[1]
    for i in range(n - 1):
        cuts[i] = uniform(state)
    sort(cuts)
    for i in range(n):
        low, high = cuts[i - 1] if i > 0 else 0.0, cuts[i] if i < n - 1 else 1.0
        p, q, square = draw_in_disc(state)
        scale = math.sqrt((high - low) / square)
        velocities[0, i], velocities[1, i] = p * scale, q * scale
    keep_spins(velocities, ring_x, ring_y, spin)


# Centres -----------------------------------------------------------------------------------------


def _rejected(state, initial, centres, k, chain):
    i = 0
    while i < initial.discs:
        x, y = initial.half_x * signed_uniform(state), initial.half_y * signed_uniform(state)
        centres[0, i], centres[1, i] = x, y
        i = i + 1 if is_free(centres, i, x, y, initial, -1) else 0


def _one_by_one(state, initial, centres, sweeps, chain, grid):
    width, height = 2 * initial.half_x, 2 * initial.half_y
    for _ in range(sweeps):
        for i in range(initial.discs):
            scale = 1.0 / np.float64(1 << (next_bits(state) % np.uint64(chain.scales)))
            x = centres[0, i] + scale * width * signed_uniform(state)
            y = centres[1, i] + scale * height * signed_uniform(state)
            x, y = ring_separation(x, initial.ring_x), ring_separation(y, initial.ring_y)
            if is_free(centres, initial.discs, x, y, initial, i):
                centres[0, i], centres[1, i] = x, y


@optional(_one_by_one)
def move_discs(state, initial, centres, sweeps, chain, grid):
    """Move discs by event chains, or one by one if there is no grid."""
    chains.run_chains(state, initial, centres, sweeps, chain.length, grid)


@optional(_rejected)
def run_chain(state, initial, centres, k, chain):
    """Fill ``centres`` (2, N) by a chain of moves, or by rejection if there is no chain.

    They have the state ``k`` − 1, from which a chain may go on.
    """
    begins = k == 0 or chain.between == 0
    for i in range(initial.discs if begins else 0):
        centres[0, i], centres[1, i] = chain.centres[0, i], chain.centres[1, i]
    sweeps = chain.sweeps if begins else chain.between
    move_discs(state, initial, centres, sweeps, chain, chain.grid)


@optional(lambda chain: False)
def is_there(chain):
    """Return True if a scene has a ``Chain``."""
    return True


@optional(lambda state, initial, centres, chain: None)
def settle(state, initial, centres, chain):
    """Move the discs from their present centres, if there is a chain."""
    move_discs(state, initial, centres, chain.sweeps, chain, chain.grid)


@inlined
def chosen(state, weights, ends, backward):
    """Return a cell with a probability ∝ weight × width × backward."""
    total = 0.0
    for k in range(weights.size):
        total += weights[k] * (ends[k + 1] - ends[k]) * backward[k]
    left = total * uniform(state)
    for k in range(weights.size):
        left -= weights[k] * (ends[k + 1] - ends[k]) * backward[k]
        if left < 0.0:
            return k
    return weights.size - 1


@compiled
def propose_heights(state, cells, sigma, heights, tilted=False):
    """Fill ``heights`` (N,), from the middle of the channel; return whether they are accepted.

    Accepted heights have the density (A − S)₊^N; if ``tilted``, that of the weights of cells for
    S < A.
    """
    discs, height = heights.size, cells.ends[-1] - cells.ends[0]
    ratio, left, k = 1.0, cells.room, 0
    even = np.ones(cells.weights.shape[0])
    for i in range(discs):
        last = k
        k = chosen(state, even if i == 0 else cells.weights[k], cells.ends, cells.backward[i])
        low, high = cells.ends[k], cells.ends[k + 1]
        heights[i] = low + (high - low) * uniform(state)
        if i > 0:
            apart = abs(heights[i] - heights[i - 1])
            left -= excess(apart, sigma, height, cells.least)
            ratio /= cells.weights[last, k]
    if left <= 0.0 or tilted:
        return left > 0.0
    for _ in range(discs):
        ratio *= left * cells.scale
    return uniform(state) < ratio


def _without_cells(state, initial, centres, k, cells):
    run_chain(state, initial, centres, k, initial.chain)


@optional(_without_cells)
def draw_centres(state, initial, centres, k, cells):
    """Fill ``centres`` (2, N) by the method of the channel if there is one, else by the others."""
    along, across = (1, 0) if cells.turned else (0, 1)
    half = initial.half_y if cells.turned else initial.half_x
    heights, order = centres[across], centres[along]
    while not propose_heights(state, cells, initial.sigma, heights, is_there(initial.chain)):
        pass
    taken = 0.0
    for i in range(1, initial.discs):
        apart = heights[i] - heights[i - 1]
        taken += math.sqrt((initial.sigma - apart) * (initial.sigma + apart))
    for i in range(initial.discs):
        order[i] = uniform(state)
    sort(order)
    free, passed = 2 * half - taken, 0.0
    for i in range(initial.discs):
        if i > 0:
            apart = heights[i] - heights[i - 1]
            passed += math.sqrt((initial.sigma - apart) * (initial.sigma + apart))
        order[i] = min(passed + free * order[i] - half, half)
    settle(state, initial, centres, initial.chain)


@inlined
def put_state(states, k, centres, velocities, spin):
    """Put ``centres`` and ``velocities``, and the spins of rough discs, into column ``k``."""
    n = centres.shape[1]
    for i in range(n):
        states[i, k], states[n + i, k] = centres[0, i], centres[1, i]
        states[2 * n + i, k], states[3 * n + i, k] = velocities[0, i], velocities[1, i]
    put_spins(velocities, spins_in(states, n, spin), k, spin)


@compiled
def draw_states(state, initial, states, first=0):
    """Fill ``states`` (rows, number): x of all discs, then y, u, v and maybe s.

    A chain that has given ``first`` states goes on from the centres in the first column.
    """
    n = initial.discs
    centres = states[: 2 * n, 0].copy().reshape((2, n))
    velocities, cuts = velocity_memory(initial.discs, initial.spin)
    for k in range(states.shape[1]):
        draw_centres(state, initial, centres, first + k, initial.cells)
        draw_velocities(state, velocities, cuts, initial.ring_x, initial.ring_y, initial.spin)
        put_state(states, k, centres, velocities, initial.spin)


@compiled
def exchange_labels(state, states, n):
    """Permute the ``n`` discs in each column of ``states`` (rows, number) randomly."""
    for k in range(states.shape[1]):
        for i in range(n - 1, 0, -1):
            j = np.int64(next_bits(state) % np.uint64(i + 1))
            for row, other in ((i, j), (n + i, n + j)):
                states[row, k], states[other, k] = states[other, k], states[row, k]


def labelled(scene, number, seed, block=0, progress=None):
    """Return ``states`` with randomly permuted labels of the discs.

    In a channel the discs are in order, and a chain may not get far from its first order. The sum
    over all discs does not depend on labels, but one disc does. Labels have a separate stream, so
    that the first states do not depend on their number. ``progress``, if given, is called
    repeatedly with the number of drawn states (None: as before), and ``number``.
    """
    initial = make_initial(scene)
    filled = np.zeros((initial.rows, number))
    seeds = np.uint64(seed), ~np.uint64(seed)
    stream, labels = (call_in_thread(open_stream, each, block) for each in seeds)
    seconds = 0.0

    def fill(first, stop):
        nonlocal seconds
        begin, some = monotonic(), np.zeros((initial.rows, stop - first))
        draw_states(stream, initial, some)
        if method(scene) != "rejection":
            exchange_labels(labels, some, scene.discs)
        filled[:, first:stop] = some
        seconds = monotonic() - begin
        return stop

    def calls():
        # A state may take a microsecond or a tenth of a second: calls grow while they are short.
        first, step = 0, 1
        while first < number:
            yield first, min(first + step, number)
            first, step = first + step, step if seconds > 0.05 else 2 * step

    draw_in_calls(fill, calls(), number, progress)
    return filled


def states(scene, number, seed, block=0, by=None):
    """Return ``number`` states of the invariant measure of a ``Scene``, columns of (rows, number).

    They are the first states of the stream of ``seed`` for ``block``.
    """
    return block_states(make_initial(scene, by), number, seed, block)


def block_states(initial, number, seed, block):
    """Return ``number`` states that an ``Initial`` draws from the stream of a ``block``."""
    states = np.zeros((initial.rows, number))
    draw_states(open_stream(np.uint64(seed), block), initial, states)
    return states
