"""Animations of the discs: two discs stay on their sides for a long time, then pass each other.

An animation is a GIF, which every program shows, an animated PNG, which a report takes as an image,
a page with a slider, or an MP4. Between events the discs move freely, or fall with the same
acceleration, so straight lines or parabolas through the rows of trajectory.csv are the trajectory
itself. On a periodic axis a disc that leaves the box at one end enters at the other. Frames have
equal steps of time, and one of them shows the moment of the hop.
"""

import io
import json
import shutil
import subprocess
from base64 import b64encode
from collections import Counter
from functools import partial
from pathlib import Path
from string import Template

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgba
from matplotlib.patches import Circle
from PIL import Image

from twodiscs.figures import drawing, panels
from twodiscs.figures.motion import disc_colours, longer_axis
from twodiscs.figures.style import BLACK, BLUE, GREY, ORANGE, VERMILLION, new_figure
from twodiscs.model.checks import InputError, check_length, path_text, writing_to
from twodiscs.model.events import HOPS

#: Inches: width of the whole, its margin on the left, and the largest width and height of the box.
FRAME_WIDTH, LEFT_MARGIN, BOX_SIZE = 3.8, 0.5, (3.8 - 0.5 - 0.12, 2.6)

#: Frames before and after the hop, frames of a trace, and frames in which the hop stays marked.
FRAMES_BEFORE, FRAMES_AFTER, TRACE_FRAMES, MARKED_FRAMES = 110, 60, 20, 20


def frame_times(rows, step, discs):
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
        if time - before > FRAMES_BEFORE * step and after - time > FRAMES_AFTER * step
    ]
    centre = (isolated or times[1:])[0] if hop else start
    later = FRAMES_AFTER if discs == 2 else FRAMES_BEFORE + FRAMES_AFTER
    frames = centre + step * np.arange(-FRAMES_BEFORE if hop else 0, later + 1)
    frames = frames[(frames >= start) & (frames <= end)]
    if len(frames) < 2:
        lasts = end - start
        raise InputError(f"trajectory must last two frames, a time of {step:g}, not {lasts:g}")
    return frames, hop, centre


class MovingDiscs:
    """The discs of a trajectory at any time, and the times of the frames that show them.

    ``columns`` are the values of the ``rows`` of trajectory.csv, {name: array}. ``frames`` are the
    times of the frames, ``step`` apart. ``hop`` is the hop that they show, or None, ``centre`` its
    time, and ``axis`` the axis along which it changes the order of the discs.
    """

    def __init__(self, box, radius, rows):
        self.box, self.scene = box, box.scene(check_length("radius", radius))
        self.sides = {"x": box.width, "y": box.height}
        self.periodic = [axis for axis in self.scene.periodic if axis in self.sides]
        known = [name for name, value in rows[0].items() if value is not None]
        self.columns = {name: np.array([row[name] for row in rows]) for name in known}
        # In 50 frames a disc of speed 1 moves by two mean sides of the box.
        self.step = (box.width + box.height) / 50
        self.frames, self.hop, self.centre = frame_times(rows, self.step, box.discs)
        self.axis = "y" if self.hop == "vertical_hop" else "x"

    def interpolate(self, name, times):
        """Return the values of a column at ``times``, on straight lines between the rows."""
        return np.interp(times, self.columns["time"], self.columns[name])

    def places(self, disc, times):
        """Return the centres (n, 2) of a disc at ``times``."""
        places = np.column_stack([self.interpolate(f"{axis}{disc}", times) for axis in "xy"])
        if self.scene.field:
            rows = self.columns["time"]
            after = np.clip(np.searchsorted(rows, times), 1, len(rows) - 1)
            fall = (times - rows[after - 1]) * (rows[after] - times)
            places[:, 1] += self.scene.field / 2 * fall
        return places

    def fold(self, places):
        """Return ``places`` moved by whole periods into the box."""
        places = places.copy()
        for axis in self.periodic:
            column, side = "xy".index(axis), self.sides[axis]
            places[:, column] -= side * np.round(places[:, column] / side)
        return places

    def folded_place(self, disc, time):
        """Return the centre of a disc at one ``time``, in the box."""
        return self.fold(self.places(disc, np.array([time])))[0]

    def separation(self, times):
        """Return the separation of two discs along the axis of the hop."""
        places = self.places(2, times) - self.places(1, times)
        return self.fold(places)[:, "xy".index(self.axis)]

    def height(self, disc, time):
        """Return the height z of a ball, in the box; all discs have the same."""
        if f"z{disc}" not in self.columns:
            return 0.0
        z = self.interpolate(f"z{disc}", time)
        if "z" in self.scene.periodic:
            z -= self.scene.depth * np.round(z / self.scene.depth)
        return z

    def path_times(self, start, end):
        """Return the times of all rows between two moments, and these two.

        If paths are curved or folded, there are more times between them, for a smooth line.
        """
        times = self.columns["time"]
        path = np.array([start, *times[(times > start) & (times < end)], end])
        if self.scene.field or self.scene.periodic:
            between = np.arange(start, end, TRACE_FRAMES * self.step / 100)
            path = np.union1d(path, between[between < end])  # by rounding the last may be > end
        return path


