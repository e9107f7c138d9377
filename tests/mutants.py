# ruff: noqa: E501 (one mutant, one line)
"""Mutants: one mistake at a time in a copy of the repository; the tests must notice each of them.

    python tests/mutants.py [FILE or word ...]

tries the mutants whose file or description holds one of the words, or all, two at a time. Test files
that are named after the mutated module, or name it most often, run first, ``--most`` of them at most;
the first failure ends the run. A line has the verdict, the seconds and the test that failed. At the end
these tests run on the sources as they are and must pass, or they noticed nothing. The exit status is
0 if no mutant lived. A mutant is anchored on a text that the sources hold once.
"""

import argparse
import ast
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from pathlib import Path
from queue import SimpleQueue

REPOSITORY = Path(__file__).resolve().parents[1]

#: Tests for what is no module, files or folders: the beginning of a path, in the order of running.
READERS = {
    # Tests draw whole initial states, which are made elsewhere.
    "src/twodiscs/sampling/conditioned.py": ("tests/sampling/test_starts.py", "tests/sampling"),
    # The workflow compares a point with its job.
    "src/twodiscs_paper/pipeline/points.py": ("tests/sampling/test_rounds.py", "tests/workflow"),
    "workflow/rules": ("tests/workflow/test_jobs.py", "tests/workflow"),
    "workflow/scripts": ("tests/pipeline/test_scripts.py", "tests/workflow/test_build.py"),
    "workflow/explorer": ("tests/pipeline/test_explorer.py",),
    "workflow/report": ("tests/pipeline/test_report.py", "tests/workflow/test_report.py"),
    "paper": ("tests/pipeline/test_numbers.py", "tests/pipeline/test_manuscript.py"),
}

#: Seconds: a run of tests that takes longer hangs, which is noticed as well.
PATIENCE = 600

