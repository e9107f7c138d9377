"""The animation: discs are where the trajectory has them, and the picture stops at a lone hop."""

import json
import re
import sys
from base64 import b64decode
from dataclasses import replace
from io import BytesIO
from itertools import chain

import numpy as np
import pytest
from effect_scenes import SCENES
from figure_cases import EFFECTS, unclear
from matplotlib.figure import Figure
from PIL import Image, ImageSequence

import twodiscs as td
from twodiscs.analysis.tables import TrajectoryTable
from twodiscs.figures import animation, style

BOX, RADIUS = td.Box(1.5, 1.0), 0.24

#: Frames on either side of a hop in a file: a few more than those with its sign.
FEW = animation.MARKED_FRAMES + 4


@pytest.fixture(scope="module")
def rows():
    """Rows of trajectory.csv with hops of both kinds."""
    return TrajectoryTable.rows(BOX, RADIUS, 1908)


def unpacked(path):
    """Return [(milliseconds, pixels)] of the frames of a file that repeats for ever."""
    with Image.open(path) as image:
        assert image.info["loop"] == 0
        return [
            (one.info["duration"], np.asarray(one.convert("RGB"), int))
            for one in ImageSequence.Iterator(image)
        ]


def at(*events, end=1000.0):
    """Return rows of a trajectory from 0 to ``end`` with ``events`` at given times."""
    rows = [(0.0, "start"), *sorted(events), (end, "end")]
    return [{"time": time, "event": event} for time, event in rows]


def drawn(box, radius, rows):
    """Return the motion of a trajectory, the circles and the other moving parts of its picture."""
    motion = animation.MovingDiscs(box, radius, rows)
    with style.context():
        return motion, *animation.draw(motion)[1:]


def show(time, circles, others):
    """Move all parts to their places at a ``time``."""
    for _, move in [*others.values(), *chain(*circles.values())]:
        move(time)


# Which moments are shown -------------------------------------------------------------------------


COMMON = [(float(t), "vertical_hop") for t in range(5, 900, 7)]
RARE = [(t, "horizontal_hop") for t in (120.0, 121.0, 400.0, 700.0)]
TWO = [(3.0, "vertical_hop"), (4.0, "vertical_hop")]


@pytest.mark.parametrize(
    ("rows", "discs", "hop", "centre", "frames"),
    [
        # The first lone hop of the rarer kind.
        (at(*COMMON, *RARE), 2, "horizontal_hop", 400.0, range(290, 461)),
        # Many discs are shown from the start, for as long as a hop of two.
        (at((300.0, "vertical_hop")), 3, None, 0.0, range(171)),
        # Hops that are never alone, and a trajectory that is too short.
        (at(*TWO), 2, "vertical_hop", 3.0, range(4 + animation.FRAMES_AFTER)),
        (at((3.0, "disc_collision"), end=9.5), 2, None, 0.0, range(10)),
        (at((0.5, "disc_collision"), end=1.0), 2, None, 0.0, range(2)),
    ],
)  # fmt: skip
def test_the_first_lone_hop_of_the_rarer_kind_is_shown(rows, discs, hop, centre, frames):
    times, *found = animation.frame_times(rows, 1.0, discs=discs)
    assert found == [hop, centre]
    assert times.tolist() == [*frames]


# Content of the frames ---------------------------------------------------------------------------


def test_the_hop_is_a_frame_and_the_only_one_that_stops(rows, tmp_path, monkeypatch):
    """A GIF, a PNG and a page show the same, ``FEW`` frames on either side of the hop."""
    monkeypatch.setattr(animation, "FRAMES_BEFORE", FEW)
    monkeypatch.setattr(animation, "FRAMES_AFTER", FEW)
    paths = [tmp_path / f"a.{kind}" for kind in ("gif", "PNG", "html")]
    with style.context():
        animation.animate(BOX, RADIUS, rows, paths)
    motion = animation.MovingDiscs(BOX, RADIUS, rows)
    frames, png = map(unpacked, paths[:2])
    text = paths[2].read_text(encoding="utf-8")
    assert "http" not in text
    assert f'max="{len(motion.frames) - 1}"' in text
    pictures, times = re.search(r"pictures = (\[.*\]), milliseconds = (\[.*\]);", text).groups()
    shown = [Image.open(BytesIO(b64decode(one))).convert("RGB") for one in json.loads(pictures)]
    page = [*zip(json.loads(times), (np.asarray(image, int) for image in shown), strict=True)]
    for others in (png, page):
        for ours, theirs in zip(frames, others, strict=True):
            assert ours[0] == theirs[0]
            np.testing.assert_array_equal(ours[1], theirs[1])

    assert motion.hop == "horizontal_hop"
    assert motion.centre in [row["time"] for row in rows if row["event"] == motion.hop]
    before, now, after = motion.separation([motion.frames[0], motion.centre, motion.frames[-1]])
    assert abs(now) < 1e-12
    assert before * after < 0
    shown = [milliseconds for milliseconds, _ in frames]
    assert shown == [*([50] * FEW), 1500, *([50] * (FEW - 1)), 1000]  # milliseconds
    orange = np.array([0xE6, 0x9F, 0x00])
    marked = [k for k, (_, pixels) in enumerate(frames) if (pixels == orange).all(2).any()]
    assert marked == list(range(FEW, FEW + animation.MARKED_FRAMES))


