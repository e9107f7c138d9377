"""Bad input, through every door: one sentence for each mistake.

Without these tests a check could be lost, or a mistake end in a traceback instead of in one
sentence.

A sentence has the key, the value and what is allowed. In the tables, "…" stands for any text.
"""

import itertools
import os
import re
from copy import deepcopy
from pathlib import Path

import numpy as np
import pandas as pd  # noqa: F401 - for a line of CALLS
import pytest
import yaml
from commands import python, refused
from effect_scenes import PAPER
from matplotlib.figure import Figure  # noqa: F401 - for a line of CALLS

import twodiscs as td
from twodiscs import cli
from twodiscs.model import checks
from twodiscs.model.checks import InputError
from twodiscs.model.scene import Box, Scene
from twodiscs.points import estimates
from twodiscs.sampling.initial_states import components
from twodiscs.sampling.many import insertions  # noqa: F401 - for a line of CALLS
from twodiscs_paper.configuration import schema
from twodiscs_paper.configuration.model import Model
from twodiscs_paper.configuration.yaml_files import ConfigError, load, read

RING, FIELD = Scene(1.5, 1.0, 0.2, periodic="x"), Scene(1.5, 1.0, 0.2, field=0.4)
FOUR = Scene(6.0, 1.0, 0.2, discs=4, periodic="x")
DEEP = Scene(1.0, 1.0, 0.2499, field=1e3)
ROUGH, CENTRES = Scene(1.5, 1.0, 0.2, moment_of_inertia=0.4), [[0.3, 0.5], [1.2, 0.5]]
NAN, INF = np.nan, np.inf
#: Disc 2 is where the next image of disc 1 is.
ROUND_THE_RING = [-0.5, 0.0, 1.0, 0.1, 1.0, 0.0, 0.0, 0.0]
START = dict(zip(components(PAPER), (-0.5, 0.0, 0.5, 0.0, 1.0, 0.0, 0.0, 0.0), strict=True))
MOVING = [[-0.5, 0.0, 1.0, 0.0], [0.5, 0.0, 0.0, 0.0]]
LYING = {"x1": -0.4, "y1": -0.3, "u1": 0.0, "x2": 0.4, "y2": 0.1, "u2": 0.68**0.5}


def x1(start, now):
    return now["x1"]


def start(**changes):
    """Return the trajectory from a state that is right except for the ``changes``."""
    return td.trajectory(PAPER, start=[*(START | changes).values()])


def fall(**changes):
    """Return the trajectory from a state in a field, in which disc 1 lies on the floor."""
    return td.trajectory(FIELD, start=START | LYING | changes)


def from_file(scene):
    """Return the trajectory of a ``scene`` from a file of two discs of radius 0.2."""
    td.trajectory(PAPER, 1).to_xyz("src/a.xyz")
    return td.trajectory(scene, start="src/a.xyz")


def observe(function=x1, times=(1,)):
    return td.observe(PAPER, function, times)


# The tables ---------------------------------------------------------------------------------------


def rows(table):
    """Return the (input, sentence) of each line of a table; ⏎ is the end of a line of YAML."""
    return [tuple(line.replace("⏎", "\n").split(" → ")) for line in table.strip("\n").split("\n")]


def pattern(sentence):
    return re.escape(sentence).replace("…", ".*")


#: Keys of a scene: the face, the shell and the configuration say the same.
SCENES = """
discs: 1 → discs must be an integer from 2 to 16384, not 1
discs: 16385 → discs must be an integer from 2 to 16384, not 16385
discs: 3, field: 1 → field must be left out with 3 discs
discs: 3, depth: 1 → depth must be left out with 3 discs
discs: 3, periodic: xy, moment_of_inertia: 0.5 → moment_of_inertia must be left out in a box without
discs: 3, radius: 0.26, periodic: xy → radius 0.26 does not fit: 3 discs in a box of 1.5 × 1.0 need
discs: 20, radius: 0.2 → 20 discs in a box of 1.5 × 1.0 need a radius below 0.136
radius: 0.5 → radius 0.5 does not fit: … need a radius below 0.3839745962155614
height: 1.0e+99 → height must … between 1e-60 and 1e60, not 1
field: 1.0e-70 → field must lie between 1e-60 and 1e60, not 1e-70
field: -0.3 → field must be …, the uniform acceleration along −y, not -0.3
field: 1, periodic: y → field must be 0 if y is periodic
field: 100, radius: 0.38 → field 100.0 is too strong at radius 0.38
field: 1, mass_ratio: 2, radius: 0.378 → radius 0.378 is too large: … here below radius 0.375
width: 3, field: 5, radius_ratio: 1.5, mass_ratio: 3, radius: 0.21 → … here below radius 0.2
width: 3, field: 5, radius_ratio: 0.75, mass_ratio: 3, radius: 0.21 → … here below radius 0.13333
periodic: z → periodic must be some of the axes x and y (z needs a depth), each once
depth: 1, moment_of_inertia: 0.4 → moment_of_inertia must be left out in a box with a depth
"""

