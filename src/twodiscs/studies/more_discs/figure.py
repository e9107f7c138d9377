"""Mean times against the number of discs: theory, Monte Carlo and dynamics."""

from twodiscs.figures.kit import panels
from twodiscs.figures.kit.looks import LOOKS, name_of
from twodiscs.figures.kit.style import new_figure

#: Inches: a panel for each radius, the gap between them, the room above.
PANEL, GAP, TOP = 1.5, 0.1, 0.12

#: Times longer than this are not drawn: hops that all but never happen.
LONGEST = 1e3


def draw(box, tables):
    """Draw more_discs.csv: exact values are lines and full, others dotted through Monte Carlo.

    Open symbols are dynamics, with their standard errors.
    """
    rows = [row for row in tables["more_discs"] if row["event"] != "virial"]
    radii = sorted({row["radius"] for row in rows})
    figure = new_figure(panels.BOTTOM + len(radii) * (PANEL + GAP) + TOP)
    for index, radius in enumerate(reversed(radii)):
        axes = panels.add_panel(figure, panels.BOTTOM + index * (PANEL + GAP), PANEL)
        for event, (colour, marker) in LOOKS.items():
            own = [
                row for row in rows
                if row["radius"] == radius and row["event"] == event and row["dynamics"]
                and row["dynamics"] < LONGEST
            ]  # fmt: skip
            if not own:
                continue
            numbers = [row["discs"] for row in own]
            expected = [row["exact"] or row["monte_carlo"] for row in own]
            axes.plot(numbers, expected, color=colour, lw=0.7, ls=(0, (1, 1.5)))
            known = [row for row in own if row["exact"]]
            axes.plot([r["discs"] for r in known], [r["exact"] for r in known], color=colour)
            axes.errorbar(
                numbers, [row["dynamics"] for row in own],
                [row["dynamics_stderr"] for row in own], ls="", elinewidth=0.6,
                label=name_of(event) if index == len(radii) - 1 else None,
                **panels.open_symbol(colour, marker),
            )  # fmt: skip
        axes.set(xscale="log", yscale="log", ylabel=f"mean time, $r={radius:g}$")
        axes.set_xticks([2, 3, 4, 8], ["2", "3", "4", "8"])
        axes.minorticks_off()
        if index:
            axes.tick_params(labelbottom=False)
        else:
            axes.set_xlabel("number of discs $N$")
        if index == len(radii) - 1:
            # Room for the names above all symbols.
            axes.set_ylim(top=60 * axes.get_ylim()[1])
            axes.legend(loc="upper right", ncols=2)
    return figure
