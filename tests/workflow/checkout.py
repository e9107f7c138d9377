"""A checkout to build in: the repository's files with a small configuration."""

import gc
import os
import re
import runpy
import shutil
import subprocess
import sys
import tempfile
from multiprocessing import get_context
from pathlib import Path

import pydantic  # noqa: F401
import smart_open  # noqa: F401
import yaml
from factory import EXPECTED
from snakemake import cli

from twodiscs_paper.catalogue import STUDY_TABLES, TABLES

cli.get_argument_parser()  # finds the plug-ins, once for all copies

REPOSITORY = Path(__file__).resolve().parents[2]
PARTS = ("workflow", "profiles", "src", "config", "paper", "Snakefile", "CITATION.cff")

MODULE = """
configfile: "mine.yaml"


module discs:
    snakefile:
        {snakefile!r}
    {more}


use rule * from discs as discs_*


rule mine:
    input:
        rules.discs_check.output,
    output:
        "mine.txt",
    shell:
        "cp {{input}} {{output}}"
"""

#: The studies whose rows a build takes from the expected tables, because their tests measure.
#: Rows of seconds are fabricated, and a part of a table is empty.
MEASURING = ["errata", "distributions", "more_discs", "passages", "stability", "tails"]
KEPT = f"""
from pathlib import Path

inspect.signature(work).bind(**given)
kept = Path({str(EXPECTED)!r}, f"{{table.name()}}.csv")
if is_part:
    rows = []
elif table.name() == "effects_cost":
    known = {{"benchmark": "effects", "value": 1e8, "unit": "1/s", "ratio": 1.0}}
    rows = [known | {{"variant": name, "instructions": 9}} for name in ("plain", *given["scenes"])]
elif table.name() in {MEASURING}:
    names = {{"paper": "full", "long": "walls"}}
    rows = [row | {{k: names.get(row[k], row[k]) for k in ("scene",) if k in row}}
            for row in table.read(kept)]
else:
    rows = work(**given)
table.write_and_log(snakemake.output.table, rows)
"""

#: Edits of a checkout that make its build quick: {file: (text, its text in a checkout)}.
QUICKER = {
    # Rows of studies, see tests/studies.
    "workflow/scripts/study.py": (
        "table.write_and_log(snakemake.output.table, work(**given))", KEPT,
    ),
    # All figures except ``volume`` are drawn, but saved empty, see tests/figures.
    "workflow/scripts/figure.py": (
        "style.save(figure, path",
        'style.save(figure if name == "volume" else style.new_figure(1), path',
    ),
    # The nodes of a curve, and the frames around a hop, see tests/figures.
    "src/twodiscs/figures/curves.py": ("else (32, 1e-5)", "else (4, 1e-5)"),
    "src/twodiscs/figures/animation.py": ("= 110, 60, 20, 20", "= 4, 4, 20, 20"),
    # Tables of long runs are not renewed, see test_long_runs.py and test_verify.py.
    "src/twodiscs_paper/pipeline/results/verify.py": ("in long_run_tables(kept)", "in []"),
}  # fmt: skip

#: The same for the one complete build. Other tests compile the engine of its scene with effects.
ONE_SCENE = {
    # Five scenes of six, and six radii of seven, see test_jobs.py and test_scenes.py.
    "src/twodiscs_paper/studies/effects/study.py": (
        '("balls", "channel", "field", "rough", "torus", "unequal")', '("field",)',
    ),
    "config/scenes/field.yaml": ("[0.02, 0.1, 0.15, 0.2, 0.3, 0.34, 0.36]", "[0.3]"),
}  # fmt: skip

#: The rules that build nothing but lists of files: targets, and checksums of sources.
AUXILIARY = r"all|default|(\w+_)?code"

#: For a module whose files are in a separate folder.
BELOW = 'config:\n        config["discs"]\n    prefix:\n        "below"'


def first(sources):
    """Return where Python looks for modules: in ``sources`` before all other places."""
    return os.pathsep.join(filter(None, [sources, os.environ.get("PYTHONPATH")]))


def forked(words, folder, sources):
    """Run a command in ``folder`` in a copy of this process; return the completed one."""
    with tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as error:
        child = get_context("fork").Process(target=run, args=(words, folder, sources, out, error))
        child.start()
        child.join()
        for file in (out, error):
            file.seek(0)
        return subprocess.CompletedProcess(words, child.exitcode, out.read(), error.read())


def run(words, folder, sources, *files):
    """Be the command ``words`` of a module, with standard output and error in ``files``."""
    gc.freeze()  # or each collection reads, and so copies, all objects of the tests
    for number, file in enumerate(files, 1):
        os.dup2(file.fileno(), number)
    sys.stdout, sys.stderr = (os.fdopen(os.dup(number), "w") for number in (1, 2))
    os.chdir(folder)
    sys.argv = [*words]
    os.environ["PYTHONPATH"] = first(sources)
    for name in [name for name in sys.modules if name.startswith("twodiscs")]:
        del sys.modules[name]
    sys.path.insert(0, sources)
    runpy.run_module(words[0], run_name="__main__")


