"""Cases for tests of figures: boxes, tables drawn from the exact theory, the texts in figures."""

import re
from functools import cache
from itertools import combinations, pairwise
from unittest.mock import patch

import numpy as np
from factory import empty
from matplotlib.collections import LineCollection
from matplotlib.colors import to_hex, to_rgb
from matplotlib.legend import Legend
from matplotlib.lines import Line2D
from matplotlib.path import Path
from matplotlib.text import Text
from matplotlib.transforms import Bbox

from twodiscs.analysis.tables import SCENE_TABLES
from twodiscs.dynamics.runs import wide_edges
from twodiscs.figures import style
from twodiscs.figures.draw import draw as draw_figure
from twodiscs.figures.scene_figures import FIGURES
from twodiscs.model.events import HOPS
from twodiscs.model.scene import Box
from twodiscs.theory import exact
from twodiscs_paper.configuration.radii import radii

BOXES = {
    "paper": Box(1.5, 1.0),
    "long": Box(3.0, 1.0),
    "square": Box(1.0, 1.0),
    "tall": Box(1.0, 1.5),
    "double": Box(2.0, 1.0),
    "nearly square": Box(1.05, 1.0),
    "ten": Box(10.0, 1.0),
    "very long": Box(40.0, 1.0),
    "very tall": Box(0.1, 1.0),
    "tiny": Box(3e-6, 1e-5),
    "small": Box(0.03, 0.02),
    "large": Box(1.5e5, 1e5),
}
PAPER = BOXES["paper"]

#: With effects, as many as a figure has to name with three digits each, and with many discs.
EFFECTS = {"radius_ratio": 0.625, "mass_ratio": 0.125, "moment_of_inertia": 0.375}
OTHERS = {"effects": Box(1.55, 1.05, periodic="x", **EFFECTS), "five": Box(1.5, 1.0, discs=5)}


def draw(name, box, tables, **more):
    """Draw a figure of the catalogue as its job does, with the table that it reads."""
    with style.context():
        return draw_figure(name, box, *(tables[table] for table in FIGURES[name].tables), **more)


# Tables -------------------------------------------------------------------------------------------


@cache
def tables_of(name):
    """Return {name: rows} of all tables that figures of one of ``BOXES`` or ``OTHERS`` read.

    They are exact values with Gaussian noise, or numbers near one if no exact value is known. Hops
    that take too long are cut off as the engine does: too few for an error, or none at all.
    """
    rng, box, relative = np.random.default_rng(20), (BOXES | OTHERS)[name], 3e-3
    found = {name: [] for name in ("volume", "areas", "mean_times", "hop_histogram")}
    grid = radii(box.width, box.height, 0.02 * box.shortest, 18)
    for scene in map(box.scene, filter(box.fits, grid)):
        radius = scene.radius
        found["volume"].append(sampled(rng, radius, "volume", exact.volume(scene), relative))
        areas, times = exact.areas(scene), exact.mean_times(scene)
        for event in scene.events:
            found["areas"].append(sampled(rng, radius, f"{event}_area", areas[event], relative))
            found["mean_times"].append(simulated(rng, scene, event, times[event], relative))
        known = {row["radius"] for row in found["hop_histogram"]}
        if scene.is_possible("vertical_hop") and len(known) < 4:
            found["hop_histogram"] += histogram(rng, scene)
    found["trajectory"] = trajectory(rng, box)
    for table, rows in found.items():
        assert all(row.keys() >= SCENE_TABLES[table].columns.keys() for row in rows)
    return found


def noisy(rng, exact, relative):
    """Return estimate, standard error, z; the estimate is near 1 if no exact value is known."""
    z, value = rng.standard_normal(), rng.uniform(0.98, 1.02) if exact is None else exact
    found = {"estimate": value * (1 + relative * z), "stderr": value * relative}
    return found | {"z": None if exact is None else z}


