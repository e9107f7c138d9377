"""Figures of studies: symbols, error bars and laws are those of the committed tables."""

import math
import re
from fractions import Fraction
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from factory import EXPECTED, LONG_RUNS, empty
from figure_cases import PAPER, bars, draw, misnamed, points, unclear
from marks import slow
from matplotlib.legend import Legend
from matplotlib.lines import Line2D
from matplotlib.patches import StepPatch

import twodiscs as td
from twodiscs.analysis.tables import SCENE_TABLES
from twodiscs.dynamics.transmission import box_time
from twodiscs.figures import curves, style
from twodiscs.figures.scene_figures import FIGURES
from twodiscs.model.events import HOPS, SHELL_EVENTS
from twodiscs_paper.catalogue import STUDY_FIGURES, TABLES, read_table
from twodiscs_paper.draw import DRAW
from twodiscs_paper.studies.effects import figure as effects
from twodiscs_paper.studies.more_discs import figure_tori as tori
from twodiscs_paper.studies.passages import figure as passages
from twodiscs_paper.studies.passages import figure_brownian as brownian
from twodiscs_paper.studies.passages import figure_diffusion as diffusion
from twodiscs_paper.studies.passages import figure_files as files
from twodiscs_paper.studies.passages import figure_friction as friction
from twodiscs_paper.studies.passages import figure_transmission as transmission
from twodiscs_paper.studies.passages.parts import with_friction
from twodiscs_paper.studies.stability import figure_calibration
from twodiscs_paper.studies.stability.figure_runs import rounded
from twodiscs_paper.studies.tails import figure as tails
from twodiscs_paper.studies.thresholds.measure import leading_law, near
from twodiscs_paper.study import select


@cache
def table(name):
    """Return the rows of a committed table; costs, which are times, are made up."""
    if name == "effects_cost":
        variants = ["plain", *dict.fromkeys(row["scene"] for row in table("effects"))]
        made = enumerate({"variant": v, "ratio": 0.1} for v in variants)
        return [empty(TABLES[name], **row, instructions=4000 + i) for i, row in made]
    folder = EXPECTED / "paper" if name in SCENE_TABLES else EXPECTED
    return read_table(folder / f"{name}.csv")


@pytest.fixture(autouse=True, scope="module")
def rough_curves():
    """Exact curves have every eighth of their nodes: with effects each takes milliseconds."""
    fine = curves.branches
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(
            curves, "branches", lambda *given, **how: [one[::8] for one in fine(*given, **how)]
        )
        yield


@cache
def drawn(name):
    """Return {label of the panel, or its place: axes} of a figure of the committed tables."""
    entry = (FIGURES | STUDY_FIGURES)[name]
    tables = {name: table(name) for name in (*entry.tables, *entry.main_tables)}
    tables |= {run: read_table(EXPECTED.parents[1] / path) for run, path in entry.long_runs.items()}
    with style.context():
        figure = DRAW[name](PAPER, tables) if name in DRAW else draw(name, PAPER, tables)
    return {axes.get_label() or i: axes for i, axes in enumerate(figure.axes)}


def symbol(x, row, factor=1.0):
    """Return (x, y, standard error) of the estimate of a ``row`` times a ``factor``."""
    return x, row["estimate"] * factor, row["stderr"] * factor


def columns(rows, x):
    """Return (x, y, standard error) of the estimates of ``rows`` over one of their columns."""
    return [symbol(row[x], row) for row in rows]


def cases():
    """Yield (figure, panel, look, (x, y, standard error) of all symbols of this look).

    Lines, with the marker "None", and symbols without error bars have (x, y).
    """
    yield from passage_cases()
    yield from long_file_cases()
    yield from threshold_cases()
    yield from distribution_cases()
    for (_, _, own), look in zip(tail_cases(), tails.CASE_LOOKS, strict=False):
        law = own[0]["law"]
        due = [symbol(r["time"] / r["exact_mean"], r, 1 / r["law"] if law else 1.0) for r in own]
        yield "tails", "ratio" if law else "exponential", look, due
    rows = [row for row in select(table("more_discs"), periodic=None) if row["dynamics"]]
    for radius in {row["radius"] for row in rows}:
        for event, look in style.EVENT_LOOKS.items():
            due, line = [], []
            for row in select(rows, radius=radius, event=event):
                n = row["discs"]
                pairs = {"vertical_hop": n * (n - 1) / 2, "right_wall": 1 / n, "top_wall": 1}
                each = pairs.get(event, n - 1)
                due.append((n, each * row["dynamics"], each * row["dynamics_stderr"]))
                line += [(n, each * t) for t in [row["exact"] or row["monte_carlo"]] if t]
            yield "more_discs", f"radius {radius}", look, due
            yield "more_discs", f"radius {radius}", (look[0], "None"), line
    rows = [row for row in table("effects") if row["quantity"] != "never_met_share"]
    for k, scene in enumerate(dict.fromkeys(row["scene"] for row in rows)):
        for panel, event in zip("abc", effects.SHOWN_EVENTS, strict=False):
            own = select(rows, scene=scene, quantity=f"{event}_time")
            own = [row for row in own if row["stderr"] and row["plain"]]
            due = [symbol(row["radius"], row, 1 / row["plain"]) for row in own]
            yield "effects", panel, effects._look(k), due
        # The time of a variant is ten times that without effects; the first one has none.
        yield "effects", "d", effects._look(k), [(10.0, k + 1)]
    # Open and full symbols of one look are of crossings and of first passages.
    (path,) = STUDY_FIGURES["brownian"].long_runs.values()
    rows = [row for row in read_table(EXPECTED.parents[1] / path) if row["room"] <= 1 / 4]
    for program, (colour, _) in brownian.PROGRAM_LOOKS.items():
        for panel, quantity in (("kappa", "coefficient"), ("exponent", "local_exponent")):
            law = []
            for step, marker in brownian.ROOM_MARKERS.items():
                own = select(rows, program=program, step=step, quantity=quantity)
                yield "brownian", panel, (colour, marker), columns(own, "neck")
                if program not in ("reflected", "kicked"):
                    law += [r for r in select(own, method="crossings") if r["neck"] >= 4]
            yield "brownian", panel, (colour, "None"), [(r["neck"], r["diffusive"]) for r in law]


