"""Estimates against exact curves over the radius, with residuals beneath.

A series is drawn from rows of a table: the exact curve on top of open symbols with error bars, one
standard error each. Rows without an error are crosses. If no event was counted, an arrow begins at
the lower bound of the mean time. A legend names crosses and arrows if there are any. Vertical lines
through both panels mark the radii at which a regime ends, with names above.
"""

import math
import re
from dataclasses import dataclass
from functools import partial
from itertools import cycle

import numpy as np
from matplotlib import rcParams
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter

from twodiscs.figures import drawing
from twodiscs.figures.curves import limits
from twodiscs.figures.style import BLACK, COLUMN_WIDTH, GREY, MARKER_SIZES, SERIES, new_figure
from twodiscs.model.effects import EFFECTS

#: Inches: the panels of curves and of residuals, with their labels.
MAIN_HEIGHT, RESIDUALS_HEIGHT = 2.3, 0.95

#: Points: the distance of a title above names of limits.
TITLE_PAD = 14

#: The texts of what a box calls for in mathtext, {name: format}, in their order.
SYMBOLS = {"discs": "${}$ discs"} | {name: EFFECTS[name].symbol for name in sorted(EFFECTS)}

#: Residuals beyond this many standard errors are drawn as triangles at the edge.
LARGEST_RESIDUAL = 6.5

#: Guide lines of residuals: 95 % are within the inner ones; no test passes beyond 5.
RESIDUAL_GUIDES = {0: "-", -2: (0, (4, 2)), 2: (0, (4, 2)), -5: (0, (1, 1.5)), 5: (0, (1, 1.5))}


@dataclass(frozen=True)
class Series:
    """One quantity: its name in the legend, rows of a table, exact values along the curve.

    ``look`` is (colour, marker); without it the order of the series decides.
    """

    name: str
    rows: list
    exact: np.ndarray
    look: tuple | None = None

    def is_visible(self):
        """Return whether there is a positive value to be drawn."""
        drawn = (row["estimate"] or row.get("bound") for row in self.rows)
        return bool(np.any(self.exact > 0)) or any(drawn)


def radius_panels(box, label, judged=True, beneath=False):
    """Return (figure, main axes, axes of residuals, axes beneath) for curves over the radius.

    ``label`` is the label of the main ordinate. The axes of residuals are None unless the estimates
    are ``judged``, the axes beneath unless there are any ``beneath``.
    """
    heights = {"main": MAIN_HEIGHT}
    heights |= {"residuals": RESIDUALS_HEIGHT} if judged else {}
    heights |= {"beneath": 1.7} if beneath else {}
    figure, axes = _column_of_panels(COLUMN_WIDTH, heights)
    main, lower = axes["main"], axes.get("residuals")
    over_radius(box, label, main, lower)
    title(main, "a" if beneath else "", box, up=TITLE_PAD)
    if beneath:
        title(axes["beneath"], "b")
    return figure, main, lower, axes.get("beneath")


def over_radius(box, label, main, lower):
    """Label curves over the radius and their residuals, None without, and mark limits of a box."""
    main.set_ylabel(label)
    (lower or main).set_xlabel("radius $r$ (length)")
    if lower:
        main.tick_params(labelbottom=False)
        lower.set_ylabel("residual $z$")
        scale_residuals(lower)
    mark([main, lower] if lower else [main], limits(box))


def _column_of_panels(width, heights):
    """Return (figure, {name: axes}) of panels above each other, with ``heights`` by name."""
    figure = new_figure(sum(heights.values()), width, layout="constrained")
    rows = [[name] for name in heights]
    return figure, figure.subplot_mosaic(rows, height_ratios=[*heights.values()])


def stacked(width=COLUMN_WIDTH, **heights):
    """Return (figure, its axes) of lettered panels above each other.

    ``heights`` are inches, with labels and titles, by the names of the panels from the top down.
    """
    figure, axes = _column_of_panels(width, heights)
    for one, letter in zip(axes.values(), "abcdefgh", strict=False):
        title(one, letter)
    return figure, [*axes.values()]


