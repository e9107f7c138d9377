"""Kill and damage a small build, again and again, and say what survived.

    python -m twodiscs.pipeline.soak --snakefile Snakefile --seconds 3600 --seed 1

Survived means: the same command, given once more, ends well, and afterwards every byte is as in an
undisturbed build, but for run times, and the record of the jobs holds. Of a killed build no
finished job may be done twice, and no process may stay.
"""

import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from contextlib import suppress
from pathlib import Path

import psutil
import yaml

from twodiscs.pipeline.arguments import Parser, number, run, whole_number
from twodiscs.pipeline.results.manifest import TIMED, is_reproducible
from twodiscs.pipeline.results.record import (
    FOLDER,
    UNRECORDED,
    audit,
    digest,
    file_of,
    name_of,
    record_of,
)

#: What is built: points of both kinds, tables and figures.
BUILD = {
    "shared": [],
    "scenes": [
        {
            "name": "plain",
            "box": {"width": 1.5, "height": 1.0},
            "radii": [0.2],
            "watch": {"volume": True, "mean_times": ["vertical_hop"]},
            "accuracy": 0.1,
            "event_budget": 1e5,
            "monte_carlo": {"samples": 1e5},
        }
    ],
}

SIGNALS = ("SIGKILL", "SIGTERM", "SIGINT", "SIGHUP")
VICTIMS = ("session", "parent", "job")
DAMAGES = ("truncated", "edited", "deleted")

#: How long a run may take, and processes of a killed one to end, in seconds.
PATIENCE = 300


def contents(results):
    """Return {name: SHA-256} of files and their records, those that hold no run times."""
    found = {}
    for path in results.rglob("*"):
        name = path.name.removesuffix(".json") if path.parent.name == FOLDER else path.name
        parts = {*path.relative_to(results).parts[:-1], name}
        drawn = Path(name).suffix in (".csv", ".pdf", ".png", ".gif")
        timed = not is_reproducible(name) if drawn else Path(name).stem in TIMED
        if path.is_file() and not timed and not parts & {*UNRECORDED, "cost"}:
            found[str(path.relative_to(results))] = digest(path)
    return found


def failed(said):
    """Return the outputs of the jobs that failed, of all that Snakemake ``said``, as a set."""
    found = re.findall(r"^Error in rule .*:\n(?:    .*\n)*?    output: (.+)", said, re.MULTILINE)
    return {name for line in found for name in line.split(", ")}


def processes(folder):
    """Return the processes that work in a folder."""
    found = []
    for process in psutil.process_iter():
        with suppress(psutil.Error):
            if process.cwd() == str(folder):
                found.append(process)
    return found


def _with_record(path):
    """Return (file, its record) of a path that is one of them."""
    return (file_of(path), path) if path.parent.name == FOLDER else (path, record_of(path))


