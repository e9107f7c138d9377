"""Rejection sampling of the volume and, by thin shells, of the surfaces of configuration space.

Centres are drawn uniformly in the prism. A sample without overlap belongs to the volume. If it is
also within ε of a surface, it belongs to the surface's shell. The thickness of a shell is along the
normal in configuration space; the surface is g = 0 with |∇g| = 1:

    vertical hop     |y1 − y2|/√2 ≤ ε, from both sides        horizontal hop  likewise in x
    disc collision   0 ≤ (|Δx| − σ)/√2 ≤ ε                    right wall      0 ≤ a − x1 ≤ ε
                                                              top wall        0 ≤ b − y1 ≤ ε

A shell of finite thickness is biased; ``exact.shell_expectation`` is its exact expectation. If the
discs overlap in almost all of the prism, draws are ``conditioned`` instead of ``prism_sampler``.
``MonteCarloRun`` chooses between them.

A coordinate is one of 2³² equidistant values, the grains. Two coordinates come from one draw of 64
bits, and their difference is an integer. The grains change a probability by some 2⁻³² of the prism,
far below the error of any number of samples that can be drawn.

Scenes with effects are sampled one draw at a time (``weighted_blocks``). The weight of the
invariant measure is the probability that a sample counts, so errors are binomial here too. The
thickness is in the metric of the masses, as in ``weighted.shell_expectation``.
"""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from twodiscs.model.checks import check_choice
from twodiscs.model.events import DECLARED_EVENTS, EVENTS, SHELL_EVENTS, WALLS, by_kind, facts
from twodiscs.model.scene import Scene
from twodiscs.model.seeds import job_seed
from twodiscs.points.monte_carlo_point import MonteCarloPoint
from twodiscs.sampling.conditioned import conditioned_sampler, propose_separation
from twodiscs.sampling.initial_states import require_free_fraction
from twodiscs.sampling.jit import compiled, inlined, optional
from twodiscs.sampling.rejection import (
    kinetic_fraction,
    power_chance,
    propose_in_prism,
    rejection_sampler,
)
from twodiscs.sampling.rounds import FIRST_ROUND, Run, Sampler, SequentialRun, fixed
from twodiscs.sampling.streams import GOLDEN, next_bits, open_stream, splitmix, uniform
from twodiscs.theory import exact

#: Random generators of a block, one a lane of the kernel. The bits depend on their number.
GENERATORS = 64

#: Samples of the prism with one random stream: 2¹⁴ of each generator.
SAMPLES_PER_BLOCK = GENERATORS << 14

#: Samples of a generator between two readings of its packed counts, eight fields of eight bits.
SAMPLES_PER_READING = 128

#: Proposals of the conditioned sampler with one random stream.
PROPOSALS_PER_BLOCK = 1 << 16

#: The time of a proposal, or of a sample in a scene with effects, over the time of a sample of the
#: prism, roughly.
PROPOSAL_TIME = 64
WEIGHTED_SAMPLE_TIME = 40

#: Samples of the prism in about a day, the most without a budget.
DAY_OF_SAMPLES = 86400 * 10**9


# Plain scenes -----------------------------------------------------------------------------------


#: The counts: of the volume, of each shell, and of the samples in both the right and the top shell.
#: An integer of 64 bits has eight fields of eight bits.
N_FIELDS = 2 + len(SHELL_EVENTS)
if N_FIELDS > 8:
    raise TypeError(f"sampling/montecarlo.py has room for 6 shells, not for {len(SHELL_EVENTS)}")

# Whether a sample without overlap is in a shell: functions of the squares of the separations and of
# the distance, of the centre of disc 1, and of the ends of all shells.


def _hop_shell(event):
    row, k = SHELL_EVENTS.index(event.name), "xy".index(event.axis)
    return lambda squares, square, centre, ends: squares[k] <= ends[row]


def _collision_shell(event):
    row = SHELL_EVENTS.index(event.name)
    return lambda squares, square, centre, ends: square <= ends[row]


def _wall_shell(event):
    row, k = SHELL_EVENTS.index(event.name), "xy".index(event.axis)
    if event.side > 0:
        return lambda squares, square, centre, ends: centre[k] >= ends[row]
    return lambda squares, square, centre, ends: centre[k] <= ends[row]


SHELL_TESTS = by_kind(
    "sampling/montecarlo.py",
    {"hop": _hop_shell, "collision": _collision_shell, "wall": _wall_shell},
    SHELL_EVENTS,
)


