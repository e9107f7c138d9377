"""What a relative error of 1e-3 costs at every radius, and where single precision fails."""

import numpy as np

from twodiscs.figures.kit import panels
from twodiscs.figures.kit.limits import limits
from twodiscs.figures.kit.looks import LOOKS, name_of
from twodiscs.figures.kit.style import BLACK, BLUE, GREY, SIZES, SKY, new_figure
from twodiscs.model.box import Box
from twodiscs.theory.exact import event_rate, mean_times

#: Inches: the figure; the height and the widths of the panels of the times and of single precision.
WIDTH, HEIGHT, TIMES, SINGLE = 7.0, 2.1, 3.72, 2.1

#: The least distance of a curve from where its event ends, relatively.
CLOSEST = 1e-3


def draw(box=None, *, tables):
    """Draw the rows of accuracy_cost.csv; ``box`` is not used, for the table has its own box."""
    rows = tables["accuracy_cost"]
    figure = new_figure(panels.BOTTOM + HEIGHT + panels.TOP, WIDTH)
    _times(panels.add_panel(figure, panels.BOTTOM, HEIGHT, width=TIMES), rows)
    left = WIDTH - panels.RIGHT - SINGLE
    _single(panels.add_panel(figure, panels.BOTTOM, HEIGHT, left, SINGLE), rows)
    return figure


def caption(shown):
    """Return the caption."""
    return """
    (a) Processor time for a relative error of 1e-3 in each mean time, against the radius: from the
    speed and the errors of a pilot (open symbols), by running to that error (full symbols), and
    predicted from the exact rates and one speed for the noise of a Poisson process (lines). Below
    its line an event comes more evenly than at random, above it in clusters. Hops near the radius
    where they are blocked are counted from starts in a strip next to their surface (grey), at a
    price that stays flat, here up to a relative distance of 1e-6. (b) Error of the mean time
    between disc collisions where there is little room left, in double and in single precision:
    lengths rounded to 24 bits make another room (dashed).
    """


def _times(axes, rows):
    """Draw measured times (symbols) and those of a Poisson process (lines) for every event.

    Those of strips are grey inside.
    """
    rows = [row for row in rows if row["part"] == "radius"]
    box = Box(rows[0]["width"], rows[0]["height"])
    ends = limits(box)
    predicted = [row for row in rows if row["method"] == "poisson"]
    speed = np.median([row["work"] / row["seconds"] for row in predicted])
    error = predicted[0]["error"]
    for event, (colour, marker) in LOOKS.items():
        radii, seconds = _prediction(box, event, speed * error**2)
        axes.plot(radii, seconds, color=colour, zorder=2)
        for method, inside in (("lockstep", "white"), ("strip", "0.7"), ("paid", colour)):
            points = [
                (row["radius"], row["seconds"])
                for row in rows
                if row["method"] == method and row["quantity"] == f"{event}_time"
            ]
            if points:
                axes.plot(
                    *zip(*points, strict=True), ls="", marker=marker, color=colour, zorder=3,
                    mfc=inside, ms=SIZES[marker],
                    label=name_of(event) if method == "lockstep" else None,
                )  # fmt: skip
    for inside, name in (("0.7", "from strips"), (BLACK, "at this error")):
        axes.plot([], [], ls="", marker="o", color=BLACK, mfc=inside, ms=SIZES["o"], label=name)
    axes.plot([], [], color=BLACK, label="Poisson process")
    for radius, _ in ends:
        axes.axvline(radius, color=GREY, lw=0.5, ls=(0, (5, 1.5, 1, 1.5)), zorder=0)
    axes.set(yscale="log", xlim=(0, 1.02 * ends[-1][0]), ylim=(5e-4, 1e4), xlabel="radius $r$")
    axes.set_ylabel("processor time for an error of $10^{-3}$ (s)")
    axes.legend(loc="upper left", ncols=2, columnspacing=0.7, handlelength=0.9, handletextpad=0.4)
    panels.name_limits(axes, ends)
    panels.name_box(axes, box)
    panels.letter(axes, "a")


def _prediction(box, event, counts):
    """Return (radii, seconds) along the curve; ``counts`` is the events a second, over error⁻²."""
    last = box.threshold(event)
    near = last * (1 - np.geomspace(CLOSEST, 0.1, 40))
    radii = np.sort([*np.linspace(0.01, 0.9 * last, 60), *near])
    scenes = [box.scene(radius) for radius in radii]
    total = [event_rate(scene) for scene in scenes]
    times = [mean_times(scene)[event] / scene.multiplicity(event) for scene in scenes]
    return radii, np.array(total) * np.array(times) / counts


def _single(axes, rows):
    """Draw the error of the mean time between collisions where there is little room."""
    looks = {
        "lockstep": ("double precision", BLUE, "o"),
        "single_precision": ("single precision", SKY, "D"),
    }
    for method, (name, colour, marker) in looks.items():
        shown = [
            row
            for row in rows
            if (row["part"], row["quantity"]) == ("precision", "disc_collision_time")
            and row["method"] == method
        ]
        rooms, errors = ([row[key] for row in shown] for key in ("setting", "error"))
        noise = [row["spread"] for row in shown]
        axes.plot(
            rooms, errors, marker=marker, ms=SIZES[marker], mfc="white", color=colour, label=name
        )
    axes.fill_between(rooms, noise, 1e-9, color=GREY, alpha=0.2, lw=0, label="statistical error")
    # Lengths are known to 2⁻²⁴, the room is this part of them.
    rooms = np.geomspace(1e-7, 1)
    axes.plot(
        rooms, 2.0**-24 / rooms, color=BLACK, lw=0.6, ls=(0, (4, 2)),
        label=r"$2^{-24}/(1-r/r_{\mathrm{max}})$",
    )  # fmt: skip
    axes.set(xscale="log", yscale="log", xlim=(5e-7, 0.2), ylim=(1e-5, 1))
    axes.set_xlabel(r"room left, $1-r/r_{\mathrm{max}}$")
    axes.set_ylabel("relative error")
    axes.legend(loc="upper right")
    panels.letter(axes, "b")