#: Mistake, text, its replacement.
# fmt: off
MUTANTS = [
    ("rough walls keep momentum", "return tuple(self.periodic) if self.moment_of_inertia is None else ()", "return tuple(self.periodic)"),
    ("wrong radius in the lowest potential", "m1 * max(apart + r2 - r1, 0.0)", "m1 * max(apart + r1 - r2, 0.0)"),
    ("copies of confined walls", "(1 + scene.identical) * scene.accessible_fraction(event)", "(1 + scene.identical)"),
    ("mirror images of the right wall", 'mirrored = EVENT_AXES[event] == "x" or not scene.field', "mirrored = not scene.field"),
    ("one seed for all radii", 'check_choice("method", method, RANDOM_METHODS), key)', 'check_choice("method", method, RANDOM_METHODS))'),
    ("two blocks, one stream", "np.uint64(block) * MIX_2", "np.uint64(block // 2) * MIX_2"),
    ("law of the flux through a hop", "rest = draw_largest(state, 3)", "rest = draw_largest(state, 2)"),
    ("orders of x and y as one", "order_y = 1 if bits & np.uint64(1 << 61)", "order_y = 1 if bits & np.uint64(1 << 62)"),
    ("a block left out", "for first in range(0, blocks, per_shard)", "for first in range(1, blocks, per_shard)"),
    ("replicas numbered anew in each block", "(block - 1) * replicas + used, 0", "used, 0"),
    ("wrong disc at a wall in a field", "else b[3], side, field)", "else b[1], side, field)"),
    ("paths end too soon", "<= self.fastest * left else", "<= 0.5 * self.fastest * left else"),
    ("off by one return", "wanted + (1.0 if rising < 0.0 else 0.0)", "wanted"),
    ("age after a hop", "age[i] = time - until if hop", "age[i] = time if hop"),
    ("squares of two classes counted twice", "products + np.triu(products, 1).T", "products + products.T"),
    ("a larger work is lost", "result._again(larger, **how)", "result._again({}, **how)"),
    ("radii that do not fit are lost", "return Scan(results, self.refused, self.parameters)", "return Scan(results, {}, self.parameters)"),
    ("numbers with errors that are not known", "n in self and self[n].stderr is not None]", "n in self and self[n].value is not None]"),
    ("finished work counts twice", "bar.update(done - bar.n)", "bar.update(done)"),
    ("a residual's sign", "math.copysign(min(abs(v), clip * LARGEST_RESIDUAL), v)", "min(abs(v), clip * LARGEST_RESIDUAL)"),
    ("no bias in the law of a cost", "c / (errors**2 - floor**2)", "c / errors**2"),
    ("costs over the plain scene", 'repetitions), "without_effects")', 'repetitions), "plain")'),
    ("a bound that is hidden", 'else found["z"] or None', "else None"),
    ("discs as an effect that is compiled", 'for n, v in effects.items() if n != "discs"]', "for n, v in effects.items()]"),
    ("sum of variances in place of their difference", "math.sqrt(late - early) / time}", "math.sqrt(late + early) / time}"),
    ("one of two tests of a plateau", 'min(rate["p"], of["trend"]["p"]) > TEST_LEVEL', 'max(rate["p"], of["trend"]["p"]) > TEST_LEVEL'),
    ("a point of another radius", 'scene.parameters() | settings))', 'content["scene"] | settings))'),
    ("kinks of a thick shell", "np.clip([*touches, float(thickness)], 0.0", "np.clip([0.0, float(thickness)], 0.0"),
    ("one block beyond the budget", "min(blocks, math.floor(affordable * done))", "min(blocks, math.ceil(affordable * done))"),
    ("misses resolved by units", "max(0.0, spread) * min(unit, samples)", "max(0.0, spread) * samples"),
    ("sign of a varying number", '"all": -per_chain * count', '"all": per_chain * count'),
    ("a shell independent of the volume", 'if len(shares) == 1 or "volume" in names:', "if len(shares) == 1:"),
    ("one event of the sum rule is enough", "if enough and all(replicas >= replicas_needed(", "if enough and any(replicas >= replicas_needed("),
    ("error asked instead of reached", "replicas_needed(scene, event, min(errors))", "replicas_needed(scene, event, errors[0])"),
    ("days of some radii", "taken * len(keys) / max(1, len(some)) / DAY", "taken / DAY"),
    ("an empty set passes", "        if tested:", "        if True:"),
    ("a score that is no number", 'not abs(row["z"]) <= bound', 'abs(row["z"]) > bound'),
    ("tolerance of scores for all estimates", 'if name in TABLES_OF_SCORES and column == "estimate"', 'if column == "estimate"'),
    ("the repository of a hook", "if name not in REPOSITORY", "if name"),
    ("a wall that discs go through", ">= 0.0 and max(y, z) <= breadth", ">= 0.0"),
    ("counts of strips in a sum", 'of_event.items() if one["starts"] == "invariant"', "of_event.items()"),
    ("energy in the measure of proposals", "return measure * neck.most ** (prism.components / 2 - 1)", "return measure"),
    ("both orders of a draw count", "return q1, q1 - q2, sign * (q1 - q2) > 0.0", "return q1, q1 - q2, True"),
    ("one stream for kicks and initial states", "open_stream(seed ^ KICK_SEED_BIT, replica)", "open_stream(seed, replica)"),
    ("the same kicks of all blocks of states", "open_kicks(i, seed, first + i, kicks)", "open_kicks(i, seed, i, kicks)"),
    ("passages of other pairs", "partial(odd_clusters_per_passage, others=others)", "odd_clusters_per_passage"),
    ("proposals of heights as states", "    settle(state, initial, centres, initial.chain)\n", ""),
    ("diffusion of unequal discs as of equal ones", "discs = range(1, scene.discs + 1 if scene.identical else 2)", "discs = range(1, scene.discs + 1)"),
    ("hops shared on a ring as in a box", "2 - (not scene.periodic) * 2 / pairs", "2 - 2 / pairs"),
    ("count of the event that is known best", 'count = min(row["count"] for row in counted)', 'count = max(row["count"] for row in counted)'),
    ("rows of a trajectory back in time", "free = np.diff(time) >= 0", "free = np.ones(len(time) - 1, bool)"),
    ("name of a scene in the verdict", '(path.parent.name if path.stem == "check" else path.stem, read_table(path))', "(path.stem, read_table(path))"),
    ("ratio of another box in the errata", "return right, ratios[0], radius", "return right, ratios[-1], radius"),
    ("shards that depend on the accuracy", "        work=lambda w: SCENES[w.scene].shard_arguments(w.stage)", "        work=lambda w: SCENES[w.scene].arguments(w.stage)"),
    ("whole steps before and after a crossing", "before, after = phase, 1.0 - phase", "before, after = 1.0, 1.0"),
    ("crossings without the weight of the flux", "forward = length * math.sqrt(2 * exponential(stream))", "forward = length * abs(normal_pair(stream)[0])"),
    ("first crossing or the last", "if crossings and not early:", "if crossings:"),
    ("error of a ratio without its correlation", '- 2 * ratio * counts["passage*crossings"] / pairs', '+ 2 * ratio * counts["passage*crossings"] / pairs'),
    ("speeds of strata in a field over the energy, not its root", "speed /= math.sqrt(state_kinetic_fraction(state, self.prism))", "speed /= state_kinetic_fraction(state, self.prism)"),
    ("fraction that is called per cent", 'at-most(single-file, "stderr/estimate", n: 1, scale: 100)', 'at-most(single-file, "stderr/estimate", n: 1)'),
    ("cost of insertions of a pilot as of a block", "(one.estimate.relative_stderr**2 * blocks, 0.0)", "(one.estimate.relative_stderr**2, 0.0)"),
    ("scores of the explorer with the other sign", "exact && (DURATION / exact - mean) / (relative * mean)", "exact && (mean - DURATION / exact) / (relative * mean)"),
    ("jobs beside one that measures seconds", "threads: lambda w: ALL_CORES if w.table in MADE_BY[w.table].timed else 1", "threads: lambda w: 1"),
    ("spin of disc 2 by the inertia of disc 1", "direction[used + 1] * inertia[1]", "direction[used + 1] * inertia[0]"),
    ("spins not reversed", "positions = 10 if law.depth is not None else 8", "positions = 10"),
    ("two shells without their overlap", '"right*top": self.right_and_top, "top*top"', '"right*top": 0, "top*top"'),
    ("first file of a list", "for moment in (min(times), max(times))", "for moment in (times[0], times[-1])"),
    ("Monte Carlo as a reference without error", "if known else (sampled_time, spread)", "if known else (sampled_time, 0.0)"),
]
# fmt: on


