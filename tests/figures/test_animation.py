"""The animation: it shows the trajectory, stops at the hop, and is the same bytes every time."""

import json
import os
import re
import subprocess
import sys
from base64 import b64decode
from io import BytesIO

import numpy as np
import pytest
from figure_cases import unclear
from matplotlib.patches import Circle
from PIL import Image

import twodiscs as td
from twodiscs.comparison.scene_tables import Trajectory
from twodiscs.figures import animation, drawing, style
from twodiscs.figures.animation import AFTER, BEFORE, FRAME, HOP, LAST, MARKED
from twodiscs.model.box import Box

BOX, RADIUS = Box(1.5, 1.0), 0.24


@pytest.fixture(scope="module")
def rows():
    """Rows of trajectory.csv with hops of both kinds."""
    return Trajectory.rows(BOX, RADIUS, 1908)


@pytest.fixture(scope="module")
def stage(rows):
    with style.context():
        return animation.Stage(BOX, RADIUS, rows)


@pytest.fixture(scope="module")
def frames(rows, tmp_path_factory):
    """Return (path, [(milliseconds, pixels)]) of a GIF that shows the same as the PNG beside it."""
    folder = tmp_path_factory.mktemp("animation")
    paths = [folder / "a.gif", folder / "a.png"]
    with style.context():
        animation.animate(BOX, RADIUS, rows, paths)
    gif, png = map(unpacked, paths)
    for ours, theirs in zip(gif, png, strict=True):
        assert ours[0] == theirs[0]
        np.testing.assert_array_equal(ours[1], theirs[1])
    return paths[0], gif


@pytest.mark.parametrize("discs", [3, 8])
def test_every_disc_keeps_its_colour(discs, tmp_path):
    box = Box(0.75 * discs, 1.0, discs=discs)
    rows = Trajectory.rows(box, 0.15, 1)[:40]
    with style.context():
        animation.animate(box, 0.15, rows, [tmp_path / "a.png"])
        stage = animation.StageOfMany(box, 0.15, rows)
    fills = {
        tuple(np.multiply(artist.get_facecolor(), 255).astype(int))
        for artist in stage.moving.values()
        if isinstance(artist, Circle) and artist.get_fill()
    }
    assert len(fills) == discs
    with Image.open(tmp_path / "a.png") as image:
        shown = [colour for _, colour in image.convert("RGB").getcolors(1 << 24)]
    for fill in fills:
        assert any(np.abs(np.subtract(fill[:3], c)).sum() < 9 for c in shown), fill


def unpacked(path):
    """Return [(milliseconds, pixels)] of the frames of a file that repeats for ever."""
    found = []
    with Image.open(path) as image:
        assert image.info["loop"] == 0
        for k in range(image.n_frames):
            image.seek(k)
            found.append((image.info["duration"], np.asarray(image.convert("RGB"), int)))
    return found


def at(*events, end=1000.0):
    """Return rows of a trajectory from 0 to ``end`` with ``events`` at given times."""
    rows = [(0.0, "start"), *sorted(events), (end, "end")]
    return [{"time": time, "event": event} for time, event in rows]


# Which moments are shown -------------------------------------------------------------------------


def test_the_first_lone_hop_of_the_rarer_kind_is_shown():
    common = [(float(t), "vertical_hop") for t in range(5, 900, 7)]
    rare = [(t, "horizontal_hop") for t in (120.0, 121.0, 400.0, 700.0)]
    times, hop, centre = animation.frame_times(at(*common, *rare), 1.0)
    assert (hop, centre) == ("horizontal_hop", 400.0)
    assert times.tolist() == list(range(400 - BEFORE, 400 + AFTER + 1))


def test_many_discs_are_shown_from_the_start_for_as_long_as_a_hop_of_two():
    rows = at((300.0, "vertical_hop"), (400.0, "disc_collision"))
    times, hop, start = animation.frame_times(rows, 1.0, discs=3)
    assert (hop, start) == (None, 0.0)
    assert times.tolist() == list(range(BEFORE + AFTER + 1))


