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
from twodiscs.figures.catalogue import ANIMATION, FIGURES
from twodiscs.figures.kit.captions import NOTES, Shown
from twodiscs.figures.kit.limits import LARGEST, limits
from twodiscs.model.box import Box
from twodiscs.model.events import EVENTS
from twodiscs.theory.virial import weights
from twodiscs_paper.catalogue import STUDIES, STUDY_FIGURES, STUDY_TABLES

ALL = FIGURES | STUDY_FIGURES | {"animation": ANIMATION}
QUANTITIES = {
    "volume",
    "hop_histogram",
    "trajectory",
    *(f"{event}_{kind}" for event in EVENTS for kind in ("area", "time")),
}
EFFECTS = {"field": 1.5}


def test_the_modules_that_draw_are_those_of_the_entries():
    """Each has a caption too."""
    folder = Path(twodiscs.__file__).parents[1]
    drawing = {
        ".".join(path.relative_to(folder).with_suffix("").parts)
        for floor in ("twodiscs/figures", "twodiscs_paper/studies")
        for path in (folder / floor).rglob("*.py")
        for node in ast.parse(path.read_text(encoding="utf-8")).body
        if isinstance(node, ast.FunctionDef) and node.name == "caption"
    }
    assert drawing == {entry.module for entry in ALL.values()}
    assert all(hasattr(import_module(module), "draw") for module in drawing - {ANIMATION.module})


@pytest.mark.parametrize("name", FIGURES | STUDY_FIGURES)
def test_the_options_are_those_that_the_module_takes(name):
    entry = ALL[name]
    signature(import_module(entry.module).draw).bind(None, tables={}, **entry.options)


@pytest.mark.parametrize(
    "name", [name for study in STUDIES.values() if not study.about_plain for name in study.figures]
)
def test_a_study_of_any_scenes_is_drawn_without_a_box(name):
    entry = ALL[name]
    signature(import_module(entry.module).draw).bind(tables={}, **entry.options)


def test_only_the_animation_animates():
    assert callable(import_module(ANIMATION.module).animate)
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
    shown = Shown(Box(1.5, 1.0, effects))
    own, alike = entry.caption_parts(shown)
    assert entry.caption(shown) == f"{own} {alike}".strip()
    assert bool(alike) == bool(entry.note)
    for caption in (own, entry.caption(shown)):
        assert caption.endswith(".")
        assert not re.search(r"[\\${}_]{2}|\\|\$|\s\s|\n|\.\.|\. [a-z]", caption)


def test_captions_of_scenes_with_effects_say_nothing_of_plain_ones():
    called = [entry for entry in FIGURES.values() if entry.needs]
    for entry in called:
        plain, other = entry.caption(), entry.caption(Shown(Box(1.5, 1.0, EFFECTS)))
        assert not re.search(r"[wh]/4|square box|Dashed|four times", other)
        assert ("lines mark h/4" in plain) == ("hops end at r_v" in other)
        assert ("lines mark h/4" in plain) == bool(entry.note)
        assert "r_v" not in plain
    assert sum("Dashed" in entry.caption() for entry in called) >= 4
    assert "of a wall halves" in caption("mean_wall_time", EFFECTS)


def caption(name, effects, discs=2, sides=(1.5, 1.0), **more):
    """Return the caption of a figure in a box with effects."""
    return ALL[name].caption(Shown(Box(*sides, effects, discs), **more))


@pytest.mark.parametrize("sides", [(1.5, 1.0), (1.0, 1.5), (1.0, 1.0), (3.0, 1.0)], ids=str)
@pytest.mark.parametrize(
    ("effects", "discs"),
    [
        ({"mass_ratio": 2.0}, 2),
        ({"radius_ratio": 0.5}, 2),
        ({"radius_ratio": 0.25, "periodic": "y"}, 2),
        ({"periodic": "xy"}, 2),
        ({"field": 1.5, "moment_of_inertia": 0.5}, 2),
        ({"field": 0.5, "radius_ratio": 0.5, "mass_ratio": 2.0}, 2),
        ({"depth": 1.2}, 2),
        ({"depth": 1.2, "periodic": "xz"}, 2),
        ({}, 3),
        ({"periodic": "x"}, 3),
        ({}, 4),
    ],
    ids=str,
)
def test_captions_explain_the_marked_radii_and_no_others(effects, discs, sides):
    marked = " ".join(name for _, name in limits(Box(*sides, effects, discs)))
    text = caption("volume", effects, discs, sides)
    names = {name for name in ("v", "h", "x", "y", "t") if rf"r_{{\mathrm{{{name}}}}}" in marked}
    assert {name.removeprefix("r_") for name in re.findall(r"r_\w\b", text)} == names
    assert set(re.findall(r"[wh]/[24]", text)) == set(re.findall(r"[wh]/[24]", marked))
    assert ("The vertical line marks" in text) == (marked == LARGEST)
    assert ("Vertical lines mark" in text) == (marked != LARGEST)


@pytest.mark.parametrize(
    ("sides", "marked", "halve"),
    [
        ((1.5, 1.0), "h/4 and w/4, where hops", ["right", "top"]),
        ((3.0, 1.0), "h/4, where horizontal hops", ["right"]),
        ((1.0, 3.0), "w/4, where vertical hops", ["top"]),
    ],
)
def test_captions_of_plain_boxes_name_the_hops_that_become_blocked(sides, marked, halve):
    text = caption("mean_wall_time", {}, sides=sides)
    assert f"Vertical lines mark {marked} become blocked" in text
    assert re.findall(r"of the (\w+) wall halves", text) == halve
    assert "right wall" not in caption("mean_wall_time", {}, quantities={"top_wall_time"})


