"""Figures: they draw for every box and every table, with nothing overlapping, to the same bytes."""

import ast
import os
import re
import subprocess
import sys
from importlib import import_module
from itertools import combinations, pairwise
from pathlib import Path

import matplotlib
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from twodiscs.cli import figure as command
from twodiscs.comparison import tables
from twodiscs.figures import catalogue, hop_histogram, hopping_trajectory
from twodiscs.figures.catalogue import FIGURES, SHARED
from twodiscs.figures.kit import curves, limits, panels, style
from twodiscs.figures.kit.limits import limits
from twodiscs.model import radii
from twodiscs.model.events import EVENTS
from twodiscs.model.scene import Scene
from twodiscs.theory import exact

PAPER = (1.5, 1.0)
BOXES = {
    "paper": PAPER,
    "long": (3.0, 1.0),
    "square": (1.0, 1.0),
    "tall": (1.0, 1.5),
    "double": (2.0, 1.0),
    "nearly square": (1.05, 1.0),
    "very long": (40.0, 1.0),
    "very tall": (0.1, 1.0),
}

QUANTITIES = {
    "volume",
    "hop_histogram",
    "trajectory",
    *(f"{event}_{kind}" for event in EVENTS for kind in ("area", "time")),
}


def fabricate(box, count=18, relative=3e-3):
    """Return {name: rows} of all tables of a box: exact values with Gaussian noise.

    Hops that take too long are cut off as the engine does: too few for an error, or none seen.
    """
    rng = np.random.default_rng(20)
    found = {name: [] for name in ("volume", "areas", "mean_times", "hop_histogram")}
    for radius in radii.radii(*box, 0.02 * min(box), count):
        scene = Scene(*box, radius)
        found["volume"].append(sampled(rng, radius, "volume", exact.volume(scene), relative))
        for event, area in exact.areas(scene).items():
            found["areas"].append(sampled(rng, radius, f"{event}_area", area, relative))
        for event, time in exact.mean_times(scene).items():
            found["mean_times"].append(simulated(rng, scene, event, time, relative))
        if scene.vertical_hops and len(found["hop_histogram"]) < 4 * 512:
            found["hop_histogram"] += histogram(rng, scene)
    found["trajectory"] = trajectory(rng)
    for name, rows in found.items():
        assert all(set(row) == set(tables.TABLES[name].names) for row in rows)
    return found


def noisy(rng, exact, relative):
    """Return estimate, standard error, z."""
    z = rng.standard_normal()
    return {"estimate": exact * (1 + relative * z), "stderr": exact * relative, "z": z}


def sampled(rng, radius, quantity, exact, relative):
    """Return a row of volume.csv or areas.csv."""
    row = {"radius": radius, "quantity": quantity, "method": "monte_carlo", "exact": exact}
    row |= {"samples": 10**7, "hits": 10**6, "epsilon": 0.001, "expectation": exact, "bias": 0.0}
    if exact == 0:
        nothing = {"estimate": None, "stderr": None, "z": 0.0, "hits": 0}
        return row | nothing | {"status": "impossible", "test": "certain"}
    return row | noisy(rng, exact, relative) | {"status": "sampled", "test": "normal"}


def simulated(rng, scene, event, exact, relative):
    """Return a row of mean_times.csv."""
    row = {"radius": scene.radius, "event": event, "exact": exact, "count": 1000}
    row |= {"replicas": 1000, "duration": 100.0, "target": relative, "bound": None}
    row |= {"ergodic_components": scene.ergodic_components, "relative_stderr": relative}
    nothing = {"estimate": None, "stderr": None, "relative_stderr": None, "count": 0}
    if exact is None:
        return row | nothing | {"z": 0.0, "status": "impossible", "test": "certain"}
    if exact > 1e5:
        bound = {"bound": exact / 2, "z": None, "status": "none-seen", "test": None}
        return row | nothing | bound
    row |= noisy(rng, exact, relative) | {"status": "reached", "test": "normal"}
    if exact > 1e4:
        row |= {"stderr": None, "relative_stderr": None, "status": "too-few"}
    return row