def sampled(rng, radius, quantity, exact, relative):
    """Return a row of volume.csv or areas.csv."""
    row = empty(SCENE_TABLES["areas"], radius=radius, quantity=quantity, exact=exact, hits=10**6)
    if exact == 0:
        return row | {"z": 0.0, "hits": 0, "status": "impossible", "test": "certain"}
    return row | noisy(rng, exact, relative) | {"status": "sampled", "test": "normal"}


def simulated(rng, scene, event, exact, relative):
    """Return a row of mean_times.csv."""
    row = empty(SCENE_TABLES["mean_times"], radius=scene.radius, event=event, exact=exact)
    if not scene.is_possible(event):
        return row | {"z": 0.0, "status": "impossible", "test": "certain"}
    if (exact or 0) > 1e5:
        return row | {"bound": exact / 2, "status": "none-seen"}
    row |= noisy(rng, exact, relative) | {"status": "reached", "test": "normal"}
    row["starts"] = "strip" if (exact or 0) > 5 else "invariant"
    return row | ({"stderr": None, "status": "too-few"} if (exact or 0) > 1e4 else {})


def histogram(rng, scene, intervals=10**6, bins=512):
    """Return the rows of hop_histogram.csv of one radius, with exponential intervals."""
    known = exact.mean_times(scene)["vertical_hop"]
    mean = known or 1.0
    edges = mean / 16 * np.arange(bins + 1)
    chances = -np.diff(np.exp(-edges / mean))
    counts = rng.multinomial(intervals, [*chances, 1 - chances.sum()])
    row = {"radius": scene.radius, "event": "vertical_hop", "intervals": intervals}
    row |= {"exact_mean": known, "mean": mean, "mean_stderr": mean / 1000, "z": 0.0}
    return [
        row
        | {"bins": name, "left": float(edges[i]), "right": float(edges[j]), "count": n}
        | {"density": n * per_count, "stderr": n**0.5 * per_count}
        for name, places in (("equal", range(bins + 1)), ("wide", wide_edges(bins)))
        for i, j in pairwise(places)
        for n, per_count in [(int(counts[i:j].sum()), 1 / ((edges[j] - edges[i]) * intervals))]
    ]


def trajectory(rng, box, events=600):
    """Return rows of a trajectory that hops three times in a row, and once long after that.

    Its lengths are below half of the shortest side, and so are its times apart.
    """
    unit, rows = box.shortest, []
    more = {f"{axis}{n}": 0.1 * unit for n in range(3, box.discs + 1) for axis in "xy"}

    def add(time, event, x):
        places = {"x1": -x, "y1": -0.9 * x, "x2": x, "y2": 0.9 * x} | more
        rows.append(empty(SCENE_TABLES["trajectory"], time=time * unit, event=event, **places))

    side = 2 * (np.searchsorted((90, 91, 92, 400), np.arange(events), side="right") % 2) - 1
    for i, x in enumerate(side * unit * rng.uniform(0.1, 0.4, events)):
        for event, time in zip(HOPS, (i - 0.6, i - 0.5), strict=True):
            if i > 0 and side[i] != side[i - 1]:
                add(time, event, 0)
        add(i, "wall_x1", x)
    return rows


# Artists of a figure ------------------------------------------------------------------------------


def points(axes, colour, marker):
    """Return the set of all (x, y) of the symbols of one look."""
    lines = [n for n in axes.lines if (n.get_color(), n.get_marker()) == (colour, marker)]
    return {(float(x), float(y)) for n in lines for x, y in zip(*n.get_data(), strict=True)}


def bars(axes, colour, marker):
    """Return (x, y, half of its bar) of all symbols of one look that have error bars, by x."""
    found = []
    for line, _, (bar, *_) in axes.containers:
        if (line.get_color(), line.get_marker()) == (colour, marker) and bar.get_segments():
            half = np.ptp(np.array(bar.get_segments())[:, :, 1], axis=1) / 2
            found += zip(line.get_xdata(), line.get_ydata(), half, strict=True)
    return sorted(found)


