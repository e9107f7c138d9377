"""Figures of the motion: hops of two discs, world lines of many, and intervals between hops."""

from itertools import dropwhile, groupby, takewhile

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import to_rgb
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from twodiscs.figures import panels, style
from twodiscs.figures.style import BLACK, BLUE, EVENT_LOOKS, GREY, SERIES, VERMILLION, new_figure
from twodiscs.model.events import EVENT_AXES, HOPS
from twodiscs.theory import laws


def draw_trajectory(box, rows, radius=None):
    """Draw x2 − x1 against time from trajectory.csv.

    In a box higher than wide, or if x is periodic, it is y2 − y1. The ``radius``, if given, is
    written above. Between events the discs move freely, or fall with the same acceleration, so
    straight lines through the rows are the trajectory itself. More than two discs are drawn by
    ``draw_world_lines``.
    """
    if box.family == "many":
        return draw_world_lines(box, rows, radius)
    hop = shown_hop(box)
    axis = EVENT_AXES[hop]
    times = np.array([row["time"] for row in rows])
    apart = np.array([row[f"{axis}2"] - row[f"{axis}1"] for row in rows])
    hops = times[[row["event"] == hop for row in rows]]

    stretches = _stretches(times, hops)
    letters = "bc"[: len(stretches)]

    figure = new_figure(2 * 1.55, layout="constrained")
    panel = figure.subplot_mosaic([["a"] * len(letters), [*letters]])
    for name, axes in panel.items():
        thick, size = (0.3, 2.2) if name == "a" else (0.7, 3)
        axes.axhline(0, color=GREY, lw=0.5, zorder=1)
        axes.plot(times, apart, color=BLUE, lw=thick, zorder=2)
        axes.plot(hops, 0 * hops, "o", color=VERMILLION, markersize=size, mew=0, zorder=3)
        axes.set(xlabel="time $t$ (length/speed)", ylabel=f"${axis}_2-{axis}_1$ (length)")
    most = 1.08 * np.abs(apart).max()
    panel["a"].set(xlim=(times[0], times[-1]), ylim=(-most, most))
    shades = style.ORANGE, style.SKY
    for name, (first, last), colour in zip(letters, stretches, shades, strict=False):
        panel[name].set(xlim=(first, last), ylim=(-most, most))
        label = f"stretch in ({name})"
        panel["a"].axvspan(first, last, color=colour, alpha=0.45, lw=0, zorder=0, label=label)
        panels.title(panel[name], name)
    if len(stretches) > 1:
        panel["c"].set_ylabel("")
        panel["c"].tick_params(labelleft=False)
        for name in letters:
            panel[name].xaxis.set_major_locator(MaxNLocator(4))
            # A power of ten of the ticks is at the right end.
            panel[name].set_xlabel(panel[name].get_xlabel(), loc="left")
    if hops.size:
        panel["a"].plot([], [], ls="", marker="o", markersize=2.2, color=VERMILLION, label="hops")
    figure.legend(loc="outside lower center", ncols=3)
    panels.title(panel["a"], "a", box, panels.radius_text(radius))
    return figure


def _stretches(times, hops):
    """Return (start, end) of the stretches that the panels beneath enlarge, one or two.

    The first has the most ``hops``. The second, as long, is around a hop far from all others.
    """
    start, end = times[0], times[-1]
    # A third of the time or 150 rows, fewer if hops would be closer than a 50th of the panel.
    length, least_gap = (end - start) * min(1 / 3, 150 / len(times)), 0.02
    first, last = _densest_stretch(hops, length, start, end)
    gaps = np.diff(hops[(hops > first) & (hops < last)])
    if gaps.size and gaps.min() < least_gap * length:
        length = max(gaps.min() / least_gap, length / 10)
        first, last = _densest_stretch(hops, length, start, end)
    lone = _loneliest_hop(hops, length, start, end)
    second = [] if lone is None else [(lone - length / 2, lone + length / 2)]
    return [(first, last), *second]


def _loneliest_hop(hops, length, start, end):
    """Return the time of the hop farthest from all others, None if another is within ``length``.

    The stretch of ``length`` around it is between ``start`` and ``end``.
    """
    if len(hops) < 2:
        return None
    gaps = np.diff(hops, prepend=-np.inf, append=np.inf)
    nearest = np.minimum(gaps[:-1], gaps[1:])
    nearest[(hops < start + length / 2) | (hops > end - length / 2)] = 0
    at = int(np.argmax(nearest))
    return hops[at] if nearest[at] > length else None