def _and(add, unit, in_shell):
    """Return ``add`` extended by one shell: a ``unit`` is added for a sample ``in_shell``."""

    @inlined
    def add_all(count, squares, square, centre, ends):
        count = add(count, squares, square, centre, ends)
        return count + (unit if in_shell(squares, square, centre, ends) else 0)

    return add_all


in_shells = inlined(lambda count, squares, square, centre, ends: count)
for field, event in enumerate(SHELL_EVENTS, 1):
    in_shells = _and(in_shells, 256**field, inlined(SHELL_TESTS[event]))
WALL_BITS = 8 * (1 + SHELL_EVENTS.index("right_wall")), 8 * (1 + SHELL_EVENTS.index("top_wall"))


@inlined
def pack_sets(squares, square, centre, ends):
    """Return the sets of a sample: an integer with a field of eight bits, 0 or 1, for each set."""
    sets = in_shells(1, squares, square, centre, ends)
    return sets + (((sets >> WALL_BITS[0]) & (sets >> WALL_BITS[1]) & 1) << (8 * (N_FIELDS - 1)))


def shell_ends(epsilon, collision, wall):
    """Return the ends of shells of thicknesses ``epsilon``, in the order of ``SHELL_EVENTS``.

    ``collision`` returns the square of the distance at which a shell of disc collisions of this
    thickness ends. ``wall`` returns the coordinate at which the shell of an axis and side begins.
    """
    makers = {
        "hop": lambda event, thick: 2.0 * (thick * thick),
        "collision": lambda event, thick: collision(math.sqrt(2.0) * thick),
        "wall": lambda event, thick: wall(event.axis, event.side, thick),
    }
    events = map(DECLARED_EVENTS.get, SHELL_EVENTS)
    return tuple(makers[e.kind](e, thick) for e, thick in zip(events, epsilon, strict=True))


