"""The pages for people: their commands, configurations and numbers.

Without these tests a command, a configuration or a number in them could be wrong.

A page shows commands in indented blocks, or after ``$`` in console blocks, followed by
their output; scenes in blocks of YAML. ``twodiscs`` is run, ``snakemake`` and ``make`` dry.
"""

import csv
import json
import math
import re
import shlex
import subprocess
from functools import cache

import pages
import pandas as pd
import pytest
import yaml
from checkout import REPOSITORY, fresh
from commands import command, python
from factory import EXPECTED
from marks import slow
from snakemake.cli import get_argument_parser

import twodiscs
from twodiscs.analysis.tables import SCENE_TABLES
from twodiscs.measure.measurements import STATUSES
from twodiscs_paper.configuration import yaml_files
from twodiscs_paper.pipeline import job_cost

DOCS = sorted(path.name for path in (REPOSITORY / "docs").glob("*.md"))
NAMES = ["README.md", "CONTRIBUTING.md", *(f"docs/{name}" for name in DOCS)]

FENCED = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
INDENTED = re.compile(r"(?:(?<=\n\n) {4}.+\n(?:(?: {4}.+)?\n)*)")


@cache
def page(name):
    """Return the text of a page."""
    return (REPOSITORY / name).read_text(encoding="utf-8")


@cache
def blocks(name):
    """Return the (language, text) of every block of a page; indented ones are yaml or shell."""
    found = FENCED.findall(page(name))
    for body in INDENTED.findall(FENCED.sub("", page(name))):
        body = re.sub(r"^ {4}", "", body, flags=re.MULTILINE)
        found.append(("yaml" if body.lstrip().startswith("- name:") else "shell", body))
    return found


def same(shown, found):
    """Return whether two texts are equal, numbers up to nine digits.

    The last digits of exact and of rounded numbers depend on the math library. z is a difference,
    in units of its error, of two numbers that are right to 1e-13.
    """

    def same_word(shown, found):
        try:
            return shown == found or math.isclose(float(shown), float(found), rel_tol=1e-9)
        except ValueError:
            return False

    shown, found = shown.split(), found.split()
    return len(shown) == len(found) and all(map(same_word, shown, found))


def examples(name):
    """Return the words of each command on a page."""
    lines = []
    for language, body in blocks(name):
        if language == "console":
            lines += re.findall(r"^\$ (.*)", body, re.MULTILINE)
        elif language == "shell":
            lines += body.splitlines()
    return [words for line in lines if (words := shlex.split(line, comments=True))]


def commands(program):
    """Return the different commands of a program in all pages, as text."""
    every = (words for name in NAMES for words in examples(name))
    return [*dict.fromkeys(shlex.join(words) for words in every if words[0] == program)]


def scenes(name):
    """Return the scenes in the blocks of YAML of a page."""
    texts = [body for language, body in blocks(name) if language == "yaml"]
    return [scene for text in texts for scene in yaml.safe_load(text)]


def with_examples():
    """Return the default configuration with the scenes of all pages."""
    mapping = yaml_files.read(REPOSITORY / "config" / "config.yaml")
    mapping["scenes"] += [scene for name in NAMES for scene in scenes(name)]
    return mapping


# Pages ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", NAMES)
def test_links_lead_somewhere(name):
    folder = (REPOSITORY / name).parent
    for target in re.findall(r'(?:\]\(|<img src=")([^)#"]+)', FENCED.sub("", page(name))):
        if not target.startswith("https://"):
            assert (folder / target).exists(), target


def test_citation_agrees_with_the_package():
    citation = yaml.safe_load((REPOSITORY / "CITATION.cff").read_text(encoding="utf-8"))
    package = (REPOSITORY / "pyproject.toml").read_text(encoding="utf-8")
    assert citation["version"] == twodiscs.__version__
    assert f'license = "{citation["license"]}"' in package
    assert f"{citation['license']} License" in (REPOSITORY / "LICENSE").read_text(encoding="utf-8")
    assert twodiscs.__name__ == citation["title"].partition(":")[0]
    deposit = json.loads((REPOSITORY / ".zenodo.json").read_text(encoding="utf-8"))
    for name in ("title", "version", "license", "keywords"):
        assert deposit[name] == citation[name]
    assert deposit["creators"] == citation["authors"]


def test_the_glossary_has_every_status():
    assert [one for one in STATUSES if f"`{one}`" not in page("docs/glossary.md")] == []


def test_what_pages_repeat_of_declarations_is_up_to_date():
    """Nothing that is promised is lost with it."""
    made = pages.pages(REPOSITORY)
    assert [n for n in made if page(n) != made[n]] == [], "python docs/make/pages.py"
    with pytest.raises(LookupError, match="forsaken: promised, and not in the code"):
        pages.promises(page("docs/promises.md").replace("```text\nall ", "```text\nall forsaken "))


