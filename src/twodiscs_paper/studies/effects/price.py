"""The cost of each effect: the speed of the engine, variant by variant, in turns.

All numbers are processor times of one core. The variants take turns, repeatedly, and their medians
are compared: if the machine slows down, all slow down. The scene is the paper's box at r = 0.2. The
variants are compared with a copy of the package from which the effects are removed.
"""

import re
import shutil
import sys
import tempfile
import time
from dataclasses import replace
from functools import partial
from importlib import import_module
from pathlib import Path
from statistics import median

import twodiscs
from twodiscs.dynamics import runs
from twodiscs.dynamics.engine import find_engine
from twodiscs.model.events import EVENTS, WALLS
from twodiscs.model.scene import Box, Scene

SCENE = Scene(1.5, 1.0, 0.2)
REPETITIONS = 7

#: Blocks of one timed run of the lock-step ensemble.
BLOCKS = 200

#: Blocks and repetitions of a quick run.
QUICK = {"blocks": 40, "repetitions": 5}

#: Effects that no scene of the study has, and all effects that discs can have together.
MORE = {
    "friction": {"friction": 5.0},
    "all effects": {
        "radius_ratio": 0.5, "mass_ratio": 2.0, "periodic": "x", "field": 0.5,
        "moment_of_inertia": 0.5, "friction": 5.0,
    },
}  # fmt: skip

#: Where ``optional`` of sampling/jit.py begins to decorate, and what replaces it in the copy.
DECORATED = "    def decorate(present):\n"
REPLACED = """        if present.__name__ != "add_one":
            return inlined(present if present.__name__ in ("snap_to_wall", "hit") else absent)
"""


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


def lockstep(blocks=BLOCKS, scene=SCENE, events=EVENTS, bare=None):
    """Count ``events``, by default all, up to a fixed end time, with statistics by replica.

    The package ``bare``, if it is given, does the work instead of ours.
    """
    engine = find_engine(scene)
    duration, run_blocks = engine.replica_duration(scene), engine.run_blocks
    if bare:
        run_blocks = import_module(f"{bare}.dynamics.two.event_counts").run_blocks
    counted, seconds = timed(lambda: run_blocks(scene, events, 1, 0, blocks, duration))
    return runs.simulated_events(counted[0]), seconds


def compared(name, speeds, baseline):
    """Return the rows of a benchmark from {variant: speed}, with ratios to the ``baseline``."""
    start = {"benchmark": name, "unit": "1/s"}
    return [
        start | {"variant": variant, "value": speed, "ratio": speed / speeds[baseline]}
        for variant, speed in speeds.items()
    ]


def rows(scenes, blocks=BLOCKS, repetitions=REPETITIONS):
    """Return the rows on events per second with the effects of ``scenes``, {name: box}.

    All events of a scene are counted. ``without_effects`` is the plain scene in a package that has
    no effects. Variants without effects are also ``plain`` and ``plain_walls``, which detects no
    hops.
    """
    effects = {name: Box(**box).effects for name, box in scenes.items()} | MORE
    bare = package_without_effects()
    variants = {
        "without_effects": partial(lockstep, blocks, bare=bare),
        "plain": partial(lockstep, blocks),
        "plain_walls": partial(lockstep, blocks, SCENE, (*WALLS, "any_wall")),
    }
    for name, own in effects.items():
        scene = replace(SCENE, **own)
        # Kicks are drawn lane by lane, so a block takes many times longer.
        number = blocks // 8 if scene.friction else blocks
        variants[name] = partial(lockstep, number, scene, scene.events)
    counted = {
        name: instructions(work, bare if name == "without_effects" else twodiscs.__name__)
        for name, work in variants.items()
    }
    speeds = compared("effects", interleaved(variants, repetitions), "without_effects")
    return [row | {"instructions": counted[row["variant"]]} for row in speeds]


def package_without_effects():
    """Import a copy of the package whose sources have no effects, and return its name.

    In the copy each optional function is replaced by what stands in for it if the effect is absent.
    Functions remain that put discs on walls, see either disc there, and count what is tracked.
    """
    name = "twodiscs_without_effects"
    if name in sys.modules:
        return name
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder, name)
        shutil.copytree(Path(twodiscs.__file__).parent, copy)
        for path in copy.rglob("*.py"):
            text = path.read_text(encoding="utf-8")
            text = re.sub(r"\b(from|import) twodiscs\b", rf"\1 {name}", text)
            if path.name == "jit.py":
                text = text.replace(DECORATED, DECORATED + REPLACED, 1)
            path.write_text(text, encoding="utf-8")
        sys.path.insert(0, folder)
        try:
            import_module(f"{name}.dynamics.runs")
            import_module(f"{name}.dynamics.two.event_counts")
        finally:
            sys.path.remove(folder)
    return name


def instructions(work, package):
    """Return the number of machine instructions of the kernel that ``work`` runs.

    Numba keeps no assembly beside compiled code, but LLVM writes it again.
    """
    compile_loop = import_module(f"{package}.dynamics.two.follow").compile_loop
    compile_loop.cache_clear()
    work()
    (kernel,) = compile_loop(
        import_module(f"{package}.dynamics.two.event_counts").Counts
    ).overloads.values()
    library = kernel.library
    module = library._get_module_for_linking()
    return len(re.findall(r"^\t[a-z]", library._codegen._tm.emit_assembly(module), re.MULTILINE))
