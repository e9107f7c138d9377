"""How the transmission coefficient scales at the threshold, for smooth discs and for rough ones."""

import numpy as np

from twodiscs.figures import panels
from twodiscs.figures.curves import QUARTER_LABELS
from twodiscs.figures.style import BLACK, BLUE, GREY, SKY, VERMILLION
from twodiscs.model.events import EVENT_AXES
from twodiscs.model.scene import Box
from twodiscs_paper.studies.estimates import columns
from twodiscs_paper.studies.passages.figure import (
    INERTIA_LOOKS,
    at_places,
    measured,
    points,
    residuals,
    scale,
)
from twodiscs_paper.studies.passages.powers import law_scale
from twodiscs_paper.study import select

#: The distances that are named above the panel of smooth discs, in halvings, and the end of its
#: abscissa. The slope of its line is fitted from ``FIT_DISTANCE`` on.
HALVINGS, X_END, FIT_DISTANCE = (4, 8, 12, 16, 20), 0.55, 2.0**-12

#: {quantity: colour, marker, name} of residuals, each in a panel of its own.
TRANSMISSION_LOOKS = {
    "slope": (BLUE, "o", r"$\kappa'(0)$, from exact"),
    "plateau": (VERMILLION, "s", r"$\kappa$, by $\kappa(t)$ and by clusters"),
}


def draw(box, tables):
    """Draw the rows of passages.csv: smooth discs at every threshold, rough discs at one.

    Long runs of smooth discs are ``kept`` rows; they go closer to the threshold.
    """
    kept = [row for row in tables["kept"] if row["scene"] != "pause"]
    rows = at_places(tables["passages"], kept, False)
    heights = {"smooth": 2.35, "rough": 1.85, "slope": 0.95, "plateau": 1.2}
    figure, (smooth, rough, *lower) = panels.stacked(**heights)
    main, hop, _, ours = measured(rows, box)
    _smooth(smooth, rows, kept, place(main, hop))
    own = select(kept, width=main.width, height=main.height, event=hop)
    _rough(rough, ours, own, place(main, hop))
    for axes, (quantity, look) in zip(lower, TRANSMISSION_LOOKS.items(), strict=True):
        residuals(axes, select(rows, friction=None), {quantity: look})
    lower[0].set_xlabel("")
    lower[0].tick_params(which="both", labelbottom=False)
    return figure


def _smooth(axes, rows, kept, ours):
    """Draw 1 − κ of smooth discs in units of ∛(σ²ε)/A over δ^(1/6), at every threshold.

    The correction of the law is of this relative order, so a line leads to the limit c. ``ours`` is
    the place of the first scene.
    """
    # Colour and marker of further boxes and hops of smooth discs.
    others, looks, named = iter(((SKY, "P"), (BLACK, "D"))), {ours: INERTIA_LOOKS[None]}, set()
    for some, filled in ((rows, False), (kept, True)):
        found = select(some, quantity="coefficient", moment_of_inertia=None, friction=None)
        for scene, event in dict.fromkeys((row["scene"], row["event"]) for row in found):
            own = select(found, scene=scene, event=event)
            where = place(Box(own[0]["width"], own[0]["height"]), event)
            if where not in looks:
                looks[where] = next(others)
            x, value, error = _units(own)
            name = None if where in named else where
            points(axes, x, value, error, looks[where], name, filled)
            named.add(where)
    for row in select(rows, quantity="amplitude"):
        c = row["estimate"]
        axes.errorbar([0], [c], [row["stderr"]], color=BLACK, marker="*", markersize=5, ls="",
                      clip_on=False, zorder=6, label=r"$c$, in the limit")  # fmt: skip
        close = select(kept, quantity="coefficient", event="horizontal_hop", scene="h/4")
        close = [row for row in close if row["distance"] <= FIT_DISTANCE]
        if close:
            x, value, error = _units(close)
            slope = np.sum((value - c) * x / error**2) / np.sum(x**2 / error**2)
            axes.plot([0, X_END], [c, c + slope * X_END], color=GREY, lw=0.8, zorder=1)
    axes.set(xlim=(0, X_END), ylim=(0.6, 1.6), xlabel=r"sixth root of the distance, $\delta^{1/6}$")
    axes.set_ylabel(r"$(1-\kappa)\,A/\sigma^{2/3}\varepsilon^{1/3}$")
    above = axes.secondary_xaxis("top")
    above.set_xticks([2 ** (-n / 6) for n in HALVINGS], [f"$2^{{-{n}}}$" for n in HALVINGS])
    axes.tick_params(which="both", top=False)
    axes.set_title("(a)   at $\\delta=$", loc="left", pad=4)
    axes.legend(loc="lower right")


def _units(rows):
    """Return (δ^(1/6), (1 − κ) in units of ∛(σ²ε)/A, its error) of ``rows``, as arrays."""
    distance, value, error = columns(rows, "distance", "estimate", "stderr")
    scale = np.array(list(map(law_scale, rows)))
    return distance ** (1 / 6), (1 - value) * scale, error * scale


def place(box, hop):
    """Return the sides of a ``Box`` and the radius where a ``hop`` becomes blocked, in mathtext."""
    return f"${panels.sides(box)}$, ${QUARTER_LABELS[EVENT_AXES[hop]]}$"


def _rough(axes, ours, kept, where):
    """Draw κ of rough discs, with ``where`` above the legend and fitted powers in it."""
    for inertia, look in INERTIA_LOOKS.items():
        rows = select(kept, moment_of_inertia=inertia) or select(ours, moment_of_inertia=inertia)
        own = select(rows, quantity="coefficient")
        if not own or inertia is None:
            continue
        distance, value, error = columns(own, "distance", "estimate", "stderr")
        name = rf"$I={inertia:g}$"
        for fit in select(rows, quantity="last_exponent"):
            name += rf",  $\delta^{{{fit['estimate']:.2f}}}$"
        points(axes, distance, value, error, look, name, rows[0] in kept)
    scale(axes, (4e-4, 0.03), (5e-3, 0.25), r"$\kappa$, rough discs", title=where)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter("{x:g}")
        axis.set_minor_formatter(lambda x, _: f"{x:g}" if f"{x:e}"[0] in "25" else "")