# Texts --------------------------------------------------------------------------------------------


def shown_texts(figure):
    """Return the visible texts of a figure, each with (left, bottom, right, top) in pixels."""
    found = []
    draw_text = Text.draw

    def record(text, renderer):
        if text.get_visible() and text.get_text().strip():
            found.append((text, Text.get_window_extent(text, renderer).extents.tolist()))
        return draw_text(text, renderer)

    with patch.object(Text, "draw", record):
        figure.draw_without_rendering()
    return found


#: Pixels of the rim by which texts may overlap and touch a line; the least contrast on white.
RIM, CONTRAST = 6, 4.5

#: A label with one of these quantities needs a unit.
QUANTITY = re.compile(r"(?<!\\)\b(times?|radius|area|volume|distance|interval)\b|^\$[xyz](_|\$)")


def unclear(figure):
    """Return the faults of a figure, each as its kind and what has it.

    An axis with numbers has "no label". A label has no "unit". A text is "beyond" the figure,
    "pale" on white, on an "other" text, or on a "line", an edge or a symbol, if no white box or rim
    of the text covers them. Others are ``misnamed``.
    """
    texts = shown_texts(figure)
    (width, height), named = figure.bbox.size, [(t.get_text(), b) for t, b in texts]
    edges = [(e, c.extents.tolist()) for axes in figure.axes for e, c in edges_of(axes)]
    bare = [(t, b) for t, b in texts if t.get_bbox_patch() is None and not t.get_path_effects()]
    shown = [one for a in figure.axes if a.axison for one in (a.xaxis, a.yaxis)]
    labels = [one.get_label_text() for one in shown]
    nameless = [one for one, label in zip(shown, labels, strict=True) if not label]
    return [
        *(("no label", one.axes.get_label()) for one in nameless if has_numbers(one)),
        *(("unit", label) for label in labels if lacks_unit(label)),
        *(("beyond", t) for t, b in named if min(b) < 0 or b[2] > width or b[3] > height),
        *(("pale", t.get_text()) for t, _ in texts if contrast(t.get_color()) < CONTRAST),
        *(("other", s, t) for (s, a), (t, b) in combinations(named, 2) if shared(a, b)),
        *(("line", t.get_text()) for t, b in bare if any(on(shared(b, c), e) for e, c in edges)),
        *misnamed(figure),
    ]


def misnamed(figure):
    """Return the faults of names in a figure, which need no layout, as ``unclear`` does.

    Symbols are "unnamed" if no legend has their colour, marker and filling. Each may stand in
    another entry, and a filling in a grey one. A name has "no legend", unless it is the only one,
    or is "twice" in one. A whole number is at another "tick", on an axis with no power of ten at
    its end. The "letter" of a panel is not the next one.
    """
    keys = [[text.get_text() for text in key.get_texts()] for key in figure.findobj(Legend)]
    names = {name for axes in figure.axes for name in axes.get_legend_handles_labels()[1]}
    letters = [a.get_title("left")[1] for a in figure.axes if a.get_title("left")[:1] == "("]
    axs = [k for a in figure.axes for k in (a.xaxis, a.yaxis) if not k.major.formatter.get_offset()]
    ticks = [(t.get_text(), t.get_position()) for k in axs for t in k.get_ticklabels(which="both")]
    return [
        *(("unnamed", *one) for one in sorted(unnamed_looks(figure))),
        *(("no legend", one) for one in names.difference(*keys) if keys or len(names) > 1),
        *(("twice", *key) for key in keys if len({*key}) < len(key)),
        *(("tick", text) for text, xy in ticks if text.isdecimal() and int(text) not in xy),
        *(("letter", one) for one, due in zip(letters, "abcdefgh", strict=False) if one != due),
    ]


