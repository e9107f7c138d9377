"""Captions explain the contents of the tables of their figures."""

import pytest

from twodiscs.comparison.scene_tables import SCENE_TABLES
from twodiscs.figures.catalogue import FIGURES
from twodiscs_paper.catalogue import STUDY_FIGURES, STUDY_TABLES
from twodiscs_paper.pipeline.documents.captions import caption, caption_parts

ENTRIES, TABLES = FIGURES | STUDY_FIGURES, SCENE_TABLES | STUDY_TABLES
SCENE = {"name": "one", "width": 1.5, "height": 1.0}


@pytest.mark.parametrize(
    ("name", "table", "row", "other", "sentence"),
    [
        ("volume", "volume", {"quantity": "volume", "status": "too-few"}, {"status": "sampled"},
         "Crosses are estimates"),
        ("mean_hop_time", "mean_times", {"event": "vertical_hop", "bound": 3.1},
         {"event": "top_wall"}, "Arrows start"),
        ("stability_of_runs", "stability", {"part": "coverage"}, {"value": 0.0},
         "Crosses are events"),
    ],
)  # fmt: skip
def test_marks_are_explained_where_a_row_calls_for_them(
    name, table, row, other, sentence, tmp_path
):
    """For its scene, and for the quantities in the figure."""
    entry = ENTRIES[name]
    path = tmp_path / ("" if table in STUDY_TABLES else "one") / f"{table}.csv"
    path.parent.mkdir(exist_ok=True)
    row, other = TABLES[table].empty(**row), TABLES[table].empty(**row | other)
    assert sentence not in caption(entry, tmp_path, SCENE)
    TABLES[table].write(path, [other])
    assert sentence not in caption(entry, tmp_path, SCENE)
    TABLES[table].write(path, [other, row])
    assert caption(entry, tmp_path, SCENE).count(sentence) == 1
    elsewhere = caption(entry, tmp_path, SCENE | {"name": "two"})
    assert (sentence in elsewhere) == (table in STUDY_TABLES)


def test_the_box_and_the_effects_of_the_scene_are_those_of_the_figure(tmp_path):
    entry = FIGURES["mean_hop_time"]
    assert "In a square box" in caption(entry, tmp_path, SCENE | {"width": 1.0})
    assert "In a square box" not in caption(entry, tmp_path, SCENE)
    own, alike = caption_parts(entry, tmp_path, SCENE | {"effects": {"field": 1.0}})
    assert "Dashed" not in own
    assert "From r_t on" in alike
    assert "Hops are those of any pair" in caption(
        entry, tmp_path, SCENE | {"effects": {"discs": 3}}
    )