#: The folders of the files that a mutant may be in.
MUTATED = "src", "workflow", "paper"


@cache
def texts(*folders):
    """Return {path in the repository: text} of the files in ``folders`` that are sources."""
    paths = (path for folder in folders for path in (REPOSITORY / folder).rglob("*"))
    kinds = (".py", ".smk", ".js", ".css", ".html", ".typ")
    return {
        path.relative_to(REPOSITORY).as_posix(): path.read_text(encoding="utf-8")
        for path in paths
        if path.suffix in kinds
    }


def file_scene(text):
    """Return the path of the only file with this ``text``, once; raise ``LookupError`` otherwise."""
    found = [path for path, content in texts(*MUTATED).items() for _ in range(content.count(text))]
    if len(found) != 1:
        raise LookupError(f"{text!r} must be in the sources once, but is in {found}")
    return found[0]


# Which tests --------------------------------------------------------------------------------------


def names_in(text, mutated):
    """Return the names of the function or class of a ``text`` that holds the mutated text, or all.

    A private one is tested through others, so that all names of the file count.
    """
    place = text.count("\n", 0, text.index(mutated)) + 1
    named = [node for node in ast.parse(text).body if hasattr(node, "name")]
    own = [node.name for node in named if node.lineno <= place <= node.end_lineno]
    return [n for n in own if n[0] != "_"] or [n.name for n in named if n.name[0] != "_"]