# Parts that stand still ---------------------------------------------------------------------------


def draw_panels(motion):
    """Return new axes of the box, with its walls and heading, and of the strip beneath it."""
    box, radius = motion.box, motion.scene.radius
    inches, margin = drawing.scale(box.width, box.height, *BOX_SIZE)
    lines, bottom, tall = panels.heading(box, panels.radius_text(radius)), 0.36, 0.62
    beneath = bottom + tall + 0.1
    # Points: the sign of a hop has its own line.
    digits = sum(len(panels.mathtext(value)) for value in (box.width, box.height, radius))
    up = 17 if box.discs == 2 and not (box.is_plain and digits <= 11) else 0
    heading = 0.156 * (len(lines) - 1) + up / 72
    figure = new_figure(beneath + inches * box.height + 0.28 + heading, FRAME_WIDTH)
    figure.set_dpi(100)
    x, y = box.width / 2, box.height / 2
    axes = drawing.add_axes(figure, LEFT_MARGIN + margin, beneath, inches, (-x, x, -y, y))
    draw_walls(axes, motion.scene)
    above = {"xycoords": "axes fraction", "ha": "left", "va": "bottom", "fontsize": 9}
    drawing.label(axes, ",\n".join(lines), (0, 1), (-72 * margin, 5 + up), **above)
    strip = panels.add_panel(figure, bottom, tall, LEFT_MARGIN, BOX_SIZE[0])
    strip.set(xlim=(motion.frames[0], motion.frames[-1]), xlabel="time $t$ (length/speed)")
    return axes, strip


def draw_walls(axes, scene):
    """Draw the walls of the box; the ends of a periodic axis are dotted."""
    (x0, x1), (y0, y1) = axes.get_xlim(), axes.get_ylim()
    if not scene.periodic:
        drawing.rectangle(axes, x0, x1, y0, y1, width=1.2)
        return
    for axis, ends in (("x", (x0, x1)), ("y", (y0, y1))):
        style = {"lw": 0.8, "ls": (0, (1, 2))} if axis in scene.periodic else {"lw": 1.2}
        for end in ends:
            line = ([end, end], [y0, y1]) if axis == "x" else ([x0, x1], [end, end])
            axes.plot(*line, color=BLACK, clip_on=False, **style)


def draw_separation(strip, motion):
    """Draw the separation of two discs over the whole time."""
    times = motion.path_times(motion.frames[0], motion.frames[-1])
    separation = motion.separation(times)
    most = 1.1 * np.abs(separation).max()
    strip.set(ylim=(-most, most), ylabel=f"${motion.axis}_2-{motion.axis}_1$ (length)")
    strip.axhline(0, color=GREY, lw=0.5)
    strip.plot(times, separation, color="#C8C8C8", lw=0.8)


