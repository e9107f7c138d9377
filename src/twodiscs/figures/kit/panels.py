"""Estimates against exact curves over the radius, with residuals beneath.

A series is drawn from rows of a table: the exact curve on top of open symbols with error bars, one
standard error each. Rows without an error are crosses. If no event was counted, an arrow begins at
the lower bound of the mean time. Vertical lines through both panels mark the radii at which a
regime ends, with names above.
"""

import math
import re
from dataclasses import dataclass
from itertools import cycle

import numpy as np
from matplotlib import rcParams
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke
from matplotlib.ticker import FuncFormatter

from twodiscs.figures.kit import drawing
from twodiscs.figures.kit.captions import is_judged
from twodiscs.figures.kit.limits import limits
from twodiscs.figures.kit.style import BLACK, COLUMN, GREY, SERIES, SIZES, new_figure
from twodiscs.model.effects import EFFECTS

#: Inches: margins, the panel of the curves, the gap and the panel of the residuals.
LEFT, RIGHT, BOTTOM, TOP = 0.48, 0.1, 0.34, 0.3
MAIN, GAP, LOWER = 1.9, 0.07, 0.82

#: Inches and points: a second line above, for the box and its effects.
LINE, ABOVE = 0.13, 14

#: Points by which the name of a box moves aside for the power of ten of the ordinate.
FACTOR = 9

#: The most digits of a box and a radius that leave space for something beside them.
BESIDE = 11

#: The most pieces of a heading (the box, its effects and additions) in one line.
PIECES = 3

#: The texts of what a box calls for in mathtext, {name: format}, in their order.
SYMBOLS = {"discs": "${}$ discs"} | {name: EFFECTS[name].symbol for name in sorted(EFFECTS)}

#: Residuals beyond this many standard errors are drawn as triangles at the edge.
LARGEST_RESIDUAL = 6.5

#: Guide lines: 95 % of all residuals are within the inner ones; no test passes beyond 5.
GUIDES = {2: (0, (4, 2)), 5: (0, (1, 1.5))}


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


def panels(box, label, beneath=0, judged=True):
    """Return (figure, main axes, axes of the residuals) for curves over the radius.

    ``label`` is the label of the main ordinate; ``beneath`` is the space for another panel, in
    inches. Unless the estimates are ``judged``, there is no panel of residuals, but None.
    """
    line = 0 if is_short(box) else LINE
    under = LOWER + GAP if judged else 0
    figure = new_figure(beneath + BOTTOM + under + MAIN + TOP + line + room(box))
    main = add_panel(figure, beneath + BOTTOM + under, MAIN, name="main")
    lower = add_panel(figure, beneath + BOTTOM, LOWER, name="residuals") if judged else None
    main.set_ylabel(label)
    (lower or main).set_xlabel("radius $r$")
    if judged:
        main.tick_params(labelbottom=False)
        lower.set_ylabel("residual $z$")
        scale_residuals(lower)
    mark((main, lower) if judged else (main,), limits(box))
    name_box(main, box, up=ABOVE if line else 0)
    return figure, main, lower


def scale_residuals(lower):
    """Draw the guide lines of residuals, and set the ends of their panel beyond them."""
    lower.set_ylim(-LARGEST_RESIDUAL, LARGEST_RESIDUAL)
    lower.set_yticks([-5, -2, 0, 2, 5])
    lower.axhline(0, color=GREY, lw=0.5, zorder=0)
    for size, dashes in GUIDES.items():
        for z in (-size, size):
            lower.axhline(z, color=GREY, lw=0.5, ls=dashes, zorder=0)


def mark(panels, ends):
    """Mark the limits ``ends`` in all ``panels``, axes from the top; the last ends the abscissa."""
    for axes in panels:
        axes.set_xlim(0, 1.02 * ends[-1][0])
        for radius, _ in ends:
            axes.axvline(radius, color=GREY, lw=0.5, ls=(0, (5, 1.5, 1, 1.5)), zorder=0)
    name_limits(panels[0], ends)


