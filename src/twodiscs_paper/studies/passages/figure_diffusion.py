"""How fast discs diffuse by hops: on a ring and in long files."""

import math

import numpy as np

from twodiscs.figures.kit import panels
from twodiscs.figures.kit.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    PURPLE,
    SKY,
    VERMILLION,
    new_figure,
)
from twodiscs.model.scene import Scene
from twodiscs_paper.studies.passages.figure import (
    LOOKS,
    columns,
    first_scene,
    is_empty,
    points,
    residuals,
    select,
)
from twodiscs_paper.studies.passages.measure import ONE_INERTIA
from twodiscs_paper.studies.passages.models import file

#: Inches: the width of the figure, the heights of its rows of panels.
WIDTH, HEIGHTS = 7.0, (2.7, 1.7)

#: Short files of more than two discs.
FILES = {4: (SKY, "P"), 8: (BLACK, "D")}

#: Long files: smooth discs, smooth discs with friction, rough discs.
SMOOTH_FILE, KICKED_FILE, ROUGH_FILE = (GREEN, "^"), (PURPLE, "v"), (VERMILLION, "s")

#: Looks of distances in a collapse.
OPEN = ((BLUE, "o"), (VERMILLION, "s"), (PURPLE, "D"))

#: {quantity: colour, marker, name} of residuals.
RESIDUAL_LOOKS = {
    "rate": (GREEN, "^", "rate of hops"),
    "diffusion": (BLUE, "o", "$D$, both methods"),
    "single_file": (PURPLE, "v", "$F$"),
}


def draw(box, tables):
    """Draw the rows of passages.csv on diffusion; the ring has the box of the first scene."""
    rows = tables["passages"]
    figure = new_figure(sum(HEIGHTS), WIDTH, layout="constrained")
    places = [["ring", "moved"], ["residuals", "collapse"]]
    axes = figure.subplot_mosaic(places, height_ratios=HEIGHTS)
    ring, lower, moved, collapse = (
        axes[name] for name in ("ring", "residuals", "moved", "collapse")
    )
    for one, letter in ((lower, "b"), (moved, "c"), (collapse, "d")):
        panels.title(one, letter)
    if is_empty(figure, ring, rows, box):
        return figure
    panels.title(ring, "a", first_scene(rows, box)[0])
    _ring(ring, rows)
    # Two discs with friction have a figure of their own.
    residuals(lower, [r for r in rows if not r["friction"] or r["discs"] > 2], RESIDUAL_LOOKS)
    long_files = [row for row in rows if row["quantity"] in LONG]
    _moved(moved, long_files)
    _collapse(collapse, rows)
    for axes in (ring, lower):
        axes.set(xlim=(0.01, 0.2))
    ring.tick_params(which="both", labelbottom=False)
    lower.xaxis.set_major_formatter("{x:g}")
    lower.xaxis.set_minor_formatter(lambda x, _: f"{x:g}" if f"{x:e}"[0] in "25" else "")
    return figure


def _ring(axes, rows):
    """Draw D/(ν ℓ²) on the ring, by both methods."""
    of_two = select(rows, quantity="diffusion", discs=2)
    for inertia, name in (
        (None, "2 smooth discs"),
        (ONE_INERTIA, f"2 rough discs, $I={ONE_INERTIA:g}$"),
    ):
        for method, filled in (("hops", False), ("states", True)):
            own = select(of_two, method=method, moment_of_inertia=inertia)
            if own:
                x, y, error = columns(own, "distance", "estimate", "stderr")
                points(axes, x, y, error, LOOKS[inertia], None if filled else name, filled)
    for discs, look in FILES.items():
        own = select(rows, quantity="diffusion", discs=discs)
        if own:
            x, y, error = columns(own, "distance", "estimate", "stderr")
            points(axes, x, y, error, look, f"{discs} smooth discs", True)
    for kicked, look in ((False, SMOOTH_FILE), (True, KICKED_FILE)):
        own = [
            row for row in select(rows, quantity="diffusion", method="order")
            if (row["friction"] is not None) == kicked
        ]  # fmt: skip
        if own:
            x, y, error = columns(own, "distance", "estimate", "stderr")
            name = f"{own[0]['discs']} {'with friction' if kicked else 'smooth discs'}"
            points(axes, x, y, error, look, name)
    axes.plot([], [], ls="", marker=".", color=BLACK, markersize=3, label="by displacements")
    axes.axhline(1, color=BLACK, lw=0.7, ls=(0, (4, 2)))
    axes.set(xscale="log", ylim=(0, None), ylabel=r"diffusion $D/(\nu\,\ell^2)$")
    axes.legend(loc="center left", bbox_to_anchor=(0, 0.4), ncols=2, fontsize=6.5)