def tail_cases():
    """Yield (event, radius, rows of its survival with an error that is drawn)."""
    for event, radius in dict.fromkeys((r["event"], r["radius"]) for r in table("tails")):
        rows = select(table("tails"), event=event, radius=radius, quantity="survival")
        own = [row for row in rows if row["stderr"] and row["stderr"] < 0.3 * row["estimate"]]
        yield event, radius, own


def over_cube_root(row):
    """Return (x, y, standard error) of (1 − κ)(w − σ)/∛(σ²(h − 2σ)) over the root of distances."""
    sigma = 2 * row["radius"]
    factor = (row["width"] - sigma) / math.cbrt(sigma**2 * (row["height"] - 2 * sigma))
    return row["distance"] ** (1 / 6), (1 - row["estimate"]) * factor, row["stderr"] * factor


def long_run(name):
    return read_table(LONG_RUNS / name / "passages.csv")


#: Rows of the last hop in the first scene have these keys if it has no effects.
PLAIN_HOPS = {"width": 1.5, "height": 1.0, "event": "horizontal_hop"}
PLAIN_HOPS |= {"periodic": None, "friction": None}


def passage_rows():
    """Return (rows of the build for which a long run has none of the same hop, rows of it)."""
    kept = [row for row in long_run("passages") if row["scene"] != "pause"]
    names = "width", "height", "event", "distance", "moment_of_inertia", "friction", "quantity"
    taken = {tuple(map(row.get, names)) for row in kept}
    return [row for row in table("passages") if tuple(map(row.get, names)) not in taken], kept


def passage_cases():
    rows, kept = passage_rows()
    ours = select([*rows, *kept], **PLAIN_HOPS)
    for inertia, look in passages.INERTIA_LOOKS.items():
        own = select(ours, moment_of_inertia=inertia)
        kappa, times = select(own, quantity="coefficient"), select(own, quantity="passage_time")
        built = select(table("passages"), quantity="passage_time", **PLAIN_HOPS)
        distances = {r["distance"] for r in select(built, moment_of_inertia=inertia)}
        times = [row for row in times if row["distance"] in distances]
        yield "passages", "times", look, columns(times, "distance")
        due = columns(kappa, "distance") if inertia else [*map(over_cube_root, kappa)]
        yield "transmission", "rough" if inertia else "smooth", look, due
        shown = [2.0**-n for n in passages.SHOWN_HALVINGS.get(inertia, ())]
        curves = [row for row in select(own, quantity="correlation") if row["distance"] in shown]
        yield "passages", "curves", look, [symbol(r["time"] / unit(r), r) for r in curves]
        # Both methods, open symbols and dots.
        ring = select(rows, quantity="diffusion", discs=2, moment_of_inertia=inertia)
        yield "diffusion", "ring", look, columns(ring, "distance")
    for rate, look in zip(friction.NECK_HALVINGS, style.SERIES, strict=True):
        kappa, exponents = [], []
        for some in (rows, kept):
            own = select(some, friction=rate, quantity="coefficient")
            kappa += [symbol(scaled(row), row) for row in own]
            # The first distance has no exponent.
            middle = [math.sqrt(scaled(a) * scaled(b)) for a, b in pairwise(own)]
            exponents += map(symbol, middle, select(some, friction=rate, quantity="local_exponent"))
        yield "friction", "kappa", look, kappa
        yield "friction", "exponent", look, exponents
    limit = select(table("passages"), quantity="amplitude")
    yield "transmission", "smooth", (style.BLACK, "*"), [symbol(0.0, row) for row in limit]
    limit = select(long_run("passages"), method="limit", quantity="coefficient")
    yield "friction", "kappa", (style.BLACK, "x"), [(r["friction"], r["estimate"]) for r in limit]
    # Two discs with friction have a figure of their own.
    smooth = [*select(table("passages"), friction=None), *long_run("displacements")]
    both = {"transmission": transmission.TRANSMISSION_LOOKS, "diffusion": diffusion.DIFFUSION_LOOKS}
    for name, looks in both.items():
        for quantity, (*look, _) in looks.items():
            own = [r for r in select(smooth, quantity=quantity) if r["z"] is not None]
            due = sorted({(r["distance"], r["z"]) for r in own if r["distance"]})
            yield name, "residuals" if name == "diffusion" else quantity, look, due


