"""The verdict: a table that is cut short, edited or of other scenes is no certificate."""

import json
import math
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from commands import command

from twodiscs.comparison import scores
from twodiscs.comparison.scene_tables import SCENE_TABLES
from twodiscs.dynamics import counting
from twodiscs.points import estimates
from twodiscs.sampling import montecarlo
from twodiscs_paper.catalogue import STUDIES, STUDY_TABLES
from twodiscs_paper.configuration.load import load
from twodiscs_paper.configuration.request import STAGES
from twodiscs_paper.pipeline.results import verdict

EXPECTED = Path(__file__).resolve().parents[2] / "paper" / "expected"
CONFIGURATION = json.loads((EXPECTED / "configuration.json").read_text(encoding="utf-8"))
SCENES = {scene.name: scene for scene in load(CONFIGURATION).scenes}
STUDIES = {name: study for name, study in STUDIES.items() if study.due}


def read(scene):
    return SCENE_TABLES["check"].read(EXPECTED / scene / "check.csv")


PAPER = read("paper")
LOCAL = sum(row["radius"] is not None for row in PAPER)


def failures(rows, scene="paper"):
    return [*verdict.scene_failures(rows, SCENES[scene])]


@pytest.mark.parametrize("scene", SCENES)
def test_tables_as_their_jobs_wrote_them_pass(scene):
    assert failures(read(scene), scene) == []
    assert failures(read(scene), {"paper": "long", "long": "paper"}[scene]) != []


@pytest.mark.parametrize("scene", SCENES)
def test_a_table_that_ends_early_fails_wherever_that_is(scene):
    rows = read(scene)
    for n in {*range(0, len(rows), 9), *range(5), *range(len(rows) - 5, len(rows))}:
        assert failures(rows[:n], scene), n


def test_a_table_of_its_head_alone_fails():
    first, second = failures([])
    assert first.startswith("area of any_wall_area at radius 0.01 is missing, and so are ")
    assert second == "nothing is compared"


def changed(which, **values):
    """Return the rows of the table, those of which ``which(row)`` holds with other ``values``."""
    return [row | values if which(row) else row for row in PAPER]


def collides(row):
    return row["quantity"] == "disc_collision_time" and row["radius"] == 0.1


def is_mean(row):
    return row["comparison"] == "z_mean" and row["quantity"] == "volume"


(COLLISIONS,) = filter(collides, PAPER)
BOUND = COLLISIONS["bound"]
DAMAGES = {
    "no answer": (
        changed(lambda row: True, passed=None),
        "the table says not compared; the same holds",
    ),
    "one answer": (changed(collides, passed=False), "the table says not passed"),
    "no score": (changed(collides, z=None), "is not compared, but the table says passed"),
    "no score, no answer": (
        changed(collides, z=None, passed=None, bound=None),
        f"has the bound {BOUND}, but the bound of ",
    ),
    "z = 99": (changed(collides, z=99.0), "by dynamics has z = 99, beyond the bound"),
    "z = 99, wide bounds": (
        changed(collides, z=99.0, bound=1e9), "by dynamics has z = 99, beyond the bound",
    ),
    "infinite": (changed(collides, z=math.inf), "by dynamics has z = inf, beyond the bound"),
    "a bound": (changed(collides, bound=9.0), "has the bound 9.0, but the bound of "),
    "an estimate": (
        changed(collides, estimate=COLLISIONS["exact"] + 9 * COLLISIONS["stderr"]),
        "but its estimate is 9 standard errors off",
    ),
    "an exact value": (
        changed(collides, exact=COLLISIONS["estimate"] * 1.01), "standard errors off",
    ),
    "an error": (changed(collides, stderr=COLLISIONS["stderr"] / 100), "standard errors off"),
    "a sign": (
        changed(lambda row: abs(row["z"]) > 2 and row["radius"], z=-2.5), "standard errors off",
    ),
    "twice": ([*PAPER[:9], *PAPER], "is duplicated, and so are 8 more"),
    "all twice": ([*PAPER, *PAPER], "is duplicated, and so are 803 more"),
    "a row less": ([row for row in PAPER if not collides(row)], "at radius 0.1 is missing"),
    "another radius": (changed(collides, radius=0.1234), "at radius 0.1 is missing"),
    "no radius": (changed(collides, radius=None), "at radius None is not requested"),
    "a mean": (changed(is_mean, z=0.0), "over all radii by conditioned has z = 0.0, but by the "),
    "a mean less": ([row for row in PAPER if not is_mean(row)], "has z = None, but by the other"),
    "no statement on all radii": (PAPER[:LOCAL], "over all radii by monte_carlo has z = None"),
}  # fmt: skip


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_table_fails_and_a_sentence_says_why(damage):
    rows, sentence = DAMAGES[damage]
    found = failures(rows)
    assert any(sentence in each for each in found), found[:5]


