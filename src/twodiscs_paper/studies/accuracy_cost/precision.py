"""The lock-step ensemble in another precision: the gain of single precision, and its failure.

The law of ``dynamics.law`` is not written again: its source is compiled a second time, with every
constant rounded to the wanted precision. The law in double precision therefore stays as it is, bit
for bit, and the two always agree.

This engine serves comparisons only: near the largest radius, a number of 24 bits cannot resolve the
distance to it.
"""

import ast
import inspect
from functools import cache

import numpy as np

from twodiscs.dynamics import law as law_module
from twodiscs.dynamics.ensemble import LANES, PASSES, REPLICAS, put_state, state_at
from twodiscs.dynamics.two.lockstep import LOOKS
from twodiscs.model.checks import check_choice, check_integer, check_length
from twodiscs.model.scene import check_scene
from twodiscs.sampling.jit import OPTIONS, numba
from twodiscs.sampling.separations import draw_constants
from twodiscs.sampling.starts import draw_starts
from twodiscs.sampling.streams import open_stream
from twodiscs_paper.studies.accuracy_cost.scalar import ANY_WALLS, COLLISIONS, N


class _Rounded(ast.NodeTransformer):
    """Replace every floating-point constant of a source by a name: {name: constant}."""

    def __init__(self):
        self.constants = {}

    def visit_Constant(self, node):
        if not isinstance(node.value, float):
            return node
        name = f"constant_{len(self.constants)}"
        self.constants[name] = node.value
        return ast.copy_location(ast.Name(name, ast.Load()), node)


def law_in(dtype):
    """Return {name: constant or compiled function} of ``dynamics.law`` for numbers of ``dtype``."""
    rounded = _Rounded()
    tree = rounded.visit(ast.parse(inspect.getsource(law_module)))
    names = {name: dtype(value) for name, value in rounded.constants.items()}
    names["__name__"] = f"law_in_{dtype.__name__}"
    exec(compile(tree, law_module.__file__, "exec"), names)
    names |= {"NEVER": dtype(law_module.NEVER), "RESTING_SPEED": dtype(4 * np.finfo(dtype).eps)}
    return names


@cache
def kernel(dtype):
    """Return ``counting.count_blocks`` for states of ``dtype``, with sums only.

    Its arguments are seed, first, stop, replicas, lanes, duration, law, draw; the duration and the
    lengths in the ``Law`` are of ``dtype``. It returns Σ N_e (int64) in the order of
    ``COUNTED``, and the sum and sum of squares of u1² + v1² + u2² + v2² − 1 over the ends of all
    replicas. Starts are drawn in double precision and rounded.
    """
    names = law_in(dtype)
    next_event, after_event = names["next_event"], names["after_event"]
    crosses, end_of_time, disc = names["crosses"], names["END_OF_TIME"], names["DISC"]
    wall_x1, wall_y1, wall_x2, wall_y2 = (names[f"WALL_{w}"] for w in ("X1", "Y1", "X2", "Y2"))
    # The 24 bits of a single-precision number hold three counts of eight bits.
    low, middle, high, zero = dtype(1), dtype(256), dtype(65536), dtype(0)

    @numba.njit(**OPTIONS)
    def count(seed, first, stop, replicas, lanes, duration, law, draw):
        state = np.zeros((8, lanes), dtype)
        rows = (
            state[0], state[1], state[2], state[3], state[4], state[5], state[6], state[7],
        )  # fmt: skip
        remaining, busy = np.zeros(lanes, dtype), np.zeros(lanes, np.bool_)
        times, codes = np.zeros(lanes, dtype), np.zeros(lanes, dtype)
        inner, outer = np.zeros(lanes, dtype), np.zeros(lanes, dtype)
        starts, sums = np.zeros((8, replicas)), np.zeros(N, np.int64)
        gained, squared = 0.0, 0.0
        block, used, running, looks = first, replicas, 0, 0
        while True:
            for i in range(lanes):
                if remaining[i] > zero:
                    continue
                if busy[i]:
                    excess = -1.0
                    for k in range(4, 8):
                        excess += np.float64(state[k, i]) ** 2
                    gained, squared = gained + excess, squared + excess * excess
                    busy[i] = False
                    running -= 1
                if used == replicas and block < stop:
                    draw_starts(open_stream(seed, block), draw, 0, 0, starts)
                    block, used = block + 1, 0
                if used < replicas:
                    for k in range(8):
                        state[k, i] = starts[k, used]
                    remaining[i] = duration
                    used += 1
                    busy[i] = True
                    running += 1
            if running > 0:
                for _ in range(PASSES):
                    for i in range(lanes):
                        times[i], codes[i] = next_event(state_at(rows, i, law), remaining[i], law)
                    for i in range(lanes):
                        before, code, a, b = state_at(rows, i, law), codes[i], inner[i], outer[i]
                        remaining[i] -= times[i]
                        after = after_event(before, times[i], code, law)
                        put_state(rows, i, after, law)
                        a += low if crosses(before[1] - before[3], after[1] - after[3]) else zero
                        a += middle if crosses(before[0] - before[2], after[0] - after[2]) else zero
                        a += high if code == disc else zero
                        b += low if (code == wall_x1) | (code == wall_x2) else zero
                        b += middle if (code == wall_y1) | (code == wall_y2) else zero
                        b += high if code > end_of_time else zero
                        inner[i], outer[i] = a, b
            looks += 1
            if looks == LOOKS or running == 0:
                looks = 0
                for i in range(lanes):
                    first_three, last_three = np.int64(inner[i]), np.int64(outer[i])
                    inner[i], outer[i] = zero, zero
                    for e in range(3):
                        sums[e] += (first_three >> (8 * e)) & 255
                        sums[3 + e] += (last_three >> (8 * e)) & 255
            if running == 0:
                sums[ANY_WALLS] -= sums[COLLISIONS]
                return sums, gained, squared

    return count


def run_blocks(scene, seed, first, stop, duration, dtype=np.float32):
    """Count all events as ``counting.run_blocks`` does, but with states of ``dtype``.

    Returns (Σ N_e in the order of ``COUNTED``, mean and root mean square of the relative error of
    the energy at the end of a replica). Raises ``InputError`` for an invalid scene, seed or
    duration, a range without blocks, and a ``dtype`` other than numpy's float32 and float64.
    """
    check_scene(scene)
    seed, first = check_integer("seed", seed, 0), check_integer("first", first, 0)
    stop, duration = check_integer("stop", stop, first + 1), check_length("duration", duration)
    check_choice(
        "dtype", dtype.__name__ if isinstance(dtype, type) else dtype, ("float32", "float64")
    )
    sums, gained, squared = kernel(dtype)(
        np.uint64(seed), first, stop, REPLICAS, LANES, dtype(duration),
        law_module.Law(*map(dtype, law_module.law_of(scene)[:3])), draw_constants(scene),
    )  # fmt: skip
    ends = (stop - first) * REPLICAS
    return sums, gained / ends, (squared / ends) ** 0.5
