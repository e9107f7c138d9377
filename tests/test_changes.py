"""Changes that docs/change-it.md describes, made in copies of the repository with its code.

Without these tests the page could invite to a change that breaks something else, or name other
files than it takes. ``changes.yaml`` has the edits; the functions ``check_…`` run in a copy.
"""

import os
import re
import shutil
import textwrap
from functools import cache
from pathlib import Path

import mutants
import pages
import pytest
import yaml
from checkout import Checkout
from commands import python
from effect_scenes import SCENES
from figure_cases import BOXES, OTHERS, draw, tables_of
from test_examples import blocks, page

import twodiscs as td
from twodiscs.analysis.tables import CheckTable
from twodiscs.dynamics import runs
from twodiscs.model.events import DECLARED_EVENTS, SHELL_EVENTS
from twodiscs.sampling import montecarlo
from twodiscs.sampling.jit import cache_folder
from twodiscs.theory import clusters

PAGE, PAGES_RENEWED = "docs/change-it.md", "python docs/make/pages.py"
EDITS = yaml.safe_load(Path(__file__).with_name("changes.yaml").read_text(encoding="utf-8"))


# The changes --------------------------------------------------------------------------------------


def block(beginning):
    """Return the block of the page with a line that begins so."""
    line = re.compile(f"^{re.escape(beginning)}", re.MULTILINE)
    (text,) = (text for _, text in blocks(PAGE) if line.search(text))
    return text.strip("\n")


@cache
def code():
    """Return {its name in ``changes.yaml``: code of the page}."""
    return {
        "box": block("  - name: double") + "\n",
        "figure's module": block("def draw(box, rows)"),
        "figure": block("hop_frequency = Figure(").partition("hop_frequency = ")[2],
        "study": block("class Waits(Table)"),
        "study's test": textwrap.indent(block("assert STUDY.tables"), "    "),
        "experiment": block("class TimeToCollision(NamedTuple)"),
        "experiment's test": textwrap.indent(block("times = times_to_collision"), "    "),
        "effect": block("@optional").split("\n\n\n")[1],
        "event": block("Event(").partition("\n\n")[2].partition("  #")[0] + ",",
    }


class Copy(Checkout):
    """A copy of the repository in which changes are made."""

    def make(self, change):
        """Make a change: the files that are edited, and then renewed, are those of the page."""
        for file, edits in EDITS[change].items():
            if isinstance(edits, str):
                self.edit(file, with_code(edits))
            for edit in [] if isinstance(edits, str) else edits:
                old, new = edit if isinstance(edit, list) else (*edit.items(),)[0]
                self.replace(file, old, with_code(new) + old * isinstance(edit, list))
        edited, renewed = pages.changes(page(PAGE))[change]
        assert {*map(self.place, edited)} == {*EDITS[change]}
        known = self.texts()
        for command in {PAGES_RENEWED, *renewed}:
            if command.startswith("python "):  # others need a build
                self.run(*command.split()[1:])
        named = {file for command, files in renewed.items() for file in files}
        assert {n for n, text in self.texts().items() if known.get(n) != text} == {
            file for file in map(self.place, named) if file
        }

    def place(self, name):
        """Return the path of a file of the page, whose folder may be left out."""
        folders = ("", "src/twodiscs/", "src/twodiscs_paper/")
        return next((f + name for f in folders if (self.path / f / name).is_file()), None)

    def texts(self):
        """Return {path: bytes} of all files except compiled modules."""
        return {n: text for n, text in self.results(".").items() if not n.endswith(".pyc")}

    def run(self, *words):
        """Run Python with the package and the tests of the copy."""
        folders = (self.path / part for part in ("src", "tests", "tests/workflow", "docs/make"))
        path = os.pathsep.join(map(str, folders))
        done = python(*words, env=os.environ | {"PYTHONPATH": path}, cwd=self.path)
        assert done.returncode == 0, done.stdout + done.stderr


def with_code(text):
    """Return a text with the code of the page in place of its names."""
    return re.sub("<([^<>]+)>", lambda name: code()[name[1]], text)


# Promises of the page -----------------------------------------------------------------------------


def compared(scene):
    """Return the quantities with a score in the check of a ``Scene``, in which nothing may fail.

    The check fails once in a thousand seeds if all is right; this seed is fixed.
    """
    quantities = ["volume", *(f"{event}_area" for event in scene.events)]
    dynamics = runs.DynamicsRun(scene, dict.fromkeys(scene.events, 5e-3), 10**7, 3).run()
    sampled = montecarlo.MonteCarloRun(scene, quantities, 400_000, 0.1, 4).run()
    rows = CheckTable.rows([dynamics, sampled])
    assert [row for row in rows if row["passed"] is False] == []
    return {row["quantity"] for row in rows if row["z"] is not None}