#: Calls of the face.
CALLS = """
Scene(1.5, 1, 0.1, depth=1e50) → depth must lie between 1e-45 and 1e45
Scene(1.5, 1, 0.1, depth=1, periodic='x,y') → periodic must be some of the axes x, y and z, each
Scene(0, 1, 0.1) → width must be a positive, finite number, not 0.0
Scene('0,3', 1, 0.1) → width must be a positive number, not '0,3'; decimals follow a point, 0.3
Scene(1.5, 1, 0.1, n_discs=3) → 'n_discs'; did you mean discs?
td.sample(Scene(20, 20, 0.5, discs=64)) → … double holds the volume …: divide all lengths by 16.0
td.simulate() → missing 1 required positional argument: 'scene'
td.simulate(PAPER, 0.5, progress=1) → progress must be True, False or None, not 1
td.simulate(PAPER, 0.1, duration=10) → error and duration must not both be given
td.simulate(PAPER, duration=2.75e5, budget=1e6) → duration must be below 2.71e5, where
td.trajectory(td.Scene(1.5, 1, 0.2, friction=2), 2e6) → duration must be below 1.76e6, where
td.trajectory(Scene(32, 32, 0.3, discs=1024), 1e9) → where 2.93e4 events are due and fill 0.96
td.sample(PAPER, cores=10**6) → cores must be an integer from 1 to 1024, not 1000000
td.simulate(PAPER, seed=2**63) → seed must be an integer from 0 to 2^63 - 1, not 9223372036854775808
td.simulate(RING, events='right_wall') → 'right_wall': the periodic axis x has no walls
td.simulate(RING, events='horizontal_hop') → x two discs have no order that a hop could change
td.simulate(Scene(1, 1, 0.1, discs=3, periodic='xy'), events='vertical_hop') → discs on a torus have
td.intervals(FOUR, 'horizontal_hop') → axis x are those of neighbours, see transmission
td.sample(PAPER, quantities='any_wall') → did you mean any_wall_area?
td.sample(PAPER, 1).save('\\0') → path must be a file to write, not '\\x00': it has a
td.sample(PAPER, 1).save('no/a.json') → path must be a file to write, not 'no/a.json'
td.load_result('absent.json') → path must be a file to read
td.load(3) → folder must be the path of a folder, not 3
td.load_result(3) → path must be the path of a file, not 3
td.load('nothere') → tables of results, but 'nothere' does not exist
td.load('src') → folder must hold tables of results, but 'src' has none
td.load(next(os.scandir('.'))) → folder must hold tables of results, but 'src' has none
td.load(__file__) → folder must hold tables of results, but … is no folder
Scene(1.5, 1, r=0.1) → argument 'r'; did you mean radius?
Scene(1.5, 1, 0.1, restitution=1) → argument 'restitution'; collisions are elastic
td.simulate(PAPER, tol=0.1) → argument 'tol'; did you mean error?
td.exact_table(1.5, 1, [0.1], feild=1) → argument 'feild'; did you mean field?
td.scan(1.5, 1, [0.2, 0.2]) → radii must differ, because one scene, … time, not [0.2, 0.2]; to
td.scan(1.5, 1, 0.2, field=[0, None, 1]) → radii and field must differ, … and [0, None, 1]; to
td.scan(1.5, 1, np.array(0.2)) → radius must be a positive number, not array(0.2)
td.cost(PAPER, np.array(0.1)) → errors must be a number above 0 and at most 1, …, not array(0.1)
td.scan(1.5, 1, 0.2, field=[]) → field must have at least one value, but has none
td.scan(1.5, 1, 0.2, field=[1, 'x']) → field must be a positive number, or 0, …, not 'x'
td.scan(1.5, 1, 0.2, field=[0, 1], name='a') → field must differ, because one scene, or one name
td.scan(1.5, 1, 0.2, 0.1, measure=td.volume) → measure must be a function of a scene, without
td.scan(1.5, 1, 0.2, measure='volume') → measure must be a function … calls, not 'volume'
td.scan(1.5, 1, 0.2, measure=lambda s: td.observe(s, {'radius': x1}, 0, 9)) → the name radius, which
td.scan(1.5, 1, 0.2, measure=td.volume) → measure must return a result of its scene, of one function
td.scan(1.5, 1, [0.1, 0.2], measure=lambda s: td.sample(PAPER, 1)) → of its scene, of one function
td.intervals(PAPER, 'wall') → hop must be one of vertical_hop, horizontal_hop, not 'wall'
td.transmission(PAPER, 'wall') → hop must be one of vertical_hop, horizontal_hop, not 'wall'
td.intervals(PAPER, td.EVENTS[0], 1, error=1) → number and error must not both be given: leave out
td.sample(PAPER, 1, error=0.1) → samples and error must not both be given: leave out one of them
td.sample(PAPER, budget=1) → budget must be left out without an error: samples is the number to draw
td.sample(PAPER, 1, quantities=5) → quantities must be some of volume, …, not 5
td.sample(PAPER, error={'volum': 0.1}) → quantity must be one of volume, …; did you mean volume?
td.simulate(PAPER, 1, events='hop') → event must be one of vertical_hop, …, not 'hop'
td.sample(Scene(1.5, 1, 0.38, field=0.5), 1) → radius 0.38 leaves a fraction 6e-06 of the prism
td.sample(PAPER, 1, method='rejecton') → conditioned, not 'rejecton'; did you mean rejection?
td.sample(FIELD, 1, method='conditioned') → method must be one of rejection, not 'conditioned'
td.simulate(PAPER, 1, method='strips') → method must be one of dynamics, not 'strips'
td.sample(PAPER, 1).more(budget=1e7) → to go on, give samples=
td.simulate(PAPER, 0.5, budget=1).more(duration=10) → duration must be left out for a result of …
td.trajectory(RING, start=ROUND_THE_RING) → must have the discs apart
td.trajectory(Scene(1.5, 1, 0.1, discs=3), start=[-0.5, 0, 0.1, *[0] * 9]) → have the discs apart
td.trajectory(PAPER, start=td.starts(PAPER, 2)) → numbers x1, …; start[0] is one of these states
td.trajectory(PAPER, start=td.trajectory(PAPER, 1)) → …; states_at(times)[0] is a state of a traj…
td.trajectory(PAPER, hops='no') → hops must be True or False, not 'no'
td.intervals(PAPER, 'vertical_hop', 1, bins=[0, 1, INF]) → edges from 0 on, not [0, 1, inf]
td.intervals(PAPER, 'vertical_hop', 1, bins=[0, 1, 1]) → ascending edges from 0 on, not [0, 1, 1]
td.starts(PAPER, 1e8) → number must be an integer from 1 to 15000000, not 100000000
td.frames(PAPER, [0, 1], 1e8) → number must be an integer from 1 to 7500000, not 100000000
td.observe(PAPER, x1, [1], 1e9 + 1) → replicas must be an integer from 1 to 1000000000, not
td.observe(PAPER, x1, [1e3], 1e8) → at most 27081956 for times up to 1000, with 1e11
td.observe(Scene(1.5, 1, 0.2, friction=2), x1, [1e9], 1) → times must be below 1.76e6, where 1e7
td.transmission(PAPER, 'vertical_hop', 1e19) → hops must be an integer from 1 to 1000000000, not
td.observe(PAPER, x1, [1], starts=td.starts(PAPER, 1)) → starts must be two states or more
td.observe(PAPER, x1, [1], 3, starts=td.starts(PAPER, 3)) → replicas must be left out with starts
td.observe(PAPER, x1, [1], starts=td.starts(FOUR, 3)) → an array of shape (number, 2, 4) of x, y, u
td.observe(PAPER, x1, [1], starts=np.ones((2, 2, 4))) → must have disc 1 inside the box, with x1
td.observe(PAPER, x1, [1], starts=[MOVING, np.add(MOVING, [9, 0, 0, 0])]) → disc 1 inside the box
td.observe(PAPER, x1, [1], starts=[MOVING, np.add(MOVING, [0, 0, 1e-8, 0])]) → of 0.5, not 0.50
td.observe(PAPER, x1, [1], starts=np.zeros((2, 3, 4))) → must be states as starts or frames returns
td.observe(PAPER, x1, [1], starts=[MOVING, MOVING * np.array([1, NAN, 1, 1])]) → as starts or frames
td.trajectory(PAPER, start=map(float, '12')) → start must be the numbers x1, …, not <map object at
td.trajectory(PAPER, start='no.xyz') → start must be a file to read, not 'no.xyz': No such file
td.trajectory(PAPER, start=__file__) → start must be an extended XYZ file with the columns pos and
td.trajectory(PAPER, start=([[0.3, 0.5], [1.2, 0.5]], np.zeros((2, 2)))) → energy of 0.5, not 0.0
td.trajectory(PAPER, 1e9) → must be below 2.71e6, where 1e7 events are due and fill 0.98 GB
td.intervals(Scene(1.5, 1, 0.3), 'horizontal_hop') → has no intervals: it is blocked at radius 0.3
td.intervals(DEEP, 'vertical_hop') → leaves a fraction 1e-13 of the prism of all centres
td.transmission(DEEP, 'vertical_hop') → with effects needs 0.0001 of it
td.intervals(Scene(1.5, 1, 0.13, discs=16), 'vertical_hop') → is so large for 16 discs that the time
td.intervals(Scene(1, 1, 0.1, discs=3, moment_of_inertia=1), 'vertical_hop') → must have smooth
insertions.sample(Scene(1.5, 1.0, 0.13, discs=16), 1000, 1) → in none of them 16 discs fit
td.pressure(FIELD) → field must be 0 for a pressure
td.pressure(Scene(1, 1, 0.1, radius_ratio=2)) → radius_ratio must be 1 for a pressure
td.pressure(Scene(1, 1, 0.1, depth=1, periodic='xy')) → must have walls along x or y for a pressure
td.pressure(td.sample(PAPER, 1)) → a Scene or a result of simulate, not a result of sample
td.free_energy(FIELD) → field must be 0 for the free energy of hard discs, not 0.4
td.sample(Scene(9, 9, 0.1, discs=65)) → discs must be at most 64 for Monte Carlo by insertion, not
td.transmission(RING, 'horizontal_hop') → hop 'horizontal_hop' must be between walls for a trans…
td.transmission(PAPER.with_radius(0.3), 'horizontal_hop') → must be open for passages, but is
td.trajectory(ROUGH, start=[CENTRES, CENTRES]) → must have the spins of rough discs, s of each disc
from_file(PAPER.with_radius(0.21)) → must have the box and the discs of the scene, not 2 discs
from_file(Box(1.6, 1).scene(0.2)) → not 2 discs of the radii [0.2, 0.2] in a box of [1.5,
from_file(Scene(1.5, 1, 0.2, discs=3)) → must have the box and the discs of the scene, not 2 discs
td.simulate(Scene(1, 9, 0.24999999, discs=20, periodic='x'), 1) → not exceed 0.249999… for 20 discs
td.plot(td.trajectory(PAPER)[['time']]) → must have at least two rows and the column event, but has
td.free_energy('a') → of must be a Scene or a result of sample, not 'a'
td.diffusion(PAPER, [1]) → axis must be periodic in the scene for diffusion
td.diffusion(RING, time=[1]) → argument 'time'; did you mean times?
td.diffusion(RING, [1], axis='y') → axis must be one of x for
td.diffusion(RING, [0, 1]) → times must be above 0 for diffusion
start(x1=0.1 + 1e-8) → have the discs apart, with 0.4 or more between their centres, not 0.3999999
td.trajectory(td.Scene(1.5e-15, 1e-15, 2e-16), start=[-6e-16, 0, 5e-16, 0, 1, 0, 0, 0]) → inside
start(x1=-0.6) → disc 1 inside the box, with x1 between -0.55 and 0.55, not -0.6
td.trajectory(RING, start=[-0.8, 0, 0, 0.31, 1, 0, 0, 0]) → disc 2 inside the box, with y2
fall() → not bring disc 1 to rest on the floor, as it does at the time 0.0: in a field a disc
fall(v1=-1e-17) → not bring disc 1 to rest on the floor, as it does at the time 0.0
fall(x1=0.4, v1=0.68**0.5, u2=0) → not bring disc 1 to rest on the floor, as it does at the
fall(y1=0.1, y2=-0.3) → not bring disc 2 to rest on the floor, as it does at the
fall(v1=1) → energy of 0.5, not 1.0; in a field the potential energy of a disc on the floor is 0
start(v2=np.ma.masked) → start must be the numbers x1, y1, x2, y2, u1, v1, u2, v2, not
td.trajectory(PAPER, start={**START, 'v3': 0.0}) → start must be the numbers x1, y1, x2, y2, u1, v1
observe(times={1: 0, 0: 0}) → times must be ascending numbers from 0 on, not [1, 0]
observe(times=np.ma.masked_array([1, 2], [0, 1])) → from 0 on, not a MaskedArray object
observe(lambda a, b: np.ma.masked_less(b['x1'], 0)) → 4096 replicas, not an array with masked values
observe(times=np.array([10], 'm8[ms]')) → not a ndarray object: give numbers without units
observe(times=np.array([0.5, '1'], object)) → times must be ascending numbers from 0 on, not
observe(times=[0.5, True]) → times must be ascending numbers from 0 on, not [0.5, True]
observe(lambda a, b: [b['x1'], pd.to_timedelta(b['x1'])]) → units would be lost: return plain
td.trajectory(PAPER).positions(1j) → times must be numbers from 0.0 to … not 1j
observe(lambda a, b: b['x3']) → function must use the fields x1, y1, x2, …, but there is no field of
observe(lambda a, b: 1.0) → a real number, or the same … 4096 replicas, not 1.0
observe(lambda a, b: None) → 4096 replicas, not None: is its return missing?
observe(lambda a, b: b) → an array with the fields x1, y1, x2, y2, u1, v1
observe(lambda a, b: b['x1'].astype(str)) → of shape (4096,) and kind <U
observe(lambda a, b: {'x': b['x1'], 'x_stderr': b['x1']}) → none of them time or another one with
observe({'time': x1}) → must be texts, none of them time or another one with _stderr, not ['time']
observe({1: x1}) → names of what function returns must be texts, none … with _stderr, not [1]
observe({'x': x1, 'y': 1}) → function must take two arrays of states, not be {'x': <function
observe({}) → function must take two arrays of states, not be {}
observe(lambda a, b: b['x1'] * 1e150) → finite numbers, below 1e140, not
td.diffusion(RING, [1], 1).more(function=x1) → function must be left out for a result of diffusion
observe(lambda a, b: b['x1'] + 1j) → real and imaginary part as two columns
td.plot(td.observe(PAPER, lambda a, b: np.stack([b['x1']] * 9, 1), [1], 1)) → to be drawn, not 9
td.trajectory(PAPER).states_at([1, 1e9]) → times must be numbers from 0.0 to
td.trajectory(PAPER)[['time', 'x1']].states_at([1]) → rows and lacks y1, x2, y2, u1, v1, u2, v2
td.trajectory(PAPER)[:0].states_at([1]) → and at least one row, but has 0 rows and lacks no column
pd.concat([td.trajectory(PAPER, 1), td.trajectory(FIELD, 1)]).scene → must have a scene in its attrs
td.plot(td.sample(PAPER, 1), figure='volum') → one of volume, …, not 'volum'; did you mean volume?
td.plot(td.sample(PAPER, 1), ax=td.sample(PAPER, 1)) → Axes of matplotlib, not a result of sample
td.cost(PAPER, shell=1) → shell must lie between 1e-6 and 1, ends excluded, not 1
td.Measurement('a', 1, 1, 1, 0, 1, 'done', '') → status must be one of reached, …, not 'done'
td.sample(PAPER, shell=1e-300) → shell must lie between 1e-6 and 1, ends excluded, not 1e-300
td.sample(PAPER, 1, seed=2.0**53) → seed must be an integer of at least 0, not 9007199254740992.0
td.plot(td.sample(PAPER, 1), ax=Figure().subplots(2)) → ax must be one plane Axes of matplotlib, not
td.plot([td.sample(s, 1) for s in (PAPER, RING)]) → for several boxes call plot with the same ax for
td.plot(td.trajectory(PAPER, 1), ax=Figure().add_subplot()) → must be over the radius to be drawn in
td.plot([td.intervals(PAPER, hop, 1) for hop in td.EVENTS[:2]]) → not horizontal_hop and verti…
td.plot([td.intervals(PAPER, 'vertical_hop', n) for n in (1, 2)]) → each radius, not 2 at 0.2
td.plot([]) → result must be a scene, a trajectory, results of simulate, …, not []
td.plot(FIELD) → scene must be two plain discs for a drawing, but it has field
td.animate(PAPER, 'a.gif') → trajectory must be a result of trajectory()
td.animate(td.trajectory(PAPER, 1), 'a.avi') → path must be a .gif, …, … .mp4 file, not 'a.avi'
td.animate(td.trajectory(PAPER, 0.01), 'a.gif') → trajectory must last two frames
"""