def title(axes, letter, box=None, more="", up=3):
    """Write the ``letter`` of a panel, the sides of its box, ``more`` and its effects above it.

    ``up`` is the distance from the panel, in points.
    """
    words = [f"({letter})"] if letter else []
    if box is not None:
        words.append(",\n".join(heading(box, more)))
    axes.set_title("  ".join(words), loc="left", pad=up)


def scale_residuals(lower):
    """Draw the guide lines of residuals, and set the ends of their panel beyond them."""
    lower.set(ylim=(-LARGEST_RESIDUAL, LARGEST_RESIDUAL), yticks=sorted(RESIDUAL_GUIDES))
    for z, dashes in RESIDUAL_GUIDES.items():
        lower.axhline(z, color=GREY, lw=0.5, ls=dashes, zorder=0)


def mark(panels, ends):
    """Mark the limits ``ends`` in all ``panels``, axes from the top; the last ends the abscissa."""
    last = 1.02 * ends[-1][0]
    for axes in panels:
        axes.set_xlim(0, last)
        for radius, _ in ends:
            axes.axvline(radius, color=GREY, lw=0.5, ls=(0, (5, 1.5, 1, 1.5)), zorder=0)
    groups = [[ends[0]]]
    for end in ends[1:]:
        if end[0] - groups[-1][-1][0] < 0.12 * last:  # their names are written as one
            groups[-1].append(end)
        else:
            groups.append([end])
    at_top = {"xycoords": ("data", "axes fraction"), "va": "bottom", "fontsize": 7.5}
    for group in groups:
        middle = sum(radius for radius, _ in group) / len(group)
        names = r",\,".join(name for _, name in group)
        drawing.label(panels[0], f"${names}$", (middle, 1), (0, 3), **at_top)


def add_panel(figure, bottom, height, left, width):
    """Return new axes at ``left`` and ``bottom``, ``width`` × ``height``, all in inches."""
    across, up = figure.get_size_inches()
    axes = figure.add_axes((left / across, bottom / up, width / across, height / up))
    # The power of ten of an ordinate is beside the heading.
    axes.yaxis.get_offset_text().set(ha="right", x=-0.01)
    return axes


def mathtext(value):
    """Return a ``value`` in mathtext: 0.25, or 3 × 10⁻⁶ if it is very small or large."""
    return powers(f"{value:g}")


def numbers(values):
    """Return ``values`` in mathtext, all with powers of ten if any is very small or large."""
    texts = [f"{value:g}" for value in values]
    if any("e" in text for text in texts):
        parts = (f"{value:.5e}".split("e") for value in values)
        texts = [f"{float(digits):g}e{power}" for digits, power in parts]
    return [powers(text) for text in texts]


def powers(text):
    """Return a ``text`` in mathtext with 3e-06 written as 3 × 10⁻⁶, and 1e-06 as 10⁻⁶."""

    def power(number):
        times = "" if number[1] == "1" else rf"{number[1]}\times"
        return f"{times}10^{{{int(number[2])}}}"

    return re.sub(r"\b([\d.]+)e([+-]\d+)\b", power, text)


def sides(box):
    """Return the sides of a ``Box`` in mathtext."""
    numbers = map(mathtext, (box.width, box.height))
    return r"\times".join(f"({side})" if "times" in side else side for side in numbers)


def radius_text(radius):
    """Return the text of a ``radius`` that follows the sides of a box, empty if it is None."""
    return f",  $r={mathtext(radius)}$" if radius else ""


def heading(box, more=""):
    """Return the lines that name the sides of the box, ``more`` and the effects."""
    pieces = [*rf"$w\times h={sides(box)}${more}".split(",  "), *effects(box)]
    return [",  ".join(pieces[i : i + 3]) for i in range(0, len(pieces), 3)]


def effects(box):
    """Return the number of discs of a ``Box``, if not two, and its effects, as texts in symbols."""
    named = box.options | {"periodic": "$, $".join(box.effects.get("periodic", ""))}
    return [powers(text.format(named[name])) for name, text in SYMBOLS.items() if named.get(name)]


