"""The cost of each effect: the speed of the engine, variant by variant, in turns.

All numbers are processor times of one core. The variants take turns, repeatedly, and their medians
are compared: if the machine slows down, all slow down. The scene is the paper's box at r = 0.2.
"""

import time
from dataclasses import replace
from functools import partial
from statistics import median

from twodiscs.dynamics import runs
from twodiscs.model.box import Box
from twodiscs.model.events import EVENTS, WALLS
from twodiscs.model.scene import Scene

SCENE = Scene(1.5, 1.0, 0.2)
REPETITIONS = 7

#: Blocks of one timed run of the lock-step ensemble.
BLOCKS = 200

#: Blocks and repetitions of a quick run.
QUICK = {"blocks": 40, "repetitions": 5}


def timed(work):
    """Return (result, processor seconds) of ``work()``."""
    start = time.process_time()
    result = work()
    return result, time.process_time() - start


def in_turns(variants, repetitions=REPETITIONS):
    """Return {name: speeds} of {name: function that returns (units, seconds)}."""
    for work in variants.values():
        work()
    speeds = {name: [] for name in variants}
    for _ in range(repetitions):
        for name, work in variants.items():
            units, seconds = work()
            speeds[name].append(units / seconds)
    return speeds


def medians(speeds):
    """Return {name: median} of {name: speeds}."""
    return {name: median(values) for name, values in speeds.items()}


def interleaved(variants, repetitions=REPETITIONS):
    """Return {name: median speed} of {name: function that returns (units, seconds)}."""
    return medians(in_turns(variants, repetitions))


def lockstep(blocks=BLOCKS, scene=SCENE, events=EVENTS):
    """Count ``events``, by default all, up to a fixed end time, with statistics by replica."""
    duration = runs.replica_duration(scene)
    counted, seconds = timed(lambda: runs.run_blocks(scene, events, 1, 0, blocks, duration))
    return runs.simulated_events(counted[0]), seconds


def compared(name, values, unit, baseline, larger_is_better=True):
    """Return the rows of a benchmark from {variant: value}, with ratios to the ``baseline``."""
    ratios = {variant: value / values[baseline] for variant, value in values.items()}
    return [
        {
            "benchmark": name,
            "variant": variant,
            "value": value,
            "unit": unit,
            "ratio": ratios[variant] if larger_is_better else 1 / ratios[variant],
        }
        for variant, value in values.items()
    ]


def rows(scenes, blocks=BLOCKS, repetitions=REPETITIONS):
    """Return the rows on events per second with the effects of ``scenes``, {name: box}.

    All events of a scene are counted. Variants without effects are ``plain`` and ``plain_walls``,
    which detects no hops.
    """
    scenes = {name: replace(SCENE, **Box(**box).effects) for name, box in scenes.items()}
    scenes = {"plain": SCENE} | scenes
    variants = {
        name: partial(lockstep, blocks, scene, scene.events) for name, scene in scenes.items()
    }
    variants["plain_walls"] = partial(lockstep, blocks, SCENE, (*WALLS, "any_wall"))
    return compared("effects", interleaved(variants, repetitions), "1/s", "plain")