#: Command lines; after the minus sign only the sides of the box are given, not the radius.
SHELL = """
exact - --radius ٠.٢ → radius must be a positive number, not '٠.٢'
simulate --seed 1_000 → seed must be an integer of at least 0, not '1_000'
exact - → the following arguments are required: --radius
exact - --radious 1 → unrecognized arguments: --radious; did you mean --radius?
exact --rad 2 → unrecognized arguments: --rad 2
exact --gravity 1 → unrecognized arguments: --gravity 1; did you mean --field?
sample --error rough → error must be a number above 0 and at most 1, or one of draft, paper
simulate --budget 1.5 → budget must be an integer of at least 1, not 1.5
run my.yaml --core 2 → unrecognized arguments: --core
--force run my.yaml → unrecognized arguments: --force; options follow the command
"""

TOP_KEYS = "results, seed, shard_events, accuracy_cost, shared, scenes"

#: Files of a configuration, up to a scene without mistakes if they have none; FILE is their path.
FILES = """
 → FILE: must hold a block of the keys TOP_KEYS, not empty; twodiscs new writes one
- 1 → FILE: must hold a block of the keys TOP_KEYS, not [1]
scenes:⏎- box: {width: 1, width: 2} → FILE, line 2: the key 'width' is given a second …
\tscenes: 1 → FILE, line 1: found character '\\t' that cannot start any token; indent with blanks
a: \x07 → FILE: unacceptable character …
seed: 9007199254740993.0 → FILE, line 1: 9007199254740993.0 must be …: YAML reads 9007199254740992.0
a: *b → FILE, line 1: found undefined alias 'b'
? [a]⏎: 1 → FILE, line 1: found unhashable key
# café⏎a: \udce9 → FILE, line 2: save the file as UTF-8, which has no byte 0xe9
scenes: {name: one} → scenes must be a non-empty list of scenes, not …; a dash begins each item
seed: 010 → FILE, line 1: 010 must be a decimal number or text in quotes: YAML reads 8
scenes: [{radii: [0.1, 1_0.5]}] → FILE, line 1: 1_0.5 must be …: YAML reads 10.5
results: here → the configuration needs the key 'scenes'
scenes: &a [*a] → scenes[0] must be a block of keys, at least name and box, not [[[...]]]
scene: [] → the configuration has an unknown key 'scene'; did you mean scenes?
SCENE⏎zz: 1 → the configuration has an unknown key 'zz'; its keys are TOP_KEYS
SCENE⏎accuracy: 1 → the configuration has an unknown key 'accuracy'; it belongs in a scene
SCENE⏎seed: '010' → seed must be an integer …, not '010'
SCENE⏎results: ../elsewhere → results must be a path, …, not '../elsewhere'
SCENE⏎shared: [paper, paper] → shared must be a list of different …, not ['paper', 'paper']
SCENE⏎shared: [papers] → shared[0] must be one of …, not 'papers'; did you mean paper?
"""