class Soak:
    """A build of a configuration in ``folder``, where ``strike`` may be called at will.

    ``command`` is what builds it. ``kernels`` is the folder of the compiled code if that may be
    damaged, too. Raises ``RuntimeError`` if the build fails undisturbed.
    """

    def __init__(self, folder, command, seed, configuration=BUILD, kernels=None):
        self.folder, self.command, self.random = folder, command, random.Random(seed)
        self.results, self.kernels = folder / "results", kernels
        self.undisturbed = folder.with_name(f"{folder.name}-undisturbed")
        (folder / "config").mkdir(parents=True)
        (folder / "config" / "config.yaml").write_text(yaml.safe_dump(configuration))
        self.durations = []  # of a build that compiles, and of one that does not
        for _ in range(2 if kernels else 1):
            shutil.rmtree(self.results, ignore_errors=True)
            start = time.monotonic()
            if self._finish(self._start()):
                raise RuntimeError(f"the undisturbed build fails:\n{self._said()[-3000:]}")
            self.durations.append(time.monotonic() - start)
        self.expected = contents(self.results)
        shutil.copytree(folder, self.undisturbed)

    def _start(self):
        with open(self.folder / "said", "w", encoding="utf-8") as said:
            return subprocess.Popen(
                self.command, cwd=self.folder, stdout=said, stderr=said, start_new_session=True
            )

    def _finish(self, process):
        """Return the exit status; a run that does not end is killed."""
        try:
            return process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            return f"none after {PATIENCE} s"

    def _said(self):
        return (self.folder / "said").read_text(encoding="utf-8", errors="replace")

    def _reasons(self):
        """Return what the last run says of the files that it makes, and why."""
        telling = ("    output:", "    reason:")
        said = self._said().splitlines()
        return [line for line in said if line.startswith(telling) or "is made again" in line]

    def _files(self):
        """Return the files that a job wrote, and the records of them, sorted."""
        records = sorted(self.results.rglob(f"{FOLDER}/*.json"))
        paths = [file_of(record) for record in records]
        return [path for path in (*records, *paths) if path.is_file()]

    def _finished(self, start):
        """Return {path: time stamp} of what has been finished since ``start``.

        Snakemake takes what a failed job leaves for finished, and removes it; where its shell alone
        was killed a job may write the rest of it after that.
        """
        found, lost = {}, failed(self._said())
        for path in self._files():
            if str(path.relative_to(self.folder)) in lost:
                continue
            name = name_of(path.relative_to(self.folder))
            known = self.folder / ".snakemake" / "metadata" / name
            begun = self.folder / ".snakemake" / "incomplete" / name
            if known.exists() and known.stat().st_mtime_ns > start and not begun.exists():
                found[path] = path.stat().st_mtime_ns
        return found

    def kill(self, name, whom):
        """Kill a build of everything or of a random part; return the moment, and what is wrong.

        One in ten builds finds its compiled code damaged, one in ten finds empty files of it.
        Returns None if the build was over before.
        """
        chance, cold = self.random.random(), False
        if self.kernels and chance < 0.2:
            cold = True
            for path in (one for one in sorted(self.kernels.rglob("*")) if one.is_file()):
                rest = self.random.random() if chance < 0.1 else 0
                os.truncate(path, int(rest * path.stat().st_size))
        if chance < 0.5:
            shutil.rmtree(self.results)
        else:
            for path in self._files():
                if self.random.random() < 0.5:
                    path.unlink()
        duration = self.durations[0 if cold else -1]
        start, moment = time.time_ns(), self.random.uniform(0, duration)
        process = self._start()
        with suppress(subprocess.TimeoutExpired):
            process.wait(moment)
            return None
        found = [p for p in processes(self.folder) if p.pid != process.pid]
        if whom == "parent":
            process.send_signal(getattr(signal, name))
        elif whom == "session":
            for one in (process, *found):
                with suppress(psutil.Error):
                    one.send_signal(getattr(signal, name))
        elif found:
            with suppress(psutil.Error):
                self.random.choice(found).send_signal(getattr(signal, name))
        where = f"after {moment:.1f} of {duration:.1f} s" + " with damaged kernels" * cold
        wrong = [f"{where}, {len(found)} processes of jobs"]
        self._finish(process)
        _, left = psutil.wait_procs(processes(self.folder), timeout=60)
        for one in left:
            wrong.append(f"a process stayed: {one.name()}")
            one.kill()
        finished = self._finished(start)
        return wrong + self._again(finished)

    def damage(self, how):
        """Damage random files; return which, and what is wrong."""
        files = self._files()
        some = self.random.sample(files, min(len(files), self.random.choice((1, 1, 2, 3))))
        for path in some:
            content = path.read_bytes()
            if how == "deleted":
                path.unlink()
                continue
            place = self.random.randrange(len(content))
            rest = b"" if how == "truncated" else bytes([content[place] ^ 1]) + content[place + 1 :]
            path.write_bytes(content[:place] + rest)
        said = "\n".join(audit(self.results))
        names = [str(path.relative_to(self.results)) for path in some]
        # Of what is gone with its record nothing is left to tell.
        told = [_with_record(path) for path in some]
        missed = [
            f"the audit misses {name}"
            for (path, record), name in zip(told, names, strict=True)
            if path.name not in said and (path.exists() or record.exists())
        ]
        return [", ".join(names), *missed, *self._again({})]

    def _again(self, finished):
        """Run the same command once more; return what is wrong then, and mend it."""
        status = self._finish(self._start())
        wrong = [f"the next run ends with {status}: {self._said()[-3000:]}"] if status else []
        found = contents(self.results)
        for name in sorted({*found, *self.expected}):
            if found.get(name) != self.expected.get(name):
                wrong.append(f"{name} {'differs' if name in found else 'is missing'}")
        wrong += [] if wrong else audit(self.results)
        for path, stamp in finished.items():
            if path.exists() and path.stat().st_mtime_ns != stamp:
                wrong.append(f"{path.relative_to(self.results)} was finished and made again")
        if wrong and not status:
            wrong += self._reasons()
        if wrong:
            shutil.rmtree(self.folder)
            shutil.copytree(self.undisturbed, self.folder)
        return wrong

    def strike(self):
        """Do one random harm; return its name and [where, what is wrong], None if it came late."""
        if self.random.random() < 0.5:
            name, whom = self.random.choice(SIGNALS), self.random.choice(VICTIMS)
            return f"{name} of {whom}", self.kill(name, whom)
        how = self.random.choice(DAMAGES)
        return f"files {how}", self.damage(how)


def soak(strikes, seconds):
    """Take ``strikes`` for so many seconds, print what came of them; return how many failed."""
    tried, failed = Counter(), Counter()
    end = time.monotonic() + seconds
    for harm, told in strikes:
        if told is not None:
            where, *wrong = told
            tried[harm] += 1
            failed[harm] += bool(wrong)
            print(harm, where, *(wrong or ["survived"]), sep="; ", file=sys.stderr, flush=True)
        if time.monotonic() > end:
            break
    for harm in sorted(tried):
        print(f"{harm:<24}{tried[harm] - failed[harm]:>6} of {tried[harm]} survived")
    print(f"{'all':<24}{tried.total() - failed.total():>6} of {tried.total()} survived")
    return failed.total()


def main():
    parser = Parser(prog="twodiscs.pipeline.soak", description=__doc__.split("\n")[0])
    parser.add_argument("--snakefile", required=True, type=Path)
    parser.add_argument("--seconds", required=True, type=number, help="how long to go on")
    parser.add_argument("--seed", required=True, type=whole_number)
    parser.add_argument("--cores", type=whole_number, default=2)
    options = parser.parse_args()

    # Of a process that ignores a signal the children do, too; and what is temporary is removed.
    for name in ("SIGTERM", "SIGINT", "SIGHUP"):
        signal.signal(getattr(signal, name), lambda which, _: sys.exit(128 + which))
    command = [sys.executable, "-m", "snakemake", "--cores", str(options.cores)]
    command += ["--snakefile", str(options.snakefile.resolve())]
    with tempfile.TemporaryDirectory() as place:
        kernels = Path(place, "kernels")
        os.environ["NUMBA_CACHE_DIR"] = str(kernels)
        try:
            build = Soak(Path(place, "build"), command, options.seed, kernels=kernels)
            return bool(soak(iter(build.strike, None), options.seconds))
        finally:
            for process in processes(Path(place, "build")):
                process.kill()


if __name__ == "__main__":
    run(main)
