"""Animations of the discs: two discs stay on their sides for a long time, then pass each other.

An animation is a GIF, which every program shows, an animated PNG, which a report takes as an image,
a page with a slider, or an MP4. Between events the discs move freely, or fall with the same
acceleration, so straight lines or parabolas through the rows of trajectory.csv are the trajectory
itself. On a periodic axis a disc that leaves the box at one end enters at the other. Frames have
equal steps of time, and one of them shows the moment of the hop.
"""

import io
import json
import os
import shutil
import subprocess
from base64 import b64encode
from collections import Counter
from pathlib import Path
from string import Template

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgba
from matplotlib.patches import Circle
from PIL import Image

from twodiscs.figures import drawing, motion, panels
from twodiscs.figures.style import BLACK, BLUE, GREY, ORANGE, VERMILLION, new_figure
from twodiscs.model.checks import InputError, check_length, writing_to
from twodiscs.model.events import HOPS

#: Pixels per inch, and inches: width of the whole, tallest box, panel beneath and margins.
DPI = 100
ACROSS, TALLEST, STRIP = 3.8, 2.6, 0.62
LEFT, RIGHT, TOP, GAP, BOTTOM = 0.5, 0.12, 0.28, 0.1, 0.36

#: The size of letters in the heading over that in other figures; the width of a hop's sign, points.
LARGER, SIGN = 1.2, 17

#: Points: the distance of a disc's number to the left of its centre and above it, and half of its
#: height. It is lower if it would leave the box at the top, into the heading.
BESIDE, HALF = 9, 4

#: Frames before and after the hop, and frames in which a disc of speed 1 moves by the mean side of
#: the box.
BEFORE, AFTER, CROSSING = 110, 60, 50

#: The mark that turns with a rough disc begins at this fraction of its radius.
MARK = 0.65

#: Frames of a trace, and frames in which the hop stays marked.
TRACE, MARKED = 20, 20

#: Milliseconds of a frame, of the hop and of the last frame.
FRAME, HOP, LAST = 50, 1500, 1000

#: The number of colours, and their least difference, summed over red, green and blue.
COLOURS, APART = 32, 60


def frame_times(rows, step, discs=2):
    """Return (times of the frames, name of the hop or None, its time) for rows of trajectory.csv.

    The hop is of the rarest kind that occurs. It is the first one with no other of its kind in the
    time that is shown, or else the first of all. Frames are ``step`` apart, the hop is one of them,
    and all are within the trajectory; without any hop they show its start. For more than two
    ``discs`` hops do not matter, and there are as many frames as with one. Raises ``InputError`` if
    it does not last two frames.
    """
    start, end = rows[0]["time"], rows[-1]["time"]
    counts = Counter(row["event"] for row in rows if row["event"] in HOPS and discs == 2)
    hop = min(sorted(counts), key=counts.get, default=None)
    times = [start, *(row["time"] for row in rows if row["event"] == hop), end]
    isolated = [
        time
        for before, time, after in zip(times, times[1:], times[2:], strict=False)
        if time - before > BEFORE * step and after - time > AFTER * step
    ]
    centre = (isolated or times[1:])[0] if hop else start
    later = AFTER if discs == 2 else BEFORE + AFTER
    frames = centre + step * np.arange(-BEFORE if hop else 0, later + 1)
    frames = frames[(frames >= start) & (frames <= end)]
    if len(frames) < 2:
        lasts = end - start
        raise InputError(f"trajectory must last two frames, a time of {step:g}, not {lasts:g}")
    return frames, hop, centre