def assign_looks(series):
    """Return ((colour, marker), ``Series``) for each of the ``series``."""
    return [(part.look or look, part) for look, part in zip(cycle(SERIES), series, strict=False)]


def draw_exact(axes, radii, exact, colour):
    """Draw exact values as a curve, or as bars if each radius is alone."""
    alone = np.all(np.isnan(radii[1::2]))
    axes.plot(radii, exact, color=colour, marker="_" if alone else None, zorder=5)


def draw_series(main, lower, radii, series, single=False):
    """Draw the ``series`` in both panels; a ``single`` one has its curve in black.

    ``lower`` is None if there are no residuals.
    """
    for (colour, marker), part in assign_looks(series):
        draw_exact(main, radii, part.exact, BLACK if single else colour)
        draw_estimates(main, part.rows, colour, marker)
        if lower:
            draw_residuals(lower, part.rows, colour, marker)


#: The style of a limiting law, and its name in a legend.
LAW_LOOK = {"color": BLACK, "lw": 0.7, "ls": (0, (4, 2)), "zorder": 6}
LAW_NAME = "limiting law"


def _column(rows, *names):
    return [[row[name] for row in rows] for name in names]


#: The names in a legend of estimates from a strip, of those from too few events for an error, and
#: of bounds; their looks.
STRIP_LOOK = ("from strips", {"color": GREY, "marker": "o", "ms": MARKER_SIZES["o"], "ls": ""})
CROSS_LOOK = ("too few events", {"color": GREY, "marker": "x", "ls": ""})
ARROW_LOOK = ("95 % lower bound", {"color": GREY, "marker": r"$\uparrow$", "ls": ""})


def split_by_error(rows):
    """Return the estimates of ``rows`` with an error, those without one, and the bounds."""
    known = [row for row in rows if row["estimate"] is not None and row["stderr"] is not None]
    rough = [row for row in rows if row["estimate"] is not None and row["stderr"] is None]
    return known, rough, [r for r in rows if r["estimate"] is None and r.get("bound") is not None]


def draw_estimates(axes, rows, colour, marker):
    """Draw the estimates of ``rows`` over their radii; estimates from a strip have full symbols."""
    known, rough, bound = split_by_error(rows)
    for shown, style in split_by_start(known, open_symbol(colour, marker)):
        r, y, s = _column(shown, "radius", "estimate", "stderr")
        axes.errorbar(r, y, s, ls="", elinewidth=0.6, **style, zorder=3)
    axes.plot(*_column(rough, "radius", "estimate"), "x", color=colour, zorder=3)
    r, y = _column(bound, "radius", "bound")
    axes.errorbar(r, y, [0.4 * b for b in y], lolims=True, ls="", color=colour, elinewidth=0.6)


def split_by_start(rows, style):
    """Yield (rows, style of symbols); rows from a strip, if there are any, have full symbols."""
    strips = [row for row in rows if row.get("starts") == "strip"]
    yield [row for row in rows if row not in strips], style
    if strips:
        yield strips, style | {"markerfacecolor": style["color"]}


def open_symbol(colour, marker, scale=1):
    """Return the settings of an open symbol, ``scale`` times as large as usual."""
    size = scale * MARKER_SIZES[marker]
    return {"color": colour, "marker": marker, "markersize": size, "markerfacecolor": "white"}


def legend_style(series, colour, marker):
    """Return the settings of a ``Series`` in a legend: a symbol only if it has estimates."""
    return open_symbol(colour, marker) if series.rows else {"color": colour}


def is_judged(row):
    """Return whether the residual of a ``row`` is drawn: there is one, and it may differ from 0."""
    return row.get("z") is not None and row.get("test") != "certain"


def draw_residuals(axes, rows, colour, marker):
    """Draw the residuals of ``rows`` over their radii, except the certain ones."""
    rows = [row for row in rows if is_judged(row)]
    for shown, symbol, clip in (
        ([r for r in rows if abs(r["z"]) <= LARGEST_RESIDUAL], marker, 1),
        ([r for r in rows if r["z"] > LARGEST_RESIDUAL], "^", 0.97),
        ([r for r in rows if r["z"] < -LARGEST_RESIDUAL], "v", 0.97),
    ):
        r, z = _column(shown, "radius", "z")
        z = [math.copysign(min(abs(v), clip * LARGEST_RESIDUAL), v) for v in z]
        style = {"color": colour, "marker": symbol, "markersize": 2.6}
        axes.plot(r, z, ls="", **(open_symbol(colour, symbol, 0.75) if clip == 1 else style))


