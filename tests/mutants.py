"""Mutants: one mistake at a time in a copy of the sources; the tests must notice each of them.

    python tests/mutants.py [word ...]

tries those whose file or description holds one of the words, or all (an hour or so): first with the
tests of the module, then with those of its room, then, if it survives, with all but those of the
workflow. Each is anchored on a text that its file holds once; where that is gone, the list below
needs another one. At the end all tests that caught a mutant run on the sources as they are: they
must pass, or they caught nothing. The exit status is 0 if none survived.
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

#: A run of tests that takes longer than so many seconds hangs, which is noticed as well.
PATIENCE = 1200

#: {file: [(text, what takes its place, what it is)]}.
# fmt: off
MUTANTS = {
    "model/scene.py": [
        ("return side / 2 if axis in self.periodic", "return side if axis in self.periodic", "reach of an image"),
        ("if self._spread(axis) <= self.exact", "if self._spread(axis) < self.exact", "hop at its threshold"),
        ("return lowest < ENERGY", "return lowest <= ENERGY", "hop at its threshold of energy"),
        (" + spins - len(self.conserved)", " + spins", "conserved momentum"),
        ("return tuple(self.periodic) if self.moment_of_inertia is None else ()", "return tuple(self.periodic)", "rough walls keep momentum"),
        ("m1 * max(apart + r2 - r1, 0.0)", "m1 * max(apart + r1 - r2, 0.0)", "wrong radius in the lowest potential"),
        ("(1 + self.alike) * self.share(event)", "(1 + self.alike)", "multiplicity of confined walls"),
        ('mirrored = found.axis == "x" or not self.field', "mirrored = not self.field", "mirror images of the right wall"),
        ("self.field * (self.height - 2 * self.radius)", "self.field * (self.height - self.radius)", "reach of the top"),
    ],
    "model/box.py": [('self.width if AXIS[hop] == "y"', 'self.width if AXIS[hop] == "x"', "swapped axis of a threshold")],
    "model/radii.py": [
        ('one_of("method", method, METHODS), key)', 'one_of("method", method, METHODS))', "one seed for all radii"),
        ("(j + 0.5) / n) ** 2", "(j + 1) / n) ** 2", "off by a half in the grid"),
    ],
    "theory/plain.py": [
        ("2 * math.sqrt(2) * disc", "math.sqrt(2) * disc", "factor of the contact area"),
        ("self.square - min(range_y, sigma) ** 2", "self.square - min(range_x, sigma) ** 2", "swapped axis of the arc"),
        ("area * x * cos", "area * x * sin", "swapped axis of the volume"),
        ("flat - epsilon / 2)", "flat - epsilon)", "factor of a wall's shell"),
        ("(1 + s / arc.sigma) * ", "", "Jacobian of a collision's shell"),
        ("math.sqrt(2) * arc.range_y * arc", "math.sqrt(2) * arc.range_x * arc", "swapped axis of a hop"),
    ],
    "theory/exact.py": [
        ("(1.5 * math.pi * volume)", "(math.pi * volume)", "Chernov's constant"),
        ("scene.share(event) / rate(scene, event)", "1 / rate(scene, event)", "time at a confined wall"),
        ("epsilon = distance / math.sqrt(2)", "epsilon = distance / 2", "width of a strip"),
    ],
    "theory/weighted.py": [
        ("math.lgamma(half + 0.5)", "math.lgamma(half + 1)", "constant of D components"),
        ("scene.velocity_components / 2 - 1).beyond()", "scene.velocity_components / 2).beyond()", "power of the energy"),
        ("space.wall(axis, disc, high) / math.sqrt(scene.masses[disc])", "space.wall(axis, disc, high)", "mass at a wall"),
        ("[(found.axis, 0, found.side > 0)]", "[(found.axis, 0, found.side < 0)]", "wrong wall"),
        ("field * Fraction(m))", "field)", "mass in the potential"),
    ],
    "theory/tails.py": [
        ("6 * (along_x + along_y)", "3 * (along_x + along_y)", "constant of a tail"),
        ("arc.range_y**2 * arc.beyond_x**4", "arc.range_x**2 * arc.beyond_x**4", "swapped axis of a tail"),
        ("math.sqrt(2) / (16 * side)", "math.sqrt(2) / (8 * side)", "density at zero"),
        ("volume(scene) * time**2)", "volume(scene) * time)", "power of a drift's chance"),
    ],
    "theory/laws.py": [
        ("(4 * along / across - 2) * r", "(4 * along / across + 2) * r", "sign for small discs"),
        ("root * left / (4 * (last_x + last_y))", "root * left / (2 * (last_x + last_y))", "factor near jamming"),
    ],
    "theory/virial.py": [("-scene.contact_distance / math", "scene.contact_distance / math", "sign of the virial")],
    "sampling/streams.py": [("np.uint64(block) * MIX_2", "np.uint64(block // 2) * MIX_2", "two blocks, one stream")],
    "sampling/separations.py": [
        ("rest = largest_of(state, 3)", "rest = largest_of(state, 2)", "law of the flux through a hop"),
        ("else (1 if bits & np.uint64(1 << 61) else -1)", "else (1 if bits & np.uint64(1 << 62) else -1)", "orders of x and y as one"),
    ],
    "sampling/prism.py": [
        ("dx, dy, dz, prism.components - 1)", "dx, dy, dz, prism.components - 2)", "power of the energy on a surface"),
        ("= -relative * prism.shares[1]", "= -relative * prism.shares[0]", "momentum not conserved"),
        ("weights[1] * (y2 + half2)", "weights[1] * (y2 + half1)", "height of the wrong disc"),
    ],
    "sampling/strata.py": [("np.sum(shares**2 * variances)", "np.sum(shares * variances)", "error of strata")],
    "sampling/rounds.py": [
        ("in run.work(first, end)]", "in run.work(0, end - first)]", "one seed for all shards"),
        ("first, stop = stop, stop + min(stop, largest)", "first, stop = stop + 1, stop + min(stop, largest)", "a block left out"),
    ],
    "sampling/montecarlo.py": [
        ("2.0 * (thick * thick)", "1.0 * (thick * thick)", "thickness of a hop's shell"),
        ('"walls": 4 * len(scene.walled)', '"walls": 2 * len(scene.walled)', "number of walls"),
    ],
    "dynamics/law.py": [
        ("square - 2.0 * gravity * above", "square - gravity * above", "height of a flight"),
        ("q2 += math.copysign(wrap[2], relative)", "q2 += math.copysign(wrap[1], relative)", "wrong mass at a jump"),
        ("divided(2.0, m2, m1)", "divided(2.0, m1, m2)", "wrong mass in a collision"),
        ("u_before - side_y * s", "u_before + side_y * s", "sign of a spin"),
        ("code == WALL_Z2, either(law.half_z1, law.half_z2)", "code == WALL_Z2, law.half_z1", "wall of the wrong ball"),
    ],
    "dynamics/counting.py": [
        ("hit(code, WALL_Y1, WALL_Y2, alike)", "hit(code, WALL_Y1, WALL_X2, alike)", "wrong wall"),
        ("for f in range(e, N):", "for f in range(e + 1, N):", "missing product"),
        ("else b[3], side, gravity)", "else b[1], side, gravity)", "wrong disc at a wall in a field"),
    ],
    "dynamics/strip.py": [
        ('"duration": 2 * place.time', '"duration": place.time', "time of a strip"),
        ("<= fastest * left else", "<= 0.5 * fastest * left else", "paths end too soon"),
    ],
    "dynamics/intervals.py": [
        ("wanted + (1.0 if rising < 0.0 else 0.0)", "wanted", "off by one return"),
        ("age[i] = time - until if hop", "age[i] = time if hop", "age after a hop"),
    ],
    "comparison/estimates.py": [
        ("(1 if a == b else 2) * w[a]", "w[a]", "products of two events"),
        ("(CLUSTER * -math.log1p", "(-math.log1p", "clusters in a bound"),
        ("np.array([7, -1]) / 6", "np.array([3, -1]) / 2", "curvature at zero"),
    ],
    "comparison/scores.py": [
        ("2 * m1 * m2 * overlap", "m1 * m2 * overlap", "overlap of two shells"),
        ("(expected - count) / error", "(count - expected) / error", "sign of a score"),
        ("alarm) / (2 * comparisons)", "alarm) / comparisons", "two tails"),
    ],
    "comparison/check.py": [("judged(rows, alarm / 2)", "judged(rows, alarm)", "half of the alarm")],
    "pipeline/configuration/request.py": [
        ("stream_seed(self.seed, self.name, stage, key)", 'stream_seed(self.seed, "", stage, key)', "one seed for all scenes"),
    ],
}
# fmt: on


def tests(package, *targets):
    """Run pytest on the ``package`` in a folder; return the test that failed first, or None."""
    environment = os.environ | {
        "PYTHONPATH": str(package),
        "XDG_CACHE_HOME": str(package / "cache"),
    }
    command = [sys.executable, "-m", "pytest", "-x", "-p", "no:cacheprovider", "--tb=no", *targets]
    try:
        run = subprocess.run(
            command,
            cwd=REPOSITORY,
            env=environment,
            capture_output=True,
            text=True,
            timeout=PATIENCE,
        )
    except subprocess.TimeoutExpired:
        return "a run without an end"
    failed = re.search(r"^(?:FAILED|ERROR) ([^\s\[]+)", run.stdout, re.MULTILINE)
    if run.returncode and not failed:
        sys.exit(f"pytest does not run:\n{run.stdout}{run.stderr}")
    return failed and failed[1]


def tiers(file):
    """Yield the targets of pytest for a mutant of ``file``, those first that take least."""
    room, *_, folder, name = Path(file).parts[0], *Path(file).parts
    own = (Path("tests", room, f"test_{stem}.py") for stem in (Path(name).stem, folder))
    yield [str(path) for path in own if (REPOSITORY / path).exists()]
    yield [f"tests/{room}"]


def main(words):
    wanted = [
        (file, *mutant)
        for file, mutants in MUTANTS.items()
        for mutant in mutants
        if not words or any(word in f"{file} {mutant[2]}" for word in words)
    ]
    caught, survived = set(), 0
    with tempfile.TemporaryDirectory() as folder:
        package = Path(folder)
        shutil.copytree(REPOSITORY / "src", package, dirs_exist_ok=True)
        for file, old, new, what in wanted:
            path, begun = package / "twodiscs" / file, time.monotonic()
            text = path.read_text(encoding="utf-8") if path.exists() else ""
            if text.count(old) != 1:
                survived += 1
                print(f"NOT THERE  {file}: {what}: {old!r} {text.count(old)} times", flush=True)
                continue
            path.write_text(text.replace(old, new), encoding="utf-8")
            failed = next(filter(None, (tests(package, *t) for t in tiers(file) if t)), None)
            path.write_text(text, encoding="utf-8")
            survived += not failed
            caught |= {failed} if failed and "::" in failed else set()
            verdict = f"by {failed}" if failed else ""
            seconds = time.monotonic() - begun
            print(
                f"{'caught   ' if failed else 'SURVIVED '}  {file}: {what} ({seconds:.0f} s) {verdict}",
                flush=True,
            )
        false = tests(package, *sorted(caught)) if caught else None
    print(f"{len(wanted) - survived} of {len(wanted)} caught")
    sys.exit(f"{false} fails without a mutant" if false else survived)


if __name__ == "__main__":
    main(sys.argv[1:])
