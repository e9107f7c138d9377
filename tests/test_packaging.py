"""Wheels: their files, and what works without the extras.

Without these tests a file could be missing in it, or a package of the extras be needed without
them.
"""

import json
import os
import re
import shutil
import subprocess
import sys
import tarfile
import tomllib
from zipfile import ZipFile

import pytest
import yaml
from checkout import REPOSITORY, Checkout
from commands import python
from jinja2 import Environment, StrictUndefined

import twodiscs

PROJECT = tomllib.loads((REPOSITORY / "pyproject.toml").read_text(encoding="utf-8"))["project"]

#: An import of a module of the extras fails, as if they were not installed.
BLOCKED = """
import sys

class Absent:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in {absent!r}:
            raise ModuleNotFoundError(f"{{name}} is of the extras", name=name)

sys.meta_path.insert(0, Absent())
"""

#: The packages of the extras.
EXTRAS = re.findall(r"['\"]([\w-]+)", str([*PROJECT["optional-dependencies"].values()]))

#: The files of the workflow, beside its Snakefile.
CARRIED = ("workflow", "config", "profiles", "paper")


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    """Build a wheel without a network, install it into a folder with a blank, and return that."""
    folder = tmp_path_factory.mktemp("wheel")
    pip, offline = ("-m", "pip", "--quiet"), ("--no-deps", "--no-index")
    source = folder / "source"
    source.mkdir()
    for name in ("pyproject.toml", "README.md", "LICENSE", "Snakefile", "CITATION.cff", *CARRIED):
        (source / name).symlink_to(REPOSITORY / name)
    leave = shutil.ignore_patterns("__pycache__", "*.egg-info")
    shutil.copytree(REPOSITORY / "src", source / "src", ignore=leave)
    wheel = "wheel", *offline, "--no-build-isolation", "--wheel-dir", folder, source
    python(*pip, *wheel, check=True)
    (built,) = folder.glob("*.whl")
    target = folder / "my packages"
    python(*pip, "install", *offline, "--target", target, built, check=True)
    absent = {{"pyyaml": "yaml"}.get(name, name) for name in EXTRAS}
    Checkout(folder / "blocked").edit("sitecustomize.py", BLOCKED.format(absent=absent))
    return target


def outside(installed, *words):
    """Run Python outside of the repository, with the wheel and without the extras."""
    path = os.pathsep.join([str(installed), str(installed.with_name("blocked"))])
    run = python(*words, cwd=installed, env=os.environ | {"PYTHONPATH": path})
    assert run.returncode == 0, run.stderr
    return run.stdout


def test_the_shell_works_from_a_wheel(installed):
    scene = "--width", "1.5", "--height", "1", "--radius", "0.2", "--json"
    found = json.loads(outside(installed, "-m", "twodiscs.cli", "exact", *scene))
    assert found["regime"] == "all-hops"
    # Reading tables and beginning a configuration need no extras.
    outside(installed, "-c", "import twodiscs.measure.load")
    outside(installed, "-m", "twodiscs.cli", "new", "my.yaml")
    with pytest.raises(AssertionError, match="yaml is of the extras"):
        outside(installed, "-c", "import yaml")
    assert (installed / "twodiscs" / "py.typed").exists()


def test_the_wheel_carries_the_workflow(installed):
    """All files that a rule may need, except the expected results."""
    (built,) = installed.parent.glob("*.whl")
    carried = {name.partition("share/twodiscs/")[2] for name in ZipFile(built).namelist()}
    left = {"expected", "queue", "shards", "slurm", "schema.json", "references.md"}
    asked = {
        path.relative_to(REPOSITORY).as_posix()
        for folder in CARRIED
        for path in (REPOSITORY / folder).rglob("*.*")
        if path.is_file() and left.isdisjoint(path.parts)
    }
    assert asked | {"Snakefile", "workflow/Snakefile", "CITATION.cff"} <= carried


def test_twodiscs_run_finds_the_workflow_of_a_wheel(installed, tmp_path):
    """Also where pip had a --target, with records of files that are elsewhere.

    The environment is in a folder with a blank, too: its Python is a word of each job's command.
    """
    paper, target = tmp_path / "my paper", "results/mine/grid.csv"
    venv = paper / ".venv"
    python("-m", "venv", "--without-pip", venv, check=True)
    (packages,) = venv.glob("lib/python*/site-packages")
    (packages / "all.pth").write_text(f"{installed}\nimport sys; sys.path += {sys.path[1:]!r}\n")
    (paper / "my.yaml").write_text("scenes: [{name: mine, box: {width: 1.5, height: 1}}]\n")
    words = [venv / "bin/python", "-m", "twodiscs", "run", "my.yaml", target, "--cores", "1"]
    options = {"cwd": paper, "capture_output": True, "text": True}
    run = subprocess.run(words, check=False, **options)
    assert run.returncode == 0, run.stderr
    assert f"--snakefile '{installed}/share/twodiscs/Snakefile'" in run.stdout
    assert (paper / target).exists()
    (installed / "share").rename(tmp_path / "share")
    run = subprocess.run(words, check=False, **options)
    (tmp_path / "share").rename(installed / "share")
    said = "the workflow is not installed: twodiscs comes without its Snakefile here"
    assert (run.returncode, run.stderr) == (2, f"error: {said}\n")