def test_hops_that_are_never_alone_and_trajectories_that_are_too_short():
    times, hop, centre = animation.frame_times(
        at((3.0, "vertical_hop"), (4.0, "vertical_hop")), 1.0
    )
    assert (hop, centre) == ("vertical_hop", 3.0)
    assert times.tolist() == list(range(3 + AFTER + 1))
    times, hop, centre = animation.frame_times(at((3.0, "disc_collision"), end=9.5), 1.0)
    assert (hop, centre) == (None, 0.0)
    assert times.tolist() == list(range(10))
    with pytest.raises(ValueError, match=r"trajectory must last two frames, a time of 1, not 0\.5"):
        animation.frame_times(at(end=0.5), 1.0)
    with pytest.raises(ValueError, match="trajectory must have rows, but is empty"):
        animation.animate(BOX, RADIUS, [], ["a.gif"])
    with pytest.raises(ValueError, match=r"path must be a \.gif, .*\.mp4 file, not 'a\.avi'"):
        animation.animate(BOX, RADIUS, [], ["a.gif", "a.avi"])
    with pytest.raises(ValueError, match="radius must be a positive"):
        animation.animate(BOX, -1, at(end=9.5), ["a.gif"])


# Content of the frames ---------------------------------------------------------------------------


def test_discs_stay_in_the_box_and_apart(stage):
    first, second = (stage.places(disc, stage.times) for disc in (1, 2))
    edge = np.array([BOX.width, BOX.height]) / 2 - RADIUS
    assert (np.abs([first, second]) <= edge + 1e-12).all()
    assert np.hypot(*(first - second).T).min() >= 2 * RADIUS - 1e-12


def test_the_hop_is_a_frame_and_the_only_one_that_stops(stage, rows, frames):
    assert stage.hop == "horizontal_hop"
    assert stage.centre in [row["time"] for row in rows if row["event"] == stage.hop]
    assert abs(stage.apart([stage.centre])[0]) < 1e-12
    assert stage.apart([stage.times[0]])[0] * stage.apart([stage.times[-1]])[0] < 0
    shown = [milliseconds for milliseconds, _ in frames[1]]
    assert shown == [*([FRAME] * BEFORE), HOP, *([FRAME] * (AFTER - 1)), LAST]
    orange = np.array([0xE6, 0x9F, 0x00])
    marked = [k for k, (_, pixels) in enumerate(frames[1]) if (pixels == orange).all(2).any()]
    assert marked == list(range(BEFORE, BEFORE + MARKED))


def test_pixels_are_those_of_the_discs(stage, frames):
    """The colour of a disc is inside its rim, except for traces and numbers, and not outside."""
    stage.box.figure.canvas.draw()
    up = frames[1][0][1].shape[0]
    angles = np.linspace(0, 2 * np.pi, 36, endpoint=False)
    around = np.column_stack([np.cos(angles), np.sin(angles)]) * RADIUS
    for k in (0, 40, BEFORE, BEFORE + 30):
        for disc, (face, _) in enumerate(drawing.DISCS, 1):
            ((x, y),) = stage.places(disc, stage.times[k : k + 1])
            colour = np.array([int(face[i : i + 2], 16) for i in (1, 3, 5)])
            for share, least, most in ((0.9, 0.75, 1), (1.1, 0, 0.1)):
                across, high = stage.box.transData.transform(share * around + (x, y)).T.astype(int)
                found = frames[1][k][1][up - 1 - high, across]
                alike = (np.abs(found - colour).sum(axis=1) < 8).mean()
                assert least <= alike <= most, (k, disc, share)


