"""The animation: it shows the trajectory, stops at the hop, and is the same bytes every time."""

import os
import subprocess
import sys

import numpy as np
import pytest
from figure_cases import unclear
from matplotlib.patches import Circle
from PIL import Image

from twodiscs.comparison.tables.trajectory import Trajectory
from twodiscs.figures.kit import drawing, style
from twodiscs.figures.motion import animation
from twodiscs.figures.motion.animation import AFTER, BEFORE, FRAME, HOP, LAST, MARKED
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
    for seed in range(1, 4):
        rows = Trajectory.rows(box, 0.15, seed)[:40]
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
    times, hop, centre = animation.moments(at(*common, *rare), 1.0)
    assert (hop, centre) == ("horizontal_hop", 400.0)
    assert times.tolist() == list(range(400 - BEFORE, 400 + AFTER + 1))


def test_hops_that_are_never_alone_and_trajectories_that_are_too_short():
    times, hop, centre = animation.moments(at((3.0, "vertical_hop"), (4.0, "vertical_hop")), 1.0)
    assert (hop, centre) == ("vertical_hop", 3.0)
    assert times.tolist() == list(range(3 + AFTER + 1))
    times, hop, centre = animation.moments(at((3.0, "disc_collision"), end=9.5), 1.0)
    assert (hop, centre) == (None, 0.0)
    assert times.tolist() == list(range(10))
    with pytest.raises(ValueError, match=r"trajectory must last two frames, a time of 1, not 0\.5"):
        animation.moments(at(end=0.5), 1.0)
    with pytest.raises(ValueError, match="trajectory must have rows, not none"):
        animation.animate(BOX, RADIUS, [], ["a.gif"])
    with pytest.raises(ValueError, match=r"path must be a \.gif or \.png file, not 'a\.mp4'"):
        animation.animate(BOX, RADIUS, [], ["a.gif", "a.mp4"])
    with pytest.raises(ValueError, match="radius must be a positive"):
        animation.animate(BOX, -1, at(end=9.5), ["a.gif"])


# What they show ----------------------------------------------------------------------------------


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
    """Inside the rim of a disc is its colour, but for traces and numbers, and outside it is not."""
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
from twodiscs.comparison.tables.trajectory import Trajectory
from twodiscs.figures.kit import style
from twodiscs.figures.motion.animation import animate
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
    """Of four discs: all in the box, an image of each a period away, no trace across the box."""
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