def program(name, folder):
    """Write the blocks of Python of a page as one program; return its path."""
    path = folder / f"{re.sub(r'[^a-z]', '_', name)}.py"
    text = "".join(body for kind, body in blocks(name) if kind == "python")
    path.write_text(text, encoding="utf-8")
    return path


#: Run programs in one process, each with its own names in its own folder.
RUN = """
import os, runpy, sys

for path in sys.argv[1:]:
    os.mkdir(f"{path}.folder")
    os.chdir(f"{path}.folder")
    runpy.run_path(path)
"""
LONG = "docs/recipes.md"


@pytest.mark.parametrize("names", [{*NAMES} - {"docs/python.md", LONG}, slow({LONG})])
def test_python_runs(names, tmp_path):
    """The blocks of a page are one program, whose assertions hold; test_tutorial runs the other."""
    done = python("-c", RUN, *(program(name, tmp_path) for name in sorted(names)))
    assert done.returncode == 0, done.stderr


#: Lines that a strict type checker accepts.
USER = """\
from collections.abc import Callable

import numpy as np

import twodiscs as td

SCENE = td.Scene(1.5, 1.0, 0.2, friction=0.5, periodic=["x"])
radii = [0.5 * SCENE.box.largest_radius, SCENE.box.threshold("vertical_hop") or 0.2]
exact: float = td.mean_times(SCENE)["vertical_hop_time"] - td.volume(SCENE)
md = td.simulate(SCENE, {event: 0.05 for event in SCENE.events}, seed=2)
one: td.Measurement = md["vertical_hop_time"]
low, high = one.interval() or (0.0, exact)
text = f"{one:.3f} of {high - low}, {one.value + (one.relative_stderr or 0.0)}, {one.u}"
kept: list[td.Measurements] = [td.sample(SCENE.with_radius(r), 1e6) for r in radii]
scan = td.scan([1.5, 2], 1.0, radii, friction=[0, 0.5], events=["right_wall"])
for result in [*kept, *scan, td.load_result("md.json").more(error=1e-3)]:
    result.save(f"{result.scene.radius}.json")
path = td.trajectory(SCENE, 10, start=td.starts(SCENE, 1)[0])
speeds: np.ndarray = path.velocities(np.linspace(0, 10, 100))
function: Callable[[np.ndarray, np.ndarray], np.ndarray] = lambda start, now: now["x1"]
seen = td.observe(SCENE, {"x": function}, range(10), seed=1).more(2**17)
late = path[path["time"] > 5].groupby("event").size()
td.plot(seen, "seen.pdf").axes[0].set_title(text)
td.animate(path, "two.gif")
found = td.transmission(SCENE, "vertical_hop", 1e4)
kappa = found.coefficient.value if found.coefficient else 0.0
z: float | None = td.pressure(md)["virial_pressure"].z
cost = td.cost(SCENE, [1e-3])["volume", "rejection"].seconds(1e-4)
hop = td.intervals(SCENE, "vertical_hop", seed=3).mean
energy: td.Measurement = td.free_energy(kept[0])
"""


@pytest.mark.slow
def test_python_has_the_types_that_are_declared(tmp_path):
    """As a type checker reads the pages, each one program, a user, and calls with misspelt words.

    Pages use figures that exist in their scenes, so None is not checked in them.
    """
    programs = [program(name, tmp_path) for name in NAMES]
    options = ["--ignore-missing-imports", "--follow-imports", "silent", "--scripts-are-modules"]
    options += ["--no-strict-optional", "--allow-redefinition"]
    checked = python("-m", "mypy", *options, *programs, cwd=tmp_path)
    assert checked.returncode == 0, checked.stdout
    wrong = {
        "td.Scene(1.5, 1.0, 0.2, frictoin=1.0)": 'did you mean "friction"?',
        "td.simulate(SCENE, 0.01, sed=3)": 'did you mean "seed"?',
        'td.intervals(SCENE, "vertical_hopp")': "Literal['vertical_hop', 'horizontal_hop']",
        'td.simulate(SCENE, events="any_wal")': "Iterable[Literal['vertical_hop', ",
        'td.sample(SCENE, quantities="volum")': "Literal['volume', 'vertical_hop_area', ",
        'SCENE.is_possible("top")': "Literal['vertical_hop', ",
        "td.scan(1.5, 1.0, 0.2, fild=[0, 1])": 'did you mean "field"?',
        "td.simulate(SCENE, 0.01).framee()": 'has no attribute "framee"',
    }
    (tmp_path / "user.py").write_text("\n".join([USER, *wrong]), encoding="utf-8")
    checked = python("-m", "mypy", "--strict", "user.py", cwd=tmp_path)
    errors = [line for line in checked.stdout.splitlines() if "error:" in line]
    assert all(map(str.__contains__, errors, wrong.values())), checked.stdout
    assert len(errors) == len(wrong), checked.stdout