class Checkout:
    """A folder to build in: a copy of the repository at ``path`` which uses its sources.

    With ``home``, another checkout, it is a folder anywhere that uses the sources of that one, and
    its workflow, unless the folder has a workflow.
    """

    def __init__(self, path, home=None):
        self.path, self.home = path, home or self
        self.configuration = path / "config" / "config.yaml"

    def snakemake(self, *arguments, passes=True):
        """Run snakemake here; by default it must succeed. Returns the completed process.

        A copy of this process runs, which has imported Snakemake already, but nothing of the
        package. Jobs are processes of their own.
        """
        if not (self.path / "Snakefile").exists():
            arguments = "--snakefile", str(self.home.path / "Snakefile"), *arguments
        return self.completed(passes, "snakemake", *arguments)

    def twodiscs_run(self, *words, passes=True):
        """Run ``twodiscs run`` here, as ``snakemake`` does it."""
        return self.completed(passes, "twodiscs", "run", *words)

    def completed(self, passes, *words):
        """Return the completed process of a command, which has the status 0 if it ``passes``."""
        done = forked(words, self.path, str(self.home.path / "src"))
        assert (done.returncode == 0) == passes, done.stdout + done.stderr
        return done

    def jobs(self, *arguments):
        """Return the jobs of a dry run, sorted: (rule, wildcards as a tuple of "name=value").

        Jobs that only list files are left out. ``printed`` is the text of the dry run.
        """
        found, self.printed = [], self.snakemake("--dry-run", *arguments).stdout
        for line in self.printed.splitlines():
            if start := re.match(r"(?:local)?rule (\w+):$", line):
                found.append([start[1], ()])
            elif wildcards := re.match(r"    wildcards: (.+)$", line):
                found[-1][1] = tuple(wildcards[1].split(", "))
        return sorted((rule, words) for rule, words in found if not re.fullmatch(AUXILIARY, rule))

    def edit(self, path, text):
        """Append ``text`` to a file, which may be new."""
        (self.path / path).parent.mkdir(parents=True, exist_ok=True)
        with open(self.path / path, "a", encoding="utf-8") as file:
            file.write(text)

    def replace(self, path, old, new):
        """Replace a text that a file has once."""
        text = (self.path / path).read_text(encoding="utf-8")
        assert text.count(old) == 1, f"{path} must say {old!r} once"
        (self.path / path).write_text(text.replace(old, new), encoding="utf-8")

    def configure(self, change):
        """Pass the configuration, as a mapping, to ``change`` and write it back."""
        mapping = yaml.safe_load(self.configuration.read_text())
        change(mapping)
        self.configuration.write_text(yaml.safe_dump(mapping))

    def results(self, folder="results"):
        """Return {path: bytes} of everything under ``folder``."""
        folder = self.path / folder
        files = (path for path in folder.rglob("*") if path.is_file())
        return {path.relative_to(folder).as_posix(): path.read_bytes() for path in files}


def fresh(path, edits=QUICKER):
    """Return a checkout at ``path`` with some ``edits``, in which nothing is built."""
    for part in PARTS:
        source, target = REPOSITORY / part, path / part
        if source.is_dir():
            shutil.copytree(source, target, ignore=shutil.ignore_patterns("*.egg-info"))
        else:
            shutil.copy2(source, target)
    shutil.copy(Path(__file__).with_name("small.yaml"), path / "config" / "config.yaml")
    checkout = Checkout(path)
    for file, (old, new) in edits.items():
        checkout.replace(file, old, new)
    return checkout


def one_scene(name, shared=(), **keys):
    """Return a configuration of one scene in the box 1.5 × 1, with some ``keys``."""
    box = {"width": 1.5, "height": 1.0}
    return {"shared": [*shared], "scenes": [{"name": name, "box": box} | keys]}


def folder(path, home, configuration):
    """Return a folder at ``path`` with a ``configuration``, which the checkout ``home`` builds."""
    place = Checkout(path, home)
    place.configuration.parent.mkdir(parents=True, exist_ok=True)
    place.configuration.write_text(yaml.safe_dump(configuration))
    return place


def copy_tables(folder, scenes, empty=()):
    """Write the tables of a build to a folder, as they are expected.

    ``scenes`` are {name in the folder: name in the expected results}. Tables that are not expected
    because of their seconds, and the ``empty`` ones, {name}, have no rows.
    """
    for own, kept in scenes.items() | {(".", ".")}:
        (folder / own).mkdir(parents=True, exist_ok=True)
        for path in (EXPECTED / kept).glob("*.csv"):
            if path.stem not in empty:
                shutil.copy(path, folder / own)
        for name in {*empty, "cost", "accuracy_cost"} & TABLES.keys():
            if (name in STUDY_TABLES) == (own == "."):
                TABLES[name].write(folder / own / f"{name}.csv", [])


def use(place, configuration, more):
    """Write a workflow that uses the one of a checkout as a module, with ``more`` settings of it.

    Its rules have the prefix ``discs_``.
    """
    text = MODULE.format(snakefile=str(place.home.path / "Snakefile"), more=more)
    (place.path / "Snakefile").write_text(text)
    (place.path / "mine.yaml").write_text(yaml.safe_dump({"discs": configuration, "mine": 1}))