def add_panel(figure, bottom, height, left=LEFT, width=COLUMN - LEFT - RIGHT, name=""):
    """Return new axes at ``left`` and ``bottom``, ``width`` × ``height``, all in inches.

    ``name`` is their label, which identifies them among the axes of the figure.
    """
    across, up = figure.get_size_inches()
    axes = figure.add_axes((left / across, bottom / up, width / across, height / up), label=name)
    # The power of ten of an ordinate is beside the heading.
    axes.yaxis.get_offset_text().set(ha="right", x=-0.01)
    return axes


def math_of(value):
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
    numbers = map(math_of, (box.width, box.height))
    return r"\times".join(f"({side})" if "times" in side else side for side in numbers)


def of_radius(radius):
    """Return the text of a ``radius`` that follows the sides of a box, empty if it is None."""
    return f",  $r={math_of(radius)}$" if radius else ""


def letter(axes, name):
    """Write the letter of a panel beside its upper left corner."""
    align = {"ha": "left", "va": "top", "xycoords": "axes fraction"}
    drawing.label(axes, f"({name})", (0, 1), (2 - 72 * LEFT, 3), **align)


def name_box(axes, box, more="", up=0):
    """Write the sides of the box, ``more`` and the effects above the left end of ``axes``.

    ``up`` is the distance, in points, from the usual height. Lines beyond the first take ``room``.
    """

    def frame(renderer):
        """Return the frame of the axes, moved if a power of ten would look like a factor."""
        beside = not up and axes.yaxis.get_offset_text().get_text()
        return axes.bbox.translated(renderer.points_to_pixels(FACTOR) if beside else 0, 0)

    text = ",\n".join(heading(box, more))
    corner = {"xycoords": frame, "ha": "left", "va": "bottom", "fontsize": 7.5}
    drawing.label(axes, text, (0, 1), (0, 5 + up), **corner)


def is_short(box, radius=0):
    """Return whether the ``heading``, maybe with a ``radius``, leaves space beside it."""
    digits = sum(len(math_of(value)) for value in (box.width, box.height, radius or 0))
    return box.is_plain and digits <= BESIDE


def heading(box, more=""):
    """Return the lines that name the sides of the box, ``more`` and the effects."""
    pieces = [*rf"$w\times h={sides(box)}${more}".split(",  "), *effects(box)]
    return [",  ".join(pieces[i : i + PIECES]) for i in range(0, len(pieces), PIECES)]


def room(box, more=""):
    """Return the inches that lines of the ``heading`` beyond the first one take."""
    return LINE * (len(heading(box, more)) - 1)


def effects(box):
    """Return the number of discs of a ``Box``, if not two, and its effects, as texts in symbols."""
    named = box.calls_for | {"periodic": "$, $".join(box.effects.get("periodic", ""))}
    return [powers(text.format(named[name])) for name, text in SYMBOLS.items() if named.get(name)]


def name_limits(axes, ends):
    """Write the names of the limits above ``axes``, moved apart if they would overlap."""
    x0, x1 = axes.get_xlim()
    points = 72 * axes.get_position().width * axes.figure.get_figwidth() / (x1 - x0)
    renderer = axes.figure.canvas.get_renderer()
    texts = [
        axes.annotate(f"${name}$", (0, 1), xycoords="axes fraction", fontsize=7.5, va="bottom")
        for _, name in ends
    ]
    scale = 72 / axes.figure.dpi
    widths = [text.get_window_extent(renderer).width * scale for text in texts]
    wanted = [(radius - x0) * points for radius, _ in ends]
    most = (x1 - x0) * points + 72 * RIGHT - 1
    for text, x, middle in zip(texts, wanted, spread(wanted, widths, 4, most), strict=True):
        text.remove()
        pointer = {"arrowstyle": "-", "color": GREY, "linewidth": 0.5, "shrinkA": 0, "shrinkB": 0}
        drawing.label(
            axes, text.get_text(), (x / points, 1), (middle - x, 5),
            xycoords=("data", "axes fraction"), va="bottom", fontsize=7.5,
            arrowprops=pointer | {"relpos": (0.5, 0)},
        )  # fmt: skip