def long_file_cases():
    """Yield the symbols of long files in the figures of diffusion and of files."""
    rows = long_run("displacements")
    for discs, look in diffusion.FILE_LOOKS.items():
        own = select(long_run("files"), quantity="diffusion", discs=discs)
        yield "diffusion", "files", look, columns(own, "distance")
    order = select(rows, quantity="diffusion", method="order")
    moved = select(rows, quantity="displacement")
    for is_kicked, look in ((False, diffusion.SMOOTH_FILE), (True, diffusion.KICKED_FILE)):
        own = [row for row in order if bool(row["friction"]) == is_kicked]
        yield "diffusion", "files", look, columns(own, "distance")
        # At the first blocked radius, and at the farthest distance where discs pass.
        due = [
            symbol(row["time"] / math.sqrt(2 * row["discs"] - 1), row)
            for row in select(moved, moment_of_inertia=None)
            if bool(row["friction"]) == is_kicked
            and (row["radius"] == 0.28 or row["distance"] > 0.1)
        ]
        yield "files", "moved", look, due
    rough = select(moved, moment_of_inertia=0.5)
    due = [symbol(row["time"] / math.sqrt(3 * row["discs"]), row) for row in rough]
    yield "files", "moved", files.ROUGH_FILE, due
    kicked = [row for row in order if row["friction"]]
    for look, row in zip(files.COLLAPSE_LOOKS, kicked, strict=True):
        where = {"distance": row["distance"], "friction": row["friction"]}
        (single,) = select(rows, quantity="single_file", **where)
        (rate,) = select(rows, quantity="rate", discs=row["discs"], **where)
        twice_d = row["estimate"] * rate["estimate"]
        time = (single["estimate"] / twice_d) ** 2  # when F √t = 2 D t
        due = [symbol(r["time"] / time, r, 1 / (twice_d * time)) for r in select(moved, **where)]
        yield "files", "collapse", look, due


def scaled(row):
    """Return γ√(εσ) of a ``row`` with friction."""
    sigma = 2 * row["radius"]
    return row["friction"] * math.sqrt((row["height"] - 2 * sigma) * sigma)


def unit(row):
    return box_time(PAPER.scene(row["radius"]), "horizontal_hop")


def threshold_cases():
    for event in SHELL_EVENTS:
        law, look = leading_law(PAPER, event), style.EVENT_LOOKS[event]
        rows = near(PAPER, law, select(table("mean_times"), event=event)) if law else []
        places = [1 - row["radius"] / law.limit for row in rows]
        if event in HOPS:
            yield "thresholds", "hops", look, [*map(symbol, places, rows)]
        due = [symbol(x, row, 1 / law(row["radius"])) for x, row in zip(places, rows, strict=True)]
        yield "thresholds", "ratios", look, due


def distribution_cases():
    rows = select(table("distributions"), scene=table("distributions")[0]["scene"])
    own = select(rows, event=rows[0]["event"])
    for radius, look in zip(dict.fromkeys(r["radius"] for r in own), style.SERIES, strict=False):
        due = [
            symbol((row["first"] + row["last"]) / 2 / row["exact_mean"], row, row["exact_mean"])
            for row in select(own, radius=radius, quantity="hazard")
            if row["stderr"] < 0.15 * row["estimate"]
        ]
        yield "distributions", "rates", look, due
        (fit,) = select(own, radius=radius, quantity="rate")
        mean, rate = fit["exact_mean"], fit["estimate"]
        zero = 3 * math.sqrt(2) / 16 * mean / (1 - 2 * radius)
        line = [(fit["first"] / mean, rate * mean), (min(fit["last"] / mean, 12), rate * mean)]
        yield "distributions", "rates", (look[0], "None"), [*line, (0.0, zero), (0.3, zero)]
    for hop, look in zip(HOPS, style.SERIES, strict=False):
        due = [
            (row["radius"], row[y] / row["exact_mean"], row[s] / row["exact_mean"])
            for row in select(rows, event=hop, quantity="first_passage", last=None)
            for y, s in (("estimate", "stderr"), ("reference", "reference_stderr"))
        ]
        yield "distributions", "passages", look, due


CASES = [*cases()]


@pytest.mark.parametrize(
    ("name", "panel", "look", "due"),
    CASES,
    ids=["-".join([name, panel, *look]) for name, panel, look, _ in CASES],
)
def test_symbols_and_error_bars_are_those_of_the_table(name, panel, look, due):
    has_bars = {*map(len, due)} == {3}
    shown = sorted((bars if has_bars else points)(drawn(name)[panel], *look))
    assert len(shown) == len(due)
    np.testing.assert_allclose(shown, sorted(due), rtol=1e-7 if has_bars else 1e-15)
    if name not in ("diffusion", "tails", "thresholds"):  # their axes begin beyond some data
        assert all(x >= min(drawn(name)[panel].get_xlim()) for x, *_ in shown)