def test_a_row_that_is_left_out_with_new_bounds_for_the_others_is_missing():
    rows = [row for row in PAPER if not collides(row)]
    bound = scores.bonferroni_bound(LOCAL - 1, scores.FALSE_ALARM / 2)
    rows = [row | {"bound": bound} if row["radius"] else row for row in rows]
    assert failures(rows)[0] == "mean_time of disc_collision_time at radius 0.1 is missing"


def test_hops_of_a_strip_are_compared_from_all_initial_states_too():
    strip = next(row for row in PAPER if row["method"] == "strip")
    key = strip["quantity"], strip["radius"], "dynamics"
    rows = [row for row in PAPER if (row["quantity"], row["radius"], row["method"]) != key]
    assert len(rows) == len(PAPER) - 1
    said = f"mean_time of {key[0]} at radius {key[1]} by dynamics is missing"
    assert failures(rows)[0] == said


@pytest.mark.parametrize("column", SCENE_TABLES["check"].columns)
def test_no_cell_that_is_empty_ends_the_verdict_without_a_sentence(column):
    """Whether it matters or not: p, status and independent decide nothing."""
    for rows in (PAPER[:40], PAPER[-40:]):
        for i in range(0, 40, 7):
            rows = [*rows[:i], rows[i] | {column: None}, *rows[i + 1 :]]
        tables = {"paper": rows}
        assert verdict.verdict(tables, {}, SCENES)[0]
        assert verdict.summary("paper", rows)


# Scores and deviations --------------------------------------------------------------------------


def row_of(estimate, exact, z, test):
    return {"estimate": estimate.value, "stderr": estimate.stderr, "exact": exact}, z, test


def sampled_rows():
    """Yield what areas and volumes may look like: deviations of up to five standard errors."""
    shares = (3e-7, 1e-3, 0.3, 0.9, 1 - 3e-7)
    for samples, share, off in product((10**6, 10**9), shares, range(-5, 6)):
        hits = round(samples * share + off * math.sqrt(samples * share * (1 - share)))
        if min(hits, samples - hits) >= 100:
            estimate = estimates.binomial_estimate(hits, samples, 3.0)
            yield row_of(estimate, 3 * share, *scores.binomial_z(hits, samples, share))


def time_rows():
    """Yield what mean times may look like, in clusters of up to fifty events."""
    cases = product((128, 10**5), (150, 2000, 10**6), (1, 3, 50), range(-5, 6))
    for replicas, expected, size, off in cases:
        count = round(expected + off * math.sqrt(size * expected))
        squares = size * count + count * count // replicas
        if count > 0 and estimates.has_error_bar(count, squares, replicas):
            estimate = estimates.mean_time(count, squares, replicas, 1.0)
            exact = replicas / expected
            yield row_of(estimate, exact, *scores.mean_time_z(count, squares, replicas, 1.0, exact))


@pytest.mark.parametrize("rows", [sampled_rows, time_rows])
def test_scores_agree_with_the_deviations_of_their_rows_and_no_others_do(rows):
    tests = set()
    for row, z, test in rows():
        tests.add(test)
        off = verdict.deviation(row)
        assert verdict.agrees(z, off, test), (z, off, test)
        assert not verdict.agrees(z + 9, off, test)
        if test != "cluster-bound":
            assert not verdict.agrees(z - 9, off, test)
    assert tests == {"normal", "exact-tail" if rows is sampled_rows else "cluster-bound"}


def test_errors_of_both_sides_are_added_in_squares():
    row = {"dynamics": 3.0, "dynamics_stderr": 0.3, "exact": None}
    assert verdict.deviation(row | {"monte_carlo": 2.0, "monte_carlo_stderr": 0.4}) == 2.0
    assert verdict.deviation(row | {"exact": 2.7}) == pytest.approx(1)
    assert verdict.deviation(row) is None


# Which rows there must be ---------------------------------------------------------------------

