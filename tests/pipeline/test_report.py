"""The report: its numbers and rows.

Without these tests numbers of the report could be those of other rows, or too wide for it.
"""

from base64 import b64decode
from io import BytesIO
from pathlib import PurePosixPath

import pytest
from checkout import REPOSITORY, copy_tables
from factory import EXPECTED, write_rows
from PIL import Image

from twodiscs.analysis.tables import CheckTable, CostTable, MeanTimesTable
from twodiscs_paper.pipeline.documents import report
from twodiscs_paper.pipeline.results.verdict import verdict


def test_other_figures_stand_in_for_those_that_are_not_there():
    def key(*names, of_scene=True):
        paths = [PurePosixPath(f"a/figures/{name}.png") for name in sorted(names)]
        return [path.stem for path in report.key_figures(paths, of_scene)]

    assert key("model", "volume", "mean_hop_time", "animation") == ["mean_hop_time", "volume"]
    assert key("model", "animation") == []
    assert key("volume", *report.KEY_FIGURES) == [*report.KEY_FIGURES]
    assert key("stability", *report.KEY_OF_ALL, of_scene=False) == [*report.KEY_OF_ALL]


@pytest.mark.parametrize("z", [2.41, 0.03456, 12.345])
def test_the_largest_deviation_has_the_digits_of_the_verdict(z):
    row = {"bound": 99, "independent": True, "status": "sampled", "z": -z}
    said = report.page("largest |z| {{ largest | three_digits }}\n", {"largest": z})
    assert said in verdict([("small", [row])])[1]
    assert (report.short(999), report.short(43_870_000_000)) == ("999", "4.4 × 10<sup>10</sup>")
    texts = "-0.66", "+1.2", "7.5e-05", "none-seen", "> 3.2"
    set_as = ["−0.66", "+1.2", "7.5 × 10<sup>−5</sup>", "none-seen", "> 3.2"]
    assert [*map(report.typeset, texts)] == set_as
    errors = ["10<sup>−3</sup>", "2.8 × 10<sup>−4</sup>"]
    assert [*map(report.relative_error, (1e-3, 2.8e-4))] == errors


def test_the_events_of_the_agreement_are_those_of_dynamics(tmp_path):
    copy_tables(tmp_path, {"paper": "paper"})
    counts = {"dynamics": 7, "monte_carlo": 100}
    write_rows(tmp_path / "paper", CostTable, ("stage", "events"), counts.items(), radius=0.1)
    found = report.agreement(tmp_path, {"name": "paper"})
    kept = [row["z"] for row in CheckTable.read(EXPECTED / "paper" / "check.csv") if row["bound"]]
    assert (found["events"], found["largest"]) == (7, max(abs(z) for z in kept if z is not None))


def test_mean_times_are_those_of_their_table():
    scene = {"name": "paper", "width": 1.5, "height": 1.0, "effects": {}}
    by_radius = report.mean_times(EXPECTED, scene).items()
    shown = [(radius, *row) for radius, rows in by_radius for row in rows]
    rows = MeanTimesTable.read(EXPECTED / "paper" / "mean_times.csv")
    for (radius, event, value, error, exact, z), row in zip(shown, rows, strict=True):
        assert (radius, event.replace(" ", "_")) == (row["radius"], row["event"])
        if row["stderr"] is None:
            assert error == row["status"]
            continue
        # All end at the second digit of the error: half of it is at most a twentieth of the error.
        for text, number in ((value, row["estimate"]), (error, row["stderr"])):
            assert abs(float(text) - number) <= 0.0501 * row["stderr"]
        if row["exact"] is not None:
            assert abs(float(exact) - row["exact"]) <= 0.0501 * row["stderr"]
            assert abs(float(z) - row["z"]) <= 0.00501
    assert report.mean_times(EXPECTED, scene | {"name": "absent"}) == {}


def picture(uri):
    """Return the image that an address holds."""
    return Image.open(BytesIO(b64decode(uri.partition(",")[2])))