@pytest.mark.parametrize("name", ["tails", "thresholds", "friction", "stability_of_runs"])
def test_a_loaded_table_is_drawn_with_those_that_lie_beside_it(name):
    """As the job of the figure draws it: the same lines in every panel."""
    panels = td.plot(td.load(EXPECTED)[STUDY_FIGURES[name].tables[0]], figure=name).axes
    for axes, due in zip(panels, drawn(name).values(), strict=True):
        for line, other in zip(axes.lines, due.lines, strict=True):
            np.testing.assert_array_equal(line.get_xydata(), other.get_xydata())


def test_the_residuals_of_more_discs_are_those_of_the_table():
    rows, axes = select(table("more_discs"), periodic=None), drawn("more_discs")["residuals"]
    for event, look in (style.EVENT_LOOKS | {"virial": (style.BLACK, "x")}).items():
        due = [row["z"] for row in select(rows, event=event) if row["z"] is not None]
        assert sorted(z for _, z in points(axes, *look)) == sorted(due)


def test_the_law_of_a_blocked_file_meets_its_symbols():
    """Without kicks at the shortest time, with kicks at long times; within five errors."""
    axes = drawn("files")["moved"]
    lines = [n.get_data() for n in axes.lines if n.get_color() == style.BLACK]
    curves = [np.log(line) for line in lines if len(line[0]) == 120]
    rows = select(long_run("displacements"), quantity="displacement", radius=0.28)
    rows = select(rows, moment_of_inertia=None)
    for is_kicked, curve, kept in zip((False, True), curves, ([0], [-2, -1]), strict=True):
        own = [row for row in rows if bool(row["friction"]) == is_kicked]
        for row in (own[k] for k in kept):
            time = math.log(row["time"] / math.sqrt(2 * row["discs"] - 1))
            law = math.exp(np.interp(time, *curve))
            assert abs(row["estimate"] - law) < 5 * row["stderr"]


def test_a_table_without_a_figure_or_alone_is_one_sentence(tmp_path):
    tables = td.load(EXPECTED)
    for name, said in (
        ("errata", "a table with a figure, but 'errata' has none"),
        ("effects", r"other tables of the figure effects, but .*effects_cost\.csv c"),
    ):
        with pytest.raises(td.InputError, match=f"^result must .*{said}"):
            td.plot(tables[name])
    (tmp_path / "distributions.csv").write_bytes((EXPECTED / "distributions.csv").read_bytes())
    alone = td.load(tmp_path)["distributions"]
    with pytest.raises(td.InputError, match="a build with a scene of two plain discs for the fig"):
        td.plot(alone, figure="thresholds")
    (tmp_path / "volume.csv").write_bytes((EXPECTED / "paper" / "volume.csv").read_bytes())
    with pytest.raises(td.InputError, match=r"beside the configuration\.json of its build, but"):
        td.plot(td.load(tmp_path)["volume"])


def test_a_study_whose_hops_are_rare_or_do_not_end_has_a_figure():
    """Without rows it names the box, or shows the long run in the box of this."""
    box, tables = td.Box(1.0, 3.0), {"passages": [], "kept": long_run("passages")}
    rates, _ = DRAW["distributions"](box, {"distributions": []}).axes
    assert rates.get_title("left").endswith(r"1\times3$: hops are too rare to record intervals")
    assert r"1.5\times1" in DRAW["friction"](box, tables).axes[0].get_title("left")


def test_a_place_with_rows_of_a_build_and_of_a_long_run_is_named_once():
    run = [row for row in long_run("passages") if row["distance"] != 2.0**-6]
    assert misnamed(DRAW["transmission"](PAPER, {"passages": table("passages"), "kept": run})) == []


def test_the_rate_of_a_fit_is_named_with_the_digits_of_its_error():
    labels = drawn("tails")["exponential"].get_legend_handles_labels()[1]
    found = re.findall(r"rate \$(\d\.(\d+))\((\d+)\)", " ".join(labels))
    rates = select(table("tails"), quantity="rate")
    for (rate, digits, error), row in zip(found, rates, strict=True):
        assert 0.95 <= int(error) < 10.5
        for text, name in ((rate, "estimate"), (error + f"e-{len(digits)}", "stderr")):
            due = row[name] * row["exact_mean"]
            assert abs(float(text) - due) <= 0.501 * 10.0 ** -len(digits)


def test_ratios_of_costs_are_logarithmic_and_go_down_the_list():
    axes = drawn("effects")["d"]
    assert (axes.get_xscale(), axes.yaxis_inverted()) == ("log", True)


def test_cases_of_predicted_times_have_their_names():
    rows = select(table("stability"), part="times", method="stable")
    due = {f"{'wall, ' * (row['quantity'] == 'wall_time')}{row['case']}" for row in rows}
    shown = [text.get_text() for text in drawn("stability_of_runs")["b"].get_yticklabels()]
    assert len(shown) == len(due)
    assert {*shown} == due