def draw_positions(strip, motion, colours):
    """Draw the positions of many discs along the longer side over the whole time."""
    axis = longer_axis(motion.box)
    times, side = motion.path_times(motion.frames[0], motion.frames[-1]), motion.sides[axis]
    strip.set_ylabel(f"${axis}$ (length)")
    if axis not in motion.periodic:  # on it positions go on beyond the box
        strip.set_ylim(-side / 2, side / 2)
    for disc, colour in enumerate(colours, 1):
        places = motion.places(disc, times)[:, "xy".index(axis)]
        strip.plot(times, places, color=colour, lw=0.8)


# Parts that move ----------------------------------------------------------------------------------
#
# Each function draws one artist, and returns it with the function that moves it to its place at a
# time.


def draw_circle(axes, motion, disc, face, edge, across=""):
    """Draw a disc, or its image at the other ends of the periodic axes that it is ``across``."""
    circle = axes.add_patch(Circle((0, 0), motion.scene.radii[disc - 1], fc=face, ec=edge, lw=1.2))

    def move(time):
        place = motion.folded_place(disc, time)
        for axis in across:
            column = "xy".index(axis)
            place[column] -= np.copysign(motion.sides[axis], place[column])
        circle.center = place

    return circle, move


def draw_trace(axes, motion, disc, colour):
    """Draw the latest path of a disc, which fades with age."""
    trace = axes.add_collection(LineCollection([], linewidths=1.3))
    longest = TRACE_FRAMES * motion.step

    def move(time):
        times = motion.path_times(max(time - longest, motion.frames[0]), time)
        places = motion.fold(motion.places(disc, times))
        segments = np.stack([places[:-1], places[1:]], axis=1)
        fading = np.array([to_rgba(colour, 1 - (time - t) / longest) for t in times[1:]])
        if motion.scene.periodic:  # the jump from one end to the other is no part of the path
            near = np.abs(places[1:] - places[:-1]).max(axis=1) < min(motion.sides.values()) / 2
            segments, fading = segments[near], fading[near]
        trace.set(segments=segments, colors=fading)

    return trace, move


def draw_points(axes, points, *form, **style):
    """Draw a line or symbols through ``points(time)``, which returns abscissas and ordinates."""
    (line,) = axes.plot([], [], *form, **style)
    return line, lambda time: line.set_data(*map(np.atleast_1d, points(time)))


def draw_mark(axes, motion, disc):
    """Draw the mark at the edge of a rough disc. Between two events its spin is constant."""
    times, radius = motion.columns["time"], motion.scene.radii[disc - 1]
    spins = motion.columns[f"s{disc}"] / radius
    angles = np.concatenate([[0.0], np.cumsum(spins[:-1] * np.diff(times))])

    def points(time):
        (x, y), angle = motion.folded_place(disc, time), np.interp(time, times, angles)
        ends = radius * np.array([0.65, 1.0])
        return x + ends * np.cos(angle), y + ends * np.sin(angle)

    return draw_points(axes, points, color=BLACK, lw=1.5)


def draw_number(axes, motion, disc, is_beside):
    """Draw the number of a disc at its centre, or beside it and below the upper end of the box."""
    number = drawing.label(axes, f"{disc}", (0, 0), fontsize=11 if is_beside else 9)

    def move(time):
        number.xy = motion.folded_place(disc, time)
        if is_beside:
            above = (motion.box.height / 2 - number.xy[1]) / drawing.points(axes)
            number.xyann = (-9, min(9, above - 4))  # half of its height is 4

    return number, move


def draw_surface(axes, motion):
    """Draw the line that disc 2 crosses at the hop; only the frame of the hop shows it."""
    x, y = motion.folded_place(1, motion.centre)
    ends = ([x, x], axes.get_ylim()) if motion.axis == "x" else (axes.get_xlim(), [y, y])
    (line,) = axes.plot(*ends, color=BLACK, lw=1.2, ls=(0, (4, 2)))
    return line, lambda time: line.set_visible(bool(motion.hop) and time == motion.centre)


