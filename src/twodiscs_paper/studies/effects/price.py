"""The cost of each effect: the speed of the engine, variant by variant, in turns.

All numbers are processor times of one core. The variants take turns, repeatedly, and their medians
are compared: if the machine slows down, all slow down. The scene is the paper's box at r = 0.2. The
variants are compared with an engine that has no effects, in a process of its own.
"""

import json
import re
import subprocess
import sys
import time
from dataclasses import replace
from functools import partial
from statistics import median

from twodiscs.dynamics import runs
from twodiscs.dynamics.engine import find_engine
from twodiscs.dynamics.two.event_counts import Counts
from twodiscs.dynamics.two.follow import compile_loop
from twodiscs.model.events import EVENTS, WALLS
from twodiscs.model.scene import Box, Scene

SCENE = Scene(1.5, 1.0, 0.2)
REPETITIONS = 7

#: Blocks of one timed run of the lock-step ensemble.
PRICE_BLOCKS = 200

#: Blocks and repetitions of a quick run.
QUICK_OPTIONS = {"blocks": 40, "repetitions": 5}

#: Effects that no scene of the study has, and all effects that discs can have together.
ADDITIONS = {
    "friction": {"friction": 5.0},
    "all effects": {
        "radius_ratio": 0.5, "mass_ratio": 2.0, "periodic": "x", "field": 0.5,
        "moment_of_inertia": 0.5, "friction": 5.0,
    },
}  # fmt: skip


def timed(work):
    """Return (result, processor seconds) of ``work()``."""
    start = time.process_time()
    result = work()
    return result, time.process_time() - start


def interleaved(variants, repetitions=REPETITIONS):
    """Return {name: median speed} of {name: function that returns (units, seconds)}."""
    for work in variants.values():
        work()
    speeds = {name: [] for name in variants}
    for _ in range(repetitions):
        for name, work in variants.items():
            units, seconds = work()
            speeds[name].append(units / seconds)
    return {name: median(values) for name, values in speeds.items()}


def lockstep(blocks=PRICE_BLOCKS, scene=SCENE, events=EVENTS):
    """Count ``events``, by default all, up to a fixed end time, with statistics by replica."""
    engine = find_engine(scene)
    duration = engine.rates.replica_duration(scene)
    run = partial(engine.counts.run_blocks, scene, events, 1, 0, duration=duration)
    run(0)  # compiles
    counted, seconds = timed(lambda: run(blocks))
    return runs.simulated_events(counted[0]), seconds


def compared(name, speeds, baseline):
    """Return the rows of a benchmark from {variant: speed}, with ratios to the ``baseline``."""
    start = {"benchmark": name, "unit": "1/s"}
    return [
        start | {"variant": variant, "value": speed, "ratio": speed / speeds[baseline]}
        for variant, speed in speeds.items()
    ]


def rows(scenes, blocks=PRICE_BLOCKS, repetitions=REPETITIONS):
    """Return the rows on events per second with the effects of ``scenes``, {name: box}.

    All events of a scene are counted. ``without_effects`` is the plain scene in an engine that has
    no effects. Variants without effects are also ``plain`` and ``plain_walls``, which detects no
    hops.
    """
    effects = {name: Box(**box).effects for name, box in scenes.items()} | ADDITIONS
    variants = {
        "without_effects": partial(result_without_effects, f"lockstep({blocks})"),
        "plain": partial(lockstep, blocks),
        "plain_walls": partial(lockstep, blocks, SCENE, (*WALLS, "any_wall")),
    }
    for name, own in effects.items():
        scene = replace(SCENE, **own)
        # Kicks are drawn lane by lane, so a block takes many times longer.
        number = blocks // 8 if scene.friction else blocks
        variants[name] = partial(lockstep, number, scene, scene.events)
    speeds = compared("effects", interleaved(variants, repetitions), "without_effects")
    counted = {"without_effects": result_without_effects("instructions(lockstep)")}
    counted |= {n: instructions(work) for n, work in variants.items() if n not in counted}
    return [row | {"instructions": counted[row["variant"]]} for row in speeds]


def result_without_effects(call):
    """Return the result of a ``call`` to a function here, in a process without effects."""
    program = (
        f"import json; from {__package__} import engine_without_effects; "
        f"from {__name__} import instructions, lockstep; print(json.dumps({call}))"
    )
    words = [sys.executable, "-c", program]
    return json.loads(subprocess.run(words, stdout=subprocess.PIPE, check=True).stdout)


def instructions(work):
    """Return the number of machine instructions of the kernel that ``work`` runs.

    Numba keeps no assembly beside compiled code, but LLVM writes it again.
    """
    compile_loop.cache_clear()
    work()
    (kernel,) = compile_loop(Counts).overloads.values()
    library = kernel.library
    module = library._get_module_for_linking()
    return len(re.findall(r"^\t[a-z]", library._codegen._tm.emit_assembly(module), re.MULTILINE))