@pytest.mark.parametrize(
    ("effects", "discs", "halves"),
    [({}, 3, False), ({"periodic": "x"}, 2, True), ({"periodic": "xy"}, 2, False)],
)
def test_captions_of_wall_hits_speak_of_the_walls_that_there_are(effects, discs, halves):
    """A mean time halves where disc 1 keeps to its side, if the figure shows that wall."""
    box = Box(1.5, 1.0, effects, discs)
    times = {f"{event}_time" for event in box.tiny.events}
    text = caption("mean_wall_time", effects, discs, quantities=times)
    assert "right" not in text
    assert ("halves" in text) == halves
    assert "halves" not in caption("mean_wall_time", effects, discs, quantities={"any_wall_time"})


def test_what_is_said_of_volumes_is_not_said_of_times():
    assert "In a field volumes" in caption("volume", EFFECTS)
    assert "In a field volumes" not in caption("mean_wall_time", EFFECTS)


@pytest.mark.parametrize(
    ("name", "words", "row", "other"),
    [
        (
            "hopping_trajectory",
            "Dots mark",
            {"event": "horizontal_hop"},
            {"event": "vertical_hop"},
        ),
        ("animation", "stops at a hop", {"event": "vertical_hop"}, {"event": "wall_x1"}),
        ("hop_histogram", "time is exact", {"exact_mean": 1.0}, {"exact_mean": None}),
        ("vertical_hop_area", "at zero", {"exact": 0.0, "hits": 0}, {"exact": 1.0, "hits": 0}),
        ("mean_wall_time", "in bursts", {"z": None}, {"z": 1.0}),
        ("mean_wall_time", "too few events", {"z": 1.0}, {"z": None}),
    ],
)
def test_what_only_some_rows_call_for_is_said_where_they_are(name, words, row, other):
    rough = {"status": "too-few", "exact": 1.0, "replicas": 1, "z": None}
    assert words in caption(name, {}, rows=[rough | other, rough | row])
    assert words not in caption(name, {}, rows=[rough | other])


@pytest.mark.parametrize(
    ("effects", "discs", "said"),
    [({"mass_ratio": 2.0}, 2, True), ({}, 3, True), ({"field": 0.5}, 2, False)],
)
def test_x_and_y_are_the_same_in_a_square_box(effects, discs, said):
    text = caption("mean_hop_time", effects, discs, (1.0, 1.0))
    assert ("In a square box both hops" in text) == said


def test_lines_of_many_discs_are_said_to_cross_where_they_do():
    def says(sides, event, effects):
        rows = [{"event": event}, {"event": "wall_x1"}]
        return "lines cross" in caption("hopping_trajectory", effects, 3, sides, rows=rows)

    assert says((1.5, 1.0), "horizontal_hop", {})
    assert says((1.0, 1.5), "vertical_hop", {"periodic": "x"})
    assert not says((1.5, 1.0), "vertical_hop", {})
    assert not says((1.5, 1.0), "vertical_hop", {"periodic": "x"})


def test_the_virials_are_explained_where_they_are_drawn():
    for effects, discs in (({}, 2), ({"moment_of_inertia": 0.5}, 2), ({}, 3)):
        assert "(b) The virials" in caption("pressure", effects, discs)
    for effects, discs in (({"mass_ratio": 2.0}, 2), ({"depth": 1.0}, 2), ({"periodic": "x"}, 3)):
        assert weights(Box(1.5, 1.0, effects, discs).tiny) is None
        assert "(b)" not in caption("pressure", effects, discs)


@pytest.mark.parametrize(
    ("effect", "value", "words"),
    [
        ("periodic", "x", ("dotted end", "do not pass each other along x")),
        ("field", 1.5, ("In a field", "r_t")),
        ("depth", 1.0, ("Balls", "are balls")),
        ("moment_of_inertia", 0.5, ("spin",)),
        ("radius_ratio", 0.5, ("is that of disc 1", "r_x")),
    ],
)
def test_captions_speak_of_an_effect_where_it_is(effect, value, words):
    called = [ANIMATION, *(entry for entry in FIGURES.values() if entry.needs)]

    def told(effects):
        return " ".join(entry.caption(Shown(Box(1.5, 1.0, effects))) for entry in called)

    for word in words:
        assert word in told({effect: value})
        assert word not in told({"mass_ratio": 2.0})


@pytest.mark.parametrize(
    ("name", "sentence", "boxes"),
    [
        ("model", "are drawn shorter.", {(5, 1), (1, 5)}),
        ("surface_shell", "are drawn shorter.", {(2, 1), (5, 1), (1, 5)}),
        ("mean_hop_time", "In a square box", {(1, 1)}),
        ("mean_wall_time", "In a square box", {(1, 1)}),
        ("wall_area", "In a square box", {(1, 1)}),
        ("pressure", "In a square box", {(1, 1)}),
        ("mean_hop_time", "Arrows", set()),
        ("volume", "Crosses", set()),
        ("stability_of_runs", "Crosses", set()),
        ("stability", "has too few samples", set()),
    ],
)
def test_captions_say_what_the_box_makes_of_a_figure(name, sentence, boxes):
    said = {
        sides
        for sides in ((1, 1), (1.5, 1), (2, 1), (5, 1), (1, 5))
        if sentence in ALL[name].caption(Shown(Box(*sides), rows=[]))
    }
    assert sentence.lower() in ALL[name].caption().lower()
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
    code = "import sys, twodiscs_paper.catalogue; print(*sys.modules)"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stdout
    assert "twodiscs.figures.catalogue" in loaded.split()
    assert not {"numpy", "matplotlib", "mpmath", "scipy", "numba"} & set(loaded.split())