#: Lines of the only scene of a configuration, and the sentence after "scenes[0]".
IN_SCENE = """
name: a/b → .name must be a name of small letters…, not 'a/b'
name: tails → .name must not be 'tails', the name of a target, a folder of results or a de…
gravity: 1 →  has an unknown key 'gravity'; field belongs in 'effects'
radii: [٠.٢] → .radii[0] must be a positive length …, not '٠.٢'
width: 1 →  has an unknown key 'width'; it belongs in 'box'
box: {discs: 3} → .box has an unknown key 'discs'; it belongs in a scene
box: {width: 1,5, height: 1} → .box has an unknown key 5; decimals have a point
box: {width: 1.5, height: 1, none: } → .box has an unknown key 'none'; its keys are width, heig…
effects: {gravity: 1} → .effects has an unknown key 'gravity'; did you mean field?
box: {width: 1, height: '1,2'} → .box.height must be a positive length …; decimals …, 1.2
discs: 2.5 → .discs must be an integer from 2 to 16384, not 2.5
discs: 65⏎radii: [0.01]⏎watch: {volume: true} → .watch.volume must be false for more than 64 discs…
radii: [0.1, 0.2, 1e-1] → .radii must hold every radius once, but …
radii: {smallest: 0.4} → .radii.smallest: radius 0.4 does not fit: …
radii: {smallest: 0.38397459} → .radii: smallest must be below the largest radius of the box, …
radii: {smallest: 0.25} → .radii: smallest must not be 0.25, at which a …
watch: false → .watch must ask for at least one of volume, …
watch: {areas: [wall]} → .watch.areas[0] must be one of …, not 'wall'; did you mean …wall?
watch: {hop_histogram: [0.1, 0.38]} → .watch.hop_histogram must keep to radii below 0.375, where …
watch: {hop_histogram: {radii: [0.24999999], event: horizontal_hop}} → … takes 3.9e+14 events
watch: {hop_histogram: {radii: [0.1], event_budget: 2.3e5}} → … 65536 intervals fit …, 230000; …
watch: {trajectory: 0.5} → .watch.trajectory: radius 0.5 does not fit: …
effects: {periodic: [x, x]} → .effects.periodic must be a list …, not [… 'x']
effects: {periodic: [x]}⏎watch: {mean_times: [horizontal_hop]} → .watch.mean_times must hold event…
effects: {periodic: [x]}⏎watch: {hop_histogram: {event: horizontal_hop}} → … such as vertical_hop, …
effects: {periodic: xy}⏎watch: {hop_histogram: true} → … must be false, because on these periodic …
effects: {periodic: xy}⏎watch: {trajectory: true} → .watch.trajectory must be false, because on …
effects: {moment_of_inertia: 0.5}⏎watch: {hop_histogram: [0.1]} → … because rough discs in a box …
effects: {field: 1}⏎radii: [0.1, 0.378] → .radii: with field 1.0, radius 0.378 leaves … positions, …
effects: {radius_ratio: 2}⏎radii: {smallest: 0.24} → .radii: smallest must be below 0.225…, not 0.24
accuracy: papper → .accuracy must be …, not 'papper'; did you mean paper?
"""

