"""The catalogue of figures: every entry can be drawn, is of use when it says so, and reads well."""

import ast
import re
import subprocess
import sys
from importlib import import_module
from inspect import signature
from pathlib import Path

import pytest

import twodiscs
from twodiscs.comparison.scene_tables import SCENE_TABLES
from twodiscs.figures.catalogue import ANIMATION, FIGURES, NOTES, Entry
from twodiscs.figures.kit.captions import Sentence, Shown
from twodiscs.model.events import EVENTS
from twodiscs.studies.catalogue import STUDIES, STUDY_FIGURES, STUDY_TABLES

ALL = FIGURES | STUDY_FIGURES | {"animation": ANIMATION}
QUANTITIES = {
    "volume",
    "hop_histogram",
    "trajectory",
    *(f"{event}_{kind}" for event in EVENTS for kind in ("area", "time")),
}
EFFECTS = {"field": 1.5}


def test_the_modules_that_draw_are_those_of_the_entries():
    folder = Path(twodiscs.__file__).parent
    drawing = {
        ".".join(path.relative_to(folder).with_suffix("").parts)
        for floor in ("figures", "studies")
        for path in (folder / floor).rglob("*.py")
        for node in ast.parse(path.read_text(encoding="utf-8")).body
        if isinstance(node, ast.FunctionDef) and node.name == "draw"
    }
    assert drawing == {entry.module for entry in (FIGURES | STUDY_FIGURES).values()}


@pytest.mark.parametrize("name", FIGURES | STUDY_FIGURES)
def test_the_options_are_those_that_the_module_takes(name):
    entry = ALL[name]
    signature(import_module(f"twodiscs.{entry.module}").draw).bind(None, tables={}, **entry.options)


@pytest.mark.parametrize(
    "name", [name for study in STUDIES.values() if not study.about_plain for name in study.figures]
)
def test_a_study_of_any_scenes_is_drawn_without_a_box(name):
    entry = ALL[name]
    signature(import_module(f"twodiscs.{entry.module}").draw).bind(tables={}, **entry.options)


def test_only_the_animation_animates():
    assert callable(import_module(f"twodiscs.{ANIMATION.module}").animate)
    assert ANIMATION.tables == ("trajectory",)
    assert ANIMATION.is_called({"trajectory"})
    assert ANIMATION.is_called({"trajectory"}, {"discs": 3})
    assert ANIMATION.is_called({"trajectory"}, {"field": 1.0})


@pytest.mark.parametrize("name", ALL)
def test_an_entry_is_complete(name):
    entry = ALL[name]
    tables = SCENE_TABLES | STUDY_TABLES if name in STUDY_FIGURES else SCENE_TABLES
    assert {*entry.tables, *entry.main_tables} <= set(tables)
    assert set(entry.main_tables) <= set(SCENE_TABLES)
    assert entry.needs <= QUANTITIES
    if name not in STUDY_FIGURES:
        assert bool(entry.needs) == bool(entry.tables)
    assert entry.note in {None, *NOTES}
    assert list(entry.labels) == ["figure"]
    assert entry.labels["figure"] == entry.title


@pytest.mark.parametrize("effects", [{}, EFFECTS], ids=["plain", "effects"])
@pytest.mark.parametrize("name", ALL)
def test_captions_are_plain_text_in_whole_sentences(name, effects):
    entry = ALL[name]
    own, alike = entry.said(Shown(effects))
    assert entry.full_caption(effects) == f"{own} {alike}".strip()
    assert own.startswith(entry.caption[0].text)
    assert bool(alike) == bool(entry.note)
    for caption in (own, entry.full_caption(effects)):
        assert caption.endswith(".")
        assert not re.search(r"[\\${}_]{2}|\\|\$|\s\s|\n|\.\.|\. [a-z]", caption)