class Stage:
    """The panels and their moving parts, for one stretch of a trajectory."""

    #: Points: what the sign of the hop takes above the box.
    above = SIGN

    def __init__(self, box, radius, rows):
        self.scene = scene = box.scene(check_length("radius", radius))
        width, height = box.width, box.height
        step = (width + height) / CROSSING
        self.of = box
        places = [f"{axis}{disc}" for disc in range(1, box.discs + 1) for axis in "xy"]
        names = ("time", *places, "event")
        self.rows = {name: np.array([row[name] for row in rows]) for name in names}
        self.rows |= self._more(rows)
        self.sides = {"x": width, "y": height}
        self.times, self.hop, self.centre = frame_times(rows, step, box.discs)
        self.trace, self.marked = TRACE * step, MARKED * step
        self.axis = "y" if self.hop == "vertical_hop" else "x"

        inches, spare = drawing.scale(width, height, ACROSS - LEFT - RIGHT, TALLEST)
        beneath = BOTTOM + STRIP + GAP
        more = panels.of_radius(radius)
        up = 0 if panels.is_short(box, radius) else self.above
        lines = panels.heading(box, more)
        heading = LARGER * panels.LINE * (len(lines) - 1) + up / 72
        self.figure = new_figure(beneath + inches * height + TOP + heading, ACROSS)
        self.figure.set_dpi(DPI)
        self.spare = spare
        x, y = width / 2, height / 2
        self.box = drawing.add_axes(self.figure, LEFT + spare, beneath, inches, (-x, x, -y, y))
        if scene.periodic:
            self._draw_walls(x, y)
        else:
            drawing.rectangle(self.box, -x, x, -y, y, width=1.2)
        above = {"xycoords": "axes fraction", "ha": "left", "va": "bottom", "fontsize": 9}
        drawing.label(self.box, ",\n".join(lines), (0, 1), (-72 * spare, 5 + up), **above)
        self.strip = panels.add_panel(self.figure, BOTTOM, STRIP, LEFT, ACROSS - LEFT - RIGHT)
        times = self.path(self.times[0], self.times[-1])
        self.strip.set(xlim=(times[0], times[-1]), xlabel="time $t$")
        self._draw_strip(times)
        self.moving = self._moving((-x, x, -y, y))

    def _more(self, rows):
        """Return the angles of rough discs and the heights of balls, if the rows have them.

        A table of the workflow has no spins. Between two events spins are constant.
        """
        more, times = {}, self.rows["time"]
        for disc in range(1, self.of.discs + 1):
            if self.scene.moment_of_inertia is not None and rows[0].get(f"s{disc}") is not None:
                spins = np.array([row[f"s{disc}"] for row in rows]) / self.scene.radii[disc - 1]
                turned = np.cumsum(spins[:-1] * np.diff(times))
                more[f"angle{disc}"] = np.concatenate([[0.0], turned])
            if self.scene.depth is not None and rows[0].get(f"z{disc}") is not None:
                more[f"z{disc}"] = np.array([row[f"z{disc}"] for row in rows])
        return more

    def artists(self, time):
        """Return the artists at a ``time``, in the order of drawing: nearer balls come later."""
        if "z2" not in self.rows:
            return [*self.moving.values()]
        heights = [np.interp(time, self.rows["time"], self.rows[f"z{disc}"]) for disc in (1, 2)]
        if "z" in self.scene.periodic:
            heights = [z - self.scene.depth * np.round(z / self.scene.depth) for z in heights]
        nearer = "disc 1" if heights[0] > heights[1] else "disc 2"
        circles = [name for name in self.moving if name.startswith("disc ")]
        circles.sort(key=lambda name: name.startswith(nearer))
        others = [name for name in self.moving if name not in circles]
        return [self.moving[name] for name in (*circles, *others)]

    def _draw_walls(self, x, y):
        """Draw the walls; the ends of a periodic axis are dotted."""
        for axis, ends in (
            ("x", [([s * x, s * x], [-y, y]) for s in (-1, 1)]),
            ("y", [([-x, x], [s * y, s * y]) for s in (-1, 1)]),
        ):
            style = {"lw": 0.8, "ls": (0, (1, 2))} if axis in self.scene.periodic else {"lw": 1.2}
            for end in ends:
                self.box.plot(*end, color=BLACK, clip_on=False, **style)

    def places(self, disc, times):
        """Return the centres (n, 2) of a disc at ``times``."""
        rows = self.rows["time"]
        places = np.column_stack([np.interp(times, rows, self.rows[f"{q}{disc}"]) for q in "xy"])
        if self.scene.field:
            after = np.clip(np.searchsorted(rows, times), 1, len(rows) - 1)
            fall = (times - rows[after - 1]) * (rows[after] - times)
            places[:, 1] += self.scene.field / 2 * fall
        return places

    def folded(self, places):
        """Return ``places`` moved by whole periods into the box."""
        places = places.copy()
        for axis in self.scene.periodic:
            if axis in self.sides:
                column, side = "xy".index(axis), self.sides[axis]
                places[:, column] -= side * np.round(places[:, column] / side)
        return places

    def path(self, start, end):
        """Return the times of all rows between two moments, and these two.

        If paths are curved or folded, there are more times between them, for a smooth line.
        """
        times = self.rows["time"]
        path = np.array([start, *times[(times > start) & (times < end)], end])
        if self.scene.field or self.scene.periodic:
            between = np.arange(start, end, self.trace / 100)
            path = np.union1d(path, between[between < end])  # by rounding the last may be > end
        return path

    def apart(self, times):
        """Return the separation of the discs along the axis of the hop."""
        axis = "xy".index(self.axis)
        return self.folded(self.places(2, times) - self.places(1, times))[:, axis]

    def _draw_strip(self, times):
        """Draw the separation over the whole time, below the box."""
        apart = self.apart(times)
        most = 1.1 * np.abs(apart).max()
        self.strip.set(ylim=(-most, most), ylabel=f"${self.axis}_2-{self.axis}_1$")
        self.strip.axhline(0, color=GREY, lw=0.5)
        self.strip.plot(times, apart, color="#C8C8C8", lw=0.8)

    def _moving(self, extent):
        """Return {name: artist} of all that changes between frames, in the order of drawing."""
        x0, x1, y0, y1 = extent
        artists = {}
        for disc, (face, edge) in enumerate(drawing.DISCS, 1):
            artists |= self._circles(disc, self.scene.radii[disc - 1], face, edge)
        for disc, (_, edge) in enumerate(drawing.DISCS, 1):
            artists[f"trace {disc}"] = self.box.add_collection(LineCollection([], linewidths=1.3))
            artists |= self._mark(disc)
            (artists[f"centre {disc}"],) = self.box.plot([], [], "o", color=edge, ms=3.5, mew=0)
            artists[f"number {disc}"] = drawing.label(
                self.box, f"{disc}", (0, 0), (-BESIDE, BESIDE), color=edge, fontsize=11
            )
        middle = self.folded(self.places(1, np.array([self.centre])))[0]
        line = ([middle[0]] * 2, [y0, y1]) if self.axis == "x" else ([x0, x1], [middle[1]] * 2)
        (artists["line"],) = self.box.plot(*line, color=BLACK, lw=1.2, ls=(0, (4, 2)))
        artists["text"] = self.box.annotate(
            rf"hop:  ${self.axis}_1={self.axis}_2$", (1, 1), (72 * self.spare, 5), "axes fraction",
            "offset points", ha="right", va="bottom", fontsize=10,
            bbox={"boxstyle": "round,pad=0.2", "facecolor": ORANGE, "edgecolor": "none"},
        )  # fmt: skip
        (artists["past"],) = self.strip.plot([], [], color=BLUE, lw=0.9)
        (artists["hops"],) = self.strip.plot([], [], "o", color=VERMILLION, ms=6, mew=0)
        (artists["now"],) = self.strip.plot([], [], "o", color=BLACK, ms=3.5, mew=0)
        return artists

    def _circles(self, disc, radius, face, edge):
        """Return the artists of a disc: on a periodic axis there is one at both ends of the box."""
        images = [""] + [f" {axis}" for axis in self.scene.periodic if axis in self.sides]
        return {
            f"disc {disc}{image}": self.box.add_patch(
                Circle((0, 0), radius, fc=face, ec=edge, lw=1.2)
            )
            for image in images
        }

    def _mark(self, disc):
        """Return the mark of a rough disc, nothing for a smooth one."""
        if f"angle{disc}" not in self.rows:
            return {}
        return {f"spin {disc}": self.box.plot([], [], color=BLACK, lw=1.5)[0]}

    def _show_disc(self, disc, edge, past, time):
        """Move a disc, its mark, trace over the times ``past`` and number; return its place."""
        moving = self.moving
        places = self.folded(self.places(disc, past))
        segments = np.stack([places[:-1], places[1:]], axis=1)
        fading = np.array([to_rgba(edge, 1 - (time - t) / self.trace) for t in past[1:]])
        if self.scene.periodic:  # the jump from one end to the other is no part of the path
            near = np.abs(places[1:] - places[:-1]).max(axis=1) < min(self.sides.values()) / 2
            segments, fading = segments[near], fading[near]
        moving[f"trace {disc}"].set(segments=segments, colors=fading)
        moving[f"disc {disc}"].center = places[-1]
        for axis in filter(self.sides.get, self.scene.periodic):
            image = places[-1].copy()
            column = "xy".index(axis)
            image[column] -= np.copysign(self.sides[axis], image[column])
            moving[f"disc {disc} {axis}"].center = image
        moving[f"number {disc}"].xy = places[-1]
        if f"angle{disc}" in self.rows:
            angle = np.interp(time, self.rows["time"], self.rows[f"angle{disc}"])
            ends = self.scene.radii[disc - 1] * np.array([MARK, 1.0])
            x, y = places[-1]
            moving[f"spin {disc}"].set_data(x + ends * np.cos(angle), y + ends * np.sin(angle))
        return places[-1]

    def show(self, time):
        """Move everything to its position at ``time``."""
        moving = self.moving
        past = self.path(max(time - self.trace, self.times[0]), time)
        for disc, (_, edge) in enumerate(drawing.DISCS, 1):
            place = self._show_disc(disc, edge, past, time)
            moving[f"centre {disc}"].set_data(*place[:, None])
            above = (self.of.height / 2 - place[1]) / drawing.points(self.box)
            moving[f"number {disc}"].xyann = (-BESIDE, min(BESIDE, above - HALF))
        since = time - self.centre if self.hop else -1
        moving["line"].set_visible(since == 0)
        moving["text"].set_visible(0 <= since < self.marked)
        past = self.path(self.times[0], time)
        moving["past"].set_data(past, self.apart(past))
        moving["now"].set_data([time], self.apart(np.array([time])))
        kinds, times = self.rows["event"], self.rows["time"]
        hops = times[(kinds == self.hop) & (times >= self.times[0]) & (times <= time)]
        moving["hops"].set_data(hops, 0 * hops)


