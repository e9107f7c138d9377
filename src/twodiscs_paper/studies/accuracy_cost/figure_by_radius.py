"""The cost of a relative error of 1e-3 at every radius."""

import numpy as np

from twodiscs.figures.kit import panels
from twodiscs.figures.kit.limits import limits
from twodiscs.figures.kit.looks import LOOKS, name_of
from twodiscs.figures.kit.style import BLACK, SIZES, new_figure
from twodiscs.model.box import Box
from twodiscs.theory.exact import event_rate, mean_times

#: Inches: heights of the panels of the times and of their ratios to a Poisson process.
TIMES, RATIOS = 1.7, 1.0

#: The smallest relative distance of a curve from the radius where its event ends.
CLOSEST = 1e-3


def draw(box=None, *, tables):
    """Draw the rows of accuracy_cost.csv; ``box`` is not used, because the table has its own."""
    rows = tables["accuracy_cost"]
    upper = panels.BOTTOM + RATIOS + panels.GAP
    figure = new_figure(upper + TIMES + panels.TOP)
    times = panels.add_panel(figure, upper, TIMES, name="times by radius")
    ratios = panels.add_panel(figure, panels.BOTTOM, RATIOS, name="ratios")
    _times(times, ratios, [row for row in rows if row["part"] == "radius"])
    for axes, name in zip(figure.axes, "ab", strict=True):
        panels.letter(axes, name)
    return figure


def caption(shown):
    """Return the caption."""
    return """
    (a) Processor time for a relative error of 1e-3 in each mean time, against the radius. It comes
    from the speed and the errors of a pilot (open symbols) or from a run to that error (full
    symbols). Lines are predicted from the exact rates and one speed for a Poisson process. Hops
    near the radius where they are blocked are counted from initial states in a strip next to their
    surface (grey). Their cost stays constant, here up to a relative distance of 1e-6. (b) The times
    of pilots divided by the times of a Poisson process. Apart from the speed at that radius, this
    ratio is the variance of the number of events divided by its mean. If it is below one, as for
    hits of any wall, events are more regular than in a Poisson process. Above one they come in
    clusters.
    """


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
    panels.name_box(axes, box)
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
    times = [mean_times(scene)[event] / scene.multiplicity(event) for scene in scenes]
    return np.array(total) * np.array(times) / counts