@pytest.mark.slow
def test_the_first_half_of_the_tutorial_runs_from_a_wheel(installed):
    page = (REPOSITORY / "docs" / "python.md").read_text(encoding="utf-8")
    blocks = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    outside(installed, "-c", "".join(blocks[: len(blocks) // 2]))


@pytest.fixture(scope="module")
def sdist(tmp_path_factory):
    """Build the source distribution and return its path."""
    folder = tmp_path_factory.mktemp("sdist")
    subprocess.run(["git", "clone", "--quiet", REPOSITORY, folder / "source"], check=True)
    build = "import setuptools.build_meta as build; print(build.build_sdist('..'))"
    python("-c", build, cwd=folder / "source", check=True)
    (built,) = folder.glob("*.tar.gz")
    return built


@pytest.mark.slow
def test_the_source_distribution_makes_the_same_wheel(installed, sdist, tmp_path):
    offline = "--no-deps", "--no-index", "--no-build-isolation"
    python("-m", "pip", "wheel", "--quiet", *offline, "--wheel-dir", tmp_path, sdist, check=True)
    (again,), (built,) = tmp_path.glob("*.whl"), installed.parent.glob("*.whl")
    names = [sorted(ZipFile(path).namelist()) for path in (again, built)]
    assert names[0] == names[1]
    with tarfile.open(sdist) as archive:
        assert not any("/tests/" in name for name in archive.getnames())


@pytest.mark.slow
@pytest.mark.parametrize("version", ["3.11", "3.12", "3.13", "3.14"])
def test_the_lines_of_the_readme_run_in_an_empty_environment(version, sdist, tmp_path):
    """With the versions of the lock, which need the network."""
    made = subprocess.run(
        ["uv", "venv", "--quiet", "--no-python-downloads", "--python", version, tmp_path / "venv"],
        check=False,
    )
    if made.returncode:
        pytest.skip(f"there is no Python {version} here")
    python, lock = tmp_path / "venv/bin/python", REPOSITORY / "requirements.lock"
    install = ["uv", "pip", "install", "--quiet", "--python", python, "--constraint", lock, sdist]
    subprocess.run(install, check=True)
    page = (REPOSITORY / "README.md").read_text(encoding="utf-8")
    (line,) = re.findall(r"`(twodiscs exact [^`]*)`", page)
    command = [python.with_name("twodiscs"), *line.split()[1:]]
    assert "1.3380472009164113" in subprocess.check_output(command, text=True)
    (code,) = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    subprocess.run([python, "-c", code], cwd=tmp_path, check=True)
    assert (tmp_path / "trajectory.png").exists()


def test_the_recipe_for_conda_has_the_version_and_the_packages_of_the_project():
    """Names in conda-forge differ for matplotlib, whose base has no windows."""
    text = (REPOSITORY / "packaging/recipe.yaml").read_text(encoding="utf-8")
    forms = {"variable_start_string": "${{", "variable_end_string": "}}"}
    context = yaml.safe_load(text)["context"] | {"python_min": "3.11", "PYTHON": "python"}
    template = Environment(undefined=StrictUndefined, **forms).from_string(text)
    recipe = yaml.safe_load(template.render(context))
    assert recipe["package"] == {"name": "twodiscs", "version": twodiscs.__version__}
    run = {line.replace(" ", "").replace("-base", "") for line in recipe["requirements"]["run"]}
    assert run == {f"python{PROJECT['requires-python']}", *PROJECT["dependencies"]}
    (script,) = recipe["build"]["python"]["entry_points"]
    assert script == f"twodiscs = {PROJECT['scripts']['twodiscs']}"
    assert (REPOSITORY / "packaging" / recipe["source"]["path"] / "pyproject.toml").exists()


def test_the_lock_has_everything():
    lock = (REPOSITORY / "requirements.lock").read_text(encoding="utf-8")
    locked = set(re.findall(r"^([\w-]+)==", lock, re.MULTILINE))
    assert {re.match(r"[\w-]+", one)[0] for one in PROJECT["dependencies"]} | {*EXTRAS} <= locked
    assert "://" not in lock


def test_make_keeps_an_environment_that_it_did_not_make(tmp_path):
    for name in ("Makefile", "requirements.lock", "pyproject.toml"):
        shutil.copy(REPOSITORY / name, tmp_path)
    Checkout(tmp_path).edit(".venv/mine", "")
    run = subprocess.run(["make", "test"], cwd=tmp_path, capture_output=True, text=True)
    assert run.returncode == 2
    assert run.stderr.startswith("make did not make this .venv, and keeps it: give it another name")
    assert (tmp_path / ".venv/mine").exists()


def test_an_archive_holds_what_git_tracks_and_the_results(tmp_path):
    """``make archive``, with other results than those of a build, which it would wait for."""
    checkout, results = tmp_path / "checkout", tmp_path / "checkout/results"
    git = ["git", "clone", "--quiet", "--depth", "1", f"file://{REPOSITORY}", checkout]
    subprocess.run(git, check=True, capture_output=True)
    (results / "a.csv").write_text("1\n")
    sums = subprocess.check_output(["sha256sum", "a.csv"], cwd=results)
    (results / "manifest.sha256").write_bytes(sums)
    (checkout / "left-over").touch()
    subprocess.run(["make", "--old-file", "all", "archive"], cwd=checkout, check=True)
    with tarfile.open(checkout / "build/twodiscs.tar.gz") as archive:
        names = {name.removeprefix("twodiscs/") for name in archive.getnames()}
        archive.extractall(tmp_path, filter="data")
    tracked = subprocess.check_output(["git", "ls-files"], cwd=checkout, text=True).split("\n")
    assert {*filter(None, tracked), "results/a.csv"} <= names
    assert "left-over" not in names
    check = ["sha256sum", "--check", "--quiet", "manifest.sha256"]
    subprocess.run(check, cwd=tmp_path / "twodiscs/results", check=True)