def draw_sign(axes, motion):
    """Draw the sign of the hop, which stays for some frames."""
    _, margin = drawing.scale(*motion.sides.values(), *BOX_SIZE)
    sign = axes.annotate(
        rf"hop:  ${motion.axis}_1={motion.axis}_2$", (1, 1), (72 * margin, 5), "axes fraction",
        "offset points", ha="right", va="bottom", fontsize=10,
        bbox={"boxstyle": "round,pad=0.2", "facecolor": ORANGE, "edgecolor": "none"},
    )  # fmt: skip

    def move(time):
        elapsed = time - motion.centre
        sign.set_visible(bool(motion.hop) and 0 <= elapsed < MARKED_FRAMES * motion.step)

    return sign, move


def draw_separations(strip, motion):
    """Return parts that draw the separation and the hops until now, and the separation now."""
    hops = motion.columns["time"][motion.columns["event"] == motion.hop]
    hops = hops[hops >= motion.frames[0]]

    def past(time):
        times = motion.path_times(motion.frames[0], time)
        return times, motion.separation(times)

    dots = {"marker": "o", "ls": "", "mew": 0}
    return {
        "past": draw_points(strip, past, color=BLUE, lw=0.9),
        "hops": draw_points(
            strip, lambda time: (hops[hops <= time], 0 * hops[hops <= time]),
            color=VERMILLION, ms=6, **dots,
        ),
        "present": draw_points(
            strip, lambda time: ([time], motion.separation(np.array([time]))),
            color=BLACK, ms=3.5, **dots,
        ),
    }  # fmt: skip


def draw(motion):
    """Draw the panels; return the figure, its circles and its other moving parts.

    A part is (artist, the function that moves it to its place at a time). The circles are {disc:
    parts}, the others {name: part}, in the order of drawing. Two discs have the colours of all
    figures, and their hop is shown. Many discs are coloured by their order at the start.
    """
    axes, strip = draw_panels(motion)
    if many := motion.box.discs > 2:
        first = {name: values[0] for name, values in motion.columns.items()}
        colours = disc_colours(motion.box, first)
        looks = [(tuple(0.45 * part + 0.55 for part in colour), colour) for colour in colours]
        draw_positions(strip, motion, colours)
    else:
        looks = drawing.DISC_COLOURS
        draw_separation(strip, motion)
    circles, others = {}, {}
    for disc, look in enumerate(looks, 1):
        # On a torus, a disc at a corner has an image at each of the others.
        images = dict.fromkeys(["", *motion.periodic, "".join(motion.periodic)])
        circles[disc] = [draw_circle(axes, motion, disc, *look, across) for across in images]
    for disc, (_, colour) in enumerate(looks, 1):
        others[f"trace {disc}"] = draw_trace(axes, motion, disc, colour)
        if f"s{disc}" in motion.columns:
            others[f"mark {disc}"] = draw_mark(axes, motion, disc)
        if not many:
            others[f"centre {disc}"] = draw_points(
                axes, partial(motion.folded_place, disc), "o", color=colour, ms=3.5, mew=0
            )
        others[f"number {disc}"] = draw_number(axes, motion, disc, not many)
    if many:
        others["present"] = draw_points(
            strip, lambda time: ([time, time], strip.get_ylim()), color=BLACK, lw=1.0
        )
    else:
        others |= {"surface": draw_surface(axes, motion), "sign": draw_sign(axes, motion)}
        others |= draw_separations(strip, motion)
    return axes.figure, circles, others


def moving_parts(motion, circles, others, time):
    """Return the moving parts at a ``time`` in the order of drawing: nearer balls come later."""
    discs = sorted(circles, key=lambda disc: motion.height(disc, time))
    return [*(part for disc in discs for part in circles[disc]), *others.values()]