#: Paths that are straight, that bend and go on beyond the box, and of discs that turn.
DRAWN = [td.Scene(1.5, 1.0, 0.2), SCENES["combination"], td.Scene(1.5, 1.0, 0.2, **EFFECTS)]


@pytest.mark.parametrize("scene", DRAWN, ids=str)
def test_discs_are_where_the_trajectory_has_them(scene):
    """On a periodic axis they go on beyond the box; what is drawn is folded into it.

    Marks turn by the spins, whose times are those between two rows. The strip has the separation
    until now and its zeros, the hops.
    """
    path = td.trajectory(scene, duration=60)
    motion, circles, others = drawn(scene.box, scene.radius, path.to_dict("records"))
    times = np.linspace(0, 60, 50)
    states = path.states_at(times)
    for disc in (1, 2):
        due = np.column_stack([states[f"x{disc}"], states[f"y{disc}"]])
        places = motion.places(disc, times)
        np.testing.assert_allclose(places, due, atol=1e-12)
        assert (np.abs(motion.fold(places)) <= [0.7501, 0.5001]).all()
    hops = path["time"][(path["event"] == motion.hop) & (path["time"] >= motion.frames[0])]
    zero, whole, *_ = circles[1][0][0].figure.axes[1].lines
    assert set(zero.get_ydata()) == {0}
    apart = np.diff(whole.get_xdata())
    if scene.field or scene.periodic:
        assert apart.max() < 1.01 * animation.TRACE_FRAMES / 100 * motion.step
    else:
        assert apart.size == path["time"].between(motion.frames[0], motion.frames[-1]).sum() + 1
    for time in (*motion.frames[::20], motion.frames[-1]):
        show(time, circles, others)
        for line, end in ((others["past"][0], time), (whole, motion.frames[-1])):
            past, apart = line.get_data()
            due = [now[f"{motion.axis}2"] - now[f"{motion.axis}1"] for now in path.states_at(past)]
            np.testing.assert_allclose(apart, due, atol=1e-12)
            assert (past[0], past[-1]) == (motion.frames[0], end)
        assert others["present"][0].get_data() == ([time], others["past"][0].get_ydata()[-1])
        assert [*others["hops"][0].get_xdata()] == [*hops[hops <= time]]
        for disc, radius in enumerate(scene.radii, 1):
            (due,) = motion.fold(motion.places(disc, [time]))
            assert circles[disc][0][0].center == pytest.approx(tuple(due))
            assert (f"mark {disc}" in others) == bool(scene.moment_of_inertia)
            if scene.moment_of_inertia:
                (x1, x2), (y1, y2) = others[f"mark {disc}"][0].get_data()
                after = np.append(path["time"].to_numpy()[1:], np.inf)
                elapsed = np.clip(np.minimum(after, time) - path["time"], 0, None)
                angle = (path[f"s{disc}"] * elapsed).sum() / radius
                assert np.cos(np.arctan2(y2 - y1, x2 - x1) - angle) == pytest.approx(1, abs=1e-9)
    assert (np.abs(path["x1"] - path["x2"]).max() > 1.5) == ("x" in scene.periodic)


@pytest.mark.parametrize(
    ("box", "radius"),
    [
        (td.Box(1.0, 4.0, **EFFECTS), 0.125),
        (td.Box(3.0, 1.0, **EFFECTS), 0.125),
        (td.Box(12.0, 1.0), 0.2),
        (td.Box(50.0, 1.0), 0.2),
        (td.Box(1e-5, 3e-6), 6e-7),
        (td.Box(1.5e5, 1e5), 2.4e4),
    ],
    ids=str,
)
def test_headings_numbers_and_the_sign_of_a_hop_stand_clear(box, radius):
    """Discs are where they are: their numbers may meet each other and a trace."""
    motion, circles, others = drawn(box, radius, TrajectoryTable.rows(box, radius, 1908))
    for time in [*motion.frames[::80], motion.centre]:
        show(time, circles, others)
        faults = unclear(others["sign"][0].figure)
        faults = [one for one in faults if one[0] not in ("line", "unnamed")]
        assert [pair for _, *pair in faults if {*pair} != {"1", "2"}] == []


def test_the_ends_of_a_periodic_axis_are_dotted():
    axes = Figure().add_axes((0, 0, 1, 1))
    animation.draw_walls(axes, td.Scene(1.5, 1.0, 0.2, periodic="x"))
    upright = {line.is_dashed(): np.ptp(line.get_xdata()) == 0 for line in axes.lines}
    assert upright == {True: True, False: False}


