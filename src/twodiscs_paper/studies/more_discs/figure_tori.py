"""Compressibility factors on tori: from 1953 to today, with their deviations beneath."""

import numpy as np

from twodiscs.figures import panels
from twodiscs.figures.style import BLACK, BLUE, GREEN, GREY, VERMILLION
from twodiscs_paper.studies.more_discs.tori import virial_series
from twodiscs_paper.study import select

#: {(reference, discs): (colour, marker, its name)}.
REFERENCE_LOOKS = {
    ("virial", 256): (BLACK, "o", "256 discs, virial series"),
    ("metropolis-1953", 224): (VERMILLION, "s", "224, Metropolis 1953"),
    ("li-2022", 72): (BLUE, "^", "72, Li 2022"),
    ("li-2022", 224): (BLUE, "s", "224, Li 2022"),
    ("li-2022", 870): (GREEN, "D", "870, Li 2022"),
}

#: Two starts that differ by more standard errors are not in equilibrium.
AGREEMENT_Z = 3

#: From this packing fraction on, coefficients that are left out matter.
SERIES_PACKING = 0.45


def draw(box, tables):
    """Draw the rows of tori.csv that have a reference; the ``box`` is not theirs."""
    rows = [row for row in tables["tori"] if row["reference"]]
    figure, (upper, lower) = panels.stacked(factor=3.0, residuals=1.6)
    for low, high, style in ((0.08, SERIES_PACKING, "-"), (SERIES_PACKING, 0.62, (0, (1, 1.5)))):
        packings = np.linspace(low, high, 100)
        factors = [virial_series(packing, 256)[0] for packing in packings]
        upper.plot(packings, factors, color=GREY, lw=0.9, ls=style, zorder=1)
    for (reference, discs), (colour, marker, name) in REFERENCE_LOOKS.items():
        own = select(rows, reference=reference, discs=discs)
        style = panels.open_symbol(colour, marker, 0.8)
        upper.plot(*_of(own, "estimate"), ls="", label=name, **style)
        if reference != "virial":
            upper.errorbar(
                *_of(own, "expected"), [row["expected_stderr"] for row in own], ls="", marker="x",
                color=colour, markersize=3, elinewidth=0.7, zorder=0,
            )  # fmt: skip
        for row in own:
            apart = row["starts_z"] or 0.0
            style = panels.open_symbol(colour if abs(apart) <= AGREEMENT_Z else GREY, marker, 0.8)
            lower.plot(row["packing_fraction"], row["z"], ls="", **style)
    upper.plot([], [], "x", color=BLACK, markersize=3, label="published")
    lower.plot([], [], ls="", label="two starts differ", **panels.open_symbol(GREY, "o", 0.8))
    lower.legend(loc="upper left", borderpad=0.2)
    panels.scale_residuals(lower)
    for axes in (upper, lower):
        axes.set_xlim(0.06, 0.9)
    upper.set(yscale="log", ylabel="$Z=PA/(NkT)$")
    upper.set_yticks([1, 2, 5, 10, 20, 50], ["1", "2", "5", "10", "20", "50"])
    upper.set_yticks([], minor=True)
    upper.tick_params(labelbottom=False)
    lower.set(xlabel=r"packing fraction $\phi$", ylabel="residual $z$")
    upper.legend(loc="upper left", borderpad=0.2)
    return figure


def _of(rows, column):
    return [row["packing_fraction"] for row in rows], [row[column] for row in rows]
