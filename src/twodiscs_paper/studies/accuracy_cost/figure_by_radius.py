"""c, the time of an error times its square, against the distance from a threshold, by method."""

from matplotlib.ticker import LogLocator, NullLocator

from twodiscs.figures import panels
from twodiscs.figures.style import BLACK, COLUMN_WIDTH, EVENT_LOOKS, event_name, new_figure
from twodiscs_paper.study import select

#: The methods of each panel, and its name.
PANELS = {
    "dynamics": ("dynamics",),
    "strips": ("strips",),
    "rejection": ("rejection", "shells, rejection"),
    "conditioned": ("conditioned", "shells, conditioned"),
}

#: Inches: the height of the figure; the ends of the ordinate, seconds.
RADIUS_HEIGHT, PRICE_RANGE = 4.1, (1e-11, 1e5)


def draw(box, tables):
    """Draw the rows of accuracy_cost.csv; ``box`` is not used, because the table has its own."""
    rows = select(tables["accuracy_cost"], part="radius")
    figure = new_figure(RADIUS_HEIGHT, COLUMN_WIDTH, layout="constrained")
    axes = figure.subplots(2, 2, sharex=True, sharey=True).flat
    for one, letter, (name, methods) in zip(axes, "abcd", PANELS.items(), strict=True):
        one.set_label(name)
        one.set_title(f"({letter})  {name}", loc="left")
        for quantity, (colour, marker) in looks().items():
            own = [r for r in rows if r["quantity"] == quantity and r["method"] in methods]
            x, y = ([row[column] for row in own] for column in ("distance", "c"))
            one.plot(x, y, lw=0.7, **panels.open_symbol(colour, marker, 0.8))
        one.set(xscale="log", yscale="log", ylim=PRICE_RANGE)
        one.label_outer()
        if letter in "ac":
            one.set_ylabel(r"time $\times$ error$^2$ (s)")
        if letter in "cd":
            one.set_xlabel(r"$1-r/r_{\mathrm{c}}$,  $r_{\mathrm{c}}=h/4$")
    axes[0].set_xlim(1.3, 5e-7)
    for axis, number in ((axes[0].xaxis, 4), (axes[0].yaxis, 9)):
        axis.set_major_locator(LogLocator(numticks=number))
        axis.set_minor_locator(NullLocator())
    names = [event_name(event) for event in EVENT_LOOKS] + ["volume"]
    handles = [
        axes[0].plot([], [], lw=0.7, **panels.open_symbol(*look, 0.8))[0]
        for look in (*EVENT_LOOKS.values(), VOLUME)
    ]
    figure.legend(handles, names, loc="outside lower center", ncols=3, columnspacing=1.0)
    return figure


VOLUME = BLACK, "P"


def looks():
    """Return {quantity: (colour, marker)}: mean times and areas of one event look the same."""
    found = {"volume": VOLUME}
    for event, look in EVENT_LOOKS.items():
        found |= {f"{event}_time": look, f"{event}_area": look}
    return found