class StageOfMany(Stage):
    """The panels of more than two discs: all discs, and beneath their positions over time."""

    above = 0

    def __init__(self, box, radius, rows):
        self.colours = motion.colours(box, rows[0])
        super().__init__(box, radius, rows)

    def _draw_strip(self, times):
        axis, side = motion.along(self.of), max(self.of.width, self.of.height)
        self.strip.set_ylabel(f"${axis}$")
        if axis not in self.scene.periodic:  # on it positions go on beyond the box
            self.strip.set_ylim(-side / 2, side / 2)
        for disc, colour in enumerate(self.colours, 1):
            places = self.places(disc, times)[:, "xy".index(axis)]
            self.strip.plot(times, places, color=colour, lw=0.8)

    def _moving(self, extent):
        artists = {}
        for disc, colour in enumerate(self.colours, 1):
            face = tuple(0.45 * part + 0.55 for part in colour)
            artists |= self._circles(disc, self.scene.radius, face, colour)
        for disc in range(1, self.of.discs + 1):
            artists[f"trace {disc}"] = self.box.add_collection(LineCollection([], linewidths=1.3))
            artists |= self._mark(disc)
            artists[f"number {disc}"] = drawing.label(
                self.box, f"{disc}", (0, 0), (0, 0), ha="center", va="center", fontsize=9
            )
        (artists["now"],) = self.strip.plot([], [], color=BLACK, lw=1.0)
        return artists

    def show(self, time):
        """Move everything to where it is at ``time``."""
        past = self.path(max(time - self.trace, self.times[0]), time)
        for disc, colour in enumerate(self.colours, 1):
            self._show_disc(disc, colour, past, time)
        self.moving["now"].set_data([time, time], self.strip.get_ylim())