def has_numbers(axis):
    """Return whether numbers stand beside an ``axis``, and not names or nothing."""
    texts = [one.get_text() for one in axis.get_ticklabels() if one.get_visible()]
    return any(re.fullmatch(r"[^a-zA-Z]*\d[^a-zA-Z]*", re.sub(r"\\[a-z]+", "", t)) for t in texts)


def lacks_unit(label):
    """Return whether a ``label`` has a time, a length or so with no unit, and not as a ratio.

    Residuals and exponents of a quantity have none.
    """
    text, formulas = re.sub(r"\$.*?\$", "", label), re.findall(r"\$(.*?)\$", label)
    if re.match("residual|exponent", text):
        return False
    ratio = " / " in text or (formulas and all("/" in formula for formula in formulas))
    return bool(QUANTITY.search(label)) and not re.search(r"\((length|s\))", text) and not ratio


def shared(one, other):
    """Return what two boxes in pixels share, or None if it is not larger than a rim."""
    left, bottom = map(max, one[:2], other[:2])
    right, top = map(min, one[2:], other[2:])
    if min(right - left, top - bottom) > RIM:
        return Bbox.from_extents(left, bottom, right, top).padded(-RIM / 2)


def on(box, edge):
    """Return whether an ``edge`` of ``edges_of`` has a line or a point in a ``box``, or None."""
    if box is None or isinstance(edge, np.ndarray):
        return box is not None and box.count_contains(edge) > 0
    return any(Path(n).intersects_bbox(box, False) for n in edge.to_polygons(closed_only=False))


def contrast(colour):
    """Return the contrast of a ``colour`` on white, as the guidelines of web pages define it."""
    parts = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in to_rgb(colour)]
    return 1.05 / (np.dot(parts, (0.2126, 0.7152, 0.0722)) + 0.05)


def edges_of(axes):
    """Yield (path of a line, or array of points, and the box where it is drawn), in pixels."""
    for line in axes.lines:
        clip = axes.bbox if line.get_clip_on() else axes.figure.bbox
        if line.get_linestyle() != "None":
            yield line.get_transform().transform_path(line.get_path()), clip
        if line.get_marker() != "None":
            yield line.get_transform().transform(line.get_xydata()), clip
    for bar in axes.findobj(LineCollection):
        for path in bar.get_paths():
            yield bar.get_transform().transform_path(path), axes.bbox
    arrows = [text.arrow_patch for text in axes.texts if text.arrow_patch]
    for patch_ in [*axes.patches, *arrows, *(axes.spines.values() if axes.axison else ())]:
        if patch_.get_linewidth() and patch_.get_edgecolor()[3]:
            yield patch_.get_transform().transform_path(patch_.get_path()), axes.figure.bbox


def look(line):
    """Return (colour, marker, filling) of the symbols of a ``line``."""
    marker = line.get_marker()
    if marker not in Line2D.filled_markers:
        return to_hex(line.get_color()), marker if isinstance(marker, str) else r"$\uparrow$", ""
    is_open = to_hex(line.get_markerfacecolor()) == "#ffffff"
    return to_hex(line.get_color()), marker, "open" if is_open else "full"


def unnamed_looks(figure):
    """Return the looks of symbols that no legend names."""
    keys = figure.findobj(Legend)
    named = {look(line) for key in keys for line in key.findobj(Line2D)}
    colours = {colour for colour, *_ in named}
    grey = (style.BLACK, to_hex(style.GREY))
    fillings = {filling for colour, _, filling in named if colour in grey}
    drawn = {
        look(line)
        for axes in figure.axes
        for line in axes.lines
        if axes.axison
        and line.get_marker() != "None"
        and axes.bbox.count_contains(line.get_transform().transform(line.get_xydata()))
    }
    if not keys and len(drawn) == 1:  # the label of the axis names it
        return set()
    markers = {marker for _, marker, _ in named}
    return {
        (colour, marker, filling)
        for colour, marker, filling in drawn - named
        if not (colour in colours and marker in markers and filling in fillings | {""})
    }