@compiled
def sample_blocks(seed, first, stop, range_x, range_y, sigma, ends, areas):
    """Count the samples of blocks ``first`` … ``stop`` − 1 that fall into each set.

    ``ends`` are the ends of the shells, with coordinates in grains. Returns int64 counts: volume,
    shells in the order of ``SHELL_EVENTS``, right and top together. ``areas`` is True, or None if
    only the volume is asked for: the shells are then not compiled.
    """
    s0, s1 = np.empty(GENERATORS, np.uint64), np.empty(GENERATORS, np.uint64)
    packed, totals = np.zeros(GENERATORS, np.int64), np.zeros(N_FIELDS, np.int64)
    unit_x, unit_y = range_x * 2.0**-32, range_y * 2.0**-32
    inner = sigma * sigma
    mask = np.uint64(0xFFFFFFFF)
    for block in range(first, stop):
        counter = open_stream(seed, block)[0]
        for i in range(GENERATORS):
            counter += GOLDEN
            s0[i] = splitmix(counter)
            counter += GOLDEN
            s1[i] = splitmix(counter) | np.uint64(1)
        for _ in range(SAMPLES_PER_BLOCK // GENERATORS // SAMPLES_PER_READING):
            for _ in range(SAMPLES_PER_READING):
                for i in range(GENERATORS):
                    # xoroshiro128+ (Blackman and Vigna 2021), twice.
                    a, b = s0[i], s1[i]
                    bits_x = a + b
                    b ^= a
                    a = ((a << np.uint64(24)) | (a >> np.uint64(40))) ^ b ^ (b << np.uint64(16))
                    b = (b << np.uint64(37)) | (b >> np.uint64(27))
                    bits_y = a + b
                    b ^= a
                    s0[i] = ((a << np.uint64(24)) | (a >> np.uint64(40))) ^ b ^ (b << np.uint64(16))
                    s1[i] = (b << np.uint64(37)) | (b >> np.uint64(27))
                    grain_x = np.int64(bits_x >> np.uint64(32))
                    grain_y = np.int64(bits_y >> np.uint64(32))
                    u = np.float64(grain_x - np.int64(bits_x & mask)) * unit_x
                    v = np.float64(grain_y - np.int64(bits_y & mask)) * unit_y
                    uu, vv = u * u, v * v
                    square = uu + vv
                    count = 1
                    if areas is not None:
                        count = pack_sets((uu, vv), square, (grain_x, grain_y), ends)
                    packed[i] += count if square >= inner else 0
            for i in range(GENERATORS):
                for e in range(N_FIELDS):
                    totals[e] += (packed[i] >> (8 * e)) & 255
                packed[i] = 0
    return totals


def shell_thickness(scene, event, fraction):
    """Return ε for the shell of ``event``: a ``fraction`` of the radius, or of the room if smaller.

    The room is the difference between the radius and the radius at which the surface vanishes: the
    largest radius, or for a hop w/4 or h/4. Beyond it a hop's surface and shell are empty. If the
    box is more than twice as long as wide, the discs can move along it up to the largest radius.
    The room of collisions and of the walls at the far ends is then long − 4r.

    With effects ε is a fraction of the smaller radius or of the room, in the metric of the lightest
    disc. The shell is then no thicker than this anywhere (√2 of it for the separation of two discs)
    and stays inside the box. The room is the distance to the largest radius or, for a hop, the
    largest gap between the discs when they pass each other.
    """
    room, smallest = SHELL_ROOMS[event](scene), min(scene.radii)
    lightest = scene.masses[0] if event in WALLS else min(scene.masses)
    length = min(smallest, room) if room > 0 else smallest
    return fraction * (math.sqrt(lightest) * length)


def _hop_room(event):
    def room(scene):
        if scene.is_plain:
            return abs(scene.blocking_radius(event.name) - scene.radius)
        across = sum(scene.reach(axis) ** 2 for axis in scene.axes if axis != event.axis)
        return abs(math.sqrt(across) - scene.contact_distance)

    return room


def _room_along(scene, side):
    """Return the room of discs at the ends of a ``side``, or None for any side."""
    long, short = max(scene.sides), min(scene.sides)
    if scene.is_plain and side == long > 2 * short:
        return long - 4 * scene.radius
    return abs(scene.largest_radius - scene.radius)


#: {event: room of ``shell_thickness``}, functions of a ``Scene``
SHELL_ROOMS = by_kind(
    "sampling/montecarlo.py",
    {
        "hop": _hop_room,
        "collision": lambda event: lambda scene: _room_along(scene, max(scene.sides)),
        "wall": lambda event: lambda scene: _room_along(scene, scene.side(event.axis)),
        "walls": lambda event: lambda scene: _room_along(scene, None),
    },
)

#: {event: measure of the prism over that of a sample}, functions of a ``Scene``: a hop's shell has
#: two sides, and for all walls a sample looks at one disc and one of its walls.
SAMPLE_MEASURES = facts(
    "sampling/montecarlo.py",
    hop=lambda scene: 1 / 2,
    collision=lambda scene: 1,
    wall=lambda scene: 1,
    walls=lambda scene: 4 * len(scene.walled),
)


def prism_sampler(scene, quantities, shell, seed):
    """Return the ``Sampler`` of a plain scene by rejection from the prism.

    ``quantities`` is a list of ``"volume"`` and ``"<event>_area"``; ``shell`` sets the thickness of
    the shells (``shell_thickness``); ``seed`` is an integer ≥ 0. The area of all walls needs no
    shell: it follows from the areas at the right and at the top.
    """
    wanted, epsilon = _shells(scene, quantities, shell)
    sigma, ranges = scene.contact_distance, {"x": scene.range_x, "y": scene.range_y}

    def first_grain(axis, side, thick):
        """Return the first grain in the shell of a wall, for a wall at the low side the last."""
        first = math.ceil((1.0 - thick / ranges[axis]) * 2.0**32 - 0.5)
        return first if side > 0 else 2**32 - 1 - first

    ends = shell_ends(epsilon, lambda thick: (sigma + thick) * (sigma + thick), first_grain)
    arguments = *ranges.values(), sigma, ends, True if any(epsilon) else None
    prism = (scene.range_x * scene.range_y) ** 2
    return _sampler(
        scene, seed, wanted, epsilon, SAMPLES_PER_BLOCK, prism, sample_blocks, arguments
    )


def _shelled(scene):
    """Return the events that Monte Carlo samples by a shell, in the order of its counts."""
    return SHELL_EVENTS if scene.is_plain else EVENTS


def _shells(scene, quantities, shell):
    """Return (the set of "volume" and events to sample, ε for each event with a shell or 0)."""
    wanted = {quantity.removesuffix("_area") for quantity in quantities}
    if "any_wall" in wanted and "any_wall" not in _shelled(scene):
        wanted |= {"right_wall", "top_wall"}
    thickness = [shell_thickness(scene, e, shell) if e in wanted else 0.0 for e in _shelled(scene)]
    return wanted, thickness


def _sampler(
    scene, seed, wanted, epsilon, block, measure, kernel, arguments, method="monte_carlo", ratio=1.0
):
    """Return a ``Sampler`` whose blocks ``kernel(seed, first, stop, *arguments)`` counts.

    A ``block`` has this number of samples; ``measure`` is the volume that they fill.
    """
    seed, sampled = np.uint64(seed), {}
    if "volume" in wanted:
        sampled["volume"] = {"place": 0, "measure": measure, "epsilon": None}
    for place, (event, thickness) in enumerate(zip(_shelled(scene), epsilon, strict=True), 1):
        if event in wanted:
            factor = SAMPLE_MEASURES[event](scene)
            sampled[f"{event}_area"] = {
                "place": place, "measure": factor * measure / thickness, "epsilon": thickness,
            }  # fmt: skip
    joined = {"right_wall", "top_wall"} <= wanted and "any_wall" not in _shelled(scene)
    both = N_FIELDS - 1 if joined else None
    constants = {"method": method, "samples": block, "quantities": sampled, "right_and_top": both}
    return Sampler(
        scene, block, lambda first, stop: kernel(seed, first, stop, *arguments), constants,
        ratio,
    )  # fmt: skip


@compiled
def propose_blocks(seed, first, stop, sampler, ends):
    """Count the proposals of blocks ``first`` … ``stop`` − 1 that fall into each set.

    The counts are those of ``sample_blocks``; ``sampler`` is the ``ConditionedSampler`` of a scene.
    The proposals give distances from the walls and from contact, so that shells keep their
    thickness if the discs hardly fit. ``ends`` are ends of |Δx|² − σ² for collisions and of −1
    times the distance from the far wall.
    """
    totals = np.zeros(N_FIELDS, np.int64)
    for block in range(first, stop):
        state = open_stream(seed, block)
        for _ in range(PROPOSALS_PER_BLOCK):
            accepted, corner_x, corner_y, u, excess = propose_separation(state, sampler)
            if not accepted:
                continue
            v = sampler.range_y - corner_y
            bits = next_bits(state)
            # Disc 1 has a random part of the free length, plus the separation if it is farther.
            to_right = corner_x * uniform(state)
            to_right += u if bits & np.uint64(1 << 62) else 0.0
            to_top = corner_y * uniform(state)
            to_top += v if bits & np.uint64(1 << 61) else 0.0
            sets = pack_sets((u * u, v * v), excess, (-to_right, -to_top), ends)
            for e in range(N_FIELDS):
                totals[e] += (sets >> (8 * e)) & 255
    return totals


def conditioned(scene, quantities, shell, seed):
    """Return the ``Sampler`` of a plain scene by draws of separations at which the discs fit.

    It is for radii at which the discs overlap in almost all of the prism. At any radius, up to the
    largest one, at least a quarter of the proposals is accepted. A proposal is a sample of a set
    whose volume, twice ``ConditionedSampler.mass``, is known. Points therefore have the same form
    as ``prism_sampler``, for the same arguments, and the errors are binomial too. A sample takes
    some forty times the time of a sample of the prism. If a few per cent of the prism are free,
    sampling in the prism is therefore better.
    """
    wanted, epsilon = _shells(scene, quantities, shell)
    separations, sigma = conditioned_sampler(scene), scene.contact_distance
    ranges = {"x": scene.range_x, "y": scene.range_y}
    ends = shell_ends(
        epsilon,
        lambda thick: thick * (2.0 * sigma + thick),
        lambda axis, side, thick: -thick if side > 0 else thick - ranges[axis],
    )
    return _sampler(
        scene, seed, wanted, epsilon, PROPOSALS_PER_BLOCK, 2 * separations.mass, propose_blocks,
        (separations, ends), "conditioned", PROPOSAL_TIME,
    )  # fmt: skip


# Scenes with effects ----------------------------------------------------------------------------


# Whether a sample is in a shell: functions of the random state, the prism, the centre of disc 1,
# the separation, and the end of the shell. If the end is None, the shell is not compiled.


def _weighted_hop(event):
    k = "xy".index(event.axis)
    return lambda state, prism, centre, apart, end: abs(apart[k]) <= end


def _weighted_collision(event):
    return lambda state, prism, centre, apart, end: (
        apart[0] * apart[0] + apart[1] * apart[1] + apart[2] * apart[2] <= end
    )


def _weighted_wall(event):
    k, side = "xy".index(event.axis), float(event.side)
    return lambda state, prism, centre, apart, end: prism.half_1[k] - side * centre[k] <= end


def _hits_random_wall(state, prism, centre, separation, end):
    """Return whether a random disc is in the shell of a random wall."""
    thickness, walled = end
    pick = int(4 * len(walled) * uniform(state))
    axis, first = walled[pick // 4], pick & 2 == 0
    q = centre[axis] if first else centre[axis] - separation[axis]
    half = prism.half_1[axis] if first else prism.half_2[axis]
    distance = half - q if pick & 1 == 0 else half + q
    return distance <= (thickness[0] if first else thickness[1])


WEIGHTED_SHELL_TESTS = by_kind(
    "sampling/montecarlo.py",
    {
        "hop": _weighted_hop,
        "collision": _weighted_collision,
        "wall": _weighted_wall,
        "walls": lambda event: _hits_random_wall,
    },
)


def weighted_ends(scene, epsilon):
    """Return the ends of the shells of a ``Scene`` for thicknesses ε, 0 for shells left out.

    Both are in the order of ``EVENTS``. The result is None if there is no shell.
    """
    if not any(epsilon):
        return None
    walled = tuple("xyz".index(axis) for axis in scene.walled)

    def outer(thick):
        end = scene.contact_distance + scene.fastest * thick
        return end * end

    makers = {
        "hop": lambda thick: scene.fastest * thick,
        "collision": outer,
        "wall": lambda thick: thick,
        "walls": lambda thick: (tuple(thick / math.sqrt(m) for m in scene.masses), walled),
    }
    kinds = (DECLARED_EVENTS[event].kind for event in EVENTS)
    return tuple(
        makers[kind](thick) if thick else None for kind, thick in zip(kinds, epsilon, strict=True)
    )


@optional(lambda state, fraction, power, weights: True)
def counted(state, fraction, power, weights):
    """Return whether a sample counts, with the probability ``fraction`` to the ``power``/2."""
    return power_chance(state, fraction, power)


def _and_weighted(count_some, k, in_shell):
    """Return ``count_some`` extended by shell ``k``, whose count is next in totals."""

    @optional(lambda totals, state, prism, centre, separation, end: None)
    def count_one(totals, state, prism, centre, separation, end):
        totals[k + 1] += in_shell(state, prism, centre, separation, end)

    @inlined
    def count_all(totals, state, prism, centre, separation, ends):
        count_some(totals, state, prism, centre, separation, ends)
        count_one(totals, state, prism, centre, separation, ends[k])

    return count_all


_count_each = inlined(lambda totals, state, prism, centre, separation, ends: None)
for k, event in enumerate(EVENTS):
    _count_each = _and_weighted(_count_each, k, inlined(WEIGHTED_SHELL_TESTS[event]))


@optional(lambda totals, state, prism, centre, separation, fraction, ends: None)
def count_shells(totals, state, prism, centre, separation, fraction, ends):
    """Count a sample of the volume in the shells that it is in, ``totals`` from 1 on.

    The weights of volume and area are powers of the kinetic fraction that differ by 1/2.
    """
    if counted(state, fraction, 1, prism.weights):
        _count_each(totals, state, prism, centre, separation, ends)


@compiled
def weighted_blocks(seed, first, stop, prism, ends):
    """Count the samples of blocks ``first`` … ``stop`` − 1 that count for each set.

    ``prism`` is the ``RejectionSampler`` of a scene with effects, ``ends`` are its
    ``weighted_ends``. Returns int64 counts: volume, then ``EVENTS``.
    """
    totals = np.zeros(1 + len(EVENTS), np.int64)
    for block in range(first, stop):
        state = open_stream(seed, block)
        for _ in range(SAMPLES_PER_BLOCK):
            x1, y1, z1, dx, dy, dz = propose_in_prism(state, prism)
            if dx * dx + dy * dy + dz * dz < prism.sigma * prism.sigma:
                continue
            fraction = kinetic_fraction(
                y1, y1 - dy, prism.half_1[1], prism.half_2[1], prism.weights
            )
            if counted(state, fraction, prism.components - 2, prism.weights):
                totals[0] += 1
                count_shells(totals, state, prism, (x1, y1, z1), (dx, dy, dz), fraction, ends)
    return totals


def weighted(scene, quantities, shell, seed):
    """Return the ``Sampler`` of a scene with effects, for the arguments of ``prism_sampler``.

    A sample without overlap counts with a probability: (1 − U/E)₊^(D/2 − 1) for the volume, and
    (1 − U/E)₊^((D − 1)/2) for each shell that it is in. All walls are a separate quantity. Each
    sample picks one disc and one wall randomly, so the measure is the volume of the prism times the
    number of pairs. A sample takes some forty times as long.
    """
    wanted, epsilon = _shells(scene, quantities, shell)
    # Configuration space has no spins: without them there is one kernel less to compile.
    prism = rejection_sampler(scene)._replace(inertia=None)
    ends, axes = weighted_ends(scene, epsilon), range(len(scene.axes))
    measure = math.prod(4 * prism.half_1[axis] * prism.half_2[axis] for axis in axes)
    return _sampler(
        scene, seed, wanted, epsilon, SAMPLES_PER_BLOCK, measure, weighted_blocks, (prism, ends),
        ratio=WEIGHTED_SAMPLE_TIME,
    )  # fmt: skip


# The choice -------------------------------------------------------------------------------------


def samplers(scene):
    """Return {method, as ``cost`` names it: function that makes a ``Sampler``} of a ``Scene``."""
    if scene.discs > 2:
        from twodiscs.sampling.many.insertions import insertion_sampler

        return {"insertions": insertion_sampler}
    if scene.effects:
        return {"rejection": weighted}
    return {"rejection": prism_sampler, "conditioned": conditioned}


@dataclass(frozen=True)
class MonteCarloRun(Run):
    """An estimate of the volume and areas of a ``Scene`` by a sampler for it, in blocks.

    The sampler is that of a ``method``, one of ``samplers``, or the best one for the scene. It is
    ``weighted`` for effects, and ``prism_sampler`` if a sample of the prism has no overlap with a
    probability of at least 1/``PROPOSAL_TIME``. Otherwise it is ``conditioned``, with the number of
    samples that takes the same time. For more than two discs it is
    ``many.insertions.insertion_sampler``, which has no shells.

    ``quantities``, ``shell`` and ``seed`` are the arguments of ``prism_sampler``, ``samples`` those
    of the prism. If a ``target`` is given, {quantity: relative error}, there are as many samples as
    the errors need, within a ``budget`` of samples of the prism, None for the work of a day.
    """

    scene: Scene
    quantities: tuple
    samples: int | None
    shell: float
    seed: int
    target: dict | None = None
    budget: int | None = None
    method: str | None = None

    def __post_init__(self):
        require_free_fraction(self.scene)

    @classmethod
    def of(cls, scene, settings):
        """Return the run of the ``settings`` of ``sample``."""
        seed = job_seed(scene, MonteCarloPoint.stage, settings["seed"], settings["name"])
        samples, error = settings.get("samples"), settings.get("error")
        target = error if isinstance(error, dict) else dict.fromkeys(settings["quantities"], error)
        more = None if error is None else target, settings.get("budget"), settings.get("method")
        return cls(scene, settings["quantities"], samples, settings["shell"], seed, *more)

    @cached_property
    def sampler(self):
        """The ``Sampler`` of the method."""
        makers = samplers(self.scene)
        few = "conditioned" in makers and exact.free_fraction(self.scene) < 1 / PROPOSAL_TIME
        best = [*makers][few]
        method = best if self.method is None else check_choice("method", self.method, makers)
        return makers[method](self.scene, self.quantities, self.shell, self.seed)

    @property
    def weight(self):
        """The samples of the prism for which each sample counts."""
        return PROPOSAL_TIME if self.sampler.constants["method"] == "conditioned" else 1

    @cached_property
    def components(self):
        """The ``SequentialRun`` of all samples, {"all": run}."""
        _, block, count, _, ratio = self.sampler

        def work(first, stop):
            return (count(first, stop),)

        def error_over_target(sums, blocks):
            point, errors = self.sampler.point({(0, blocks): sums}), []
            for quantity, target in self.target.items():
                if quantity == "volume" or self.scene.is_possible(quantity.removesuffix("_area")):
                    found = (point.sampled(quantity) or point.all_walls()).estimate
                    errors.append(found.relative_stderr / target if found else math.inf)
            return np.array(errors)

        each = block * self.weight
        if self.target is None:
            return {"all": fixed(work, -(-self.samples // each), block, ratio)}
        ratio /= self.weight
        budget = self.budget or DAY_OF_SAMPLES / ratio
        run = SequentialRun(work, error_over_target, None, each, budget, FIRST_ROUND, ratio)
        return {"all": run}

    def point(self, ranges):
        """Return the point, given {"all": {(first, stop): sums}}."""
        return self.sampler.point(ranges["all"])