def test_residuals_of_stability_stand_upon_each_other():
    axes, counts = drawn("stability")["d"], np.zeros(10)
    for bar in axes.patches:
        if not isinstance(bar, StepPatch):
            k = math.floor(bar.get_x() + bar.get_width() / 2) + 5
            assert bar.get_y() == counts[k]
            counts[k] += bar.get_height()
    rows = select(table("stability"), part="estimates", status="sampled")
    z = [row["z"] for row in [*rows, *select(table("stability"), part="extremes")]]
    due, _ = np.histogram([one for one in z if one is not None], 10, (-5, 5))
    assert counts.tolist() == due.tolist()


def test_every_figure_of_a_study_is_compared():
    """Costs are times, which no table of the repository has: tests of the study compare them."""
    elsewhere = "accuracy_cost accuracy_cost_by_radius calibration stability stability_of_runs tori"
    assert {name for name, *_ in CASES} | {*elsewhere.split()} >= STUDY_FIGURES.keys()


#: The figures of tables that the repository has.
OF_TABLES = sorted({*STUDY_FIGURES} - {"accuracy_cost_by_radius", "accuracy_cost"})
OF_SCENES = [name for name, entry in FIGURES.items() if entry.tables]

#: The fast half compares the texts of these figures: the fullest ones.
FAST = {"passages", "brownian", "transmission", "tails"}


@pytest.mark.parametrize(
    ("name", "faults"),
    [
        case
        for name in OF_TABLES
        for case in ((name, misnamed), ((name, unclear) if name in FAST else slow(name, unclear)))
    ],
)
def test_texts_of_studies_stand_clear_and_symbols_are_named(name, faults):
    (axes, *_) = drawn(name).values()
    assert faults(axes.get_figure(root=True)) == []


def spans_decades(axes, k):
    """Return whether the lines of a panel have positive numbers ``k`` over two decades."""
    lines = [n for n in axes.lines if n.get_transform() == axes.transData and len(n.get_xdata())]
    numbers = [np.asarray(getattr(line, f"get_{k}data")(), float) for line in lines]
    numbers = np.concatenate([[1.0], *numbers])
    return np.nanmin(numbers) > 0 and np.nanmax(numbers) > 100 * np.nanmin(numbers)


@pytest.mark.parametrize("name", [*OF_TABLES, *OF_SCENES])
def test_axes_with_numbers_are_named_and_decades_are_logarithmic(name):
    """An axis that begins at 0 may be linear."""
    for axes in drawn(name).values():
        for k, side in (("x", "labelbottom"), ("y", "labelleft")):
            axis = getattr(axes, f"{k}axis")
            texts = "".join(text.get_text() for text in axis.get_ticklabels())
            has_numbers = texts and not re.search("[a-z=]", texts.replace(r"\mathdefault", ""))
            if axes.lines and has_numbers and axis.get_tick_params().get(side, True):
                assert axis.get_label_text()
            begins_at_0 = axis.get_view_interval()[0] == 0
            assert axis.get_scale() == "log" or begins_at_0 or not spans_decades(axes, k)


@pytest.mark.parametrize("name", OF_TABLES)
def test_ticks_with_names_stand_in_the_panel(name):
    for axes in drawn(name).values():
        for axis in (axes.xaxis, axes.yaxis):
            texts = {tick.get_text() for tick in axis.get_majorticklabels()}
            if any(re.search("[a-z] ", text) for text in texts):
                low, high = sorted(axis.get_view_interval())
                assert all(low < tick < high for tick in axis.get_majorticklocs())


#: Panels that do not show all of their symbols: small ones of long runs, or of other scenes.
CUT = {
    ("diffusion", "residuals"), ("distributions", "rates"), ("effects", "z of a"),
    ("effects", "z of b"), ("effects", "z of c"), ("stability", "a"), ("stability", "c"),
    ("pressure", "beneath"), ("tails", "tails"), ("tails", "ratio"), ("thresholds", "ratios"),
}  # fmt: skip


@pytest.mark.parametrize("name", [*OF_TABLES, *OF_SCENES])
def test_panels_show_all_of_their_symbols(name):
    for label, axes in drawn(name).items():
        lines = [n for n in axes.lines if n.get_transform() == axes.transData]
        shown = [n.get_xydata() for n in lines if n.get_marker() != "None"]
        places = np.concatenate([np.empty((0, 2)), *shown])
        places = places[np.isfinite(places).all(axis=1)]
        low, high = np.sort([axes.get_xlim(), axes.get_ylim()]).T
        inside = (low <= places) & (places <= high)
        assert inside.all() == ((name, label) not in CUT)


def dashes(lines):
    """Return the patterns of those ``lines`` that are neither full nor symbols alone."""
    return {str(n._unscaled_dash_pattern) for n in lines if n.get_linestyle() not in ("-", "None")}


