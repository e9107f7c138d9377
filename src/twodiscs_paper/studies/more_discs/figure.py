"""Mean times against the number of discs: theory, Monte Carlo and dynamics."""

from twodiscs.figures import panels
from twodiscs.figures.style import BLACK, EVENT_LOOKS, GREY, event_name
from twodiscs_paper.study import select

#: Inches: heights of a panel of one radius and of the residuals.
PANEL, RESIDUALS = 1.5, 1.3

#: {event: (how many pairs or discs share its times among N discs, the same in mathtext)}.
PAIR_FACTORS = {
    "vertical_hop": (lambda n: n * (n - 1) / 2, r"$\times N(N-1)/2$"),
    "horizontal_hop": (lambda n: n - 1, r"$\times(N-1)$"),
    "disc_collision": (lambda n: n - 1, r"$\times(N-1)$"),
    "right_wall": (lambda n: 1 / n, r"$/N$"),
    "top_wall": (lambda n: 1, ""),
}

DOTTED = (0, (1, 1.5))


def draw(box, tables):
    """Draw the boxes of more_discs.csv: lines are exact values, dotted ones only Monte Carlo.

    Times are per pair of discs that has the event, or per disc at the right wall, so that they
    depend little on the number of discs. Open symbols are dynamics, with their standard errors.
    Residuals are beneath.
    """
    rows = select(tables["more_discs"], periodic=None)
    radii = sorted({row["radius"] for row in rows})
    heights = {f"radius {radius}": PANEL for radius in radii}
    figure, (*upper, lower) = panels.stacked(**heights, residuals=RESIDUALS)
    for axes, radius in zip(upper, radii, strict=True):
        _times(axes, select(rows, radius=radius))
        axes.set(yscale="log", ylabel=f"time (length/speed)\nat $r={panels.mathtext(radius)}$")
        low, high = axes.get_ylim()
        axes.set_ylim(low / 1.05, high * 1.05)
        panels.label_decades(axes.yaxis, high / low)
        axes.tick_params(labelbottom=False)
    _legend(upper[0])
    _residuals(lower, rows, radii)
    lower.set_xlabel("number of discs $N$")
    upper[0].set_title(r"(a)  $w\times h=0.75\,N\times 1$", loc="left")
    numbers = sorted({row["discs"] for row in rows})
    for axes in (*upper, lower):
        axes.set(xscale="log", xlim=(numbers[0] / 1.15, numbers[-1] * 1.15))
        axes.set_xticks(numbers, [str(number) for number in numbers])
        axes.set_xticks([], minor=True)
    return figure


def _times(axes, rows):
    for event, (colour, marker) in EVENT_LOOKS.items():
        own = [row for row in rows if row["event"] == event and row["dynamics"]]
        if not own:
            continue
        share, name = PAIR_FACTORS[event]
        numbers = [row["discs"] for row in own]
        times = {
            column: [row[column] and row[column] * share(row["discs"]) for row in own]
            for column in ("exact", "monte_carlo", "dynamics", "dynamics_stderr")
        }
        either = [a or b for a, b in zip(times["exact"], times["monte_carlo"], strict=True)]
        for due, style in ((either, {"lw": 0.7, "ls": DOTTED}), (times["exact"], {})):
            known = [(number, time) for number, time in zip(numbers, due, strict=True) if time]
            if known:
                axes.plot(*zip(*known, strict=True), color=colour, **style)
        axes.errorbar(
            numbers, times["dynamics"], times["dynamics_stderr"], ls="", elinewidth=0.6,
            label=f"{event_name(event)} {name}".strip(), **panels.open_symbol(colour, marker),
        )  # fmt: skip


def _legend(axes):
    axes.plot([], [], color=GREY, label="exact")
    axes.plot([], [], color=GREY, lw=0.7, ls=DOTTED, label="Monte Carlo")
    handles, names = axes.get_legend_handles_labels()
    axes.figure.legend(handles, names, loc="outside upper center", ncols=2)


def _residuals(axes, rows, radii):
    for event, (colour, marker) in {**EVENT_LOOKS, "virial": (BLACK, "x")}.items():
        own = [row for row in rows if row["event"] == event and row["z"] is not None]
        # Residuals of one number of discs stand side by side, from radius to radius.
        x = [r["discs"] * 1.035 ** (radii.index(r["radius"]) - (len(radii) - 1) / 2) for r in own]
        style = panels.open_symbol(colour, marker, 0.75) if marker != "x" else {
            "color": colour, "marker": marker, "markersize": 3,
        }  # fmt: skip
        label = "virial theorem" if event == "virial" else None
        axes.plot(x, [row["z"] for row in own], ls="", label=label, **style)
    panels.scale_residuals(axes)
    axes.set(ylim=(-panels.LARGEST_RESIDUAL, 8.5), ylabel="residual $z$")
    axes.legend(loc="upper right", borderpad=0.1)