# Files -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("box", [Box(1.0, 1.5), Box(40.0, 1.0)], ids=str)
def test_other_boxes(box, tmp_path):
    found = Trajectory.rows(box, RADIUS, 3)
    with style.context():
        animation.animate(box, RADIUS, found, [tmp_path / "a.gif"])
    assert (tmp_path / "a.gif").stat().st_size < 600_000


ANIMATE = f"""
import sys
from base64 import b64decode
from io import BytesIO
import twodiscs as td
from twodiscs.comparison.scene_tables import Trajectory
from twodiscs.figures import style
from twodiscs.figures.animation import animate
from twodiscs.model.box import Box
with style.context():
    animate({BOX!r}, {RADIUS}, Trajectory.read(sys.argv[1]), sys.argv[2:])
"""


@pytest.mark.slow
def test_same_bytes_whatever_the_machine_is_set_to(rows, frames, tmp_path):
    table, style_file = tmp_path / "trajectory.csv", tmp_path / "matplotlibrc"
    Trajectory.write(table, rows)
    style_file.write_text("font.size: 20\nlines.linewidth: 7\n")
    outputs = [tmp_path / "b.gif", tmp_path / "b.png"]
    run = subprocess.run(
        [sys.executable, "-c", ANIMATE, table, *outputs],
        env=os.environ | {"PYTHONHASHSEED": "2", "MATPLOTLIBRC": str(style_file)},
        capture_output=True,
        text=True,
    )
    assert (run.returncode, run.stdout + run.stderr) == (0, "")
    for path in outputs:
        assert path.read_bytes() == frames[0].with_name(f"a{path.suffix}").read_bytes()
        assert path.stat().st_size < 600_000


@pytest.mark.parametrize(
    "effects", [{"periodic": "x"}, {"periodic": "x", "mass_ratio": 3.0}, {"field": 1.5}]
)
def test_paths_with_effects_are_those_of_the_dynamics(effects):
    """Between events discs fall with the field; on a periodic axis nothing jumps."""
    box = Box(1.5, 1.0, effects)
    rows = Trajectory.rows(box, 0.1, 1)
    with style.context():
        stage = animation.Stage(box, 0.1, rows)
    times = np.linspace(stage.times[0], stage.times[-1], 20001)
    for disc in (1, 2):
        places = stage.places(disc, times)
        # No disc is faster than if it had all of the energy.
        speed = 1.0001 * (1 + 2 * effects.get("field", 0)) ** 0.5
        assert np.abs(np.diff(places, axis=0)).max() < speed * (times[1] - times[0])
        if "field" in effects:
            bent = np.diff(places[:, 1], 2) / (times[1] - times[0]) ** 2
            assert np.median(bent) == pytest.approx(-1.5, rel=1e-3)
        inside = stage.folded(places)
        assert (np.abs(inside).max(axis=0) < [0.7501, 0.5001]).all()
    stage.show(stage.centre)


def test_paths_end_where_they_are_asked_to_whatever_the_width_of_the_box():
    """Points between rows are a multiple of a float apart, which may not add up to the end."""
    box = Box(5.0, 1.0, {"field": 0.6})
    rows = Trajectory.rows(box, 0.2, 1)
    with style.context():
        stage = animation.Stage(box, 0.2, rows)
    for width in np.linspace(1, 10, 901):
        stage.trace = animation.TRACE * (width + 1) / animation.CROSSING
        for end in stage.times[::20]:
            start = max(end - stage.trace, stage.times[0])
            path = stage.path(start, end)
            assert (path[0], path[-1]) == (start, end)
            assert np.diff(path).max(initial=0) <= stage.trace / 99


