"""The rules that an edit of a module reruns: their fingerprints change, module by module.

    python tests/workflow/test_fingerprints.py > tests/workflow/reruns.txt

makes the table anew. Fingerprints follow imports, so the table is read off without any build.
"""

import re
from pathlib import Path

import pytest
from checkout import REPOSITORY

from twodiscs.figures.catalogue import FIGURES
from twodiscs.model import sources
from twodiscs.model.family import FAMILIES, module_of
from twodiscs_paper.catalogue import STUDIES
from twodiscs_paper.configuration.request import STAGES

TABLE = Path(__file__).with_name("reruns.txt")
COMMON = (REPOSITORY / "workflow" / "rules" / "common.smk").read_text(encoding="utf-8")


def not_computing():
    """Return the modules that the rules leave out."""
    block = re.search(r"NOT_COMPUTING = \((.*?)\n\)", COMMON, re.DOTALL)[1]
    return tuple(re.findall(r'"([\w.]+)"', block))


def of_families(floor, *families):
    """Return the names in the rules beside the modules whose imports they follow."""
    floors = ("model", "theory", "sampling", "dynamics")
    return [
        module_of(one, family) for one in floors[: floors.index(floor) + 1] for family in families
    ]


def jobs():
    """Return {job: (its modules, those of them that are left out)} as the rules say."""
    pipeline = "twodiscs_paper.pipeline"
    kinds = {}
    for stage, own in STAGES.items():
        for family in FAMILIES:
            modules = [f"{pipeline}.jobs.point", *of_families(own.split(".")[1], family)]
            others = {*STAGES.values(), "twodiscs.points.estimates"} - {own}
            kinds[f"{stage} of {family}"] = modules, others
    table, study = f"{pipeline}.jobs.table", f"{pipeline}.jobs.study"
    for name in ("theory", "trajectory", "mean_times", "check"):
        kinds[f"table {name}"] = ([table, f"twodiscs.comparison.tables.{name}"], ())
    for name, one in STUDIES.items():
        modules = [study, one.tables[0].__module__, *of_families("dynamics", *one.families)]
        kinds[f"study {name}"] = modules, ()
    draw = f"{pipeline}.jobs.figure", "twodiscs.figures.kit.style"
    for name in ("volume", "mean_hop_time"):
        kinds[f"figure {name}"] = ([*draw, FIGURES[name].module], ())
    return kinds


def reruns():
    """Return {module: the jobs that an edit of it reruns}."""
    found = {".".join(name): [] for name in sources.modules()}
    for job, (modules, without) in jobs().items():
        for path in sources.imported(*modules, without=(*not_computing(), *without)):
            parts = path.relative_to(sources.ROOT).with_suffix("").parts
            name = ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
            found[name].append(job)
    return found


def text():
    """Return the table, a line for each module."""
    return "".join(f"{name}: {', '.join(some) or '-'}\n" for name, some in reruns().items())


def test_the_table_of_what_reruns_is_up_to_date():
    assert text() == TABLE.read_text(encoding="utf-8"), "python tests/workflow/test_fingerprints.py"


@pytest.mark.parametrize("name", not_computing())
def test_what_computes_nothing_reruns_nothing(name):
    assert reruns()[name] == []


def points(jobs):
    """Return those of ``jobs`` that make points."""
    return [job for job in jobs if job.partition(" ")[0] in STAGES]


def test_each_stage_has_its_own_module():
    for stage, module in STAGES.items():
        assert points(reruns()[module]) == [f"{stage} of {family}" for family in FAMILIES]


@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize("floor", ["theory", "sampling", "dynamics"])
def test_an_edit_for_one_family_reruns_its_points_alone(floor, family):
    found = points(reruns()[module_of(floor, family)])
    assert found
    assert all(job.endswith(f" of {family}") for job in found)


def test_an_edit_for_one_family_reruns_the_studies_of_its_scenes_alone():
    found = reruns()
    many = {"study more_discs", "study passages"}
    of_three = {"twodiscs.theory.many.three", "twodiscs.theory.many.rates"}  # a virial coefficient
    for name, jobs in found.items():
        studies = {job for job in jobs if job.startswith("study ")}
        if name == "twodiscs.dynamics.many.passages":  # no study has hops of many discs
            assert jobs == []
        elif "many" in name.split(".")[:-1] or name.endswith("families.many"):
            assert studies == many | ({"study agreement"} if name in of_three else set()), name
    effects = {job for job in found["twodiscs.theory.weighted"] if job.startswith("study ")}
    assert effects == {"study effects", "study passages"}


def test_a_module_that_all_points_share_reruns_all_of_them():
    found = reruns()
    for name in ("model.scene", "sampling.jit", "sampling.streams", "sampling.blocks.rounds"):
        assert len(points(found[f"twodiscs.{name}"])) == len(STAGES) * len(FAMILIES)


def test_the_fingerprint_changes_with_every_module_that_is_imported(monkeypatch):
    """A line is appended to each in turn, as it is read."""
    modules, read = "twodiscs_paper.pipeline.jobs.point", sources._read
    paths = sources.imported(modules)
    fingerprint = sources.fingerprint.__wrapped__
    before, edited = fingerprint(modules), None
    monkeypatch.setattr(
        sources, "_read", lambda path: (f"{read(path)[0]}{path == edited}", read(path)[1])
    )
    unedited = fingerprint(modules)
    assert unedited != before
    for edited in paths:  # noqa: B007
        assert fingerprint(modules) != unedited


if __name__ == "__main__":
    print(text(), end="")
