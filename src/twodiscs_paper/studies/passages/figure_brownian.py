"""Passages in Brownian dynamics: one function of neck over step, if no step is rejected."""

import math

import numpy as np

from twodiscs.figures import drawing, panels
from twodiscs.figures.style import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, VERMILLION
from twodiscs_paper.studies.estimates import columns
from twodiscs_paper.studies.passages.brownian import MOVE_WIDTHS
from twodiscs_paper.studies.passages.figure import points
from twodiscs_paper.study import select

#: {program: (colour, its name)}.
PROGRAM_LOOKS = {
    "reflected": (BLUE, "reflected"),
    "kicked": (PURPLE, "reflected, random times"),
    "together": (VERMILLION, "rejected, both discs"),
    "confined": (ORANGE, "the same, and at walls"),
    "singly": (GREEN, "rejected, one disc"),
}

#: {length of a step: marker}.
ROOM_MARKERS = {2.0**-2: "o", 2.0**-3: "s", 2.0**-5: "^", 2.0**-7: "D"}

#: The abscissas and the ordinates that are shown.
NECKS, KAPPAS, EXPONENT_RANGE = (0.006, 60), (2e-3, 120), (-3.7, 0.4)

#: Wider channels, in σ, have no neck.
WIDEST_NECK = 1 / 4

#: In necks of fewer steps rejected discs step through each other, and no law is drawn.
LONGEST_STEP = 4

#: κ times neck over step, for a separation that diffuses through a long neck.
NECK_LIMIT = math.sqrt(2 / math.pi)


def draw(box, tables):
    """Draw the rows of brownian.csv; the ``box`` is not that of the channel."""
    rows = [row for row in tables["brownian"] if row["room"] <= WIDEST_NECK]
    figure, (upper, lower) = panels.stacked(kappa=2.7, exponent=2.0)
    for program, (colour, _) in PROGRAM_LOOKS.items():
        for step, marker in ROOM_MARKERS.items():
            for panel, quantity in ((upper, "coefficient"), (lower, "local_exponent")):
                own = select(rows, program=program, step=step, quantity=quantity)
                crossings, passages = (select(own, method=m) for m in ("crossings", "passages"))
                points(panel, *columns(crossings, *POINT_COLUMNS), (colour, marker))
                points(panel, *columns(passages, *POINT_COLUMNS), (colour, marker), filled=True)
                law = [r for r in crossings if program in MOVE_WIDTHS and r["neck"] >= LONGEST_STEP]
                panel.plot(*columns(law, "neck", "diffusive"), color=colour, lw=0.8, zorder=4)
    dashed = {"color": BLACK, "lw": 0.8, "ls": (0, (4, 2)), "zorder": 5}
    upper.plot(NECKS, np.ones(2), **dashed)
    long = np.array([NECK_LIMIT, NECKS[1]])
    upper.plot(long, NECK_LIMIT / long, **dashed)
    for power, name in (
        (-1.5, r"$-\frac{3}{2}$"),
        (-2.0, "$-2$"),
        (-2.5, r"$-\frac{5}{2}$"),
        (-3.5, r"$-\frac{7}{2}$"),
        (0.0, "$0$"),
    ):
        lower.axhline(power, color=GREY, lw=0.8, ls=(0, (4, 2)), zorder=1)
        drawing.label(lower, name, (NECKS[1], power), (3, 0), ha="left", color=GREY)
    for colour, name in PROGRAM_LOOKS.values():
        upper.plot([], [], color=colour, lw=2, label=name)
    for step, marker in ROOM_MARKERS.items():
        style = panels.open_symbol(GREY, marker, 0.85)
        upper.plot([], [], ls="", label=rf"crossings, $s=\sigma/{1 / step:g}$", **style)
    upper.plot([], [], "o", color=GREY, markersize=1.8, label="passages")
    upper.set(xscale="log", yscale="log", xlim=NECKS, ylim=KAPPAS)
    upper.set_ylabel(r"$\kappa$ = passages / crossings of theory")
    upper.tick_params(which="both", labelbottom=False)
    upper.yaxis.set_major_formatter("{x:g}")
    lower.set(xscale="log", xlim=NECKS, ylim=EXPONENT_RANGE)
    lower.set_xlabel(r"neck over step $\sqrt{\varepsilon\sigma}/s$")
    lower.set_ylabel(r"exponent of the time of passage")
    lower.xaxis.set_major_formatter("{x:g}")
    figure.legend(loc="outside upper center", ncols=2)
    return figure


#: The columns that are drawn.
POINT_COLUMNS = ("neck", "estimate", "stderr")