def test_what_leaves_a_ring_comes_in_at_the_other_end():
    """Four discs: all in the box, an image of each a period away, no trace across the box."""
    box = td.Box(1.5, 1.0, periodic="x", discs=4)
    motion, circles, others = drawn(box, 0.15, TrajectoryTable.rows(box, 0.15, 1))
    beyond = 0
    for time in motion.frames[::4]:
        show(time, circles, others)
        for disc, ((circle, _), (image, _)) in circles.items():
            x, y = circle.center
            assert abs(x) <= 0.75
            assert abs(y) <= 0.35 + 1e-12
            assert image.center == pytest.approx((x - np.copysign(1.5, x), y))
            beyond += abs(motion.places(disc, [time])[0, 0]) > 0.75
            for (x1, _), (x2, _) in others[f"trace {disc}"][0].get_segments():
                assert abs(x1 - x2) < 0.5
    assert beyond
    (strip,) = (axes for axes in circle.figure.axes if axes.get_ylabel().startswith("$x$"))
    assert strip.get_xlim() == (motion.frames[0], motion.frames[-1])
    low, high = strip.get_ylim()
    paths = [line.get_ydata() for line in strip.lines if len(line.get_ydata()) > 2]
    assert [line.get_xdata()[-1] for line in strip.lines[:4]] == [motion.frames[-1]] * 4
    assert len(paths) == 4
    assert all(low <= path.min() <= path.max() <= high for path in paths)
    walled = td.Box(1.5, 1.0, discs=4)
    circles = drawn(walled, 0.15, TrajectoryTable.rows(walled, 0.15, 1))[1]
    assert circles[1][0][0].figure.axes[1].get_ylim() == (-0.75, 0.75)


def test_no_trace_goes_across_the_shorter_side():
    box, beyond = td.Box(3.0, 1.0, periodic="y"), 0
    motion, circles, others = drawn(box, 0.1, TrajectoryTable.rows(box, 0.1, 1))
    for time in motion.frames[::8]:
        show(time, circles, others)
        for disc in (1, 2):
            beyond += abs(motion.places(disc, [time])[0, 1]) > 0.5
            for (_, y1), (_, y2) in others[f"trace {disc}"][0].get_segments():
                assert abs(y1 - y2) < 0.5
    assert beyond


# Effects and other files --------------------------------------------------------------------------


def test_the_nearer_ball_is_in_front():
    """Heights are folded into the box, as all positions on a periodic axis."""
    path = td.trajectory(replace(SCENES["combination"], periodic="xz"), seed=2)
    assert np.abs(path[["z1", "z2"]]).max(axis=None) > 0.45
    box, radius = path.scene.box, path.scene.radius
    motion, circles, others = drawn(box, radius, path.to_dict("records"))
    nearer = set()
    for time in motion.frames:
        (state,) = path.states_at(time)
        z1, z2 = (state[name] - 0.9 * np.round(state[name] / 0.9) for name in ("z1", "z2"))
        parts = animation.moving_parts(motion, circles, others, time)
        first, second = (parts.index(circles[disc][0]) for disc in (1, 2))
        assert (first > second) == (z1 > z2)
        assert len(parts) == len(others) + sum(map(len, circles.values()))
        nearer.add(first > second)
    assert nearer == {True, False}


#: A program in place of ffmpeg: it keeps its arguments and its input.
RECORDER = """#!{python}
import json, sys
open(sys.argv[-1], "wb").write(sys.stdin.buffer.read())
json.dump(sys.argv, open(sys.argv[0] + ".json", "w"))
if {status}:
    print("no encoder", file=sys.stderr)
sys.exit({status})
"""


def test_an_mp4_is_written_by_ffmpeg(rows, tmp_path, monkeypatch):
    path, folder = tmp_path / "a.mp4", tmp_path / "bin"
    monkeypatch.setenv("PATH", str(folder))
    with monkeypatch.context() as patch:
        patch.setattr(animation, "MovingDiscs", None)  # before anything is drawn
        with pytest.raises(td.InputError, match="because the program ffmpeg is missing"):
            animation.animate(BOX, RADIUS, rows, [path])
    folder.mkdir()
    program = folder / "ffmpeg"
    program.write_text(RECORDER.format(python=sys.executable, status=0))
    program.chmod(0o755)
    with style.context():
        animation.animate(BOX, RADIUS, rows[:3], [tmp_path / "a.gif", path])
    frames = unpacked(tmp_path / "a.gif")
    words = json.loads((folder / "ffmpeg.json").read_text())
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
    assert path.stat().st_size == pixels.size
    with pytest.raises(td.InputError, match="path must be a file to write"):
        animation.animate(BOX, RADIUS, rows, [tmp_path / "absent" / "a.mp4"])
    # ffmpeg reads file:b.mp4 as the file b.mp4, but not behind a folder.
    program.write_text(RECORDER.format(python=sys.executable, status=0))
    monkeypatch.chdir(tmp_path)
    animation.write_mp4("file:b.mp4", [image], [50])
    assert json.loads((folder / "ffmpeg.json").read_text())[-1].startswith(f"{tmp_path}/")
    assert (tmp_path / "file:b.mp4").stat().st_size == 18