def spread(wanted, widths, gap, most):
    """Return middles for intervals of ``widths``, in order, ``gap`` apart, near those ``wanted``.

    Intervals that would overlap become a block around the mean of their wanted middles; none ends
    beyond ``most``.
    """
    blocks = []
    for middle, width in zip(wanted, widths, strict=True):
        block = [middle - width / 2, [width]]
        while blocks and blocks[-1][0] + sum(blocks[-1][1]) + gap * len(blocks[-1][1]) > block[0]:
            left, before = blocks.pop()
            length = sum(before) + gap * len(before)
            share = len(before) / (len(before) + len(block[1]))
            block = [left * share + (block[0] - length) * (1 - share), before + block[1]]
        blocks.append(block)
    middles, end = [], most
    for left, members in reversed(blocks):
        right = min(end, left + sum(members) + gap * (len(members) - 1))
        for width in reversed(members):
            middles.append(right - width / 2)
            right -= width + gap
        end = right
    return middles[::-1]


def with_looks(series):
    """Return ((colour, marker), ``Series``) for each of the ``series``."""
    return [(part.look or look, part) for look, part in zip(cycle(SERIES), series, strict=False)]


def draw_series(main, lower, radii, series, single=False):
    """Draw the ``series`` in both panels; a ``single`` one has its curve in black.

    ``lower`` is None if there are no residuals.
    """
    for (colour, marker), part in with_looks(series):
        main.plot(radii, part.exact, color=BLACK if single else colour, zorder=5)
        estimates(main, part.rows, colour, marker)
        if lower:
            residuals(lower, part.rows, colour, marker)


#: The style of a limiting law, and its name in a legend.
LAW = {"color": BLACK, "lw": 0.7, "ls": (0, (4, 2)), "zorder": 6}
LAW_NAME = "limiting law"


def asymptote(axes, x, y):
    """Draw a limiting law."""
    axes.plot(x, y, **LAW)


def _column(rows, *names):
    return [[row[name] for row in rows] for name in names]


def estimates(axes, rows, colour, marker):
    """Draw the estimates of ``rows`` over their radii; estimates from a strip have full symbols."""
    known = [row for row in rows if row["estimate"] is not None and row["stderr"] is not None]
    rough = [row for row in rows if row["estimate"] is not None and row["stderr"] is None]
    bound = [row for row in rows if row["estimate"] is None and row.get("bound") is not None]
    for shown, style in by_start(known, open_symbol(colour, marker)):
        r, y, s = _column(shown, "radius", "estimate", "stderr")
        axes.errorbar(r, y, s, ls="", elinewidth=0.6, **style, zorder=3)
    axes.plot(*_column(rough, "radius", "estimate"), "x", color=colour, zorder=3)
    r, y = _column(bound, "radius", "bound")
    axes.errorbar(r, y, [0.4 * b for b in y], lolims=True, ls="", color=colour, elinewidth=0.6)


def by_start(rows, style):
    """Yield (rows, style of symbols); rows from a strip, if there are any, have full symbols."""
    strips = [row for row in rows if row.get("starts") == "strip"]
    yield [row for row in rows if row not in strips], style
    if strips:
        yield strips, style | {"markerfacecolor": style["color"]}


def open_symbol(colour, marker, scale=1):
    """Return the settings of an open symbol, ``scale`` times as large as usual."""
    size = scale * SIZES[marker]
    return {"color": colour, "marker": marker, "markersize": size, "markerfacecolor": "white"}


