"""The declarations of studies, and what each takes and reads.

Without these tests a job could fail by what its study hands to it, or reads.
"""

import dataclasses
import inspect
import json
import math

import pytest
from checkout import REPOSITORY, one_scene
from factory import EXPECTED, of

from twodiscs.model.effects import EFFECTS
from twodiscs_paper.catalogue import STUDIES, TABLES, is_reproducible, read_table
from twodiscs_paper.configuration.yaml_files import load, read
from twodiscs_paper.draw import DRAW
from twodiscs_paper.studies.distributions import measure as distributions
from twodiscs_paper.studies.more_discs import measure as more_discs

CONFIG = REPOSITORY / "config"
every_study = pytest.mark.parametrize("study", STUDIES.values(), ids=STUDIES)


def loaded(block):
    """Return a configuration beside the scenes of ``config/scenes``, which effects reads."""
    paths = sorted((CONFIG / "scenes").glob("*.yaml"))
    scenes = tuple(load({"seed": 1} | read(path)).scenes[0] for path in paths)
    return dataclasses.replace(load(block), effect_scenes=scenes)


def test_every_effect_has_a_scene(default):
    assert {*EFFECTS} <= {name for scene in default.effect_scenes for name in scene.effects}


@pytest.fixture(scope="module")
def default():
    return loaded(read(CONFIG / "config.yaml"))


@every_study
def test_parameters_are_plain_values_that_its_table_takes(study, default):
    """The first table, which is named as the study is."""
    given = study.parameters(default)
    for values in (given, *study.parts(default).values()):
        assert json.loads(json.dumps(values, allow_nan=False)) == values
    assert study.tables[0].name() == study.name
    signature = inspect.signature(study.tables[0].rows)
    takes_tables = "tables" in signature.parameters
    signature.bind(**given, **{"tables": {}} if takes_tables else {})
    assert bool(study.reads(default) or study.parts(default)) == takes_tables


def same(row, other):
    """Return whether two rows have the same cells, floats to 1e-9."""
    pairs = [(value, other[name]) for name, value in row.items()]
    close = (isinstance(a, float) and b and math.isclose(a, b, rel_tol=1e-9) for a, b in pairs)
    return all(near or a == b for near, (a, b) in zip(close, pairs, strict=True))


def test_some_rows_are_the_expected_ones(default, monkeypatch):
    """``verify`` compares all of them; these take a second, with the parameters of all."""
    near = distributions.near_threshold
    monkeypatch.setattr(distributions, "near_threshold", lambda *of: near(*of)[:1])
    given = {name: study.parameters(default) for name, study in STUDIES.items()}
    given["distributions"]["scenes"] = [given["distributions"]["scenes"][0] | {"radii": []}]
    scenes = {"discs": (2,), "radii": (0.28,), "on_tori": ((3, 0.1),)}
    read = STUDIES["thresholds"].reads(default).items()
    paths = {name: EXPECTED / (scene or "") / f"{table}.csv" for name, (scene, table) in read}
    tables = {name: read_table(path) for name, path in paths.items()}
    for name, rows in {
        "more_discs": more_discs.rows(**given["more_discs"], **scenes),
        "distributions": distributions.rows(**given["distributions"]),
        "thresholds": TABLES["thresholds"].rows(tables, **given["thresholds"]),
    }.items():
        made, kept = list(rows), read_table(EXPECTED / f"{name}.csv")
        assert len(made) > 5
        assert [sum(same(row, other) for other in kept) for row in made] == [1] * len(made)


def test_studies_read_only_what_there_is(default):
    """A scene that measures no times has no part in the thresholds."""
    little = load(one_scene("paper", watch={"volume": True}, radii=[0.1]))
    assert STUDIES["thresholds"].reads(little) == {"distributions": (None, "distributions")}
    checked = {"paper/check": ("paper", "check"), "effects": (None, "effects")}
    assert STUDIES["agreement"].reads(little) == checked
    assert STUDIES["thresholds"].reads(default)["paper/mean_times"] == ("paper", "mean_times")


def test_budgets_follow_the_main_scene_within_limits():
    def parameters(study, budget):
        keys = {} if budget is None else {"event_budget": budget}
        return STUDIES[study].parameters(load(one_scene("a", radii=[0.1], **keys)))

    for study, name, *numbers in (
        ("tails", "replicas", 4_000, 5_000, 100_000),
        ("tails", "samples", 2, 5, 100),
        ("distributions", "events", 2**16, 250_000, 2**22),
        ("stability", "ordinary", 10**7, 12_500_000, 250_000_000),
        ("stability", "hard", 10**6, 1_250_000, 25_000_000),
        ("more_discs", "events", 10**5, 200_000, 10**8),
        ("more_discs", "samples", 10**4, 25_000, 10**7),
    ):
        assert [parameters(study, 10**power)[name] for power in (4, 8, 12)] == numbers
    for name in ("tails", "distributions", "passages", "stability", "more_discs"):
        assert parameters(name, None) == parameters(name, 2 * 10**9)


def test_the_rough_discs_of_a_hop_are_those_of_its_expected_rows(default):
    rows = of(TABLES["passages"].read(EXPECTED / "passages.csv"), friction=None, periodic=None)
    parts = of(STUDIES["passages"].parts(default).values(), part="near_threshold")
    assert len(parts) == 3
    for one in parts:
        own = of(rows, scene=one["name"], event=one["hop"])
        assert {row["moment_of_inertia"] for row in own} == {None, *one["inertias"]}


def test_a_configuration_without_plain_scenes_has_studies():
    """Those that are not about plain scenes need no main one."""
    only_effects = loaded(read(CONFIG / "scenes" / "rough.yaml"))
    kept = [study for study in STUDIES.values() if not study.about_plain]
    assert [study.name for study in kept] == ["accuracy_cost", "effects"]
    assert only_effects.main is None
    for study in kept:
        json.dumps(study.parameters(only_effects))
        assert all(scene.startswith("effects/") for scene, _ in study.reads(only_effects).values())


@every_study
def test_figures_are_drawn_from_all_tables_of_the_study_and_those_with_seconds_are_timed(study):
    names = {table.name() for table in study.tables}
    for name, entry in study.figures.items():
        module = inspect.getmodule(DRAW[name]).__name__
        assert module.startswith(f"twodiscs_paper.studies.{study.name}.")
        if entry.tables or not entry.long_runs:  # a figure may be of a long run alone
            assert names <= set(entry.tables)
    assert set(study.timed) <= names
    for table in study.tables:
        seconds = [name for name, column in table.columns.items() if column.unit == "s"]
        assert not seconds or table.name() in study.timed


def test_results_with_seconds_and_documents_are_not_the_same_on_every_run():
    """A figure has the seconds of its tables; that of the effects shows their cost."""
    same = ["a/check.csv", "effects.csv", "a/volume.png", "a/animation.gif", "thresholds.pdf"]
    other = ["a/cost.csv", "accuracy_cost.csv", "benchmark.csv", "effects_cost.csv", "paper.pdf"]
    other += ["accuracy_cost_by_radius.pdf", "effects.png", "report.html", "configuration.json"]
    assert [path for path in same + other if is_reproducible(path)] == same