def legend(axes, series, single=None, more=()):
    """Explain the symbols at the emptiest place; ``single`` names the method of the only series.

    ``more`` are (name, style) of other lines. Series without a visible value, of impossible events,
    are left out.
    """
    entries = []
    for (colour, marker), part in assign_looks(series):
        style = legend_style(part, colour, marker)
        if single and (not part.rows or np.any(np.isfinite(part.exact))):
            entries.append(("exact", {"color": BLACK}))
        if single and part.rows:
            entries.append((single, style | {"ls": ""}))
        if not single and part.is_visible():
            line = "-" if np.any(part.exact > 0) else ""
            entries.append((part.name, style | {"ls": line}))
    known, *special = split_by_error([row for part in series for row in part.rows])
    special = [[row for row in known if row.get("starts") == "strip"], *special]
    entries += more
    looks = zip((STRIP_LOOK, CROSS_LOOK, ARROW_LOOK), special, strict=True)
    entries += [look for look, rows in looks if rows]
    names = [name for name, _ in entries]
    handles = [Line2D([], [], **style) for _, style in entries]
    if len(names) > 4:  # no place without a curve is large enough
        axes.figure.legend(handles, names, loc="outside lower center", ncols=3)
    else:
        # A letter's height away from the symbols that it can avoid.
        axes.legend(handles, names, loc="best", borderpad=1.2, borderaxespad=-0.6)


def logarithmic(axes, radii, series):
    """Make the ordinate logarithmic, with a range for all estimates and most of the curves."""
    estimates = [row["estimate"] or row.get("bound") for part in series for row in part.rows]
    ends = radii[np.flatnonzero(np.isnan(radii)) - 1]
    largest = max(ends, default=0.0)
    clear = (np.abs(radii[:, None] - ends) > 0.05 * largest).all(axis=1) & (radii > 0.1 * largest)
    clear |= np.all(np.isnan(radii[1::2]))  # single radii are no curves that leave the panel
    values = [value for part in series for value in part.exact[clear] if value > 0]
    values += [value for value in estimates if value]
    low, high = min(values, default=1.0), max(values, default=1.0)
    # Between ends of the ratio 3 there is a tick or two.
    margin = max((high / low) ** 0.06, (3 * low / high) ** 0.5)
    axes.set_yscale("log")
    axes.set_ylim(low / margin, high * margin)
    label_decades(axes.yaxis, high / low)


def _plain_numbers(digits, power):
    """Return labels of ticks as numbers over 10^``power``, at the ticks that begin with a digit."""
    labels = FuncFormatter(partial(_plain_number, digits, power))
    labels.set_offset_string(rf"$\times10^{{{power}}}$" if power else "")
    return labels


def _plain_number(digits, power, x, place):
    """Return the text of a label at ``x``, whatever its ``place``: "" if no digit begins it."""
    return f"{x / 10.0**power:g}" if f"{x:e}"[0] in digits else ""


def label_decades(axis, ratio):
    """Label a logarithmic ``axis``, between decades too if its ends have a ``ratio`` below 100.

    These labels are at 2 and 5 or, below a ratio of 3, at 2, 3, 5 and 7. A power of ten of small or
    large numbers is at the end of the axis, as on linear axes.
    """
    if ratio >= 100:
        axis.set_minor_formatter("")
        return
    digits = "25" if ratio >= 3 else "12357"
    power = math.floor(math.log10(max(axis.get_view_interval())))
    low, high = rcParams["axes.formatter.limits"]
    power = 0 if low < power < high else power
    axis.set_major_formatter(_plain_numbers("123456789", power))
    axis.set_minor_formatter(_plain_numbers(digits, power))