@pytest.mark.parametrize("name", [*OF_TABLES, *OF_SCENES])
def test_dashed_curves_are_named_in_a_legend(name):
    """In two figures the caption names them."""
    panels = [*drawn(name).values()]
    keys = panels[0].get_figure(root=True).findobj(Legend)
    named = dashes(line for key in keys for line in key.findobj(Line2D))
    curves = [n for axes in panels for n in axes.lines if n.get_transform() == axes.transData]
    own = dashes(n for n in curves if len(n.get_xdata()))
    caption = STUDY_FIGURES[name].caption() if name in ("tori", "brownian") else ""
    assert own <= named or re.search("Dashed|dotted", caption)


#: The values that panels are compared with: lines at one value of x or y.
RULES = {
    ("pressure", "main", "y"): [1],
    ("tails", "ratio", "y"): [1],
    ("distributions", "rates", "y"): [1],
    ("distributions", "passages", "y"): [1],
    ("friction", "exponent", "y"): [-1.5, -2],
    ("brownian", "exponent", "y"): [-1.5, -2, -2.5, -3.5, 0],
    ("diffusion", "ring", "y"): [1],
    ("thresholds", "ratios", "y"): [1],
    ("effects", "a", "y"): [1],
    ("effects", "d", "x"): [1],
    ("tori", "residuals", "y"): [0, -2, 2, -5, 5],
    ("calibration", "calibration", "x"): [1],
    ("stability_of_runs", "b", "x"): [8],
    ("stability_of_runs", "d", "x"): [-5, 5, 0],
}


@pytest.mark.parametrize(("name", "panel", "axis"), RULES)
def test_a_line_through_a_panel_is_at_the_value_that_is_due(name, panel, axis):
    axes = drawn(name)[panel]
    own = getattr(axes, f"get_{axis}axis_transform")("grid")
    lines = [line for line in axes.lines if line.get_transform() == own]
    assert [getattr(n, f"get_{axis}data")()[0] for n in lines] == RULES[name, panel, axis]


def test_first_passages_of_brownian_discs_are_full_symbols():
    rows = select(read_table(LONG_RUNS / "brownian" / "brownian.csv"), quantity="coefficient")
    lines = [n for n in drawn("brownian")["kappa"].lines if n.get_marker() != "None"]
    for program, (colour, _) in brownian.PROGRAM_LOOKS.items():
        full = [n for n in lines if n.get_markerfacecolor() == n.get_color() == colour]
        found = {tuple(place) for line in full for place in line.get_xydata().tolist()}
        own = select(rows, program=program, method="passages")
        assert found == {(row["neck"], row["estimate"]) for row in own if row["room"] <= 1 / 4}


@pytest.mark.parametrize("name", ["friction", "brownian"])
def test_exponents_stand_beside_their_lines(name):
    axes, found = drawn(name)["exponent"], {}
    for text in axes.texts:
        number = re.sub(r"\\frac\{(\d)\}\{(\d)\}", r"\1/\2", text.get_text().split("$")[1])
        found[text.xy[1]] = float(Fraction(number))
    assert [*found] == [*found.values()] == RULES[name, "exponent", "y"]


hop_time = np.vectorize(lambda d: td.mean_times(PAPER.scene(0.25 - d / 4))["horizontal_hop_time"])


def transmission_with_friction(x):
    (row,) = select(long_run("passages"), quantity="scaling_constant")
    return 1 / (4 * x / 3 + 1 / (1 + row["estimate"] * x + with_friction.SECOND * x**2))


def toward_the_limit(x):
    """The line from the exact limit through the nearest long run, by weighted least squares."""
    (limit,) = select(table("passages"), quantity="amplitude")
    keys = {"scene": "h/4", "event": "horizontal_hop", "quantity": "coefficient"}
    run = select(long_run("passages"), **keys, moment_of_inertia=None, friction=None)
    near_limit = [over_cube_root(row) for row in run if row["distance"] <= 2.0**-12]
    root, value, error = np.array(near_limit).T
    (slope,) = np.linalg.lstsq((root / error)[:, None], (value - limit["estimate"]) / error)[0]
    return limit["estimate"] + slope * x


def decays():
    """Yield the curves κ exp(−2κt/τ) of what passages leave."""
    rows = select([row for some in passage_rows() for row in some], **PLAIN_HOPS)
    for inertia, halvings in passages.SHOWN_HALVINGS.items():
        own = select(rows, quantity="coefficient", moment_of_inertia=inertia)
        for row in (row for row in own if -math.log2(row["distance"]) in halvings):
            kappa, rate = row["estimate"], unit(row) / row["exact_mean"]
            yield lambda t, kappa=kappa, rate=rate: kappa * np.exp(-2 * kappa * rate * t)


