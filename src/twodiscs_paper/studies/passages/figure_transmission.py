"""How the transmission coefficient scales at the threshold, for smooth discs and for rough ones."""

import numpy as np

from twodiscs.figures import drawing, panels
from twodiscs.figures.curves import QUARTERS
from twodiscs.figures.style import BLACK, BLUE, GREY, SKY, VERMILLION
from twodiscs.model.box import Box
from twodiscs.model.events import AXIS
from twodiscs_paper.studies.passages.figure import (
    LOOKS,
    columns,
    is_empty,
    measured,
    points,
    residuals,
    scale,
    select,
)

#: Colour and marker of further boxes and hops of smooth discs.
OTHERS = ((SKY, "P"), (BLACK, "D"))

#: {quantity: colour, marker, name} of residuals.
RESIDUAL_LOOKS = {
    "slope": (BLUE, "o", r"$\kappa'(0)$, from exact"),
    "plateau": (VERMILLION, "s", r"$\kappa$, by $\kappa(t)$ and by clusters"),
}


def draw(box, tables):
    """Draw the rows of passages.csv: smooth discs at every threshold, rough discs at one."""
    rows = tables["passages"]
    figure, (smooth, rough, lower) = panels.stacked(smooth=2.3, rough=2.3, residuals=1.4)
    if is_empty(figure, smooth, rows, box):
        return figure
    main, hop, _, ours = measured(rows, box)
    _smooth(smooth, rows, ours)
    _rough(rough, ours, place(main, hop))
    residuals(lower, select(rows, friction=None), RESIDUAL_LOOKS)
    return figure


def _smooth(axes, rows, ours):
    """Draw 1 − κ of smooth discs over ∛(σ²ε)/A, at every threshold of every scene."""
    others = iter(OTHERS)
    coefficients = select(rows, quantity="coefficient", moment_of_inertia=None, friction=None)
    for scene, event in dict.fromkeys((row["scene"], row["event"]) for row in coefficients):
        own = select(coefficients, scene=scene, event=event)
        distance, value, error = columns(own, "distance", "estimate", "stderr")
        where = place(Box(own[0]["width"], own[0]["height"]), event)
        look = LOOKS[None] if own[0] in ours else next(others)
        unit = np.array([cube_root(row) for row in own])
        points(axes, distance, (1 - value) / unit, error / unit, look, where)
    for row in select(rows, quantity="amplitude"):
        axes.axhline(row["estimate"], color=BLACK, lw=0.8, ls=(0, (4, 2)), zorder=5,
                     label=r"$c$, at $\delta=0$")  # fmt: skip
    label = r"$(1-\kappa)\,A/\sigma^{2/3}\varepsilon^{1/3}$"
    scale(axes, (4e-5, 0.25), (0, 2), label, "linear", loc="lower left")


def place(box, hop):
    """Return the sides of a ``Box`` and the radius where a ``hop`` becomes blocked, in mathtext."""
    return f"${panels.sides(box)}$, ${QUARTERS[AXIS[hop]]}$"


def cube_root(row):
    """Return ∛(σ²ε)/A of a ``row``: the range A along its hop, the room ε left in the neck."""
    scene, hop = Box(row["width"], row["height"]).scene(row["radius"]), row["event"]
    return (scene.contact_distance**2 * scene.room(hop)) ** (1 / 3) / scene.reach(AXIS[hop])


def _rough(axes, ours, where):
    """Draw κ of rough discs, with ``where`` above the legend."""
    for inertia, look in LOOKS.items():
        own = select(ours, quantity="coefficient", moment_of_inertia=inertia)
        if own and inertia is not None:
            distance, value, error = columns(own, "distance", "estimate", "stderr")
            points(axes, distance, value, error, look, rf"$I={inertia:g}$")
    _power(axes, 1 / 2, r"$\delta^{1/2}$", 2e-3, 0.009)
    scale(axes, (1e-3, 0.1), (0.007, 0.5), r"$\kappa$, rough discs", title=where)


def _power(axes, power, name, start, height):
    """Draw a power law that starts at (``start``, ``height``)."""
    x = np.array([start, 20 * start])
    axes.plot(x, height * (x / x[0]) ** power, color=GREY, lw=0.8, zorder=1)
    drawing.label(axes, name, (x[1], height * 20**power), (3, 0), ha="left", color=GREY)
