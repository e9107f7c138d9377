"""Families: the same names on every floor, one sentence for missing ones, edits for one family."""

import re
import shutil
from importlib import import_module

import pytest

from twodiscs.model import sources
from twodiscs.model.box import Box
from twodiscs.model.checks import InputError
from twodiscs.model.family import FAMILIES, module_of, of_family
from twodiscs.model.scene import Scene

FLOORS = ("model", "theory", "sampling", "dynamics")

SCENES = {
    "plain": Scene(1.5, 1.0, 0.2),
    "effects": Scene(1.5, 1.0, 0.2, mass_ratio=2.0),
    "many": Scene(1.5, 1.0, 0.15, discs=3),
}

#: The functions that a family does not have, by floor.
ABSENT = {
    ("theory", "plain"): {"passing_rate"},
    ("theory", "many"): {"fraction_near", "passing_rate", "shell_expectation", "shells"},
    ("sampling", "many"): {"near_hop", "origins", "rejection", "shelled", "thickness"},
    ("dynamics", "many"): {"rare_run", "rare_summary"},
}


def names(floor, family):
    return set(import_module(module_of(floor, family)).__all__)


@pytest.mark.parametrize("floor", FLOORS)
def test_families_have_the_same_names(floor):
    every = set().union(*(names(floor, family) for family in FAMILIES))
    for family in FAMILIES:
        assert every - names(floor, family) == ABSENT.get((floor, family), set()), family


@pytest.mark.parametrize("family", FAMILIES)
def test_a_scene_knows_its_family(family):
    assert SCENES[family].family == family


def test_what_a_family_cannot_do_is_one_sentence():
    with pytest.raises(InputError, match=r"^discs must be 2 for shells, not 3$"):
        of_family(SCENES["many"], "theory", "shell_expectation", "shells")
    with pytest.raises(InputError, match=r"^discs must be 2 for near hop, not 3$"):
        of_family(SCENES["many"], "sampling", "near_hop")
    with pytest.raises(
        InputError, match=r"^scene must be plain for nothing at all, but it has mass"
    ):
        of_family(SCENES["effects"], "dynamics", "nothing", "nothing at all")


#: A question for the number of discs, for effects or for a family.
QUESTION = re.compile(
    r'discs [!=<>]=? (2\b|USUAL)|has_effects\b|"discs" (not )?in (self|box|scene)|family [!=]= "'
)

#: The modules that ask, apart from those of families, and how often.
ASKING = {
    "twodiscs/model/scene.py": 3,  # two questions, and the definition of one
    "twodiscs/model/box.py": 1,
    "twodiscs/model/family.py": 1,
    "twodiscs/figures/kit/captions.py": 1,
    "twodiscs/figures/motion/animation.py": 1,
    "twodiscs/figures/motion/hopping_trajectory.py": 1,
    "twodiscs_paper/benchmark.py": 1,
    "twodiscs_paper/configuration/load.py": 1,
    "twodiscs_paper/pipeline/cost.py": 1,
}


def test_few_modules_ask_for_the_family_or_what_decides_it():
    found = {}
    for parts in sources.modules():
        path = sources._file(parts)
        if not {"families", "many"} & {*parts}:
            number = len(QUESTION.findall(path.read_text(encoding="utf-8")))
            found |= {path.relative_to(sources.ROOT).as_posix(): number} if number else {}
    assert found == ASKING


def test_all_discs_have_a_radius_and_a_mass():
    assert (SCENES["many"].radii, SCENES["many"].masses) == ((0.15,) * 3, (1.0,) * 3)
    assert (SCENES["effects"].radii, SCENES["effects"].masses) == ((0.2, 0.2), (1.0, 2.0))


def test_rough_discs_have_the_bursts_of_two_whatever_their_number():
    """Their modules are imported by a computed name, so rules have to name both families."""
    rough = {"moment_of_inertia": 0.5}
    families = [Box(1.5, 1.0, rough, discs).families for discs in (2, 3)]
    assert families == [("effects",), ("many", "effects")]
    assert [Box(1.5, 1.0, {}, discs).families for discs in (2, 3)] == [("plain",), ("many",)]


# An edit for one family ---------------------------------------------------------------------------


@pytest.fixture
def copy(tmp_path, monkeypatch):
    """Return a function: the fingerprints of the work on a family after an edit of some modules."""
    ignored = shutil.ignore_patterns("__pycache__")
    for package in sources.PACKAGES:
        shutil.copytree(sources.ROOT / package, tmp_path / package, ignore=ignored)
    monkeypatch.setattr(sources, "ROOT", tmp_path)
    known = (sources._file, sources._imports, sources._read, sources.fingerprint)

    def fingerprints(*edited):
        for name in edited:
            with open(tmp_path / f"{name.replace('.', '/')}.py", "a", encoding="utf-8") as file:
                file.write("\nADDED = 1\n")
        for function in known:
            function.cache_clear()
        jobs = ("twodiscs.sampling.montecarlo", "twodiscs.dynamics.counting")
        return {
            family: sources.fingerprint(*jobs, *(module_of(floor, family) for floor in FLOORS))
            for family in FAMILIES
        }

    yield fingerprints
    monkeypatch.undo()
    for function in known:
        function.cache_clear()


def changed(before, after):
    return {family for family in FAMILIES if before[family] != after[family]}


def test_an_edit_for_one_family_changes_the_fingerprint_of_no_other(copy):
    before = copy()
    of_many = [
        ".".join(name)
        for name in sources.modules()
        if name[0] == "twodiscs" and "many" in name and "figures" not in name
    ]
    assert len(of_many) > 10
    edits = [
        (of_many, {"many"}),
        (["twodiscs.theory.weighted"], {"effects"}),
        ([module_of(floor, "effects") for floor in FLOORS], {"effects"}),
        (["twodiscs.dynamics.two.lockstep"], {"plain", "effects"}),
        (["twodiscs.theory.flux"], {"effects", "many"}),
        (["twodiscs.model.scene"], set(FAMILIES)),
    ]
    for modules, families in edits:
        files = [name for name in modules if not name.endswith(".many") or "families" in name]
        after = copy(*files)
        assert changed(before, after) == families, modules
        before = after