#: The laws that panels have as black or grey lines. A disc of rough ones has 2/3 of their energy.
LAWS = {
    ("passages", "times"): [hop_time, lambda d: 5 / 4 * hop_time(d)],
    ("passages", "curves"): [*decays(), lambda t: 1 - 3 * math.sqrt(2) / 8 * t],
    ("brownian", "kappa"): [lambda x: math.sqrt(2 / math.pi) / x, np.ones_like],
    ("friction", "kappa"): [lambda x: 0.75 / x, np.ones_like, transmission_with_friction],
    ("transmission", "smooth"): [toward_the_limit],
    ("files", "collapse"): [lambda u: np.sqrt(u) + u],
    ("distributions", "rates"): [lambda t: 3 / t],
    **{("tails", panel): [lambda t: np.exp(-t)] for panel in ("tails", "exponential")},
    ("thresholds", "hops"): [lambda x: 10 * (x / 4e-5) ** -2, lambda x: 10 * (x / 4e-5) ** -1.5],
    ("stability_of_runs", "c"): [lambda bits: 2.0**bits / 2**53],
    # Henderson's equation of state, for the full and for the dotted line.
    ("tori", "factor"): 2 * [lambda x: (1 + x**2 / 8) / (1 - x) ** 2],
}


@pytest.mark.parametrize(("name", "panel", "laws"), [(*key, laws) for key, laws in LAWS.items()])
def test_the_lines_of_laws_are_these(name, panel, laws):
    axes, rtol = drawn(name)[panel], {"factor": 0.02, "times": 1e-9}.get(panel, 1e-12)
    lines = [n for n in axes.lines if n.get_color() in (style.BLACK, style.GREY)]
    lines = [n for n in lines if n.get_transform() == axes.transData and n.get_marker() == "None"]
    lines = [n.get_data() for n in lines if len(n.get_xdata())]
    assert len(lines) == len(laws)
    same = [[np.allclose(y, law(np.array(x)), rtol, 0) for x, y in lines] for law in laws]
    assert np.all(np.any(same, 0) & np.any(same, 1))


def test_the_symbols_of_tori_are_those_of_the_long_run():
    rows = read_table(LONG_RUNS / "tori" / "tori.csv")
    for (reference, discs), (colour, marker, _) in tori.REFERENCE_LOOKS.items():
        own, axes = select(rows, reference=reference, discs=discs), drawn("tori")
        due = {(row["packing_fraction"], row["estimate"]) for row in own}
        assert points(axes["factor"], colour, marker) >= due != set()
        settled = [row for row in own if abs(row["starts_z"] or 0.0) <= tori.AGREEMENT_Z]
        due = {(row["packing_fraction"], row["z"]) for row in settled}
        assert points(axes["residuals"], colour, marker) >= due
    published = style.VERMILLION, style.BLUE, style.GREEN
    shown = [bar for colour in published for bar in bars(drawn("tori")["factor"], colour, "x")]
    names = "packing_fraction", "expected", "expected_stderr"
    own = [row for row in rows if row["reference"] not in (None, "virial")]
    np.testing.assert_allclose(sorted(shown), sorted([row[name] for name in names] for row in own))


def test_the_mean_squares_of_calibration_are_those_of_the_long_run():
    """Every row with enough scores, except those of long calls, has a symbol in its line."""
    lines = [n for n in drawn("calibration")["calibration"].lines if n.get_marker() in "os^"]
    shown = sorted((round(y), x) for line in lines for x, y in line.get_xydata())
    path, fewest = "calibration/calibration.csv", figure_calibration.FEWEST_SCORES
    rows = read_table(LONG_RUNS / path)
    rows = [row for row in rows if row["scores"] >= fewest and row["size"] != "long"]
    due = []
    for level, (call, part) in enumerate(figure_calibration.ESTIMATORS.values()):
        own = [row for row in select(rows, call=call) if re.search(part, row["quantity"])]
        due += [(level, row["mean_square"]) for row in own]
    assert shown == sorted(due)
    assert len(due) == len(rows)  # each in one line


def test_the_panels_of_stability_are_those_of_the_table():
    rows, (volume, _) = table("stability"), style.SERIES[:2]
    shares = select(rows, part="sampling", case="largest radius", method="conditioned")
    due = {(-row["distance"], row["value"]) for row in shares}
    assert points(drawn("stability")["c"], *volume) == due
    estimates = select(rows, part="estimates", status="sampled")
    extremes = [row for row in select(rows, part="extremes") if row["z"] is not None]
    axes, edges = drawn("stability")["d"], np.arange(-5, 6)
    counts = [np.histogram([r["z"] for r in own], edges)[0] for own in (estimates, extremes)]
    for bars_of, due in zip(axes.containers, counts, strict=True):
        assert [bar.get_height() for bar in bars_of] == [*due]
    (law,) = [patch for patch in axes.patches if isinstance(patch, StepPatch)]
    assert law.get_data().values.sum() == pytest.approx(sum(map(sum, counts)), rel=1e-6)
    assert law.get_data().values[5] / law.get_data().values[6] == pytest.approx(2.5116, rel=1e-4)
    theory, end = select(rows, part="theory"), "largest radius"
    others = [row for row in theory if row["case"] != end]
    for panel, own in (("a", select(theory, case=end)), ("b", others)):
        for look, series in (
            ((style.VERMILLION, "s"), select(own, method="closed-form", quantity="volume")),
            ((style.ORANGE, "D"), select(own, method="closed-form", quantity="areas")),
            (volume, select(own, method="stable")),
        ):
            worst = {}
            for row in series:
                distance = abs(row["distance"])
                worst[distance] = max(row["value"], worst.get(distance, 1e-17))
            assert points(drawn("stability")[panel], *look) == {*worst.items()} != set()