#: Quantities of long files over the time.
LONG = ("displacement", "file", "order")


def _scene(row):
    """Return the ``Scene`` of a ``row`` of a long file, without its friction."""
    return Scene(
        row["width"], row["height"], row["radius"], discs=row["discs"], periodic="x",
        moment_of_inertia=row["moment_of_inertia"],
    )  # fmt: skip


def _thermal(row):
    """Return the thermal speed over h of the discs of a ``row`` on a ring."""
    return file.thermal_speed(_scene(row)) / row["height"]


def _of(rows, quantity, **wanted):
    """Return (times in units of h over the thermal speed, values, errors) of a ``quantity``."""
    own = select(rows, quantity=quantity, **wanted)
    time, value, error = columns(own, "time", "estimate", "stderr")
    return time * _thermal(own[0]), value, error


def _moved(axes, rows):
    """Draw displacements in long files, blocked and at the farthest open distance."""
    shown = [
        distance for some in ((r for r in rows if (r["distance"] > 0) == sign) for sign in (0, 1))
        for distance in [max((r["distance"] for r in some), default=None)] if distance is not None
    ]  # fmt: skip
    for distance in shown:
        here = select(rows, distance=distance)
        blocked = distance < 0
        kinds = dict.fromkeys((row["friction"], row["moment_of_inertia"]) for row in here)
        for friction, inertia in kinds:
            own = select(here, friction=friction, moment_of_inertia=inertia)
            look, kind = (SMOOTH_FILE, "smooth") if friction is None else (KICKED_FILE, "friction")
            if inertia is not None:
                look, kind = ROUGH_FILE, "rough"
            x, y, error = _of(own, "displacement")
            name = f"{kind}, {'blocked' if blocked else 'open'}"
            points(axes, x, y, error, look, name, blocked)
            if blocked and inertia is None:
                scene = _scene(own[0])
                time = np.geomspace(x[0], x[-1], 120)
                due = np.array([file.law(scene, friction, t / _thermal(own[0])) for t in time])
                # Sound that has gone around half of the ring brings the discs back.
                rises = np.append(np.diff(due) > 0, True).cumprod() > 0
                time, due = time[rises], due[rises]
                axes.plot(time, due, color=BLACK, lw=0.8, zorder=5)
            elif not blocked:
                _, place, _ = _of(own, "file")
                _, walk, _ = _of(own, "order")
                axes.plot(x, place + walk, color=GREY, lw=0.8, zorder=2)
    axes.set(xscale="log", yscale="log", xlabel=r"time $t\,\sqrt{kT/m}\,/h$")
    axes.set_ylabel(r"displacement $\langle x^2\rangle/\ell^2$")
    axes.xaxis.set_major_formatter("{x:g}")
    if axes.get_legend_handles_labels()[1]:
        axes.legend(loc="upper left", fontsize=6.5)


def _collapse(axes, rows):
    """Draw displacements with friction over F √t×, against t/t×."""
    looks = iter(OPEN)
    for row in select(rows, quantity="diffusion", method="order"):
        if row["friction"] is None:
            continue
        own = {name: row[name] for name in ("scene", "distance", "friction")}
        (single,) = select(rows, quantity="single_file", **own)
        (rate,) = select(rows, quantity="rate", method="insertion", distance=row["distance"])
        d, f = row["estimate"] * rate["estimate"] / 2, single["estimate"]
        crossover = (f / (2 * d)) ** 2
        moved = select(rows, quantity="displacement", **own)
        time, value, error = columns(moved, "time", "estimate", "stderr")
        unit = f * math.sqrt(crossover)
        name = rf"$\delta=1/{round(1 / row['distance'])}$"
        points(axes, time / crossover, value / unit, error / unit, next(looks), name)
    s = np.geomspace(1e-3, 10, 60)
    axes.plot(s, np.sqrt(s) + s, color=BLACK, lw=0.8, zorder=5)
    axes.set(xscale="log", yscale="log", xlabel=r"time $t/t_\times$")
    axes.set_ylabel(r"$\langle x^2\rangle/F\sqrt{t_\times}$")
    if axes.get_legend_handles_labels()[1]:
        axes.legend(loc="upper left")