def animate(box, radius, rows, paths):
    """Write an animation of one hop, or of more than two discs, to every one of ``paths``.

    The paths are .gif, .png, .html or .mp4 files. ``box`` is the ``Box``, ``radius`` the radius of
    the discs, and ``rows`` are the rows of trajectory.csv, long enough for two frames. Raises
    ``InputError`` for anything else.
    """
    for path in paths:
        if not str(path).endswith((".gif", ".png", ".html", ".mp4")):
            raise InputError(f"path must be a .gif, .png, .html or .mp4 file, not {str(path)!r}")
        if str(path).endswith(".mp4"):
            ffmpeg()
        with writing_to(path):
            os.stat(Path(path).parent)  # raises for a folder that does not exist
    stage = (StageOfMany if box.family == "many" else Stage)(box, radius, rows)
    canvas = stage.figure.canvas
    for artist in stage.moving.values():
        artist.set_animated(True)
    canvas.draw()
    still = canvas.copy_from_bbox(stage.figure.bbox)

    def image(time):
        canvas.restore_region(still)
        stage.show(time)
        for artist in stage.artists(time):
            stage.figure.draw_artist(artist)
        return Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB")

    fills = {
        tuple(round(255 * part) for part in artist.get_facecolor()[:3])
        for artist in stage.moving.values()
        if isinstance(artist, Circle)
    }
    # The frame of the hop shows everything.
    palette = _palette(image(stage.centre), sorted(fills))
    true = [image(t) for t in stage.times]
    first, *others = images = [one.quantize(palette=palette, dither=0) for one in true]
    shown = [HOP if stage.hop and t == stage.centre else FRAME for t in stage.times]
    shown[-1] = LAST
    for path in paths:
        if str(path).endswith(".html"):
            write_page(path, images, shown, str(stage.scene))
        elif str(path).endswith(".mp4"):
            write_mp4(path, true, shown)
        else:
            with writing_to(path):
                first.save(path, save_all=True, append_images=others, duration=shown, loop=0)