def check_event():
    """It has its exact area and rate in every scene, and all other events keep theirs.

    Walls have different multiplicities in these scenes; more discs have exact values or none.
    """
    own, scene = [*DECLARED_EVENTS][-1], td.Scene(1.5, 1.0, 0.2)
    for other in (
        td.Scene(1.5, 1.0, 0.3),
        td.Scene(1.5, 1.0, 0.38),
        *map(SCENES.get, ("field", "rough", "unequal", "channel")),
        td.Scene(1.5, 1.0, 0.15, discs=3),
    ):
        assert {f"{own}_time", f"{own}_area"} <= compared(other)
    compared(td.Scene(1.5, 1.0, 0.12, discs=5))
    known = td.pressure(scene)
    assert known["wall_pressure"] == pytest.approx(known["virial_pressure"], rel=1e-12)
    assert known["virial_pressure"] == pytest.approx(0.648, abs=1e-4)
    assert known[f"{own}_pressure"] == known["top_wall_pressure"]
    assert td.areas(scene)[f"{own}_area"] == td.areas(scene)["top_wall_area"]
    md = td.simulate(scene, duration=1e4, seed=3)
    assert md[f"{own}_time"].u.std_dev == pytest.approx(md[f"{own}_time"].stderr)
    assert all(abs(td.pressure(md)[f"{name}_pressure"].z) < 5 for name in ("virial", "wall"))
    td.plot(md, "md.png")
    td.plot(td.sample(scene, 1e5, seed=2), "mc.png")
    for field in (0.2, 0.5, 0.8):
        falling = td.Scene(1.5, 1.0, 0.2, moment_of_inertia=0.5, field=field)
        low, high = (clusters.corner_variance(falling, wall, 4.0) for wall in (own, "top_wall"))
        # The density of six components of velocity, by the kinetic energy that is left at the top.
        assert low / high == pytest.approx((1 - 2 * field * 0.6) ** -2)


def check_effect():
    """Every mean time is that of the same scene without it, and others keep theirs."""
    for more in ({"recoil": 1.0}, {"recoil": 1.0, "mass_ratio": 2.0, "field": 0.4}):
        scene = td.Scene(1.5, 1.0, 0.2, **more)
        assert {f"{event}_time" for event in scene.events} <= compared(scene)
        without = td.mean_times(td.Scene(**scene.parameters() | {"recoil": 0.0}))
        assert td.mean_times(scene) == pytest.approx(without, rel=1e-12)
    for others in ({"moment_of_inertia": 0.5}, {"depth": 1.0}, {"discs": 3}):
        with pytest.raises(td.InputError, match="recoil must be "):
            td.Scene(1.5, 1.0, 0.15, recoil=1.0, **others)


def check_figure():
    """It is drawn with exact values, and without, where cells of its rows are empty."""
    for name in ("paper", "five"):
        figure = draw("hop_frequency", (BOXES | OTHERS)[name], tables_of(name))
        rows = tables_of(name)["mean_times"]
        own = [r for r in rows if r["event"] == "vertical_hop" and r["stderr"]]
        heights = {float(y) for line in figure.axes[0].lines for y in line.get_ydata()}
        assert own
        assert {1 / row["estimate"] for row in own} <= heights


#: Changes that share a copy, what must hold in it, and its nearest tests: changes of kernels, and
#: those for which kernels are kept.
COPIES = {
    "kernels": (
        ("an event", "an effect", "an experiment with two discs"),
        (check_event, check_effect),
        (
            "tests/model", "tests/theory/test_clusters.py", "tests/theory/test_weighted.py",
            "tests/measure/test_pressure.py", "tests/dynamics/test_to_collision.py",
            "tests/studies/test_catalogue.py", "tests/workflow/test_scenes.py",
        ),
    ),
    "tables and figures": (
        (
            "a box", "a figure of a scene", "a study", "a figure of a study",
            "a column of a table", "a key of a study",
        ),
        (check_figure,),
        (
            "tests/studies/test_catalogue.py", "tests/studies/test_waits.py",
            "tests/figures/test_tables.py", "tests/configuration",
            "tests/analysis/test_scene_tables.py",
        ),
    ),
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("name", COPIES)
def test_a_change_takes_the_files_of_the_page_and_all_else_holds(name, tmp_path, monkeypatch):
    """No kernel is compiled for the second copy: those of the repository are kept."""
    changes, checks, tests = COPIES[name]
    kept = tmp_path / "cache" if name == "kernels" else Path(cache_folder("twodiscs")).parent
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(kept))
    copy = Copy(mutants.copied(tmp_path / "copy"))
    for change in changes:
        copy.make(change)
    for check in checks:
        copy.run("-c", f"import test_changes; test_changes.{check.__name__}()")
    assert mutants.failure(copy.path, tests) is None


def test_every_change_of_the_page_is_made_and_finds_its_text():
    made = [change for changes, _, _ in COPIES.values() for change in changes]
    assert sorted(made) == sorted(EDITS) == sorted(pages.changes(page(PAGE)))
    for file, edits in (item for change in made for item in EDITS[change].items()):
        for old, *_ in [] if isinstance(edits, str) else map(tuple, edits):
            assert page(file).count(old) == 1, (file, old)


def test_a_seventh_shell_is_refused_with_a_sentence(tmp_path):
    shutil.copytree(td.__path__[0], tmp_path / "src/twodiscs")
    old, new = EDITS["an event"]["src/twodiscs/model/events.py"][0]
    more = (with_code(new).replace("bottom", str(i)) for i in range(7 - len(SHELL_EVENTS)))
    copy = Copy(tmp_path)
    copy.replace("src/twodiscs/model/events.py", old, "".join(more) + old)
    with pytest.raises(AssertionError, match="has room for 6 shells, not for 7"):
        copy.run("-c", "import twodiscs.sampling.montecarlo")
