"""Frames of an animation as a page with a slider, or as an MP4 by the program ffmpeg."""

import io
import json
import os
import shutil
import subprocess
from base64 import b64encode

from twodiscs.model.checks import InputError, writing_to

#: The page: the frames are pictures in it, so it needs no network and no other file.
PAGE = """<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>{title}</title>
<style>
body {{ font-family: sans-serif; text-align: center; background: white; color: black }}
img {{ max-width: 100% }}
input {{ width: 20rem; max-width: 70%; vertical-align: middle }}
</style>
<img id="picture" alt="{title}">
<div>
<button id="play" type="button">Pause</button>
<input id="frame" type="range" min="0" max="{last}" value="0" aria-label="Frame">
</div>
<script>
const pictures = {pictures}, milliseconds = {milliseconds};
const picture = document.getElementById("picture"), frame = document.getElementById("frame");
const play = document.getElementById("play");
let timer = null;
function show(k) {{
  frame.value = k;
  picture.src = "data:image/png;base64," + pictures[k];
}}
function next() {{
  const k = (Number(frame.value) + 1) % pictures.length;
  show(k);
  timer = setTimeout(next, milliseconds[k]);
}}
function pause() {{
  clearTimeout(timer);
  timer = null;
  play.textContent = "Play";
}}
play.onclick = () => {{
  if (timer === null) {{ play.textContent = "Pause"; next(); }} else pause();
}};
frame.oninput = () => {{ pause(); show(Number(frame.value)); }};
show(0);
timer = setTimeout(next, milliseconds[0]);
</script>
</html>
"""


def write_page(path, images, durations, title):
    """Write ``images``, each shown for some milliseconds, as a page."""
    pictures = []
    for image in images:
        stream = io.BytesIO()
        image.save(stream, format="png", optimize=True)
        pictures.append(b64encode(stream.getvalue()).decode())
    text = PAGE.format(
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