def residuals(axes, rows, colour, marker):
    """Draw the residuals of ``rows`` over their radii, except the certain ones."""
    rows = [row for row in rows if is_judged(row)]
    for shown, symbol, clip in (
        ([r for r in rows if abs(r["z"]) <= LARGEST_RESIDUAL], marker, 1),
        ([r for r in rows if r["z"] > LARGEST_RESIDUAL], "^", 0.97),
        ([r for r in rows if r["z"] < -LARGEST_RESIDUAL], "v", 0.97),
    ):
        r, z = _column(shown, "radius", "z")
        z = [math.copysign(min(abs(v), clip * LARGEST_RESIDUAL), v) for v in z]
        style = open_symbol(colour, symbol) if clip == 1 else {"color": colour, "marker": symbol}
        axes.plot(r, z, ls="", **style | {"markersize": 0.75 * SIZES[symbol] if clip == 1 else 2.6})


#: A legend with the distance of a letter's height from the symbols that it can avoid.
CLEAR = {"borderpad": 1.2, "borderaxespad": -0.6}


def legend(axes, box, series, loc, single=None, more=()):
    """Explain the symbols at a ``loc``; ``single`` names the method of the only series.

    ``more`` are (name, style) of other lines. Series without a visible value, of impossible events,
    are left out. ``loc`` is a corner in matplotlib's words, or "best": a ``box`` with effects
    always has "best", the emptiest place.
    """
    loc = loc if box.is_plain else "best"
    handles, names = [], []
    for (colour, marker), part in with_looks(series):
        style = open_symbol(colour, marker)
        if single and not np.any(np.isfinite(part.exact)):
            handles += axes.plot([], [], ls="", **style)
            names.append(single)
        elif single:
            handles += axes.plot([], [], color=BLACK) + axes.plot([], [], ls="", **style)
            names += ["exact", single]
        elif part.is_visible():
            handles += axes.plot([], [], ls="-" if np.any(part.exact > 0) else "", **style)
            names.append(part.name)
    for name, style in more:
        handles.append(Line2D([], [], **style))
        names.append(name)
    made = axes.legend(handles, names, loc=loc, **CLEAR)
    if len(names) > 4:  # no place without a curve is large enough
        made.set_zorder(7)
        for text in made.get_texts():
            text.set(fontsize=6.3, path_effects=[withStroke(linewidth=2, foreground="white")])


#: The least ratio of the ends of a logarithmic ordinate: there is a tick or two within.
LEAST = 3


def logarithmic(axes, radii, series):
    """Make the ordinate logarithmic, with a range for all estimates and most of the curves."""
    seen = [row["estimate"] or row.get("bound") for part in series for row in part.rows]
    ends = radii[np.flatnonzero(np.isnan(radii)) - 1]
    largest = ends[-1]
    clear = (np.abs(radii[:, None] - ends) > 0.05 * largest).all(axis=1) & (radii > 0.1 * largest)
    shown = [value for part in series for value in part.exact[clear] if value > 0]
    shown += [value for value in seen if value]
    low, high = min(shown, default=1.0), max(shown, default=1.0)
    room = max((high / low) ** 0.06, (LEAST * low / high) ** 0.5)
    axes.set_yscale("log")
    axes.set_ylim(low / room, high * room)
    label_decades(axes.yaxis, high / low)


def label_decades(axis, ratio):
    """Label a logarithmic ``axis``, between decades too if its ends have a ``ratio`` below 100.

    These labels are at 2 and 5 or, below a ratio of 3, at every tick. A power of ten of small or
    large numbers is at the end of the axis, as on linear axes.
    """
    if ratio < 100:
        digits = "25" if ratio >= 3 else "123456789"
        power = math.floor(math.log10(max(axis.get_view_interval())))
        low, high = rcParams["axes.formatter.limits"]
        unit = 1.0 if low < power < high else float(f"1e{power}")
        major = FuncFormatter(lambda x, _: f"{x / unit:g}")
        major.set_offset_string("" if unit == 1.0 else rf"$\times10^{{{power}}}$")
        axis.set_major_formatter(major)
        axis.set_minor_formatter(lambda x, _: major(x) if f"{x:e}"[0] in digits else "")
    else:
        axis.set_minor_formatter("")