def shown_hop(box):
    """Return the hop of two discs in a ``Box`` that the figure shows.

    It is the one along the longer side, unless this axis is periodic.
    """
    periodic = box.effects.get("periodic", "")
    along_x = "y" in periodic or (box.width >= box.height and "x" not in periodic)
    return "horizontal_hop" if along_x else "vertical_hop"


def _densest_stretch(hops, length, start, end):
    """Return the ends of the stretch of ``length`` with the most ``hops``."""
    first = start
    if len(hops):
        counts = np.searchsorted(hops, hops + 0.6 * length) - np.arange(len(hops))
        first = hops[np.argmax(counts)] - 0.3 * length
    first = min(max(first, start), end - length)
    return first, first + length


# Many discs ---------------------------------------------------------------------------------------


#: Bends for each disc that either panel shows, and the most lines in a panel.
DISC_BENDS, CLOSE_BENDS, LINES_PER_PANEL = 75, 15, 24


def longer_axis(box):
    """Return "x" in a box at least as wide as high, else "y"."""
    return "x" if box.width >= box.height else "y"


def disc_colours(box, first):
    """Return a colour for each disc, by its rank along the longer side in the row ``first``."""
    places = [first[f"{longer_axis(box)}{disc}"] for disc in range(1, box.discs + 1)]
    ranks = np.argsort(np.argsort(places))
    if box.discs <= len(EVENT_LOOKS):
        colours = [colour for colour, _ in EVENT_LOOKS.values()]
        return [to_rgb(colours[rank]) for rank in ranks]
    # The ends of the map are too dark and too light.
    shades = 0.05 + (0.95 - 0.05) * ranks / (box.discs - 1)
    return [to_rgb(colormaps["turbo"](shade)) for shade in shades]