# Commands ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("example", commands("twodiscs"))
def test_every_command_of_a_page_succeeds(example, monkeypatch):
    """``test_what_pages_repeat_of_declarations_is_up_to_date`` compares what it prints."""
    assert command(monkeypatch, *shlex.split(example)[1:]) == 0


@pytest.mark.parametrize("name", ["docs/physics.md", "docs/reading-check.md"])
def test_numbers_in_the_text_are_those_of_the_examples(name):
    tables_shown = re.compile(r"^\|.*\n", re.MULTILINE)
    shown = " ".join([*(body for _, body in blocks(name)), *tables_shown.findall(page(name))])
    known = re.findall(r"\d+\.\d+(?:e-?\d+)?", shown)
    prose = tables_shown.sub("", FENCED.sub("", page(name)))
    written = re.findall(r"\d+\.\d+", re.sub(r"\]\([^)]*\)|arXiv:[\d.]+", "", prose))
    assert len(written) > 3
    for number in written:
        digits = len(number.partition(".")[2])
        assert any(f"{float(x):.{digits}f}" == number for x in known), number


@pytest.mark.parametrize("example", commands("make"))
def test_make_knows_what_to_do(example):
    words = [*shlex.split(example), "--dry-run"]
    run = subprocess.run(words, cwd=REPOSITORY, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr


def test_snakemake_knows_every_target(tmp_path):
    """Dry runs with the default configuration and the scenes of all pages, one for each options."""
    checkout, mapping = fresh(tmp_path / "checkout"), with_examples()
    # An accuracy that its budget reaches needs no forecast.
    mapping["scenes"] = [scene | {"accuracy": 0.5} for scene in mapping["scenes"]]
    checkout.configuration.write_text(yaml.safe_dump(mapping))
    targets = {}  # {options that matter: targets}
    for example in commands("snakemake"):
        given = get_argument_parser().parse_args(shlex.split(example)[1:])
        assert all((REPOSITORY / name / "config.yaml").is_file() for name in given.profile or ())
        chosen = ("--configfile", str(given.configfile[0])) if given.configfile else ()
        targets.setdefault(chosen, set()).update(given.targets or ["all"])
    assert {"volume", "check", "all"} <= targets[()]
    files = ("config/draft.yaml", "config/scenes/field.yaml")
    assert targets.keys() == {(), *(("--configfile", file) for file in files)}
    for options, names in targets.items():
        assert checkout.jobs(*options, "--", *sorted(names))


# Results ------------------------------------------------------------------------------------------


def test_numbers_of_pages_are_those_of_the_expected_results():
    events = re.search(r"^\| 1.5 × 1 \|.*\| (\S+) \|$", page("README.md"), re.MULTILINE)[1]
    assert f"| `paper` | 3e-4 | {events} |" in page("docs/accuracy-and-cost.md")
    largest = pd.read_csv(EXPECTED / "effects.csv")["z"].abs().max()
    assert f"largest |z| of the mean times is {largest:.3g}." in page("docs/results.md")


# The check ----------------------------------------------------------------------------------------


def test_rows_of_the_check_are_those_of_the_page(tmp_path):
    """The check of the scene ``look``, whose work is done here."""
    scene, path = yaml_files.load(with_examples()).folders["look"], tmp_path / "check.csv"
    points = [
        job_cost.run_at(scene, stage, radius).run()
        for stage, keys in scene.keys.items()
        for radius in keys.values()
    ]
    SCENE_TABLES["check"].write(path, SCENE_TABLES["check"].rows(points, scene.quantities.areas))
    found = [*csv.DictReader(path.read_text(encoding="utf-8").splitlines())]
    lines = re.findall(r"^\| `(\w+)` \|(.*)\|$", page("docs/reading-check.md"), re.MULTILINE)
    assert [name for name, _ in lines] == list(SCENE_TABLES["check"].columns)
    cells = [[cell.strip() for cell in line.split("|")] for _, line in lines]
    key = ("comparison", "quantity", "radius", "method")
    for values in zip(*cells, strict=True):
        shown = dict(zip((name for name, _ in lines), values, strict=True))
        (row,) = (row for row in found if all(row[name] == shown[name] for name in key))
        for name, value in shown.items():
            assert same(value, row[name]), name
