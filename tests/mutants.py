# ruff: noqa: E501 (one mutant, one line)
"""Mutants: one mistake at a time in a copy of the sources; the tests must notice each of them.

    python tests/mutants.py [word ...]

tries those whose file or description holds one of the words, or all (an hour or so): with the tests
of the module, then with the tests of its folder. Each is anchored on a text that its file holds once;
where that is gone, the list needs another one. At the end all tests that caught a mutant run on the
sources as they are and must pass, or they caught nothing. The exit status is 0 if none survived.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]

#: The tests of folders that have no tests of the same name: results of the face.
ELSEWHERE = {"comparison/measured": "tests/test_results.py"}

#: Seconds: a run of tests that takes longer hangs, which is noticed as well.
PATIENCE = 1200

#: File, mistake, text, its replacement.
# fmt: off
MUTANTS = [
    ("model/scene.py", "reach of an image", "return side / 2 if axis in self.periodic", "return side if axis in self.periodic"),
    ("model/two.py", "hop at its threshold", "if scene.spread(axis) <= scene.exact", "if scene.spread(axis) < scene.exact"),
    ("model/two.py", "discs that jam fit", "scene.spread() > scene.exact_contact**2", "scene.spread() >= scene.exact_contact**2"),
    ("model/two.py", "hop at its threshold of energy", "return lowest < ENERGY", "return lowest <= ENERGY"),
    ("model/scene.py", "conserved momentum", " + spin) - len(self.conserved)", " + spin)"),
    ("model/scene.py", "rough walls keep momentum", "return tuple(self.periodic) if self.moment_of_inertia is None else ()", "return tuple(self.periodic)"),
    ("model/two.py", "wrong radius in the lowest potential", "m1 * max(apart + r2 - r1, 0.0)", "m1 * max(apart + r1 - r2, 0.0)"),
    ("model/two.py", "multiplicity of confined walls", "(1 + scene.identical) * scene.share(event.name)", "(1 + scene.identical)"),
    ("model/two.py", "mirror images of the right wall", 'mirrored = event.axis == "x" or not scene.field', "mirrored = not scene.field"),
    ("model/scene.py", "reach of the top", "self.field * (self.height - 2 * self.radius)", "self.field * (self.height - self.radius)"),
    ("model/box.py", "swapped axis of a threshold", 'self.width if AXIS[hop] == "y"', 'self.width if AXIS[hop] == "x"'),
    ("model/radii.py", "one seed for all radii", 'check_choice("method", method, METHODS), key)', 'check_choice("method", method, METHODS))'),
    ("model/radii.py", "off by a half in the grid", "(j + 0.5) / n) ** 2", "(j + 1) / n) ** 2"),
    ("theory/plain.py", "factor of the contact area", "2 * math.sqrt(2) * disc", "math.sqrt(2) * disc"),
    ("theory/plain.py", "swapped axis of the arc", "self.square - min(range_y, sigma) ** 2", "self.square - min(range_x, sigma) ** 2"),
    ("theory/plain.py", "swapped axis of the volume", "area * x * cos", "area * x * sin"),
    ("theory/plain.py", "factor of a wall's shell", "flat - epsilon / 2)", "flat - epsilon)"),
    ("theory/plain.py", "Jacobian of a collision's shell", "(1 + s / arc.sigma) * ", ""),
    ("theory/plain.py", "swapped axis of a hop", "math.sqrt(2) * arc.range_y * arc", "math.sqrt(2) * arc.range_x * arc"),
    ("theory/plain.py", "Chernov's constant", "(1.5 * math.pi * volume)", "(math.pi * volume)"),
    ("theory/exact.py", "time at a confined wall", "scene.share(event) / value if value", "1 / value if value"),
    ("theory/plain.py", "width of a strip", "epsilon = distance / math.sqrt(2)", "epsilon = distance / 2"),
    ("theory/flux.py", "constant of D components", "math.lgamma(half + 0.5)", "math.lgamma(half + 1)"),
    ("theory/weighted.py", "power of the energy", "scene.velocity_components / 2 - 1).beyond()", "scene.velocity_components / 2).beyond()"),
    ("theory/weighted.py", "mass at a wall", "space.wall(axis, disc, high) / math.sqrt(scene.masses[disc])", "space.wall(axis, disc, high)"),
    ("theory/weighted.py", "wrong wall", "[(declared.axis, 0, declared.side > 0)]", "[(declared.axis, 0, declared.side < 0)]"),
    ("theory/weighted.py", "mass in the potential", "field * Fraction(m))", "field)"),
    ("theory/tails.py", "constant of a tail", "6 * (along_x + along_y)", "3 * (along_x + along_y)"),
    ("theory/tails.py", "swapped axis of a tail", "arc.range_y**2 * arc.beyond_x**4", "arc.range_x**2 * arc.beyond_x**4"),
    ("theory/tails.py", "density at zero", "math.sqrt(2) / (16 * side)", "math.sqrt(2) / (8 * side)"),
    ("theory/tails.py", "power of a drift's chance", "volume(scene) * time**2)", "volume(scene) * time)"),
    ("theory/laws.py", "sign for small discs", "(4 * along / across - 2) * r", "(4 * along / across + 2) * r"),
    ("theory/laws.py", "factor near jamming", "root * left / (4 * (last_x + last_y))", "root * left / (2 * (last_x + last_y))"),
    ("theory/virial.py", "sign of the virial", "-scene.contact_distance / pairs", "scene.contact_distance / pairs"),
    ("theory/many/three.py", "slope of a far pair", "np.where(bent, most**2 / 2, across**2 / 2)", "np.where(bent, most**2, across**2 / 2)"),
    ("theory/many/channel.py", "one disc too few across", "per_height = n / channel.height", "per_height = (n - 1) / channel.height"),
    ("sampling/streams.py", "two blocks, one stream", "np.uint64(block) * MIX_2", "np.uint64(block // 2) * MIX_2"),
    ("sampling/separations.py", "law of the flux through a hop", "rest = largest_of(state, 3)", "rest = largest_of(state, 2)"),
    ("sampling/separations.py", "orders of x and y as one", "else (1 if bits & np.uint64(1 << 61) else -1)", "else (1 if bits & np.uint64(1 << 62) else -1)"),
    ("sampling/prism.py", "power of the energy on a surface", "dx, dy, dz, prism.components - 1)", "dx, dy, dz, prism.components - 2)"),
    ("sampling/prism.py", "momentum not conserved", "= -relative * prism.fractions[1]\n            used", "= relative * prism.fractions[1]\n            used"),
    ("sampling/prism.py", "height of the wrong disc", "weights[1] * (y2 + half2)", "weights[1] * (y2 + half1)"),
    ("points/strata.py", "error of strata", "np.sum(shares**2 * variances)", "np.sum(shares * variances)"),
    ("sampling/blocks/rounds.py", "a block left out", "for first in range(0, blocks, per_piece)", "for first in range(1, blocks, per_piece)"),
    ("sampling/montecarlo.py", "thickness of a hop's shell", "2.0 * (thick * thick)", "1.0 * (thick * thick)"),
    ("sampling/montecarlo.py", "number of walls", '"walls": 4 * len(scene.walled)', '"walls": 2 * len(scene.walled)'),
    ("sampling/many/initial.py", "power of the room in a channel", "for _ in range(discs):\n        ratio *= left", "for _ in range(discs - 1):\n        ratio *= left"),
    ("sampling/many/insertions.py", "covariance with the volume", "- 2 * ratios * covariance[0, 1:]", "- ratios * covariance[0, 1:]"),
    ("dynamics/law.py", "height of a flight", "square - 2.0 * gravity * above", "square - gravity * above"),
    ("dynamics/law.py", "wrong mass at a jump", "q2 += math.copysign(wrap[2], relative)", "q2 += math.copysign(wrap[1], relative)"),
    ("dynamics/law.py", "wrong mass in a collision", "divided(2.0, m2, m1)", "divided(2.0, m1, m2)"),
    ("dynamics/law.py", "sign of a spin", "u_before - side_y * s", "u_before + side_y * s"),
    ("dynamics/law.py", "wall of the wrong ball", "z2 + w2 * time, code == WALL_Z2", "z2 + w2 * time, code == WALL_Z1"),
    ("dynamics/two/follow.py", "velocities not reversed", "= -value if turned else value", "= value"),
    ("dynamics/two/follow.py", "replicas numbered anew in each block", "(block - 1) * replicas + used, 0", "used, 0"),
    ("dynamics/two/lockstep.py", "wrong wall", "hit(code, WALL_Y1, WALL_Y2,", "hit(code, WALL_Y1, WALL_X2,"),
    ("dynamics/two/lockstep.py", "missing product", "for f in range(e, N):", "for f in range(e + 1, N):"),
    ("dynamics/two/lockstep.py", "wrong disc at a wall in a field", "else b[3], side, gravity)", "else b[1], side, gravity)"),
    ("dynamics/two/strip.py", "time of a strip", '"duration": 2 * ', '"duration": 1 * '),
    ("dynamics/two/strip.py", "paths end too soon", "<= self.fastest * left else", "<= 0.5 * self.fastest * left else"),
    ("dynamics/two/returns.py", "off by one return", "wanted + (1.0 if rising < 0.0 else 0.0)", "wanted"),
    ("dynamics/two/returns.py", "age after a hop", "age[i] = time - until if hop", "age[i] = time if hop"),
    ("dynamics/many/lockstep.py", "wrong image on a ring", "dx - math.copysign(ring[0], dx)", "dx + math.copysign(ring[0], dx)"),
    ("dynamics/many/lockstep.py", "squares of two classes counted twice", "products + np.triu(products, 1).T", "products + products.T"),
    ("points/estimates.py", "products of two events", "(1 if a == b else 2) * w[a]", "w[a]"),
    ("points/estimates.py", "clusters in a bound", "(CLUSTER * -math.log1p", "(-math.log1p"),
    ("points/estimates.py", "curvature at zero", "np.array([7, -1]) / 6", "np.array([3, -1]) / 2"),
    ("comparison/scores.py", "overlap of two shells", "2 * m1 * m2 * overlap", "m1 * m2 * overlap"),
    ("comparison/scores.py", "sign of a score", "(expected - count) / error", "(count - expected) / error"),
    ("comparison/scores.py", "two tails", "alarm) / (2 * comparisons)", "alarm) / comparisons"),
    ("comparison/check.py", "half of the alarm", "judged(rows, alarm / 2)", "judged(rows, alarm)"),
    ("comparison/measured/scan.py", "a larger work is lost", "result._again(settings, options)", "result._again(self.settings, options)"),
    ("comparison/measured/scan.py", "radii that do not fit are lost", "for result in self], self.refused)", "for result in self])"),
    ("comparison/measured/measurements.py", "numbers with errors that are not known", "self._has_error(name)]", "self[name].value is not None]"),
    ("comparison/measured/measurements.py", "times proportional to counts", "means[k] / number if", "number / means[k] if"),
    ("comparison/measured/progress.py", "finished work counts twice", "bar.update(done - bar.n)", "bar.update(done)"),
    ("figures/motion/pressure.py", "error of a pressure", 'value * row["stderr"] / time', 'row["stderr"] / time'),
    ("figures/motion/over_time.py", "decay of what is left", "np.exp(-2 * kappa * late", "np.exp(-kappa * late"),
    ("figures/kit/panels.py", "a residual's sign", "math.copysign(min(abs(v), clip * LARGEST_RESIDUAL), v)", "min(abs(v), clip * LARGEST_RESIDUAL)"),
    ("figures/geometry/surface_shell.py", "width of a shell along an axis", "d = sqrt(2) * epsilon", "d = epsilon"),
    ("twodiscs_paper/studies/accuracy_cost/figure.py", "bars of one run for the mean", 'row["spread"] / math.sqrt(row["repetitions"])', 'row["spread"]'),
    ("twodiscs_paper/studies/passages/measure.py", "one stream for two estimates", 'self._seed("states"), on_surface', 'self._seed("times"), on_surface'),
    ("twodiscs_paper/studies/passages/measure.py", "sign of an exponent", "math.log2(values[0] / values[1])", "math.log2(values[1] / values[0])"),
    ("twodiscs_paper/studies/passages/models/file.py", "length of a ring for a disc", "per_disc = scene.width / scene.discs\n    moved", "per_disc = scene.width / 2\n    moved"),
    ("twodiscs_paper/studies/passages/measure.py", "error of the slope of κ", "math.hypot(4 * early.stderr", "math.hypot(early.stderr"),
    ("twodiscs_paper/studies/passages/measure.py", "fit to all distances", '-one["distance"])[-LAST:]', '-one["distance"])'),
    ("twodiscs_paper/studies/passages/measure.py", "error of a logarithm", 'errors = [one["stderr"] / value', 'errors = [one["stderr"]'),
    ("twodiscs_paper/studies/tails/measure.py", "sum of variances in place of their difference", "weights.append(time**2 / (late - early))", "weights.append(time**2 / (late + early))"),
    ("twodiscs_paper/studies/tails/measure.py", "degrees of freedom", "return chi2, len(hazards) - 1", "return chi2, len(hazards)"),
    ("twodiscs_paper/studies/distributions/measure.py", "swapped axis of a drift", 'row["height"] if row["event"] == "vertical_hop"', 'row["width"] if row["event"] == "vertical_hop"'),
    ("twodiscs_paper/studies/distributions/measure.py", "one of two tests of a plateau", 'min(rate["p"], of["trend"]["p"]) > LEVEL', 'max(rate["p"], of["trend"]["p"]) > LEVEL'),
    ("twodiscs_paper/studies/agreement/measure.py", "error of a mean square", "math.sqrt(2 / number)", "math.sqrt(1 / number)"),
    ("twodiscs_paper/studies/agreement/measure.py", "independent counts of a bin", "fraction * (1 - fraction)", "fraction"),
    ("twodiscs_paper/configuration/scene.py", "smallest radius of the smaller disc", 'max(1, box.effects.get("radius_ratio", 1))', 'box.effects.get("radius_ratio", 1)'),
    ("twodiscs_paper/configuration/request.py", "one seed for all scenes", "stream_seed(self.seed, self.name, stage", 'stream_seed(self.seed, "", stage'),
    ("theory/weighted.py", "kinks of a thick shell", "np.clip([0.0, *touches, float(thickness)], 0.0", "np.clip([0.0, float(thickness)], 0.0"),
    ("theory/exact.py", "range of a disc in the free fraction", "else 2 * radius)\n        for axis in scene.axes", "else radius)\n        for axis in scene.axes"),
    ("sampling/blocks/rounds.py", "one block beyond the budget", "min(blocks, math.floor(affordable * done))", "min(blocks, math.ceil(affordable * done))"),
    ("points/estimates.py", "misses resolved by units", "max(0.0, spread) * min(unit, samples)", "max(0.0, spread) * samples"),
    ("points/estimates.py", "error of a straight line at 0", "math.hypot(3 * error, other) / 2", "math.hypot(3 * error, other)"),
    ("points/intervals.py", "sign of a varying number", 'weights |= {"all": -per_chain * count / self.intervals}', 'weights |= {"all": per_chain * count / self.intervals}'),
    ("points/monte_carlo.py", "a shell independent of the volume", 'if len(shares) == 1 or "volume" in names:', "if len(shares) == 1:"),
    ("points/monte_carlo.py", "volume and area in a ratio", '| {"volume": -1 / volume}', '| {"volume": 1 / volume}'),
    ("points/monte_carlo.py", "fewest hits of both walls", "enough = min(self.sampled(wall).enough for wall in WALL_AREAS)", "enough = max(self.sampled(wall).enough for wall in WALL_AREAS)"),
    ("comparison/check.py", "one event of the sum rule is enough", "enough = all(replicas >= replicas_needed(", "enough = any(replicas >= replicas_needed("),
    ("comparison/tables/mean_times.py", "error asked instead of reached", "replicas_needed(scene, event, min(errors))", "replicas_needed(scene, event, errors[0])"),
    ("twodiscs_paper/pipeline/cost.py", "days of some radii", "taken * len(keys) / max(1, len(some)) / DAY", "taken / DAY"),
    ("twodiscs_paper/pipeline/results/verdict.py", "an empty set passes", "        if tested:", "        if True:"),
    ("twodiscs_paper/pipeline/results/verdict.py", "a score that is no number", 'not abs(row["z"]) <= bound', 'abs(row["z"]) > bound'),
    ("twodiscs_paper/pipeline/results/verify.py", "tolerance of scores for all estimates", 'if name in TABLES_OF_SCORES and column == "estimate"', 'if column == "estimate"'),
    ("twodiscs_paper/pipeline/results/provenance.py", "the repository of a hook", "if name not in REPOSITORY", "if name"),
    ("twodiscs_paper/studies/distributions/measure.py", "error of a hazard", "math.sqrt(1 / rest - 1 / alive)", "math.sqrt(1 / rest + 1 / alive)"),
    ("twodiscs_paper/studies/passages/measure.py", "error of an exponent", "math.hypot(*errors) / math.log(2)", "math.hypot(*errors)"),
    ("twodiscs_paper/studies/agreement/measure.py", "counts of strips in a sum", 'of_event.items() if one["starts"] == "invariant"', "of_event.items()"),
    ("sampling/prism.py", "energy in the measure of proposals", " else measure * neck.most ** (prism.components / 2 - 1)", " else measure"),
    ("sampling/prism.py", "both orders of a draw count", "return q1, q1 - q2, sign * (q1 - q2) > 0.0", "return q1, q1 - q2, True"),
    ("dynamics/many/passages.py", "flux weight cut off", "math.sqrt(2.0) * uniform(state) < abs(", "uniform(state) < abs("),
    ("dynamics/many/passages.py", "the same kicks in all blocks", "block * HOPS_OF_BLOCK + l, kicks)", "l, kicks)"),
    ("dynamics/kicks.py", "one stream for kicks and initial states", "open_stream(seed ^ SEED, replica)", "open_stream(seed, replica)"),
    ("dynamics/kicks.py", "the same kicks of all blocks of states", "open_kicks(i, seed, first + i, kicks)", "open_kicks(i, seed, i, kicks)"),
    ("comparison/measured/transmission.py", "each call repeats the first blocks", 'seeds["clusters"], first)', 'seeds["clusters"], 0)'),
    ("comparison/measured/transmission.py", "passages of other pairs", "partial(of_clusters, others=others)", "of_clusters"),
    ("sampling/many/initial.py", "proposals of heights as states", "    settle(state, initial, centres, initial.chain)\n", ""),
    ("twodiscs_paper/studies/passages/measure.py", "error of the second estimate", "math.hypot(found.stderr, reference.stderr)", "found.stderr"),
    ("twodiscs_paper/studies/passages/measure.py", "error of a root", "variance.value / 2 if variance", "variance.value if variance"),
    ("twodiscs_paper/studies/passages/models/file.py", "limit of long waves", "np.polyfit(numbers**2, sizes", "np.polyfit(numbers, sizes"),
]
# fmt: on


def tests(package, *targets):
    """Run pytest on the ``package`` in a folder; return the test that failed first, or None."""
    here = {"PYTHONPATH": str(package), "XDG_CACHE_HOME": str(package / "cache")}
    words = [sys.executable, "-m", "pytest", "-x", "-p", "no:cacheprovider", "--tb=no", *targets]
    how = {"capture_output": True, "text": True, "timeout": PATIENCE}
    try:
        run = subprocess.run(words, env=os.environ | here, **how)
    except subprocess.TimeoutExpired:
        return "a run without an end"
    failed = re.search(r"^(?:FAILED|ERROR) ([^\s\[]+)", run.stdout, re.MULTILINE)
    if run.returncode and not failed:
        sys.exit(f"pytest does not run:\n{run.stdout}{run.stderr}")
    return failed and failed[1]


def source(file):
    """Return the path of a ``file`` of the list below ``src``."""
    return Path(file if file.startswith("twodiscs_paper/") else f"twodiscs/{file}")


def tiers(file):
    """Yield the targets of pytest for a mutant of ``file``, those first that take least."""
    path = Path("tests", file.removeprefix("twodiscs_paper/"))
    own = {
        *path.parent.glob(f"test_{path.stem}*"),
        *path.parents[1].glob(f"test_{path.parent.name}*"),
    }
    yield sorted({*map(str, own), *filter(None, [ELSEWHERE.get(str(Path(file).parent))])})
    yield [f"tests/{path.parts[1]}"]
    if path.parts[1] != "studies":  # which measure what engines and theory promise
        yield ["tests/studies"]


def main(words):
    os.chdir(REPOSITORY)
    wanted = [m for m in MUTANTS if not words or any(word in f"{m[0]} {m[1]}" for word in words)]
    caught, survived = set(), 0
    with tempfile.TemporaryDirectory() as folder:
        package = Path(folder)
        shutil.copytree(REPOSITORY / "src", package, dirs_exist_ok=True)
        for file, what, old, new in wanted:
            path, begun = package / source(file), time.monotonic()
            text = path.read_text(encoding="utf-8") if path.exists() else ""
            if text.count(old) != 1:
                survived += 1
                print(f"NOT THERE   {file}: {what}: {old!r} {text.count(old)} times", flush=True)
                continue
            path.write_text(text.replace(old, new), encoding="utf-8")
            failed = next(filter(None, (tests(package, *t) for t in tiers(file) if t)), None)
            path.write_text(text, encoding="utf-8")
            survived += not failed
            caught |= {failed} if failed and "::" in failed else set()
            verdict = f"caught      {file}: {what}" if failed else f"SURVIVED    {file}: {what}"
            print(f"{verdict} ({time.monotonic() - begun:.0f} s) {failed or ''}", flush=True)
        false = tests(package, *sorted(caught)) if caught else None
    print(f"{len(wanted) - survived} of {len(wanted)} caught")
    sys.exit(f"{false} fails without a mutant" if false else survived)


if __name__ == "__main__":
    main(sys.argv[1:])