def animate(box, radius, rows, paths):
    """Write an animation of one hop, or of more than two discs, to every one of ``paths``.

    The paths are .gif, .png, .html or .mp4 files. ``box`` is the ``Box``, ``radius`` the radius of
    the discs, and ``rows`` are the rows of trajectory.csv, long enough for two frames. Raises
    ``InputError`` for anything else.
    """
    for path in paths:
        kind = Path(text := path_text(path)).suffix.lower()
        if kind not in (".gif", ".png", ".html", ".mp4"):
            raise InputError(f"path must be a .gif, .png, .html or .mp4 file, not {text!r}")
        if kind == ".mp4":
            ffmpeg()
        if not Path(path).parent.is_dir():
            with writing_to(path):  # raises before all frames are drawn
                pass
    motion = MovingDiscs(box, radius, rows)
    figure, circles, others = draw(motion)
    for artist, _ in moving_parts(motion, circles, others, motion.centre):
        artist.set_animated(True)
    figure.canvas.draw()
    still = figure.canvas.copy_from_bbox(figure.bbox)

    def image(time):
        figure.canvas.restore_region(still)
        for artist, move in moving_parts(motion, circles, others, time):
            move(time)
            figure.draw_artist(artist)
        return Image.fromarray(np.asarray(figure.canvas.buffer_rgba())).convert("RGB")

    fills = {
        tuple(round(255 * part) for part in circle.get_facecolor()[:3])
        for parts in circles.values()
        for circle, _ in parts
    }
    # The frame of the hop shows everything.
    palette = _palette(image(motion.centre), sorted(fills))
    true = [image(time) for time in motion.frames]
    first, *later = images = [one.quantize(palette=palette, dither=0) for one in true]
    # Milliseconds of the hop, of a frame and of the last frame.
    durations = [1500 if motion.hop and time == motion.centre else 50 for time in motion.frames]
    durations[-1] = 1000
    for path in paths:
        kind = Path(path).suffix.lower()
        if kind == ".html":
            write_page(path, images, durations, str(motion.scene))
        elif kind == ".mp4":
            write_mp4(path, true, durations)
        else:
            with writing_to(path) as new:
                first.save(new, save_all=True, append_images=later, duration=durations, loop=0)


def _palette(image, kept):
    """Return an image whose palette of 32 has the colours ``kept`` and the most frequent ones.

    Two colours of ``image`` differ at least by 60, summed over red, green and blue.
    """
    chosen = [*kept]
    for _, colour in sorted(image.getcolors(1 << 24), reverse=True):
        if all(sum(map(abs, np.subtract(colour, other))) >= 60 for other in chosen):
            chosen.append(colour)
    palette = Image.new("P", (1, 1))
    palette.putpalette([channel for colour in chosen[:32] for channel in colour])
    return palette


# Files --------------------------------------------------------------------------------------------


#: The page: the frames are pictures in it, so it needs no network and no other file.
PAGE_TEMPLATE = Path(__file__).with_name("animation.html")


def write_page(path, images, durations, title):
    """Write ``images``, each shown for some milliseconds, as a page."""
    pictures = []
    for image in images:
        stream = io.BytesIO()
        image.save(stream, format="png", optimize=True)
        pictures.append(b64encode(stream.getvalue()).decode())
    text = Template(PAGE_TEMPLATE.read_text(encoding="utf-8")).substitute(
        title=title, last=len(pictures) - 1, pictures=json.dumps(pictures),
        milliseconds=json.dumps(durations),
    )  # fmt: skip
    with writing_to(path) as new:
        Path(new).write_text(text, encoding="utf-8", newline="\n")


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
    ]  # fmt: skip
    frames = b"".join(
        image.convert("RGB").tobytes() * round(duration / step)
        for image, duration in zip(images, durations, strict=True)
    )
    with writing_to(path) as new:  # an absolute path, in which a colon begins no protocol
        done = subprocess.run([*command, new], input=frames, capture_output=True, check=False)
        if done.returncode:
            message = done.stderr.decode(errors="replace").strip().split("\n")[-1]
            refused = f"path must be a file that ffmpeg can write, not {path_text(path)!r}"
            raise InputError(f"{refused}: {message}")
