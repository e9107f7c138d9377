"""Mean times against the number of discs: theory, Monte Carlo and dynamics."""

from twodiscs.figures import panels
from twodiscs.figures.style import BLACK, GREY, LOOKS, name_of

#: Inches: heights of a panel of one radius and of the residuals.
PANEL, RESIDUALS = 1.6, 1.3

#: Times longer than this are not drawn: hops that almost never happen.
LONGEST = 1e3

#: Residuals of one number of discs stand side by side, from radius to radius.
APART = 1.035

DOTTED = (0, (1, 1.5))


def draw(box, tables):
    """Draw more_discs.csv: full lines are exact values, dotted lines Monte Carlo without them.

    Open symbols are dynamics, with their standard errors. Residuals are beneath.
    """
    rows = tables["more_discs"]
    radii = sorted({row["radius"] for row in rows})
    heights = {f"radius {radius}": PANEL for radius in radii}
    figure, (*upper, lower) = panels.stacked(**heights, residuals=RESIDUALS)
    for axes, radius in zip(upper, radii, strict=True):
        _times(axes, [row for row in rows if row["radius"] == radius])
        axes.set(yscale="log", ylabel=f"mean time, $r={panels.math_of(radius)}$")
        axes.tick_params(labelbottom=False)
    _legend(upper[0])
    _residuals(lower, rows, radii)
    lower.set_xlabel("number of discs $N$")
    upper[0].set_title(r"(a)  $w\times h=0.75\,N\times 1$", loc="left")
    numbers = sorted({row["discs"] for row in rows})
    for axes in (*upper, lower):
        axes.set(xscale="log", xlim=(numbers[0] / 1.15, numbers[-1] * 1.15))
        axes.set_xticks(numbers, [str(number) for number in numbers])
        axes.minorticks_off()
    return figure


def _times(axes, rows):
    for event, (colour, marker) in LOOKS.items():
        own = [
            row for row in rows
            if row["event"] == event and row["dynamics"] and row["dynamics"] < LONGEST
        ]  # fmt: skip
        if not own:
            continue
        numbers = [row["discs"] for row in own]
        due = [(row["discs"], row["exact"] or row["monte_carlo"]) for row in own]
        due = [(number, time) for number, time in due if time]
        axes.plot(*zip(*due, strict=True), color=colour, lw=0.7, ls=DOTTED)
        known = [row for row in own if row["exact"]]
        axes.plot([r["discs"] for r in known], [r["exact"] for r in known], color=colour)
        axes.errorbar(
            numbers, [row["dynamics"] for row in own], [row["dynamics_stderr"] for row in own],
            ls="", elinewidth=0.6, label=name_of(event), **panels.open_symbol(colour, marker),
        )  # fmt: skip


def _legend(axes):
    axes.plot([], [], color=GREY, label="exact")
    axes.plot([], [], color=GREY, lw=0.7, ls=DOTTED, label="Monte Carlo")
    # The legend stands above all symbols.
    axes.set_ylim(top=50 * axes.get_ylim()[1])
    axes.legend(loc="upper right", ncols=3, columnspacing=0.8)


def _residuals(axes, rows, radii):
    for event, (colour, marker) in {**LOOKS, "virial": (BLACK, "x")}.items():
        own = [row for row in rows if row["event"] == event and row["z"] is not None]
        x = [r["discs"] * APART ** (radii.index(r["radius"]) - (len(radii) - 1) / 2) for r in own]
        style = panels.open_symbol(colour, marker, 0.75) if marker != "x" else {
            "color": colour, "marker": marker, "markersize": 3,
        }  # fmt: skip
        label = "virial theorem" if event == "virial" else None
        axes.plot(x, [row["z"] for row in own], ls="", label=label, **style)
    axes.axhline(0, color=GREY, lw=0.5, zorder=0)
    for size, dashes in panels.GUIDES.items():
        for z in (-size, size):
            axes.axhline(z, color=GREY, lw=0.5, ls=dashes, zorder=0)
    axes.set(ylim=(-panels.LARGEST_RESIDUAL, 8.5), ylabel="residual $z$")
    axes.set_yticks([-5, -2, 0, 2, 5])
    axes.legend(loc="upper right", borderpad=0.1)