def nearest(mutated):
    """Return the test files for a mutated text of the sources, the nearest first.

    By name, then by how often a file names its module and what is mutated.
    """
    path = file_scene(mutated)
    for beginning, files in READERS.items():
        if path.startswith(beginning):
            return files
    here = Path(path)
    names = [here.stem, *names_in(texts(*MUTATED)[path], mutated)]

    def order(test):
        text = texts("tests")[test]
        named = Path(test).stem.startswith((f"test_{here.stem}", f"test_{here.parent.name}"))
        # Not as an argument by name, as in ``run(check=True)``.
        spoken = sum(len(re.findall(rf"\b{name}\b(?!=)", text)) for name in names)
        return not named, -spoken, len(text)

    return sorted((p for p in texts("tests") if Path(p).name.startswith("test_")), key=order)


# How ----------------------------------------------------------------------------------------------


def copied(folder):
    """Copy the files of the repository to a ``folder``, those that are ignored left out."""
    words = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    listed = subprocess.run(words, cwd=REPOSITORY, capture_output=True, text=True, check=True)
    for name in filter(None, listed.stdout.split("\0")):
        if (REPOSITORY / name).exists():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(REPOSITORY / name, folder / name)
    return folder


def failure(folder, files):
    """Run tests in a copy of the repository; return the one that failed first, or None."""
    here = {"PYTHONPATH": str(folder / "src"), "XDG_CACHE_HOME": str(folder.parent / "cache")}
    words = [sys.executable, "-m", "pytest", "-x", "-p", "no:cacheprovider", "--tb=no", *files]
    how = {"capture_output": True, "text": True, "timeout": PATIENCE, "cwd": folder}
    try:
        run = subprocess.run(words, env=os.environ | here, **how)
    except subprocess.TimeoutExpired:
        return "a run without an end"
    failed = re.search(r"^(?:FAILED|ERROR) (\S+)", run.stdout, re.MULTILINE)
    if run.returncode and not failed:
        sys.exit(f"pytest does not run:\n{run.stdout}{run.stderr}")
    return failed and failed[1]


def main(words, most):
    # The plan is made before the first run, so that an edit meanwhile changes nothing.
    plans = []
    for what, old, new in MUTANTS:
        file = file_scene(old)
        if not words or any(word.removeprefix("./") in f"{file} {what}" for word in words):
            plans.append((what, old, new, file, nearest(old)[:most]))
    with tempfile.TemporaryDirectory() as home, ThreadPoolExecutor(2) as threads:
        copies = SimpleQueue()
        for name in ("a", "b"):
            copies.put(copied(Path(home, name)))

        def tried(plan):
            what, old, new, file, tests = plan
            folder, begun, text = copies.get(), time.monotonic(), texts(*MUTATED)[file]
            (folder / file).write_text(text.replace(old, new), encoding="utf-8")
            try:
                failed = failure(folder, tests)
            finally:
                (folder / file).write_text(text, encoding="utf-8")
                copies.put(folder)
            verdict = f"killed by {failed}" if failed else "LIVED"
            print(f"{file}: {what}: {verdict} ({time.monotonic() - begun:.0f} s)", flush=True)
            return failed

        found = [*threads.map(tried, plans)]
        killers = sorted({one.partition("[")[0] for one in found if one and "::" in one})
        false = failure(copies.get(), killers) if killers else None
    lived = found.count(None)
    print(f"{len(plans) - lived} of {len(plans)} killed")
    sys.exit(f"{false} fails without a mutant" if false else lived)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("words", nargs="*", metavar="FILE")
    parser.add_argument("--most", type=int, default=8, help="test files for a mutant (8)")
    options = parser.parse_args()
    main(options.words, options.most)