def _palette(image, kept):
    """Return an image whose palette has the colours ``kept`` and the most frequent of ``image``.

    Two colours differ at least by ``APART``.
    """
    chosen = [*kept]
    for _, colour in sorted(image.getcolors(1 << 24), reverse=True):
        if all(sum(map(abs, np.subtract(colour, other))) >= APART for other in chosen):
            chosen.append(colour)
    palette = Image.new("P", (1, 1))
    palette.putpalette([channel for colour in chosen[:COLOURS] for channel in colour])
    return palette


# Files --------------------------------------------------------------------------------------------


#: The page: the frames are pictures in it, so it needs no network and no other file.
PAGE = Path(__file__).with_name("animation.html")


def write_page(path, images, durations, title):
    """Write ``images``, each shown for some milliseconds, as a page."""
    pictures = []
    for image in images:
        stream = io.BytesIO()
        image.save(stream, format="png", optimize=True)
        pictures.append(b64encode(stream.getvalue()).decode())
    text = Template(PAGE.read_text(encoding="utf-8")).substitute(
        title=title, last=len(pictures) - 1, pictures=json.dumps(pictures),
        milliseconds=json.dumps(durations),
    )  # fmt: skip
    with writing_to(path), open(path, "w", encoding="utf-8", newline="\n") as file:
        file.write(text)


def ffmpeg():
    """Return the path of ffmpeg; raise ``InputError`` if there is none."""
    program = shutil.which("ffmpeg")
    if program is None:
        raise InputError(
            "path must not be an .mp4 file, because the program ffmpeg is missing; .gif, .png and "
            ".html do not need it"
        )
    return program


def write_mp4(path, images, durations):
    """Write ``images`` of one size, each shown for some milliseconds, as an MP4.

    All frames last as long as the shortest; images with longer times are repeated.
    """
    program, step = ffmpeg(), min(durations)
    width, height = images[0].size
    command = [
        program, "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24",
        "-video_size", f"{width}x{height}", "-framerate", f"{1000 / step:g}", "-i", "-",
        # Every player knows this pixel format, whose encoders need even numbers of pixels.
        "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white", "-pix_fmt", "yuv420p",
        "-movflags", "+faststart",
        os.path.abspath(path),  # else a colon in the name begins a protocol
    ]  # fmt: skip
    frames = b"".join(
        image.convert("RGB").tobytes() * round(duration / step)
        for image, duration in zip(images, durations, strict=True)
    )
    done = subprocess.run(command, input=frames, capture_output=True, check=False)
    if done.returncode:
        said = done.stderr.decode(errors="replace").strip().split("\n")[-1]
        raise InputError(f"path must be a file that ffmpeg can write, not {str(path)!r}: {said}")