BOXES = {
    "plain": {},
    "any wall": {"watch": {"areas": ["any_wall"], "mean_times": ["any_wall", "vertical_hop"]}},
    "collisions": {"watch": {"areas": ["disc_collision"], "volume": False}},
    "times": {"watch": {"areas": False, "volume": False}},
    "areas": {"watch": {"mean_times": False}},
    "rough": {"effects": {"moment_of_inertia": 0.4}},
    "on a ring": {"effects": {"periodic": ["x"]}, "radii": [0.1, 0.2]},
    "in a field": {"effects": {"field": 0.2, "mass_ratio": 2}},
    "balls": {"box": {"width": 1.5, "height": 1, "depth": 1.2}},
    "three": {"box": {"width": 2.5, "height": 1}, "discs": 3, "radii": [0.05, 0.15]},
    "four on a ring": {
        "box": {"width": 2.5, "height": 1}, "discs": 4, "radii": [0.1, 0.15],
        "effects": {"periodic": ["x"]},
    },
}  # fmt: skip


def built(block):
    """Return the ``SceneRequest`` of a block and the rows of check.csv of a few events each."""
    plain = {"name": "a", "box": {"width": 1.5, "height": 1.0}, "radii": [0.2, 0.374]}
    watch = {"volume": True, "areas": True, "mean_times": True, "hop_histogram": False}
    watch |= block.get("watch", {})
    (scene,) = load({"scenes": [plain | block | {"watch": watch}]}).scenes
    points = {stage: [] for stage in STAGES}
    for radius in scene.keys["monte_carlo"].values():
        work = scene.arguments("monte_carlo", radius) | {"samples": 2**12}
        run = montecarlo.SamplingRun(scene.box.scene(radius), **work)
        points["monte_carlo"].append(run.run())
    for radius in scene.keys["dynamics"].values():
        work = scene.arguments("dynamics", radius) | {"budget": 1}
        run = counting.CountingRun(scene.box.scene(radius), **work)
        points["dynamics"].append(run.run())
    theory = SCENE_TABLES["theory"].rows(scene.box, scene.radii)
    rows = SCENE_TABLES["check"].rows(scene.box, theory, points, scene.quantities.areas)
    return scene, rows


#: Those whose kernels this file alone would compile.
OTHERS = ("rough", "on a ring", "in a field", "balls", "three", "four on a ring")


@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=[pytest.mark.slow] * (name in OTHERS)) for name in BOXES],
)
def test_all_that_a_scene_asks_for_is_due_and_nothing_else(name):
    scene, rows = built(BOXES[name])
    found = {(r["comparison"], r["quantity"], r["radius"]) for r in rows if r["radius"]}
    assert {key for key in found if key[0] != "flux"} == {*verdict.due(scene)}


# The command ----------------------------------------------------------------------------------


@pytest.fixture
def folder(tmp_path):
    """Tables to be judged, and an old verdict."""
    for scene in SCENES:
        (tmp_path / scene).mkdir()
        text = (EXPECTED / scene / "check.csv").read_text(encoding="utf-8")
        (tmp_path / scene / "check.csv").write_text(text, encoding="utf-8")
    (tmp_path / "check.passed").write_text("paper: all is well\n", encoding="utf-8")
    return tmp_path


def judge(monkeypatch, folder, scenes=SCENES, studies=STUDIES, configuration=CONFIGURATION):
    tables = [folder / name / "check.csv" for name in scenes]
    words = ["--studies", *(EXPECTED / f"{name}.csv" for name in studies)]
    words += ["--configuration", configuration, "--output", folder / "check.passed"]
    return command(monkeypatch, verdict, *tables, *words)


def test_the_command_writes_what_passed(monkeypatch, folder, capsys):
    assert judge(monkeypatch, folder) == 0
    text = (folder / "check.passed").read_text(encoding="utf-8")
    assert capsys.readouterr().out == text
    assert [line.split(":")[0] for line in text.splitlines()] == [*SCENES, *STUDIES]
    assert text.startswith(f"paper: {len(PAPER)} comparisons passed, ")


@pytest.mark.parametrize("lines", [0, 1, 2, 300, 804])
def test_the_command_fails_for_a_table_that_is_cut_short(monkeypatch, folder, capsys, lines):
    path = folder / "paper" / "check.csv"
    kept = path.read_text(encoding="utf-8").splitlines(keepends=True)[:lines]
    path.write_text("".join(kept), encoding="utf-8")
    assert judge(monkeypatch, folder) == (1 if lines else 2)
    error = capsys.readouterr().err
    assert "paper" in error.splitlines()[0]
    assert "Traceback" not in error
    assert not (folder / "check.passed").exists()


