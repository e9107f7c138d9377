"""Equal bits: the same sums from shards, lanes and processors of any kind.

Without these tests a result could depend on who computes which blocks, in how many lanes or on
which processor, and a kernel could change and nobody would notice: another random number, another
sum, another disc in a row. Other tests compare the values with theory. After a change that is
meant, ``python tests/dynamics/test_shards.py`` renews the table of digests; say in the commit why.
"""

import csv
import os
from dataclasses import replace
from hashlib import sha256
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from commands import python
from effect_scenes import ALL, PAPER, SCENES
from marks import slow

import twodiscs as td
from twodiscs.dynamics import runs
from twodiscs.dynamics.engine import find_engine
from twodiscs.dynamics.two import strip
from twodiscs.model.events import EVENTS, HOPS
from twodiscs.model.many_geometry import CELL_DISCS
from twodiscs.model.scene import Scene
from twodiscs.sampling import montecarlo
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


# Digests ------------------------------------------------------------------------------------------


#: Scenes whose bits are in the table as well.
MORE = {
    **SCENES,
    "narrow": PAPER.with_radius(0.249),
    "upright": Scene(1.0, 1.5, 0.24),
    "three": Scene(1.5, 1.0, 0.15, discs=3),
    "many, friction": Scene(1.5, 1.0, 0.15, discs=3, friction=2.0),
    "many, ring": Scene(1.5, 1.0, 0.15, discs=4, periodic="x"),
    "many, torus": Scene(2.0, 2.0, 0.2, discs=6, periodic="xy"),
    "many, crowded": Scene(1.5, 1.0, 0.2, discs=6),
    "many, upright": Scene(0.6, 2.3, 0.18, discs=8),
    "many, cells, torus": Scene(4.0, 4.0, 0.2, discs=CELL_DISCS, periodic="xy"),
}


def intervals(scene):
    """Return the times of chains and the sums in bins, for each hop."""
    for hop in filter(scene.is_possible, HOPS):
        yield from runs.record_blocks(scene, hop, 3, 0, 2, np.ones(1, np.bool_))


def clusters(scene):
    """Return the sums of hops at two times and the sizes of clusters, for each hop."""
    follow = find_engine(scene).clusters
    for hop in filter(scene.is_possible, HOPS):
        yield from follow.hop_sums(scene, hop, (0.5, 2.0), 2, 3)
        yield from follow.cluster_sizes(scene, hop, 1.0, 2, 3)


def strips(scene):
    """Return the sums of hops that are counted in their strip."""
    for hop in strip.rare_hops(scene):
        band = strip.choose_strip(scene, hop)
        yield from strip.run_blocks(scene, hop, band, 3, 0, 2, replicas=100)


def samples(scene):
    """Return the hits of one block by each method."""
    quantities = ("volume", *(f"{event}_area" for event in scene.events))
    for make in montecarlo.samplers(scene).values():
        yield from make(scene, quantities, 0.02, 3).count(0, 1)


#: {name: numbers of a ``Scene``, a list of arrays}
NUMBERS = {
    "counts": lambda scene: counts(scene)(0, 2),
    "intervals": intervals,
    "clusters": clusters,
    "strips": strips,
    "samples": samples,
    "trajectory": lambda scene: [td.trajectory(scene, duration=3.0, seed=3).to_records()],
    "starts": lambda scene: [td.starts(scene, 20, seed=3)],
    "frames": lambda scene: [td.frames(scene, [0.5, 2.0], 5, seed=3)],
}


TABLE = Path(__file__).with_name("bits.csv")


def digest(scene, name):
    """Return the beginning of the SHA-256 of numbers of a scene, of floats with nine digits."""
    arrays = NUMBERS[name]((SCENES_BY_NAME | MORE)[scene])
    texts = (pd.DataFrame(np.ravel(array)).to_csv(float_format="%.9g") for array in arrays)
    return sha256("".join(texts).encode()).hexdigest()[:12]


with TABLE.open(newline="") as lines:
    #: {(name of a scene, name of its numbers): (half of the tests, digest)}
    BITS = {(scene, name): rest for scene, name, *rest in csv.reader(lines, delimiter=";")}


@pytest.mark.parametrize(
    ("scene", "name"), [slow(*key) if half == "slow" else key for key, (half, _) in BITS.items()]
)
def test_the_bits_are_those_of_the_table(scene, name):
    assert digest(scene, name) == BITS[scene, name][1]


@pytest.mark.slow
def test_the_bits_do_not_depend_on_the_processor(tmp_path):
    """A processor without AVX computes the same, and no kernel reads beyond its arrays."""
    generic = {"NUMBA_CPU_NAME": "generic", "NUMBA_CPU_FEATURES": ""}
    generic |= {"NUMBA_CACHE_DIR": str(tmp_path), "NUMBA_BOUNDSCHECK": "1"}
    words = "-m", "pytest", "-n", "0", "-p", "no:cacheprovider", __file__
    found = python(*words, env=os.environ | generic, cwd=Path(__file__).parents[1])
    assert found.returncode == 0, found.stdout


if __name__ == "__main__":
    with TABLE.open("w") as lines:
        for key, (half, _) in BITS.items():
            print(*key, half, digest(*key), sep=";", file=lines)