GOOD = {"scenes": [{"name": "one", "box": {"width": 1.5, "height": 1}}]}


def refusal(path, text):
    """Return what is said about a ``text`` as the file of a configuration."""
    path.write_text(text, encoding="utf-8", errors="surrogateescape")
    with pytest.raises(ConfigError) as caught:
        load(read(path))
    return str(caught.value).replace(str(path), "FILE")


@pytest.mark.parametrize(("keys", "sentence"), rows(SCENES))
def test_a_mistake_in_a_scene_is_one_sentence_everywhere(keys, sentence, monkeypatch, capsys):
    keys = {"width": 1.5, "height": 1, "radius": 0.1} | yaml.safe_load(f"{{{keys}}}")
    with pytest.raises(InputError) as caught:
        Scene(**keys)
    words = [w for key, value in keys.items() for w in (f"--{key.replace('_', '-')}", value)]
    shell = refused(monkeypatch, capsys, "exact", *words)
    scene = {"name": "one", "radii": [keys.pop("radius")]}
    scene |= {key: keys.pop(key) for key in ("discs",) if key in keys}
    scene["box"] = {key: keys.pop(key) for key in ("width", "height", "depth") if key in keys}
    with pytest.raises(ConfigError, match=r"^scenes\[0\].* \(scene 'one'\)$") as configured:
        load({"scenes": [scene | {"effects": keys}]})
    for found in (str(caught.value), shell, str(configured.value)):
        assert re.search(pattern(sentence), found), found