def test_the_panels_of_stability_of_runs_are_those_of_the_table():
    rows, axes = table("stability"), drawn("stability_of_runs")
    contacts = select(rows, part="times", quantity="contact_time")
    seen = {row["case"]: row["count"] for row in select(contacts, method="stable")}
    textbook = select(contacts, method="textbook")
    missed = [f"{lost} missed" for row in textbook if (lost := seen[row["case"]] - row["count"])]
    texts = [text.get_text() for text in axes["b"].texts]
    assert missed == [text for text in texts if "missed" in text] != []
    cells = {text.xy: text.get_text() for text in axes["a"].texts}
    signs = {"energy_error": 1, "smallest_gap": -1, "excess": 1}
    for column, (quantity, sign) in enumerate(signs.items()):
        due = [max(sign * row["value"], 0) for row in select(rows, quantity=quantity)]
        due = sorted("0" if value == 0 else f"${rounded(value)}$" for value in due)
        assert sorted(cells[column + 0.5, line] for line in range(1, len(due) + 1)) == due != []
    for method, quantity, look in (
        ("stable", "contact_time", style.SERIES[0]),
        ("stable", "wall_time", style.SERIES[1]),
        ("textbook", "contact_time", (style.VERMILLION, "x")),
    ):
        due = {row["value"] for row in select(rows, part="times", quantity=quantity, method=method)}
        assert {x for x, _ in points(axes["b"], *look)} == due != set()
    extremes = select(rows, part="extremes")
    places = [*dict.fromkeys(row["case"] for row in extremes)]
    for event, look in style.EVENT_LOOKS.items():
        own = [row for row in select(extremes, quantity=f"{event}_time") if row["z"] is not None]
        due = {(row["z"], places.index(row["case"])) for row in own}
        assert points(axes["d"], *look) == due != set()
    returns = select(rows, part="reversal", quantity="return_error")
    radii = sorted({row["radius"] for row in returns})
    for radius, look in zip(radii, (*style.SERIES, (style.ORANGE, "v")), strict=True):
        (exponent,) = select(rows, radius=radius, quantity="exponent", case="separation")
        own = select(returns, radius=radius)
        due = {(exponent["value"] * row["count"] / math.log(2), row["value"]) for row in own}
        assert points(axes["c"], *look) == due


def test_tails_are_those_of_the_table_with_their_laws():
    for (event, radius, own), look in zip(tail_cases(), tails.CASE_LOOKS, strict=False):
        rates = select(table("tails"), event=event, radius=radius, quantity="rate")
        axes = drawn("tails")["exponential" if rates else "tails"]
        line = next(n for n in axes.lines if n.get_color() == look[0] and n.get_marker() == "None")
        times, values = line.get_data()
        if rates:
            (rate,) = rates
            within = [row for row in own if rate["time"] <= row["time"] <= rate["until"]]
            log = [math.log(r["estimate"]) + rate["estimate"] * r["time"] for r in within]
            end = np.array([rate["time"], rate["until"]])
            np.testing.assert_allclose(times * rate["exact_mean"], end, rtol=1e-12)
            assert np.log(values) + rate["estimate"] * end == pytest.approx(np.mean(log), rel=1e-12)
            number, digits, error = re.search(r"(\d\.(\d*))\((\d+)\)/", line.get_label()).groups()
            of_unit = 10 ** len(digits) * rate["exact_mean"]
            assert float(number) == round(rate["estimate"] * rate["exact_mean"], len(digits))
            assert int(error) == round(rate["stderr"] * of_unit)
        else:
            laws = {row["time"] / row["exact_mean"]: row["law"] for row in own}
            assert [laws[t] for t in times] == [*values]
            assert len(times) > 5


def test_curves_of_thresholds_are_exact_and_crosses_are_first_passages():
    hops, ratios = drawn("thresholds").values()
    for event, (colour, _) in style.EVENT_LOOKS.items():
        law = leading_law(PAPER, event) if event in SHELL_EVENTS else None
        if law is None:
            continue
        for axes in (hops, ratios)[event not in HOPS :]:
            lines = [line for line in axes.lines if line.get_color() == colour]
            curve = max(lines, key=lambda n: (n.get_linestyle() == "-", len(n.get_xdata())))
            radii = law.limit * (1 - np.array(curve.get_xdata()))
            due = [td.mean_times(PAPER.scene(radius))[f"{event}_time"] for radius in radii]
            unit = law(radii) if axes is ratios else 1
            np.testing.assert_allclose(curve.get_ydata(), np.divide(due, unit), rtol=1e-9)
        if event in HOPS:
            rows = select(table("distributions"), event=event, quantity="first_passage", last=None)
            rows = near(PAPER, law, select(rows, scene=rows[0]["scene"]))
            due = {(1 - row["radius"] / law.limit, row["estimate"]) for row in rows}
            assert points(hops, colour, "x") == due != set()
