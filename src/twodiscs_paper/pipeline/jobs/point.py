"""Compute a point: the counts at one radius, by Monte Carlo, dynamics or intervals of hops.

    python -m twodiscs_paper.pipeline.jobs.point dynamics --width 1.5 --height 1 --radius 0.2 \\
        --target vertical_hop=1e-3 disc_collision=1e-3 --budget 1e9 --seed 1 --output 0.2.json

A point is a JSON object of counts and sums, with their digest and their processor time. If it is
too much work for one job, it is the sum of shards: separate jobs, with ``--part`` and ``--blocks``.
"""

import inspect
import time
from pathlib import Path

from twodiscs.arguments import (
    Parser,
    add_scene,
    assignment,
    number,
    run,
    scene_of,
    whole_number,
)
from twodiscs.comparison.measured.progress import progress_bar
from twodiscs.model.checks import InputError
from twodiscs.points.digests import read_json, read_seconds, write_json


def monte_carlo(scene, quantities, samples, shell, seed):
    """Return the ``SamplingRun`` of volume and areas."""
    from twodiscs.sampling.montecarlo import SamplingRun

    return SamplingRun(scene, quantities, samples, shell, seed)


def dynamics(scene, target, budget, seed):
    """Return the ``CountingRun`` of mean times."""
    from twodiscs.dynamics.counting import CountingRun

    return CountingRun(scene, dict(target), budget, seed)


def intervals(scene, event, intervals, budget, seed):
    """Return the ``IntervalRun`` of a hop."""
    from twodiscs.dynamics.intervals import IntervalRun

    return IntervalRun(scene, event, intervals, seed, budget)


RUNS = {"monte_carlo": monte_carlo, "dynamics": dynamics, "intervals": intervals}


def work_of(stage, scene, options):
    """Return the run of a ``stage`` with the ``options`` of the command line."""
    _, *names = inspect.signature(RUNS[stage]).parameters
    given = {name: getattr(options, name) for name in names}
    if missing := [name for name, value in given.items() if value is None]:
        raise InputError(f"{stage} needs --{missing[0]}")
    return RUNS[stage](scene, **given)


def shard(work, part, first, stop):
    """Return the content of a shard: sums of the blocks ``first`` … ``stop`` − 1 of a ``part``."""
    if part not in work.parts:
        raise InputError(f"part must be one of {', '.join(work.parts)}, not {part!r}")
    sums = [array.tolist() for array in work.parts[part].work(first, stop)]
    return {"part": part, "first": first, "stop": stop, "sums": sums}


def joined(work, paths):
    """Return the point that is the sum of the shards at ``paths``, in any order."""
    from twodiscs.sampling.blocks.rounds import joined

    parts = {name: [] for name in work.parts}
    for path in paths:
        content = read_json(path)
        if content.get("part") not in parts:
            raise InputError(f"{path} must be a shard of one of {', '.join(parts)}")
        parts[content["part"]].append(content)
    return work.point({name: joined(run, parts[name]) for name, run in work.parts.items()})


def main():
    parser = Parser(prog=__spec__.name, description=__doc__.split("\n")[0])
    parser.add_argument("stage", choices=RUNS)
    add_scene(parser)
    parser.add_argument("--quantities", nargs="+", help="monte_carlo: volume, <event>_area")
    parser.add_argument("--samples", type=whole_number, help="monte_carlo: how many at least")
    parser.add_argument("--shell", type=number, help="monte_carlo: thickness, a fraction")
    parser.add_argument(
        "--target",
        nargs="+",
        type=assignment,
        metavar="EVENT=ERROR",
        help="dynamics: relative standard errors",
    )
    parser.add_argument("--event", help="intervals: the hop")
    parser.add_argument("--intervals", type=whole_number, help="intervals: how many at least")
    parser.add_argument("--budget", type=whole_number, help="wall and disc events at most")
    parser.add_argument("--seed", type=whole_number, required=True, help="of the random streams")
    parser.add_argument("--part", help="of a shard: all, or a rare hop")
    parser.add_argument("--blocks", nargs=2, type=int, metavar=("FIRST", "STOP"))
    parser.add_argument("--shards", nargs="*", default=[], metavar="JSON", help="shards to add up")
    parser.add_argument("--output", required=True, type=Path, metavar="JSON")
    options = parser.parse_args()
    work = work_of(options.stage, scene_of(options), options)
    if options.blocks:
        content = shard(work, options.part, *options.blocks)
    elif options.shards:
        content = joined(work, options.shards).content()
    else:
        with progress_bar(None, options.stage) as progress:
            content = work.run(progress).content()
    of_shards = sum(read_seconds(path) or 0.0 for path in options.shards)
    write_json(options.output, content, round(time.process_time() + of_shards, 2))


if __name__ == "__main__":
    run(main)
