"""The catalogue of figures: every entry can be drawn, and is made for the scenes that it says."""

import subprocess
import sys

import pytest

from twodiscs.comparison.scene_tables import SCENE_TABLES
from twodiscs.figures import draw
from twodiscs.figures.catalogue import ANIMATION, FIGURES, SHELLS, SIMULATED, Caption
from twodiscs.model.box import Box
from twodiscs.model.events import EVENTS

QUANTITIES = {
    "volume",
    "hop_histogram",
    "trajectory",
    *(f"{event}_{kind}" for event in EVENTS for kind in ("area", "time")),
}
EFFECTS = {"field": 1.5}


def test_every_figure_has_a_function_that_draws_it():
    both = {"mean_times", "areas"}  # all events of a table, which only td.plot draws
    assert {*draw.FROM_ROWS, *draw.OF_A_BOX} - both == {*FIGURES}
    assert {*draw.OF_A_BOX} == {name for name, entry in FIGURES.items() if not entry.tables}


@pytest.mark.parametrize("name", FIGURES)
def test_an_entry_is_complete(name):
    entry = FIGURES[name]
    assert {*entry.tables, *entry.main_tables} <= set(SCENE_TABLES)
    assert entry.needs <= QUANTITIES
    assert bool(entry.needs) == bool(entry.tables)
    assert entry.labels == {"figure": entry.title}
    for box in (None, Box(1.5, 1.0), Box(1.5, 1.0, EFFECTS), Box(1.5, 1.0, discs=4)):
        caption = entry.caption(box)
        assert caption.endswith(".")
        assert not {"\n", "  ", "$", "\\"} & {caption[i : i + 2] for i in range(len(caption))}


def test_a_caption_has_the_sentences_of_its_scene():
    caption = Caption("A.", plain="P.", other="O.", many="M.", field="F.", periodic="Q.")
    for effects, discs, text in (
        ({}, 2, "A. P."),
        ({"mass_ratio": 2.0}, 2, "A. O."),
        ({"field": 1.0}, 2, "A. O. F."),
        ({"field": 1.0, "periodic": "x"}, 2, "A. O. F. Q."),
        ({}, 3, "A. O. M."),
    ):
        assert caption.of(Box(1.5, 1.0, effects, discs)) == text
    assert caption.of() == "A. P."


@pytest.mark.parametrize(("note", "count"), [(SHELLS, 5), (SIMULATED, 4)])
def test_figures_over_the_radius_share_a_note(note, count):
    own = [entry for entry in FIGURES.values() if entry.note is note]
    assert len(own) == count
    assert all(entry.caption().endswith(note.of()) for entry in own)


def test_a_figure_is_made_for_what_it_shows():
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
