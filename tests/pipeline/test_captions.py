"""Captions say what their figures have: of this box, and of these tables."""

import pytest

from twodiscs.figures.catalogue import FIGURES
from twodiscs.pipeline.documents.captions import caption, said
from twodiscs.studies.catalogue import STUDY_FIGURES

ENTRIES = FIGURES | STUDY_FIGURES
SCENE = {"name": "one", "width": 1.5, "height": 1.0}


@pytest.mark.parametrize(
    ("name", "sentence", "boxes"),
    [
        ("model", "are drawn shorter.", {"5 1", "1 5"}),
        ("surface_shell", "are drawn shorter.", {"2 1", "5 1", "1 5"}),
        ("mean_hop_time", "In a square box", {"1 1"}),
        ("mean_hop_time", "Arrows", set()),
        ("volume", "Crosses", set()),
        ("stability", "Crosses", set()),
        ("stability", "Rows without a symbol were not run.", {"1 1", "1.5 1", "2 1", "5 1", "1 5"}),
    ],
)
def test_captions_say_what_the_box_makes_of_a_figure(name, sentence, boxes, tmp_path):
    found = set()
    for box in ("1 1", "1.5 1", "2 1", "5 1", "1 5"):
        width, height = map(float, box.split())
        if sentence in caption(ENTRIES[name], tmp_path, SCENE | {"width": width, "height": height}):
            found.add(box)
    assert sentence in ENTRIES[name].full_caption()
    assert found == boxes


@pytest.mark.parametrize(
    ("name", "table", "header", "row", "sentence"),
    [
        ("volume", "one/volume.csv", "quantity,status", "volume,too-few", "Crosses are estimates"),
        ("mean_hop_time", "one/mean_times.csv", "event,bound", "vertical_hop,3.1", "Arrows start"),
        ("stability", "stability.csv", "part,value", "coverage,", "Crosses are events"),
    ],
)
def test_marks_are_explained_where_a_row_calls_for_them(
    name, table, header, row, sentence, tmp_path
):
    path = tmp_path / table
    path.parent.mkdir(exist_ok=True)
    entry = ENTRIES[name]
    other = row.replace("too-few", "sampled").replace("3.1", "").replace("coverage", "energy")
    path.write_text(f"{header}\n{other}\n")
    before = caption(entry, tmp_path, SCENE)
    assert sentence not in before
    path.write_text(f"{header}\n{other}\n{row}\n")
    after = caption(entry, tmp_path, SCENE)
    assert after.count(sentence) == 1
    assert sorted(after.split()) != sorted(before.split())
    # A row of what the figure does not show is of no consequence, nor is another scene's.
    path.write_text(f"{header}\n{row.replace('vertical_hop', 'top_wall')}\n")
    shown = name != "mean_hop_time"
    assert (sentence in caption(entry, tmp_path, SCENE)) == shown
    if "/" in table:
        path.write_text(f"{header}\n{row}\n")
        assert sentence not in caption(entry, tmp_path, SCENE | {"name": "two"})


def test_a_scene_with_effects_has_words_of_its_own(tmp_path):
    entry = FIGURES["mean_wall_time"]
    own, alike = said(entry, tmp_path, SCENE | {"effects": {"field": 1.0}})
    assert entry.with_effects in own
    assert entry.plain not in own
    assert "In a field volumes and areas are weighted" in alike