def test_captions_of_scenes_with_effects_say_nothing_of_plain_ones():
    called = [entry for entry in FIGURES.values() if entry.needs]
    for entry in called:
        plain, other = entry.full_caption(), entry.full_caption(EFFECTS)
        assert not re.search(r"[wh]/4|square box|Dashed|four times", other)
        assert ("lines mark h/4" in plain) == ("r_v and horizontal ones" in other)
        assert ("lines mark h/4" in plain) == bool(entry.note)
        assert "r_v" not in plain
    assert sum("Dashed" in entry.full_caption() for entry in called) >= 4
    assert "begins to keep to one side" in FIGURES["mean_wall_time"].full_caption(EFFECTS)


@pytest.mark.parametrize(
    ("effect", "value", "words"),
    [
        ("periodic", "x", ("dotted end", "along a periodic axis")),
        ("field", 1.5, ("In a field", "r_t")),
        ("depth", 1.0, ("Balls",)),
        ("moment_of_inertia", 0.5, ("spin",)),
    ],
)
def test_captions_speak_of_an_effect_where_it_is(effect, value, words):
    called = [ANIMATION, *(entry for entry in FIGURES.values() if entry.needs)]

    def told(effects):
        return " ".join(entry.full_caption(effects) for entry in called)

    for word in words:
        assert word in told({effect: value})
        assert word not in told({"mass_ratio": 2.0})


def test_what_explains_a_mark_is_said_by_each_figure_that_has_it(monkeypatch):
    crosses = Sentence("Crosses are\n few.", mark=lambda row: row["count"] < 9)
    monkeypatch.setitem(NOTES, "note", (Sentence("All alike."), crosses))
    entry = Entry("a", "b", "One\n  two.", "c", note="note")
    assert entry.said(Shown(rows=[{"count": 1}])) == ("One two. Crosses are few.", "All alike.")
    assert entry.said(Shown(rows=[{"count": 9}])) == ("One two.", "All alike.")
    assert entry.full_caption() == "One two. Crosses are few. All alike."


@pytest.mark.parametrize(
    ("name", "sentence", "boxes"),
    [
        ("model", "are drawn shorter.", {(5, 1), (1, 5)}),
        ("surface_shell", "are drawn shorter.", {(2, 1), (5, 1), (1, 5)}),
        ("mean_hop_time", "In a square box", {(1, 1)}),
        ("mean_hop_time", "Arrows", set()),
        ("volume", "Crosses", set()),
        ("stability", "Crosses", set()),
        ("stability", "not run.", {(1, 1), (1.5, 1), (2, 1), (5, 1), (1, 5)}),
    ],
)
def test_captions_say_what_the_box_makes_of_a_figure(name, sentence, boxes):
    said = {
        sides
        for sides in ((1, 1), (1.5, 1), (2, 1), (5, 1), (1, 5))
        if sentence in " ".join(ALL[name].said(Shown(sides=sides, rows=[])))
    }
    assert sentence in ALL[name].full_caption()
    assert said == boxes


def test_a_figure_is_called_for_by_what_it_shows():
    called = {n for n, entry in FIGURES.items() if entry.is_called({"right_wall_time"})}
    drawings = {n for n, entry in FIGURES.items() if not entry.tables}
    assert called == drawings | {n for n, e in FIGURES.items() if "right_wall_time" in e.needs}
    assert {"mean_wall_time", "pressure"} <= called
    assert called.isdisjoint({"mean_hop_time", "volume", "wall_area", "hop_histogram"})
    assert all(entry.is_called(QUANTITIES) for entry in FIGURES.values())


def test_scenes_with_effects_have_no_drawings_but_an_animation():
    called = {n for n, entry in FIGURES.items() if entry.is_called(QUANTITIES, EFFECTS)}
    assert called == {
        n for n, entry in FIGURES.items() if entry.tables and entry.without.isdisjoint(EFFECTS)
    }
    assert ANIMATION.is_called(QUANTITIES)
    assert ANIMATION.is_called(QUANTITIES, EFFECTS)


def test_catalogues_are_quick_to_import():
    code = "import sys, twodiscs.studies.catalogue; print(*sys.modules)"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stdout
    assert "twodiscs.figures.catalogue" in loaded.split()
    assert not {"numpy", "matplotlib", "mpmath", "scipy", "numba"} & set(loaded.split())