def draw_world_lines(box, rows, radius):
    """Draw the positions of the discs of a ``Box`` along its longer side, against time.

    ``rows`` are the rows of trajectory.csv; the first ones are shown, and discs move freely between
    them. If there are more than ``LINES_PER_PANEL`` discs, this number is drawn, at equal distances
    in their order at the start. The ``radius``, if given, is written above.
    """
    axis, side = longer_axis(box), max(box.width, box.height)
    rows = [row for row in rows if row["event"] not in HOPS][: DISC_BENDS * box.discs + 1]
    times = np.array([row["time"] for row in rows])
    figure, (whole, close) = panels.stacked(whole=2.0, close=2.0)
    shades = disc_colours(box, rows[0])
    whole.set_xlim(times[0], times[-1])
    # A short trajectory has fewer rows than either panel could show.
    close_rows = min(CLOSE_BENDS * box.discs, len(times) * CLOSE_BENDS // DISC_BENDS)
    close.set_xlim(times[0], times[close_rows])
    places = np.array([[row[f"{axis}{disc}"] for row in rows] for disc in range(1, box.discs + 1)])
    shown_discs = np.arange(box.discs)
    if box.discs > LINES_PER_PANEL:
        ranks = np.linspace(0, box.discs - 1, LINES_PER_PANEL).round().astype(int)
        shown_discs = np.argsort(places[:, 0], kind="stable")[ranks]
    for axes, width in ((whole, 0.5), (close, 0.9)):
        shown = places[:, times <= axes.get_xlim()[1]]
        goes_on = axis in box.effects.get("periodic", "")
        low, high = (shown.min(), shown.max()) if goes_on else (-side / 2, side / 2)
        axes.set(xlabel="time $t$ (length/speed)", ylabel=f"${axis}$ (length)", ylim=(low, high))
        for disc in shown_discs:
            axes.plot(times, places[disc], color=shades[disc], lw=width)
    if box.discs <= 8:  # more names have no place
        names = ["disc 1", *map(str, range(2, box.discs + 1))]
        place = {"loc": "outside lower center", "ncols": box.discs}
        figure.legend(close.get_lines(), names, handlelength=1, **place)
    panels.title(whole, "a", box, panels.radius_text(radius))
    if box.discs > LINES_PER_PANEL:
        close.set_title(f"{LINES_PER_PANEL} of the discs", loc="right", pad=3)
    return figure


# Intervals ----------------------------------------------------------------------------------------


#: Densities above this, in units of the mean rate, need logarithmic axes: hops are in bursts.
STEEP_DENSITY = 8

#: The number of bins that can show a density that changes with the room at a hop.
FINE_BINS = 4

#: Points: the width of the dashes that mark exact densities at 0.
DASH_WIDTH = 1.8


def draw_hop_histogram(box, rows):
    """Draw the densities of hop_histogram.csv, in units of the mean interval (``curve``)."""
    figure, (whole, short) = panels.stacked(whole=2.4, short=1.7)
    groups = [list(group) for _, group in groupby(rows, key=lambda row: row["radius"])]
    radii = panels.numbers([group[0]["radius"] for group in groups])
    low, last, first, top, is_marked = 0.1, 1.0, np.inf, 0.0, False
    for i, group in enumerate(groups):
        colour, marker = SERIES[i % len(SERIES)]
        # A curve ends before a bin with fewest intervals; symbols are some mean times apart.
        for axes, bins, fewest, apart in ((whole, "wide", 10, 1.2), (short, "equal", 1, 0.4)):
            own = [row for row in group if row["bins"] in (bins, "own")]
            edges, density, errors = curve(own, fewest)
            if not density.size:
                continue
            middles = (edges[1:] + edges[:-1]) / 2
            wanted = apart * np.arange(0.4 + i / len(groups), middles[-1] / apart)
            at = np.unique(np.searchsorted(middles, wanted))
            axes.stairs(density, edges, baseline=None, color=colour, lw=0.7)
            symbol = panels.open_symbol(colour, marker) | {"label": f"$r={radii[i]}$"}
            axes.errorbar(middles[at], density[at], errors[at], ls="", **symbol)
            if axes is whole:
                low, last = min(low, density.min()), max(last, edges[-1])
            else:
                first, top = min(first, edges[1]), max(top, density.max())
        if box.is_plain:
            is_marked |= _mark_zero(short, box, group[0], colour)
    for axes, end in ((whole, last), (short, 2.5)):
        times = np.linspace(0, end, 60)
        axes.plot(times, np.exp(-times), color=BLACK, ls=(0, (4, 2)), label=r"$e^{-t/\tau}$")
        axes.set(xlim=(0, end), xlabel=r"interval $t/\tau$", ylabel=r"density $\tau\,p(t)$")
    whole.set(yscale="log", ylim=(low / 3, None))
    short.set_ylim(0, None)
    if short.get_ylim()[1] > STEEP_DENSITY:
        short.set(xlim=(first / 2, end), xscale="log", yscale="log")
        short.set_ylim(np.exp(-end) / 2, 2 * top)
    whole.legend(loc="upper right")
    if is_marked:
        exact = Line2D([], [], color=BLACK, lw=DASH_WIDTH, label=r"exact density at $t=0$")
        short.legend(handles=[exact], handlelength=1, loc="upper right")
    panels.title(whole, "a", box, f",  {style.event_name(rows[0]['event'])}")
    return figure


def _mark_zero(axes, box, row, colour):
    """Mark the exact density at 0 if bins are fine enough to show it; return whether they are."""
    scene, hop = box.scene(row["radius"]), row["event"]
    free, across = (scene.width, scene.height)[:: 1 if EVENT_AXES[hop] == "y" else -1]
    sigma = scene.contact_distance
    are_fine = (row["right"] - row["left"]) * FINE_BINS <= min(across - sigma, free - 2 * sigma)
    if are_fine:
        value = row["exact_mean"] * laws.density_at_zero(scene, hop)
        dash = {"color": colour, "lw": DASH_WIDTH, "clip_on": False, "zorder": 5}
        axes.plot([-0.035, 0.035], [value, value], **dash)
    return are_fine


def curve(rows, fewest):
    """Return (edges, density, standard error) in units of the mean interval, exact if it is known.

    ``rows`` are successive bins of one radius. The first bins that have ``fewest`` intervals or
    more are shown; bins before and after them are left out.
    """

    def is_few(row):
        return row["count"] < fewest

    shown = list(takewhile(lambda row: not is_few(row), dropwhile(is_few, rows)))
    mean = rows[0]["exact_mean"] or rows[0]["mean"]
    edges = [row["left"] for row in shown[:1]] + [row["right"] for row in shown]
    values = ([row[name] for row in shown] for name in ("density", "stderr"))
    return np.array(edges) / mean, *(np.array(each, float) * mean for each in values)