def histogram(rng, scene, intervals=10**6, bins=512):
    """Return the rows of hop_histogram.csv of one radius, with exponential intervals."""
    mean = exact.mean_times(scene)["vertical_hop"]
    edges = mean / 16 * np.arange(bins + 1)
    chances = -np.diff(np.exp(-edges / mean))
    counts = rng.multinomial(intervals, [*chances, 1 - chances.sum()])
    row = {"radius": scene.radius, "event": "vertical_hop", "intervals": intervals}
    row |= {"exact_mean": mean, "mean": mean, "mean_stderr": mean / 1000, "z": 0.0}
    return [
        row
        | {"left": float(left), "right": float(right), "count": int(n)}
        | {"density": 16 * n / (mean * intervals), "stderr": 16 * n**0.5 / (mean * intervals)}
        for (left, right), n in zip(pairwise(edges), counts[:-1], strict=True)
    ]


def trajectory(rng, events=400):
    """Return rows of a trajectory that stays on one side and hops now and then."""
    side = np.where(np.arange(events) // 90 % 2, 1, -1)
    rows = []
    for i, x in enumerate(side * rng.uniform(0.1, 0.4, events)):
        hop = i > 0 and side[i] != side[i - 1]
        if hop:
            for event in ("horizontal_hop", "vertical_hop"):
                place = dict.fromkeys(("x1", "y1", "x2", "y2"), 0)
                rows.append({"time": i - 0.5, "event": event, **place, "z1": None, "z2": None})
        place = {"x1": -x, "y1": -x, "x2": x, "y2": x, "z1": None, "z2": None}
        rows.append({"time": float(i), "event": "wall_x1", **place})
    return rows


@pytest.fixture(scope="module")
def tables_of():
    """Return a function from the name of a box to its tables."""
    made = {}

    def of(name):
        if name not in made:
            made[name] = fabricate(BOXES[name])
        return made[name]

    return of


def draw(name, box, read):
    scene = {"width": box[0], "height": box[1], "radius": 0.2 * min(box)}
    return import_module(f"twodiscs.figures.{name}").draw(scene, read)


# The catalogue ---------------------------------------------------------------------------------


def test_catalogue_holds_the_modules_that_draw():
    folder = Path(catalogue.__file__).parent
    drawing = {
        path.stem
        for path in folder.glob("*.py")
        for node in ast.parse(path.read_text(encoding="utf-8")).body
        if isinstance(node, ast.FunctionDef) and node.name == "draw"
    }
    assert drawing == set(FIGURES) | set(SHARED)


@pytest.mark.parametrize("name", FIGURES)
def test_entry_is_complete(name):
    entry = FIGURES[name]
    assert set(entry.tables) <= set(tables.TABLES)
    assert entry.needs <= QUANTITIES
    assert bool(entry.needs) == bool(entry.tables)
    assert catalogue.caption(name) == entry.caption
    assert entry.caption.endswith(".")
    assert not re.search(r"[\\${}_]{2}|\\|\$|  |\.\.|\. [a-z]", entry.caption)
    assert all(isinstance(text, str) for pair in entry.labels.items() for text in pair)


def test_captions_of_scenes_with_effects_say_nothing_of_plain_ones():
    called = [entry for entry in FIGURES.values() if entry.needs and not entry.of_plain]
    for plain in catalogue.WITH_EFFECTS:
        assert any(plain in entry.caption for entry in called)
    for entry in called:
        assert entry.caption_with({}) == entry.caption
        caption = entry.caption_with({"field": 1.5})
        assert not re.search(r"[wh]/4|square box|Dashed|four times|  ", caption)
        assert ("r_v" in caption) == (catalogue.LINES in entry.caption)


def test_caption_of_an_unknown_figure():
    with pytest.raises(ValueError, match=r"name must be one of model, .* not 'portrait'"):
        catalogue.caption("portrait")


def test_figures_called_for():
    called = {n for n, entry in FIGURES.items() if entry.is_called({"right_wall_time"})}
    drawings = {n for n, entry in FIGURES.items() if not entry.tables}
    assert called == drawings | {"mean_wall_time"}
    assert all(entry.is_called(QUANTITIES) for entry in FIGURES.values())


def test_catalogue_is_quick_to_import():
    code = "import sys, twodiscs.figures.catalogue; print(*sys.modules)"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stdout
    assert "twodiscs.figures.catalogue" in loaded.split()
    assert not {"numpy", "matplotlib"} & set(loaded.split())


# Every figure, every box -----------------------------------------------------------------------


@pytest.fixture
def shown_texts(monkeypatch):
    """Return a function from a figure to its visible texts, each with its box in inches."""
    found = []
    draw_text = matplotlib.text.Text.draw

    def record(text, renderer):
        if text.get_visible() and text.get_text().strip():
            box = matplotlib.text.Text.get_window_extent(text, renderer)
            found.append((text.get_text(), box.transformed(text.figure.dpi_scale_trans.inverted())))
        return draw_text(text, renderer)

    def texts(figure):
        monkeypatch.setattr(matplotlib.text.Text, "draw", record)
        figure.draw_without_rendering()
        return found

    return texts


def overlap(a, b, slack):
    """Say whether two boxes share more than a rim of ``slack`` inches."""
    return min(a.x1, b.x1) - max(a.x0, b.x0) > slack and min(a.y1, b.y1) - max(a.y0, b.y0) > slack


def pairs():
    """Yield (figure, box): drawings in all boxes, the others where labels could meet."""
    for name, entry in FIGURES.items():
        yield from ((name, box) for box in (("paper", "nearly square") if entry.tables else BOXES))
    yield from ((name, "long") for name in ("mean_collision_time", "mean_hop_time"))
    yield from ((name, "tall") for name in ("hopping_trajectory", "wall_area"))
    yield from ((name, "square") for name in ("mean_wall_time", "horizontal_hop_area"))


@pytest.mark.parametrize(("name", "box"), list(pairs()))
def test_texts_stand_clear(name, box, tables_of, shown_texts):
    with style.context():
        figure = draw(name, BOXES[box], tables_of(box))
        texts = shown_texts(figure)
    width, height = figure.get_size_inches()
    assert width == style.COLUMN
    assert height < 6.5
    outside = [t for t, b in texts if b.x0 < 0 or b.y0 < 0 or b.x1 > width or b.y1 > height]
    assert not outside
    assert not [(s, t) for (s, a), (t, b) in combinations(texts, 2) if overlap(a, b, 0.02)]


# What the figures show -------------------------------------------------------------------------


@pytest.mark.parametrize("box", BOXES.values())
def test_curves_approach_every_limit_from_both_sides(box):
    ends = [0, *(radius for radius, _ in limits(*box))]
    scene = {"width": box[0], "height": box[1]}
    for branch, (low, high) in zip(curves.branches(scene), pairwise(ends), strict=True):
        assert (np.diff(branch) > 0).all()
        assert low < branch[0]
        assert branch[-1] < high
        assert branch[0] - low <= 1.01e-4 * (high - low)
        assert high - branch[-1] <= 1e-8 * high


def test_curves_break_where_times_jump():
    radii, exact = curves.exact({"width": 1.5, "height": 1.0})
    gaps = np.flatnonzero(np.isnan(radii))
    assert len(gaps) == 3
    for event, factors in (("right_wall", [2, 1]), ("top_wall", [1, 2]), ("any_wall", [1, 1])):
        times = exact[f"{event}_time"]
        assert np.isnan(times[gaps]).all()
        # The curves come within 1e-9 of the limits; near w/4 the times change fast.
        jumps = times[gaps[:2] - 1] / times[gaps[:2] + 1]
        np.testing.assert_allclose(jumps, factors, rtol=1e-5)
    impossible = radii > PAPER[1] / 4
    assert np.isnan(exact["horizontal_hop_time"][impossible]).all()
    assert (exact["horizontal_hop_area"][impossible] == 0).all()


def test_limits_of_the_boxes():
    assert [name for _, name in limits(1.5, 1)] == ["h/4", "w/4", r"r_{\mathrm{max}}"]
    assert [name for _, name in limits(1, 1.5)] == ["w/4", "h/4", r"r_{\mathrm{max}}"]
    assert [name for _, name in limits(1, 1)] == ["h/4=w/4", r"r_{\mathrm{max}}"]
    assert limits(3, 1) == [(0.25, "h/4"), (0.5, r"r_{\mathrm{max}}")]


def test_limits_follow_from_the_box_or_from_the_scene():
    """An effect too small to matter leaves the radii where they are, but for rounding."""
    for width, height in BOXES.values():
        box = {"width": width, "height": height}
        plain = limits.scene_limits(box)
        assert plain == limits(width, height)
        same = limits.scene_limits(box | {"effects": {"mass_ratio": 1 + 1e-15}})
        assert len(same) == len(plain)
        for (a, _), (b, _) in zip(same, plain, strict=True):
            assert a == pytest.approx(b, rel=1e-15)
        ends = limits.hop_ends(box | {"effects": {"mass_ratio": 2.0}})
        assert [end for end, _ in ends.values()] == pytest.approx(
            [end for end, _ in limits.hop_ends(box).values()], rel=1e-15
        )


@pytest.mark.parametrize(
    ("effects", "expected"),
    [
        ({"periodic": "x"}, {"h/2": 0.25, "v": 0.375}),
        ({"periodic": "y"}, {"h": 0.25, "w/2": 0.375}),
        ({"periodic": "xy"}, {"h/2": 0.25, "w/2": 0.375}),
        # Two discs one above the other need 2 g r < 1/2; one reaches the top if g (h − 2r) < 1/2.
        ({"field": 2.0}, {"h": 0.125, "v": 0.375, "t": 0.375}),
        # The larger disc 1 passes behind disc 2 as long as h < (√r1 + √r2)².
        ({"radius_ratio": 0.25}, {"h": 0.4, "x": 4 / 9}),
        ({"radius_ratio": 4.0}, {"h": 0.1}),
    ],
)
def test_limits_of_scenes_with_effects(effects, expected):
    scene = {"width": 1.5, "height": 1.0, "effects": effects}
    *found, (largest, name) = limits.scene_limits(scene)
    assert name == r"r_{\mathrm{max}}"
    assert largest == pytest.approx(Scene(1.5, 1.0, 0.1, **effects).largest_radius, rel=1e-14)
    named = {
        index: radius for radius, text in found for index in re.findall(r"(?:\{|=)([\w/]+)", text)
    }
    assert named == pytest.approx(expected, rel=1e-15)


def test_a_field_lowers_the_largest_radius():
    scene = {"width": 1.5, "height": 1.0, "effects": {"field": 10.0}}
    *_, (largest, _) = limits.scene_limits(scene)
    assert largest < Scene(1.5, 1.0, 0.1, field=10.0).largest_radius
    Scene(1.5, 1.0, largest * (1 - 1e-15), field=10.0)
    with pytest.raises(ValueError, match="too strong"):
        Scene(1.5, 1.0, largest, field=10.0)


@given(
    st.lists(st.tuples(st.floats(0, 200), st.floats(1, 30)), min_size=1, max_size=4),
    st.floats(1, 8),
)
def test_labels_are_moved_apart(labels, gap):
    labels.sort()
    wanted, widths = zip(*labels, strict=True)
    places = panels.spread(wanted, widths, gap, 210)
    intervals = [(p - w / 2, p + w / 2) for p, w in zip(places, widths, strict=True)]
    assert intervals[-1][1] <= 210 + 1e-9
    apart = [b[0] - a[1] for a, b in pairwise(intervals)]
    assert all(distance >= gap - 1e-9 for distance in apart)


def test_labels_with_room_stay_where_they_belong():
    assert panels.spread([20, 60, 100], [10, 20, 10], 4, 200) == [20, 60, 100]
    assert panels.spread([50, 50], [10, 10], 4, 200) == [43, 57]


def row(radius, **values):
    shown = {"radius": radius, "estimate": None, "stderr": None, "z": None, "bound": None}
    return shown | {"test": "normal"} | values


def drawn_lines(rows):
    """Draw ``rows`` of one series and return {(panel, marker): abscissae and ordinates}."""
    with style.context():
        _, main, lower = panels.panels({"width": 1.5, "height": 1.0}, "")
        before = set(main.lines) | set(lower.lines)
        one = panels.Series("", rows, np.array([1.0, 1.0]))
        panels.draw_series(main, lower, np.array([0.1, 0.2]), [one])
        found = {}
        for name, axes in (("main", main), ("lower", lower)):
            for line in set(axes.lines) - before:
                if len(line.get_xdata()) and line.get_linestyle() == "None":
                    points = zip(line.get_xdata(), line.get_ydata(), strict=True)
                    found[name, line.get_marker()] = sorted(points)
        return found


def test_every_status_has_its_symbol():
    found = drawn_lines(
        [
            row(0.1, estimate=1.0, stderr=0.1, z=1.0),
            row(0.15, estimate=1.2, z=-0.5),
            row(0.2, bound=3.0),
            row(0.25, z=0.0, test="certain"),
            row(0.3, estimate=2.0, stderr=0.1, z=9.0),
            row(0.35, estimate=2.0, stderr=0.1, z=-40.0),
        ]
    )
    assert found["main", "o"] == [(0.1, 1.0), (0.3, 2.0), (0.35, 2.0)]
    assert found["main", "x"] == [(0.15, 1.2)]
    (caret,) = [points for (_, marker), points in found.items() if not isinstance(marker, str)]
    assert [x for x, _ in caret] == [0.2]
    assert found["lower", "o"] == [(0.1, 1.0), (0.15, -0.5)]
    assert found["lower", "^"] == [(0.3, 0.97 * panels.LARGEST_RESIDUAL)]
    assert found["lower", "v"] == [(0.35, -0.97 * panels.LARGEST_RESIDUAL)]


def test_tables_with_little_in_them(tables_of):
    """A single radius, a single event, and no estimate at all."""
    read = tables_of("paper")
    few = {
        "volume": read["volume"][:1],
        "areas": [r for r in read["areas"] if r["quantity"] == "top_wall_area"][:2],
        "mean_times": [r for r in read["mean_times"] if r["event"] == "horizontal_hop"][-2:],
        "hop_histogram": read["hop_histogram"][:512],
        "trajectory": read["trajectory"][:3],
    }
    assert [r["status"] for r in few["mean_times"]] == ["impossible"] * 2
    with style.context():
        for name in ("volume", "wall_area", "mean_hop_time", "hop_histogram", "hopping_trajectory"):
            draw(name, PAPER, few).draw_without_rendering()
        with pytest.raises(ValueError, match=r"areas\.csv has no row of disc_collision"):
            draw("collision_area", PAPER, few)
        with pytest.raises(ValueError, match=r"mean_times\.csv has no row of right_wall"):
            draw("mean_wall_time", PAPER, few)


def test_blocked_hop_area_is_shown_as_zero(tables_of):
    with style.context():
        figure = draw("horizontal_hop_area", PAPER, tables_of("paper"))
    points = {
        (x, y)
        for line in figure.axes[1].lines
        if line.get_marker() == "o"
        for x, y in zip(line.get_xdata(), line.get_ydata(), strict=True)
    }
    blocked = [r["radius"] for r in tables_of("paper")["volume"] if r["radius"] > 0.25]
    assert {(r, 0.0) for r in blocked} <= points


def test_densities_at_zero_are_marked(tables_of):
    with style.context():
        short = draw("hop_histogram", PAPER, tables_of("paper")).axes[1]
    rows = tables_of("paper")["hop_histogram"]
    exact = {
        # 3√2/(16 (h − 2r)), in units of the mean time.
        row["exact_mean"] * 3 * 2**0.5 / (16 * (1 - 2 * row["radius"]))
        for row in rows
    }
    marked = {line.get_ydata()[0] for line in short.lines if not line.get_clip_on()}
    np.testing.assert_allclose(sorted(marked), sorted(exact), rtol=1e-14)


def test_joined_bins_hold_what_they_should():
    rows = [
        {"left": i / 4, "right": (i + 1) / 4, "count": n, "intervals": 2000}
        for i, n in enumerate([500, 400, 300, 200, 100, 60, 30, 20, 4, 3, 9, 9])
    ]
    edges, density, errors = hop_histogram.joined(rows, 0, 1)
    assert edges.tolist() == [i / 4 for i in range(13)]
    np.testing.assert_allclose(density * 2000 / 4, [r["count"] for r in rows], rtol=1e-14)
    np.testing.assert_allclose(errors[0] * 2000 / 4, (500 * 0.75) ** 0.5, rtol=1e-14)
    edges, density, _ = hop_histogram.joined(rows, 0.3, 20)
    assert edges.tolist() == [0, 0.25, 0.5, 0.75, 1, 1.5, 2]
    counts = density * 2000 * np.diff(edges)
    np.testing.assert_allclose(counts, [500, 400, 300, 200, 160, 50], rtol=1e-14)


def test_trajectory_panel_shows_most_hops():
    hops = np.array([3.0, 40.0, 41.0, 42.0, 90.0])
    start, end = hopping_trajectory._crowded(hops, 10.0, 0.0, 100.0)
    assert (start, end) == (37.0, 47.0)
    assert hopping_trajectory._crowded(hops[:1], 10.0, 0.0, 100.0) == (0.0, 10.0)
    assert hopping_trajectory._crowded(hops[:0], 10.0, 0.0, 100.0) == (0.0, 10.0)


# Files -----------------------------------------------------------------------------------------


def arguments(folder, name, read, outputs, box=PAPER):
    """Write the tables that a figure reads and return its command line."""
    found = [name, "--scene", repr({"width": box[0], "height": box[1]})]
    for table in FIGURES[name].tables:
        path = folder / f"{table}.csv"
        tables.write(path, table, read[table])
        found += ["--table", f"{table}={path}"]
    return [*found, "--output", *(str(folder / output) for output in outputs)]


def run(words, **environment):
    return subprocess.run(
        [sys.executable, "-m", "twodiscs.cli.figure", *words],
        env=os.environ | environment,
        capture_output=True,
        text=True,
    )


@pytest.mark.parametrize("name", ["integration_regimes", "mean_hop_time"])
def test_same_bytes_whatever_the_machine_is_set_to(name, tmp_path, tables_of):
    style_file = tmp_path / "matplotlibrc"
    style_file.write_text("font.size: 20\nlines.linewidth: 7\npdf.fonttype: 3\n")
    contents = []
    for turn, environment in enumerate(
        ({"PYTHONHASHSEED": "1"}, {"PYTHONHASHSEED": "2", "MATPLOTLIBRC": str(style_file)})
    ):
        folder = tmp_path / str(turn)
        folder.mkdir()
        words = arguments(folder, name, tables_of("paper"), ["a.pdf", "a.png"])
        finished = run(words, TZ=f"UTC{turn}", **environment)
        assert (finished.returncode, finished.stderr) == (0, "")
        contents.append([(folder / f).read_bytes() for f in ("a.pdf", "a.png")])
    assert contents[0] == contents[1]
    pdf, png = contents[0]
    assert not re.search(rb"Date|Creator|Producer|Matplotlib", pdf)
    assert b"/Subtype /Type0" in pdf or b"/Subtype /TrueType" in pdf
    assert b"/FontFile2" in pdf
    assert b"/Type3" not in pdf
    width = float(re.search(rb"/MediaBox \[ ?0 0 ([0-9.]+)", pdf)[1])
    assert width == pytest.approx(72 * style.COLUMN)
    assert png[:8] == b"\x89PNG\r\n\x1a\n"
    assert not re.search(rb"tEXt|tIME|iTXt", png)
    assert int.from_bytes(png[16:20], "big") == round(style.DPI * style.COLUMN)


def test_settings_are_restored(tmp_path):
    before = dict(matplotlib.rcParams)
    with style.context():
        assert matplotlib.rcParams["font.size"] == style.SETTINGS["font.size"]
    assert dict(matplotlib.rcParams) == before


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["portrait"], "there is no figure called 'portrait'"),
        (["style"], "there is no figure called 'style'"),
        (["../model"], "there is no figure called '../model'"),
        (["model", "--scene", "{'width': 1.5}"], "figure model needs 'height', which is not given"),
        (["model", "--scene", "{'width': -1, 'height': 1}"], "width must be"),
        (["model", "--scene", "1.5"], "must be a Python dict"),
        (["model", "--table", "volume"], "table must be given as NAME=PATH, not 'volume'"),
        (["model", "--table", "volumes=a.csv"], "table must be one of"),
        (["model", "--table", "volume=nowhere.csv"], "nowhere.csv: No such file"),
        (["volume"], "figure volume needs 'volume', which is not given"),
        (["model", "--output", "a.svg"], "output must be a .pdf or .png file, not 'a.svg'"),
    ],
)
def test_mistakes_are_told_in_one_sentence(words, sentence, monkeypatch, capsys, tmp_path):
    defaults = {"--scene": "{'width': 1.5, 'height': 1.0}", "--output": "a.png"}
    for option, value in defaults.items():
        if option not in words:
            words = [*words, option, value]
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sys.argv", ["figure", *words])
    with pytest.raises(SystemExit) as leave:
        command.arguments.run(command.main)
    error = capsys.readouterr().err
    assert leave.value.code == 2
    assert sentence in error
    assert error.count("\n") == 1
    assert not any(tmp_path.iterdir())