def test_what_leaves_a_ring_comes_in_at_the_other_end():
    """Four discs: all in the box, an image of each a period away, no trace across the box."""
    box = Box(1.5, 1.0, {"periodic": "x"}, discs=4)
    rows = Trajectory.rows(box, 0.15, 1)
    with style.context():
        stage = animation.StageOfMany(box, 0.15, rows)
    beyond = 0
    for time in stage.times:
        stage.show(time)
        for disc in range(1, 5):
            x, y = stage.moving[f"disc {disc}"].center
            assert abs(x) <= 0.75
            assert abs(y) <= 0.35 + 1e-12
            image = x - np.copysign(1.5, x), y
            assert stage.moving[f"disc {disc} x"].center == pytest.approx(image)
            beyond += abs(stage.places(disc, [time])[0, 0]) > 0.75
            for (x1, _), (x2, _) in stage.moving[f"trace {disc}"].get_segments():
                assert abs(x1 - x2) < 0.5
    assert beyond


@pytest.mark.parametrize("sides", [(1.0, 2.0), (3.0, 1.0), (1.0, 4.0)], ids=str)
@pytest.mark.parametrize(
    "effects", [{}, {"radius_ratio": 0.625, "mass_ratio": 0.125, "moment_of_inertia": 0.375}]
)
def test_the_heading_of_many_effects_is_within_the_picture(sides, effects):
    """And clear of the sign of a hop."""
    box = Box(*sides, effects)
    rows = Trajectory.rows(box, 0.125, 1908)
    with style.context():
        stage = animation.Stage(box, 0.125, rows)
        stage.show(stage.centre)
        assert unclear(stage.figure) == []


@pytest.mark.parametrize("width", [12.0, 20.0, 50.0])
def test_the_numbers_of_small_discs_keep_clear_of_the_heading(width):
    box = Box(width, 1.0)
    rows = Trajectory.rows(box, 0.2, 1)
    with style.context():
        stage = animation.Stage(box, 0.2, rows)
        for time in stage.times[::10]:
            stage.show(time)
            # Discs are where they are: beside each other their numbers may meet.
            met = [pair for pair in unclear(stage.figure) if {*pair} != {"1", "2"}]
            assert met == []


# Effects and other files --------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("kind", "discs"), [(animation.Stage, 2), (animation.StageOfMany, 3)], ids=["two", "three"]
)
def test_marks_of_rough_discs_turn_with_them(kind, discs):
    """Angles against the times between rows; the sign by what walls do to spin and velocity."""
    scene = td.Scene(1.5, 1.0, 0.2, moment_of_inertia=0.5, discs=discs)
    path = td.trajectory(scene, 200, seed=1)
    for wall in ("wall_y1", "wall_y2"):
        disc = wall[-1]
        u, s, y = (path[f"{name}{disc}"].to_numpy() for name in "usy")
        (hits,) = np.nonzero((path["event"] == wall).to_numpy())
        # A disc that turns counterclockwise has the velocity u + s at its lowest point.
        surface = np.where(y[hits] < 0, s[hits], -s[hits])
        before = np.where(y[hits] < 0, s[hits - 1], -s[hits - 1])
        assert len(hits) > 20
        assert np.allclose(u[hits] + surface, -(u[hits - 1] + before), atol=1e-9)
    with style.context():
        stage = kind(Box.of(scene), 0.2, path.to_dict("records"))
    for time in stage.times[::20]:
        stage.show(time)
        for disc in range(1, discs + 1):
            (x1, x2), (y1, y2) = stage.moving[f"spin {disc}"].get_data()
            after = np.append(path["time"].to_numpy()[1:], np.inf)
            elapsed = np.clip(np.minimum(after, time) - path["time"], 0, None)
            angle = (path[f"s{disc}"] * elapsed).sum() / 0.2
            turned = np.arctan2(y2 - y1, x2 - x1) - angle
            assert np.cos(turned) == pytest.approx(1, abs=1e-9)


def test_the_nearer_ball_is_in_front():
    path = td.trajectory(td.Scene(1.5, 1.0, 0.2, depth=1.2), seed=2)
    with style.context():
        stage = animation.Stage(Box.of(path.scene), 0.2, path.to_dict("records"))
    nearer = set()
    for time in stage.times:
        (state,) = path.states_at(time)
        drawn = stage.artists(time)
        first, second = (drawn.index(stage.moving[f"disc {disc}"]) for disc in (1, 2))
        assert (first > second) == (state["z1"] > state["z2"])
        assert len(drawn) == len(stage.moving)
        nearer.add(first > second)
    assert nearer == {True, False}


