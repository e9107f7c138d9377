"""The cost of a relative error of 1e-3 at every radius."""

import numpy as np

from twodiscs.figures import panels
from twodiscs.figures.curves import limits
from twodiscs.figures.style import BLACK, LOOKS, SIZES, name_of
from twodiscs.model.box import Box
from twodiscs.theory.exact import event_rate, mean_times

#: The smallest relative distance of a curve from the radius where its event ends.
CLOSEST = 1e-3


def draw(box, tables):
    """Draw the rows of accuracy_cost.csv; ``box`` is not used, because the table has its own."""
    rows = tables["accuracy_cost"]
    figure, (times, ratios) = panels.stacked(**{"times by radius": 2.0, "ratios": 1.2})
    _times(times, ratios, [row for row in rows if row["part"] == "radius"])
    return figure


def _times(axes, ratios, rows):
    """Draw measured times (symbols), times of a Poisson process (lines), and their ratios.

    Symbols of strips are filled with grey. Ratios are of pilots, which use no strips.
    """
    box = Box(rows[0]["width"], rows[0]["height"])
    ends = limits(box)
    predicted = [row for row in rows if row["method"] == "poisson"]
    speed = np.median([row["work"] / row["seconds"] for row in predicted])
    counts = speed * predicted[0]["error"] ** 2
    for event, (colour, marker) in LOOKS.items():
        radii = _radii(box, event)
        axes.plot(radii, _prediction(box, event, radii, counts), color=colour, zorder=2)
        for method, inside in (("lockstep", "white"), ("strip", "0.7"), ("paid", colour)):
            own = [
                row for row in rows if (row["method"], row["quantity"]) == (method, f"{event}_time")
            ]
            style = {"ls": "", "marker": marker, "color": colour, "mfc": inside, "zorder": 3}
            style["ms"] = SIZES[marker]
            here = np.array([row["radius"] for row in own])
            seconds = np.array([row["seconds"] for row in own])
            label = name_of(event) if method == "lockstep" else None
            axes.plot(here, seconds, label=label, **style)
            if method == "lockstep":
                ratios.plot(here, seconds / _prediction(box, event, here, counts), **style)
    for inside, name in (("0.7", "from strips"), (BLACK, "at this error")):
        axes.plot([], [], ls="", marker="o", color=BLACK, mfc=inside, ms=SIZES["o"], label=name)
    axes.plot([], [], color=BLACK, label="Poisson process")
    panels.mark((axes, ratios), ends)
    axes.set(yscale="log", ylim=(5e-4, 1e4))
    axes.tick_params(labelbottom=False)
    axes.set_ylabel("time for an error of $10^{-3}$ (s)")
    axes.legend(loc="upper left", ncols=2, columnspacing=0.7, handlelength=0.9, handletextpad=0.4)
    panels.title(axes, "a", box, up=panels.ABOVE)
    ratios.axhline(1, color=BLACK)
    ratios.set(yscale="log", xlabel="radius $r$", ylabel="time / Poisson")
    panels.label_decades(ratios.yaxis, 100)


def _radii(box, event):
    """Return radii that are dense near the radius where the event ends."""
    last = box.threshold(event)
    near = last * (1 - np.geomspace(CLOSEST, 0.1, 40))
    return np.sort([*np.linspace(0.01, 0.9 * last, 60), *near])


def _prediction(box, event, radii, counts):
    """Return the seconds at ``radii``; ``counts`` is events per second times error²."""
    scenes = [box.scene(float(radius)) for radius in radii]
    total = [event_rate(scene) for scene in scenes]
    times = [mean_times(scene)[event] / scene.copies(event) for scene in scenes]
    return np.array(total) * np.array(times) / counts