@pytest.mark.parametrize(("call", "sentence"), rows(CALLS))
def test_a_mistake_in_a_call_is_one_sentence(call, sentence, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "src").mkdir()
    with pytest.raises(InputError, match=pattern(sentence)) as caught:
        eval(call)
    assert "\n" not in str(caught.value)
    is_about_names = re.search("argument|mean (events|discs)", sentence)
    assert isinstance(caught.value, TypeError) == bool(is_about_names)
    assert [path.name for path in tmp_path.iterdir()] == ["src"]


@pytest.mark.parametrize(("line", "sentence"), rows(SHELL))
def test_a_mistake_on_the_command_line_is_one_sentence(line, sentence, monkeypatch, capsys):
    name, *words = line.split()
    if "run" not in line.split():
        radius = [] if "-" in words else ["--radius", "0.1"]
        words = ["--width", "1.5", "--height", "1", *radius, *(w for w in words if w != "-")]
    assert sentence in refused(monkeypatch, capsys, name, *words)


@pytest.mark.parametrize(("text", "sentence"), rows(FILES))
def test_a_mistake_in_a_file_is_one_sentence(text, sentence, tmp_path):
    text = text.replace("SCENE", yaml.safe_dump(GOOD))
    found = refusal(tmp_path / "bad.yaml", text)
    assert re.fullmatch(pattern(sentence.replace("TOP_KEYS", TOP_KEYS)), found), found


@pytest.mark.parametrize(("lines", "sentence"), rows(IN_SCENE))
def test_a_mistake_in_a_scene_of_a_file_is_one_sentence(lines, sentence, tmp_path):
    block = {"name": "name: one", "box": "box: {width: 1.5, height: 1}"}
    block |= {line.split(":")[0]: line for line in lines.splitlines()}
    found = refusal(tmp_path / "bad.yaml", "scenes:\n  - " + "\n    ".join(block.values()))
    named = r"( \(scene 'one'\))?" if lines.startswith("name") else r" \(scene 'one'\)"
    assert re.fullmatch(rf"scenes\[0\]{pattern(sentence)}{named}", found), found


def test_all_mistakes_are_told_together():
    other = {"name": "two", "box": {"width": 1, "height": 1}}
    with pytest.raises(ConfigError) as caught:
        load({"seeed": 1, "shard_events": 3, "scenes": [GOOD["scenes"][0] | {"accuracy": 7}]})
    unknown, *others = str(caught.value).split("\n")
    assert unknown == "the configuration has an unknown key 'seeed'; did you mean seed?"
    assert [s.partition(" must")[0] for s in others] == ["shard_events", "scenes[0].accuracy"]
    with pytest.raises(ConfigError) as caught:
        load({"scenes": [other | {"radii": [9]}, other | {"watch": False}]})
    first, name, watch = str(caught.value).split("\n")
    assert first.startswith("scenes[0].radii: radius 9.0 does not fit")
    assert name == "scenes[1].name must differ from every other scene's, not 'two'"
    assert re.fullmatch(r"scenes\[1\].watch must ask for at least one of .* \(scene 'two'\)", watch)


# Any argument of the face -------------------------------------------------------------------------

POINT = {"scene": PAPER, "quantities": ["volume"], "samples": 1, "shell": 0.02, "seed": 1}
COUNTED, NAMED = {"events": ["any_wall"], "budget": 1}, {"seed": 1, "name": "a"}

#: Public functions with arguments that are right.
RIGHT = [
    (Scene, {"width": 1.5, "height": 1.0, "radius": 0.2}),
    (PAPER.with_radius, {"radius": 0.1}),
    (PAPER.is_possible, {"event": "any_wall"}),
    (Box, {"width": 1.5, "height": 1.0, "field": 0.1, "periodic": "x", "radius_ratio": 0.5}),
    (PAPER.box.threshold, {"event": "any_wall"}),
    *((f, {"scene": PAPER}) for f in (td.volume, td.areas, td.mean_times, td.exact)),
    (td.rate, {"scene": PAPER, "event": "any_wall"}),
    (estimates.normal_quantile, {"confidence": 0.95}),
    (td.exact_table, {"width": 1.5, "height": 1.0, "radii": [0.2]}),
    (td.scan, {"width": 1.5, "height": 1.0, "radii": [0.2], "error": 0.5, **COUNTED}),
    (td.simulate, {"scene": PAPER, "error": 0.5, **COUNTED, **NAMED}),
    (td.sample, POINT | NAMED | {"method": "rejection"}),
    (td.intervals, {"scene": PAPER, "hop": "vertical_hop", "number": 1, "bins": [0, 1], **NAMED}),
    (td.transmission, {"scene": PAPER, "hop": "vertical_hop", "hops": 1, **NAMED}),
    (td.starts, {"scene": PAPER, "number": 1, **NAMED}),
    (td.trajectory, {"scene": PAPER, "start": [*START.values()], "duration": 1.0, **NAMED}),
    (td.observe, {"scene": PAPER, "function": x1, "times": [1], "replicas": 1, **NAMED}),
    (td.frames, {"scene": PAPER, "times": [1], "number": 1, **NAMED}),
    (td.diffusion, {"scene": RING, "times": [1], "replicas": 1, **NAMED}),
    (td.plot, {"result": PAPER, "path": None}),
]