def test_the_command_asks_for_the_tables_of_the_configuration(monkeypatch, folder, capsys):
    for given in ({"scenes": ["paper"]}, {"studies": ["passages"]}, {"scenes": [], "studies": []}):
        assert judge(monkeypatch, folder, **given) == 2
        assert "tables must be given of ['long', 'more_discs'," in capsys.readouterr().err
        assert not (folder / "check.passed").exists()


def test_what_measures_nothing_is_said_to_compare_nothing(monkeypatch, folder, capsys):
    names = "volume", "areas", "mean_times", "hop_histogram"
    watch = dict.fromkeys(names, False) | {"trajectory": 0.2}
    scene = {"name": "a", "box": {"width": 1.5, "height": 1}, "watch": watch}
    assert judge(monkeypatch, folder, [], [], {"scenes": [scene]}) == 0
    assert "comparisons passed" not in capsys.readouterr().out


@pytest.mark.parametrize("name", STUDIES)
def test_scores_of_a_study_are_compared_with_its_estimates(name):
    rows = STUDY_TABLES[name].read(EXPECTED / f"{name}.csv")
    assert [*verdict.study_failures(rows)] == []
    i = next(i for i, row in enumerate(rows) if row["z"] is not None)
    for z, said in ((99.0, "has z = 99, beyond the bound"), (3.4, "standard errors off")):
        bad = [*rows[:i], rows[i] | {"z": z}, *rows[i + 1 :]]
        (sentence,) = verdict.study_failures(bad)
        assert said in sentence
    assert any("is duplicated" in said for said in verdict.study_failures([*rows, *rows]))
    for nothing in ([], [row | {"z": None} for row in rows]):
        assert "nothing is compared" in verdict.study_failures(nothing)


@pytest.mark.parametrize("name", STUDIES)
def test_no_row_of_a_study_that_is_compared_can_go(name):
    rows = STUDY_TABLES[name].read(EXPECTED / f"{name}.csv")
    due = [*STUDIES[name].due(load(CONFIGURATION))]
    assert [*verdict.study_failures(rows, due)] == []
    n = len(rows)
    for cut in (*range(1, n, 1 + n // 7), n - 1):
        assert "is missing" in next(verdict.study_failures(rows[:cut], due)), cut
    # Many rows may have the same key, such as those of all times.
    i = next(i for i, row in enumerate(rows) if due[0].items() <= row.items())
    assert "is missing" in next(verdict.study_failures([*rows[:i], *rows[i + 1 :]], due))
    # Some plateaus exist for some measured values only.
    scored = [i for i, row in enumerate(rows) if row["z"] is not None]
    scored = [i for i in scored if rows[i].get("quantity") != "plateau"]
    for i in scored[:: 1 + len(scored) // 9]:
        without = [*rows[:i], *rows[i + 1 :]]
        assert "is missing" in next(verdict.study_failures(without, due)), rows[i]
        empty = [*rows[:i], rows[i] | {"z": None}, *rows[i + 1 :]]
        assert any("no score" in said for said in verdict.study_failures(empty, due)), rows[i]


@pytest.mark.parametrize("name", STUDIES)
def test_the_command_fails_for_a_study_that_is_cut_in_half(monkeypatch, folder, capsys, name):
    lines = (EXPECTED / f"{name}.csv").read_text(encoding="utf-8").splitlines(keepends=True)
    (folder / f"{name}.csv").write_text("".join(lines[: len(lines) // 2]), encoding="utf-8")
    assert judge(monkeypatch, folder, studies=[folder / name, *({*STUDIES} - {name})]) == 1
    assert capsys.readouterr().err.startswith(f"{name}: ")
    assert not (folder / "check.passed").exists()


def test_studies_are_judged_by_their_scores():
    """1000 scores: a bound of 4.9 or so."""
    row = dict.fromkeys(("scene", "event", "radius", "z"))
    z = *np.linspace(0, 1, 998).tolist(), -4.7
    rows = [row | {"radius": 0.1, "event": "vertical_hop", "z": each} for each in z]
    failures, text = verdict.verdict({}, {"passages": [*rows, row]})
    assert (failures, text) == ([], "passages: 999 comparisons passed, largest |z| 4.7\n")
    (failure,), _ = verdict.verdict({}, {"passages": [*rows, rows[0] | {"z": 5.1}]})
    bound = scores.bonferroni_bound(1000, scores.FALSE_ALARM)
    assert failure == (
        f"passages: event vertical_hop, radius 0.1 has z = 5.1, beyond the bound {bound:.3g}"
    )