def test_a_page_holds_the_frames_of_the_gif(rows, tmp_path):
    gif, page = tmp_path / "a.gif", tmp_path / "a.html"
    with style.context():
        animation.animate(BOX, RADIUS, rows[:3], [gif, page])
    text = page.read_text(encoding="utf-8")
    assert "http" not in text
    pictures, times = re.search(r"pictures = (\[.*\]), milliseconds = (\[.*\]);", text).groups()
    shown = [Image.open(BytesIO(b64decode(one))).convert("RGB") for one in json.loads(pictures)]
    frames = unpacked(gif)
    assert len(frames) > 3
    assert [milliseconds for milliseconds, _ in frames] == json.loads(times)
    for image, (_, pixels) in zip(shown, frames, strict=True):
        np.testing.assert_array_equal(np.asarray(image, int), pixels)


#: A program in place of ffmpeg: it keeps its arguments and its input.
RECORDER = """#!{python}
import json, sys
open(sys.argv[-1], "wb").write(sys.stdin.buffer.read())
json.dump(sys.argv, open(sys.argv[-1] + ".json", "w"))
if {status}:
    print("no encoder", file=sys.stderr)
sys.exit({status})
"""


def test_an_mp4_is_written_by_ffmpeg(rows, tmp_path, monkeypatch):
    path, folder = tmp_path / "a.mp4", tmp_path / "bin"
    monkeypatch.setenv("PATH", str(folder))
    with pytest.raises(td.InputError, match="because the program ffmpeg is missing"):
        animation.animate(BOX, RADIUS, rows, [path])
    folder.mkdir()
    program = folder / "ffmpeg"
    program.write_text(RECORDER.format(python=sys.executable, status=0))
    program.chmod(0o755)
    with style.context():
        animation.animate(BOX, RADIUS, rows[:3], [tmp_path / "a.gif", path])
    frames = unpacked(tmp_path / "a.gif")
    words = json.loads((tmp_path / "a.mp4.json").read_text())
    assert words[words.index("-framerate") + 1] == "20"
    width, height = map(int, words[words.index("-video_size") + 1].split("x"))
    pixels = np.fromfile(path, np.uint8).reshape(-1, height, width, 3).astype(int)
    assert len(pixels) * 50 == sum(milliseconds for milliseconds, _ in frames)
    # The GIF has 32 colours; the frames are the same pictures.
    assert np.abs(pixels[0] - frames[0][1]).mean() < 2
    image = Image.new("RGB", (3, 2))
    program.write_text(RECORDER.format(python=sys.executable, status=1))
    with pytest.raises(td.InputError, match=r"that ffmpeg can write, .*: no encoder"):
        animation.write_mp4(path, [image], [50])
    with pytest.raises(td.InputError, match="path must be a file to write"):
        animation.animate(BOX, RADIUS, rows, [tmp_path / "absent" / "a.mp4"])


def test_a_colon_in_the_name_of_an_mp4_begins_no_protocol(tmp_path, monkeypatch):
    """ffmpeg reads file:b.mp4 as the file b.mp4, which it would overwrite."""
    program = tmp_path / "bin" / "ffmpeg"
    program.parent.mkdir()
    program.write_text(RECORDER.format(python=sys.executable, status=0))
    program.chmod(0o755)
    monkeypatch.setenv("PATH", str(program.parent))
    monkeypatch.chdir(tmp_path)
    animation.write_mp4("file:b.mp4", [Image.new("RGB", (3, 2))], [50])
    assert json.loads((tmp_path / "file:b.mp4.json").read_text())[-1] == f"{tmp_path}/file:b.mp4"