#: Wrong values for each of these arguments, one of each kind.
LENGTH = [-1.0, 0.0, INF, 1e-61, 1e61, "1", True]
RADIUS = [*LENGTH, 0.4, PAPER.box.largest_radius]
COUNT = [0, 1.5, 2**64, "1", True]
PART = [0.0, 1.0, -0.1, "0.1", True]
EVENT = ["", "hop", b"any_wall", PAPER]
WRONG = (
    {"width": LENGTH, "height": LENGTH, "radius": RADIUS, "shell": PART, "confidence": PART}
    | {"field": [-1.0, "1"], "periodic": ["xx", "z", 1], "radius_ratio": [1e9, -1.0]}
    | dict.fromkeys(("samples", "budget", "replicas", "hops", "number"), COUNT)
    | {"scene": [1.0, "scene", (1.5, 1.0, 0.2), Scene], "method": EVENT, "event": EVENT}
    | {"hop": [*EVENT, "any_wall"], "quantities": [[], ["mass"], [None], ["any_wall"]]}
    | {"seed": [-1, 1.5, "1", True], "duration": [INF, "1", 0.0, -1.0]}
    | {"error": [0.0, 1.1, -0.5, True, "rough", {}, {"hop": 0.1}], "name": [3, b"a"]}
    | {"events": [["hop"], {"any_wall": 0.1}, b"any_wall", 5], "radii": [[], [0.9], [None]]}
    | {"bins": [[], [1], [0, 2, 1], [-1, 1], [0, INF], "x", 5]}
    | {"start": [[], [1.0] * 8, "x", [None] * 8], "times": [[-1], [1, 1], [1e9], [INF]]}
    | {"function": [1, lambda start, now: None, lambda start, now: "x1"], "path": [3.5, "a.txt"]}
    | {"result": [1, "scene", [PAPER, 1], {}]}
)

#: No argument may be such a thing, or hold it where it is a list.
JUNK = [NAN, 1j, b"", object()]

#: The name of the wrong part of an argument with several parts.
INSIDE = dict.fromkeys(("error", "events"), "event")
INSIDE |= {"quantities": "quantity", "radii": "radius"}


@pytest.mark.parametrize(("function", "good"), RIGHT)
def test_what_is_right_is_taken_and_a_mistake_of_each_kind_refused(function, good):
    function(**good)
    for name in good.keys() & WRONG.keys():
        junk = [[value] for value in JUNK] if name == "quantities" else JUNK
        for value in [*WRONG[name], *junk]:
            with pytest.raises(InputError, match=r"must|does not fit|has no|is blocked|name") as no:
                function(**good | {name: value})
            sentence = str(no.value)
            assert "\n" not in sentence
            assert 10 < len(sentence) < 300
            assert name in sentence or INSIDE.get(name, name) in sentence, sentence