def test_pictures_are_in_their_sections_and_an_animation_stands_still_at_the_longest(tmp_path):
    """A figure of no key is small, in the section of all scenes if it is of none."""
    frames = [Image.new("RGB", (60, 40), (12 * x, 0, 0)) for x in range(20)]
    path = PurePosixPath("one/figures/animation.png")
    (tmp_path / path).parent.mkdir(parents=True)
    times = [1500 if k == 12 else 50 for k in range(20)]
    frames[0].save(tmp_path / path, save_all=True, append_images=frames[1:], duration=times, loop=0)
    (tmp_path / "figures").mkdir()
    Image.new("RGB", (641, 1000)).save(tmp_path / "figures/thresholds.png")
    scene = {"name": "one", "box": "1.5 × 1", "width": 1.5, "height": 1.0, "effects": {}}
    files = [str(path), "figures/thresholds.png", "one/volume.csv", "thresholds.csv"]
    one, of_all = report.contents(tmp_path, files, [scene], "run")["sections"]
    tables = [[str(path) for path in part["tables"]] for part in (one, of_all)]
    assert tables == [["one/volume.csv"], ["thresholds.csv"]]
    assert picture(one["animation"]["still"]).convert("RGB").tobytes() == frames[12].tobytes()
    named = "The box is 1.5 × 1 (scene “one” of the configuration)."
    (small,) = of_all["thumbnails"]
    assert (named in one["animation"]["caption"], named in small["caption"]) == (True, False)
    assert (small["width"], picture(small["uri"]).size) == (641 // 2, (320, 499))


def test_boxes_are_described_with_their_effects_and_events():
    scenes = [
        {"name": "plain", "box": "1.2 × 0.8", "effects": {}},
        {
            "name": "three", "box": "2 × 1", "effects": {"discs": 3, "periodic": "x"},
            "detected": ["disc_collision", "top_wall"],
        },
        {"name": "micro", "box": "3.25e-06 × 1.25e-05", "effects": {"mass_ratio": 0.5}},
    ]  # fmt: skip
    scenes = [scene | {"width": 2.0, "height": 1.0} for scene in scenes]
    files = [f"{scene['name']}/mean_times.csv" for scene in scenes]
    template = (REPOSITORY / "workflow/report/front.html").read_text(encoding="utf-8")
    text = report.page(template, report.contents(REPOSITORY, files, scenes, "twodiscs run my.yaml"))
    for scene in scenes:
        assert f"<h2>Box {scene['box']} (scene “{scene['name']}”)</h2>" in text
    plain, three, unequal = text.split("Physics: ")[1:]
    assert plain.startswith("two discs, no further effects. Counted:\nnothing.")
    assert three.startswith("3 discs, periodic x. Counted:\ndisc collision, top wall.")
    assert unequal.startswith("two discs, mass ratio 0.5.")


def test_the_section_on_accuracy_has_the_worst_error_and_the_time_of_others(tmp_path):
    scene = {"name": "a", "event_budget": None}
    assert report.accuracies(tmp_path, scene) == []
    errors = {"any_wall": 0.001, "top_wall": 0.02, "right_wall": None}
    same = {"radius": 0.2, "estimate": 2.0, "target": 1e-2}
    write_rows(tmp_path / "a", MeanTimesTable, ("event", "stderr"), errors.items(), **same)
    assert report.accuracies(tmp_path, scene) == []
    # The job took three seconds, most of them to compile; at the speed of the other it takes one.
    jobs = (0.2, 10**7, 3.0), (0.3, 10**8, 10.0)
    write_rows(tmp_path / "a", CostTable, ("radius", "events", "seconds"), jobs, stage="dynamics")
    (row,) = report.accuracies(tmp_path, scene)
    assert (row["radius"], row["quantity"], row["asked"]) == (0.2, "top_wall_time", 1e-2)
    assert row["reached"] == pytest.approx(1e-2)
    assert (row["seconds"], row["times"]) == ("3 s", ["1.7 min", "2.8 h", "12 d", "3.2 years"])
    assert report.TABULATED_ERRORS == (1e-3, 1e-4, 1e-5, 1e-6)
