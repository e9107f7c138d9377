"""Equal bits: the same sums from shards, lanes and processors of any kind.

Without these tests a result could depend on who computes which blocks, in how many lanes or on
which processor.
"""

import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from commands import python
from effect_scenes import ALL, PAPER, SCENES
from marks import slow

from twodiscs.dynamics.engine import find_engine
from twodiscs.dynamics.two import strip
from twodiscs.model.events import EVENTS
from twodiscs.model.many_geometry import CELL_DISCS
from twodiscs.model.scene import Scene
from twodiscs.sampling.many import insertions

SCENES_BY_NAME = {
    "plain": PAPER,
    "combination": SCENES["combination"],
    "friction": replace(PAPER, friction=2.0),
    "many, rough": Scene(1.5, 1.0, 0.15, discs=3, moment_of_inertia=0.5),
    "many, channel": Scene(1.6, 0.6, 0.18, discs=4),
    "many, dense": Scene(1.5, 1.0, 0.19, discs=5),
    "many, cells": Scene(15.0, 1.0, 0.1, discs=CELL_DISCS),
    "all": ALL,
    "all, friction": replace(ALL, friction=2.0),
}


def counts(scene):
    how = {"replicas": 100 if scene.discs < CELL_DISCS else 20}
    return lambda first, stop, **lanes: find_engine(scene).counts.run_blocks(
        scene, EVENTS, 3, first, stop, 8.0, **how, **lanes
    )


def of_strip(first, stop, **lanes):
    scene, hop = PAPER.with_radius(0.245), "horizontal_hop"
    band = strip.choose_strip(scene, hop)
    found, events = strip.run_blocks(scene, hop, band, 7, first, stop, replicas=100, **lanes)
    return *found, events


#: Kernels by name: functions of the first block and the one after the last.
KERNELS = {
    **{name: counts(scene) for name, scene in SCENES_BY_NAME.items()},
    "strip": of_strip,
    "insertions": lambda first, stop: insertions.run_blocks(
        SCENES_BY_NAME["many, channel"], 7, first, stop
    ),
}


#: The kernels for all effects take seconds to compile.
@pytest.mark.parametrize("name", [slow(name) if name[:3] == "all" else name for name in KERNELS])
def test_blocks_add_up_in_any_number_of_lanes(name):
    run = KERNELS[name]
    whole = run(0, 4)
    for total, *parts in zip(whole, run(0, 1), run(1, 4), strict=True):
        assert np.array_equal(total, sum(parts))
    assert not np.array_equal(run(0, 1)[0], run(1, 2)[0])
    for lanes in () if name == "insertions" else (1, 37):
        for one, same in zip(whole, run(0, 4, lanes=lanes), strict=True):
            assert np.array_equal(one, same)


BITS = """
import hashlib
from factory import sample_point
from twodiscs.dynamics import runs
from twodiscs.dynamics.many import class_counts
from twodiscs.model.events import EVENTS
from twodiscs.model.scene import Scene
from twodiscs.points.base import file_content
from twodiscs.sampling.many import many_initial_states, insertions
scene = Scene(1.5, 1.0, 0.24)
effects = {"periodic": "x", "field": 0.3, "radius_ratio": 1.2, "mass_ratio": 2.0}
bent = Scene(1.5, 1.0, 0.2, moment_of_inertia=0.4, **effects)
areas = ["volume", *(event + "_area" for event in EVENTS)]
for point in (
    runs.DynamicsRun(scene, {event: 0.02 for event in EVENTS}, 10**6, 11).run(),
    runs.IntervalsRun(scene, "vertical_hop", 1, 11).run(),
    sample_point(scene, areas, 1, 0.02, 11),
    runs.DynamicsRun(bent, {"vertical_hop": 0.02, "any_wall": 0.02}, 10**6, 11).run(),
):
    print(file_content("", {}, {}, point.components))
scenes = [Scene(1.5, 1.0, 0.15, discs=3), Scene(2.3, 0.6, 0.18, discs=8)]
scenes += [Scene(1.5, 1.0, 0.2, discs=6), Scene(1.5, 1.0, 0.15, discs=3, moment_of_inertia=0.3)]
for scene in [*scenes, Scene(1.5, 1.0, 0.15, discs=4, periodic="x")]:
    counts = class_counts.run_classes(scene, 5, 0, 1, 16.0, replicas=64)
    states = many_initial_states.states(scene, 50, 3)
    for part in (*counts, *insertions.run_blocks(scene, 5, 0, 1), states):
        print(hashlib.sha256(part.tobytes()).hexdigest())
"""


@pytest.mark.slow
def test_the_bits_do_not_depend_on_the_processor(tmp_path):
    """A processor without AVX computes the same, and no kernel reads beyond its arrays."""
    ours = os.environ | {"PYTHONPATH": str(Path(__file__).parents[1])}
    generic = {"NUMBA_CPU_NAME": "generic", "NUMBA_CPU_FEATURES": ""}
    generic |= {"NUMBA_CACHE_DIR": str(tmp_path), "NUMBA_BOUNDSCHECK": "1"}
    here, there = (
        python("-c", BITS, env=environment, check=True).stdout
        for environment in (ours, ours | generic)
    )
    assert here == there
    assert here.count("\n") == 4 + 5 * 5