@pytest.mark.parametrize(("time", "replica"), [(0.25, 3), (1.5, 4099)])
def test_what_a_function_returns_is_finite_or_its_time_and_replica_are_named(time, replica):
    calls = itertools.count()

    def seen(start, now):
        block, step = divmod(next(calls), 2)
        values = np.stack([now["x1"], now["x2"]], axis=1)
        if (block, (0.25, 1.5)[step]) == (replica // len(now), time):
            values[replica % len(now), 1] = NAN
        return values

    asked = "function must return finite numbers, below 1e140, not nan at"
    with pytest.raises(InputError, match=f"^{asked} the time {time} of the replica {replica}$"):
        td.observe(PAPER, seen, [0.25, 1.5], replicas=5000)


# Any key of a configuration -----------------------------------------------------------------------


def keys_of(node, path=""):
    """Yield (path, node of the schema, whether it is required) of every key beneath a node."""
    for name, child in node.get("properties", {}).items():
        yield f"{path}.{name}", child, name in node.get("required", [])
        yield from keys_of(child, f"{path}.{name}")
        yield from keys_of(child.get("items", {}), f"{path}.{name}[]")


def with_value(path, value):
    """Return a configuration with a ``value`` at a ``path`` such as .scenes[].box.width."""
    found = block = deepcopy(GOOD)
    *blocks, last = path.lstrip(".").split(".")
    for name in blocks:
        block = block[name.rstrip("[]")][0] if name.endswith("[]") else block.setdefault(name, {})
    block[last] = value
    return found


def limits(node, *names):
    """Return the limits of the range of a node that have these names."""
    forms = [node, *node.get("anyOf", ())]
    return [form[name] for form in forms for name in names if name in form]


#: What YAML may give in the place of anything; some of it is right in some places.
ODD = [
    *(None, True, "", "x", "1e3", "010", "draft", [], [[]], {}, b"x", 0, -1, 65, 1e-70, 1e70),
    *(10**400, NAN, INF, [0.1, 0.1], [None], {5: None}, {None: 1}, {(1, 2): 3}, {"bool": 1}),
]


@pytest.mark.parametrize(("path", "node", "required"), list(keys_of(schema.keys())))
def test_every_key_is_documented_and_refuses_other_values(path, node, required):
    assert node["description"].endswith(".")
    assert node["allowed"]
    assert required or {"default", "otherwise", "properties"} & {*node}
    if node.get("type") == "number" and 1 not in map(node.get, ("maximum", "exclusiveMaximum")):
        assert node["unit"]
    for value in limits(node, "minimum", "maximum"):
        Model.model_validate(with_value(path, value))
    beyond = [limit - max(1, limit) for limit in limits(node, "minimum")]
    beyond += [limit + max(1, limit) for limit in limits(node, "maximum")]
    beyond += limits(node, "exclusiveMinimum", "exclusiveMaximum")
    for value in (None, NAN, {"colour": 1}, [["a"]], -1e300, *beyond):
        with pytest.raises(ConfigError, match=r" must |unknown key|needs the key") as caught:
            load(with_value(path, value))
        sentence = str(caught.value)
        assert sentence.startswith(path.lstrip(".").replace("[]", "[0]")), sentence
        assert "\n" not in sentence
        assert len(sentence) < 500
    for value in ODD:
        try:
            load(with_value(path, value))
        except ConfigError as error:
            for sentence in str(error).split("\n"):
                assert re.match(r"[a-z].*( must | needs |unknown key|: )", sentence), sentence


def nested(value, depth):
    """Return YAML of a list in a list …, six of them in each."""
    return value if depth == 0 else f"[{', '.join([nested(value, depth - 1)] * 6)}]"


#: YAML in which a few lines name a list of 9^30 items.
LAUGHS = [f"a{i + 1}: &a{i + 1} [{', '.join([f'*a{i}' if i else '1'] * 9)}]" for i in range(30)]

LONG = {
    "a list of lists": f"seed: {nested('a' * 30, 5)}\nscenes: [{{name: one, box: 1}}]",
    "no block": nested("a", 5),
    "depth": "a: " + "[" * 1000,
    "alias": "a: *" + "b" * 70_000,
    "tag": "a: !" + "b" * 70_000 + " 1",
    "key": "? " + "a" * 1000 + "\n: 1",
    "digits": "seed: " + "9" * 5000,
    "name": f"scenes: [{{name: {'a' * 101}, box: {{width: 1, height: 1}}}}]",
    "laughs": "\n".join(LAUGHS),
    "mistakes": "\n".join(f"k{i}: 1" for i in range(1000)),
}


@pytest.mark.parametrize("kind", LONG)
def test_sentences_have_an_end(tmp_path, kind):
    """They quote the first part of a long value."""
    found = refusal(tmp_path / "bad.yaml", LONG[kind]).split("\n")
    assert len(found) <= checks.MOST_SENTENCES
    there_are_more = found[-1] == "you see more mistakes after you mend these"
    assert there_are_more == (len(found) == checks.MOST_SENTENCES)
    assert there_are_more or kind != "mistakes"
    assert all(len(sentence) <= checks.LONGEST_SENTENCE + 1 for sentence in found)
    assert str(InputError(*"a" * checks.MOST_SENTENCES)).split() == ["a"] * checks.MOST_SENTENCES
    assert str(InputError("a" * checks.LONGEST_SENTENCE)) == "a" * checks.LONGEST_SENTENCE


def test_numbers_of_one_meaning_and_merged_blocks_are_taken(tmp_path):
    path, numbers = tmp_path / "a.yaml", ["0", "-7", "+.5", "1.", "1e6", "2.5E-01", "'010'"]
    path.write_text(f"a: [{', '.join(numbers)}]\n", encoding="utf-8")
    assert [float(n) for n in read(path)["a"]] == [float(n.strip("'")) for n in numbers]
    text = "deep: [&b {<<: &a {count: 1}, count: 2}]\nc: {<<: *b, smallest: 3}\n"
    path.write_text(text, encoding="utf-8")
    assert read(path) == yaml.safe_load(text)
    path.write_text('{\n\t"a":\t{"count": 1}\n}', encoding="utf-8")  # JSON, which has tabs
    assert read(path) == {"a": {"count": 1}}
    with pytest.raises(ConfigError, match=r"none\.yaml: No such file or directory"):
        read(tmp_path / "none.yaml")


# The process --------------------------------------------------------------------------------------


def test_what_the_workflow_cannot_run_with_is_one_sentence(tmp_path):
    """Only the workflow needs docstrings."""
    sources = Path(checks.__file__).parents[2]
    environment = os.environ | {"PYTHONPATH": str(sources), "PYTHONOPTIMIZE": "2"}
    (tmp_path / "theory.csv").write_text("radius,quantity,exact\n0.1,volume,1.0\n")
    code = "import twodiscs as td; print(*td.load('.')); from twodiscs import cli; cli.main()"
    run = python("-P", "-c", code, "run", "my.yaml", env=environment, cwd=tmp_path)
    said = "PYTHONOPTIMIZE=2 must not be set: it removes docstrings, which the pages show"
    assert (run.returncode, run.stdout, run.stderr) == (2, "theory\n", f"error: {said}\n")

    mine = tmp_path / "twodiscs.py"
    mine.write_text("raise SystemExit('imported by mistake')\n")
    environment = os.environ | {"PYTHONPATH": os.pathsep.join((str(tmp_path), str(sources)))}
    run = python("-c", "import twodiscs_paper.pipeline.job_cost", env=environment, cwd=tmp_path)
    said = f"{mine} hides the package twodiscs: give this file another name\n"
    assert (run.returncode, run.stdout, run.stderr) == (1, "", said)


def test_a_mistake_in_the_program_keeps_its_traceback():
    for error in (ValueError, KeyError, TypeError, ZeroDivisionError):
        with pytest.raises(error, match="colour"):
            cli.run(lambda error=error: (_ for _ in ()).throw(error("colour")))
    with pytest.raises(TypeError, match=r"^mine$"):
        observe(lambda start, now: (_ for _ in ()).throw(TypeError("mine")))
