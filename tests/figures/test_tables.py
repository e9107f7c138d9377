"""Figures show their tables: symbols, error bars and curves against the committed results."""

import math
from functools import cache
from itertools import groupby, pairwise
from pathlib import Path

import numpy as np
import pytest
from figure_cases import PAPER, bars, draw, points, tables_of
from matplotlib.patches import StepPatch

from twodiscs.comparison.scene_tables import SCENE_TABLES
from twodiscs.comparison.transmission import box_time
from twodiscs.figures import curves, style
from twodiscs.figures.catalogue import FIGURES
from twodiscs.figures.style import LOOKS
from twodiscs.model.events import HOPS, SHELLS
from twodiscs.theory import exact, virial
from twodiscs_paper.catalogue import STUDY_FIGURES, STUDY_TABLES, read_table
from twodiscs_paper.drawings import DRAW
from twodiscs_paper.studies.effects import figure as effects
from twodiscs_paper.studies.passages import figure as passages
from twodiscs_paper.studies.passages import figure_brownian as brownian
from twodiscs_paper.studies.passages import figure_diffusion as diffusion
from twodiscs_paper.studies.passages import figure_files as files
from twodiscs_paper.studies.passages import figure_friction as friction
from twodiscs_paper.studies.passages import figure_transmission as transmission
from twodiscs_paper.studies.tails import figure as tails
from twodiscs_paper.studies.thresholds.measure import leading_law, near

EXPECTED = Path(__file__).parents[2] / "paper" / "expected"
TABLES = SCENE_TABLES | STUDY_TABLES


@cache
def table(name):
    """Return the rows of a committed table; costs, which are times, are made up."""
    if name == "effects_cost":
        variants = ["plain", *dict.fromkeys(row["scene"] for row in table("effects"))]
        return [
            TABLES[name].empty(variant=v, ratio=1 / (1 + i), instructions=4000 + i)
            for i, v in enumerate(variants)
        ]
    folder = EXPECTED / "paper" if name in SCENE_TABLES else EXPECTED
    return TABLES[name].read(folder / f"{name}.csv")


@cache
def drawn(name):
    """Return {label of the panel, or its place: axes} of a figure of the committed tables."""
    entry = (FIGURES | STUDY_FIGURES)[name]
    tables = {name: table(name) for name in (*entry.tables, *entry.main_tables)}
    tables |= {name: read_table(EXPECTED.parents[1] / path) for name, path in entry.kept.items()}
    with style.context():
        figure = DRAW[name](PAPER, tables) if name in DRAW else draw(name, PAPER, tables)
    return {axes.get_label() or i: axes for i, axes in enumerate(figure.axes)}


def of(rows, **wanted):
    return [row for row in rows if all(row[name] == value for name, value in wanted.items())]


def cases():
    """Yield (figure, panel, colour, marker, (x, y, standard error) of all symbols of this look)."""
    yield from _passages()
    yield from _pressure()
    yield from _thresholds()
    yield from _distributions()
    yield from _brownian()
    rows = table("tails")
    for (event, radius), look in zip(
        dict.fromkeys((row["event"], row["radius"]) for row in rows), tails.LOOKS, strict=False
    ):
        own = [
            (row["time"] / row["exact_mean"], row["estimate"], row["stderr"], row["law"])
            for row in of(rows, event=event, radius=radius)
            if row["quantity"] == "survival"
            and row["stderr"]
            and row["stderr"] < 0.3 * row["estimate"]
        ]
        if all(law for *_, law in own):
            yield "tails", "ratio", *look, [(t, y / law, s / law) for t, y, s, law in own]
        else:
            yield "tails", "exponential", *look, [(t, y, s) for t, y, s, _ in own]
    rows = [row for row in table("more_discs") if row["dynamics"]]
    for radius in sorted({row["radius"] for row in rows}):
        for event, look in LOOKS.items():
            own = of(rows, radius=radius, event=event)
            pairs = [
                {"vertical_hop": n * (n - 1) / 2, "right_wall": 1 / n, "top_wall": 1}.get(
                    event, n - 1
                )
                for n in (row["discs"] for row in own)
            ]
            due = [
                (row["discs"], n * row["dynamics"], n * row["dynamics_stderr"])
                for row, n in zip(own, pairs, strict=True)
            ]
            yield "more_discs", f"radius {radius}", *look, due
    rows = [row for row in table("effects") if row["quantity"] != "never_met_share"]
    for k, scene in enumerate(dict.fromkeys(row["scene"] for row in rows)):
        for i, event in enumerate(effects.SHOWN_EVENTS):
            own = of(rows, scene=scene, quantity=f"{event}_time")
            due = [
                (row["radius"], row["estimate"] / row["plain"], row["stderr"] / row["plain"])
                for row in own
                if row["stderr"] and row["plain"]
            ]
            yield "effects", "abc"[i], *effects._look(k), due
    rows = of(table("stability"), part="coverage")
    radii = sorted({row["radius"] for row in rows})
    for i, (event, look) in enumerate(LOOKS.items()):
        beside = 0.12 * (i - (len(LOOKS) - 1) / 2)
        own = [row for row in of(rows, quantity=event) if row["value"] is not None]
        due = [(radii.index(row["radius"]) + beside, row["value"], row["stderr"]) for row in own]
        yield "stability_of_runs", "d", *look, due


def _over_cube_root(row):
    """Return a ``row`` on κ of a horizontal hop as one on (1 − κ)(w − σ)/∛(σ²(h − 2σ)).

    Its distance becomes the sixth root.
    """
    sigma = 2 * row["radius"]
    factor = (row["width"] - sigma) / math.cbrt(sigma**2 * (row["height"] - 2 * sigma))
    moved = {"estimate": (1 - row["estimate"]) * factor, "stderr": row["stderr"] * factor}
    return row | moved | {"distance": row["distance"] ** (1 / 6)}


def _passages():
    rows = table("passages")
    first = rows[0]["scene"]
    ours = of(rows, scene=first, event="horizontal_hop", periodic=None, friction=None)
    for inertia, look in passages.LOOKS.items():
        own = of(ours, moment_of_inertia=inertia)
        kappa, times = of(own, quantity="coefficient"), of(own, quantity="passage_time")
        yield "passages", "times", *look, _columns(times, "distance")
        if inertia is None:
            kept = of(_long_run("passages"), quantity="coefficient", scene="h/4")
            kappa = [*kappa, *kept]
            kappa = [_over_cube_root(row) for row in kappa]
        yield "transmission", "rough" if inertia else "smooth", *look, _columns(kappa, "distance")
        shown = [2.0**-n for n in passages.SHOWN.get(inertia, ())]
        curves = [row for row in of(own, quantity="correlation") if row["distance"] in shown]
        if curves:
            due = [(row["time"] / _unit(row), row["estimate"], row["stderr"]) for row in curves]
            yield "passages", "curves", *look, due
        # Both methods, open symbols and dots.
        yield (
            "diffusion",
            "ring",
            *look,
            _columns(
                of(rows, quantity="diffusion", discs=2, moment_of_inertia=inertia), "distance"
            ),
        )
    for discs, look in diffusion.FILES.items():
        own = of(_long_run("files"), quantity="diffusion", discs=discs)
        yield "diffusion", "files", *look, _columns(own, "distance")
    yield from _long_files(_long_run("displacements"))
    for rate, look in friction.LOOKS.items():
        own = of(rows, friction=rate, quantity="coefficient")
        yield "friction", "kappa", *look, [(_scaled(r), r["estimate"], r["stderr"]) for r in own]
        steps = of(rows, friction=rate, quantity="local_exponent")
        # The first distance has no exponent.
        middle = [math.sqrt(_scaled(a) * _scaled(b)) for a, b in pairwise(own)]
        due = [(x, r["estimate"], r["stderr"]) for x, r in zip(middle, steps, strict=True)]
        yield "friction", "exponent", *look, due


def _long_run(name):
    return read_table(EXPECTED.parent / "long_run" / name / "passages.csv")


def _long_files(rows):
    """Yield the symbols of long files in the figures of diffusion and of files."""
    looks = {False: diffusion.SMOOTH_FILE, True: diffusion.KICKED_FILE}
    order = of(rows, quantity="diffusion", method="order")
    for is_kicked, look in looks.items():
        own = [row for row in order if bool(row["friction"]) == is_kicked]
        yield "diffusion", "files", *look, _columns(own, "distance")
        # At the first blocked radius, and at the farthest distance where discs pass.
        moved = [
            row for row in of(rows, quantity="displacement")
            if row["moment_of_inertia"] is None and bool(row["friction"]) == is_kicked
            and (row["radius"] == 0.28 or row["distance"] > 0.1)
        ]  # fmt: skip
        due = [
            (row["time"] / math.sqrt(2 * row["discs"] - 1), row["estimate"], row["stderr"])
            for row in moved
        ]
        yield "files", "moved", *look, due
    due = [
        (row["time"] / math.sqrt(3 * row["discs"]), row["estimate"], row["stderr"])
        for row in of(rows, quantity="displacement", moment_of_inertia=0.5)
    ]
    yield "files", "moved", *files.ROUGH_FILE, due
    kicked = [row for row in order if row["friction"]]
    for look, row in zip(files.OPEN, kicked, strict=True):
        where = {"distance": row["distance"], "friction": row["friction"]}
        (single,) = of(rows, quantity="single_file", **where)
        (rate,) = of(rows, quantity="rate", discs=row["discs"], **where)
        twice_d = row["estimate"] * rate["estimate"]
        # F √t = 2 D t at this time.
        time = (single["estimate"] / twice_d) ** 2
        unit = twice_d * time
        due = [
            (r["time"] / time, r["estimate"] / unit, r["stderr"] / unit)
            for r in of(rows, quantity="displacement", **where)
        ]
        yield "files", "collapse", *look, due


def _scaled(row):
    """Return γ√(εσ) of a ``row`` with friction."""
    sigma = 2 * row["radius"]
    return row["friction"] * math.sqrt((row["height"] - 2 * sigma) * sigma)


def _unit(row):
    return box_time(PAPER.scene(row["radius"]), "horizontal_hop")


def _columns(rows, x):
    return [(row[x], row["estimate"], row["stderr"]) for row in rows]


def _pressure():
    rows = [row for row in table("mean_times") if row["stderr"] is not None]
    factors = (
        ("main", dict.fromkeys(("right_wall", "top_wall"), virial.pressure_factor)),
        ("beneath", {
            event: lambda scene, event: abs(virial.weights(scene)[event])
            for event in ("right_wall", "top_wall", "disc_collision")
        }),
    )  # fmt: skip
    for panel, events in factors:
        for (event, factor), look in zip(events.items(), style.SERIES, strict=False):
            due = []
            for row in of(rows, event=event):
                scene = PAPER.scene(row["radius"])
                value = factor(scene, event) * scene.accessible_fraction(event) / row["estimate"]
                due.append((row["radius"], value, value * row["stderr"] / row["estimate"]))
            yield "pressure", panel, *look, due


def _thresholds():
    for event, look in LOOKS.items():
        law = leading_law(PAPER, event) if event in SHELLS else None
        if law:
            rows = near(PAPER, law, of(table("mean_times"), event=event))
            own = [(1 - r["radius"] / law.limit, r["estimate"], r["stderr"]) for r in rows]
            units = [law(row["radius"]) for row in rows]
            if event in HOPS:
                yield "thresholds", "hops", *look, own
            due = [(x, y / unit, s / unit) for (x, y, s), unit in zip(own, units, strict=True)]
            yield "thresholds", "ratios", *look, due


def _distributions():
    rows = of(table("distributions"), scene=table("distributions")[0]["scene"])
    event = rows[0]["event"]
    radii = list(dict.fromkeys(row["radius"] for row in of(rows, event=event)))
    for radius, look in zip(radii, style.SERIES, strict=False):
        due = [
            ((row["first"] + row["last"]) / 2 / mean, row["estimate"] * mean, row["stderr"] * mean)
            for row in of(rows, event=event, radius=radius, quantity="hazard")
            for mean in [row["exact_mean"]]
            if row["stderr"] < 0.15 * row["estimate"]
        ]
        yield "distributions", "rates", *look, due
    for hop, look in zip(HOPS, style.SERIES, strict=False):
        own = of(rows, event=hop, quantity="first_passage", last=None)
        columns = (("estimate", "stderr"), ("reference", "reference_stderr"))
        due = [
            (row["radius"], row[y] / row["exact_mean"], row[s] / row["exact_mean"])
            for row in own
            for y, s in columns
        ]
        yield "distributions", "passages", *look, due


def _brownian():
    """Open and full symbols of one look are of crossings and of first passages."""
    (path,) = STUDY_FIGURES["brownian"].kept.values()
    rows = [row for row in read_table(EXPECTED.parents[1] / path) if row["stderr"] is not None]
    for program, (colour, _) in brownian.LOOKS.items():
        for step, marker in brownian.MARKERS.items():
            own = of(rows, program=program, step=step)
            for panel, quantity in (("kappa", "coefficient"), ("exponent", "local_exponent")):
                due = _columns(of(own, quantity=quantity), "neck")
                yield "brownian", panel, colour, marker, due


CASES = [case for case in cases() if case[-1]]


@pytest.mark.parametrize(
    ("name", "panel", "colour", "marker", "due"),
    CASES,
    ids=[f"{name}-{panel}-{colour}{marker}" for name, panel, colour, marker, _ in CASES],
)
def test_symbols_and_error_bars_are_those_of_the_table(name, panel, colour, marker, due):
    shown = bars(drawn(name)[panel], colour, marker)
    assert len(shown) == len(due)
    np.testing.assert_allclose(shown, sorted(due), rtol=1e-7)


def test_every_figure_of_a_study_is_compared():
    """Costs are times, which no table of the repository has: tests of the study compare them."""
    compared = {name for name, *_ in CASES}
    costs = {"accuracy_cost", "accuracy_cost_by_radius", "stability"}
    assert compared | costs >= STUDY_FIGURES.keys()


def test_what_passages_leave_falls_at_twice_their_rate():
    """The curves κ exp(−2κt/τ) of the figure, at all their times."""
    rows = of(table("passages"), scene=table("passages")[0]["scene"], event="horizontal_hop")
    rows = of(rows, friction=None)
    shown = [
        line.get_data()
        for line in drawn("passages")["curves"].lines
        if line.get_color() == style.BLACK and len(line.get_xdata()) == 30
    ]
    due = [
        row
        for inertia, halvings in passages.SHOWN.items()
        for n in halvings
        for row in of(rows, quantity="coefficient", moment_of_inertia=inertia, distance=2.0**-n)
    ]
    assert len(shown) == len(due) > 2
    for (times, values), row in zip(shown, due, strict=True):
        kappa, rate = row["estimate"], 1 / row["exact_mean"]
        expected = [kappa * math.exp(-2 * kappa * rate * t * _unit(row)) for t in times]
        np.testing.assert_allclose(values, expected, rtol=1e-12)


def test_the_laws_of_passages_with_friction_are_one_and_three_quarters_over_x():
    dashed = [line for line in drawn("friction")["kappa"].lines if line.get_linestyle() == "--"]
    one, diffusive = (line.get_xydata() for line in dashed)
    assert np.all(one[:, 1] == 1)
    np.testing.assert_allclose(diffusive[:, 0] * diffusive[:, 1], 0.75, rtol=1e-12)


def test_residuals_are_those_of_the_table():
    for name, looks in (("transmission", transmission), ("diffusion", diffusion)):
        for quantity, (colour, marker, _) in looks.RESIDUAL_LOOKS.items():
            rows = [*table("passages"), *_long_run("displacements")]
            rows = of(rows, quantity=quantity)
            # Two discs with friction have a figure of their own.
            rows = [row for row in rows if row["friction"] is None or row["discs"] > 2]
            due = {(r["distance"], r["z"]) for r in rows if r["z"] is not None and r["distance"]}
            axes = drawn(name)["residuals" if "residuals" in drawn(name) else quantity]
            assert points(axes, colour, marker) == due


def test_the_panels_of_stability_are_those_of_the_table():
    rows, (volume, _) = table("stability"), style.SERIES[:2]
    shares = of(rows, part="sampling", case="largest radius", method="conditioned")
    due = {(-row["distance"], row["value"]) for row in shares}
    assert points(drawn("stability")["c"], *volume) == due
    estimates = of(rows, part="estimates", status="sampled")
    extremes = [row for row in of(rows, part="extremes") if row["z"] is not None]
    axes, edges = drawn("stability")["d"], np.arange(-5, 6)
    counts = [np.histogram([r["z"] for r in own], edges)[0] for own in (estimates, extremes)]
    for bars_of, due in zip(axes.containers, counts, strict=True):
        assert [bar.get_height() for bar in bars_of] == [*due]
    (law,) = [patch for patch in axes.patches if isinstance(patch, StepPatch)]
    assert law.get_data().values.sum() == pytest.approx(sum(map(sum, counts)), rel=1e-6)
    assert law.get_data().values[5] / law.get_data().values[6] == pytest.approx(2.5116, rel=1e-4)
    theory, end = of(rows, part="theory"), "largest radius"
    for panel, own in (
        ("a", of(theory, case=end)),
        ("b", [row for row in theory if row["case"] != end]),
    ):
        for look, series in (
            ((style.VERMILLION, "s"), of(own, method="closed-form", quantity="volume")),
            ((style.ORANGE, "D"), of(own, method="closed-form", quantity="areas")),
            (volume, of(own, method="stable")),
        ):
            worst = {}
            for row in series:
                errors = worst.setdefault(abs(row["distance"]), [1e-17])
                errors.append(row["value"])
            due = {(distance, max(errors)) for distance, errors in worst.items()}
            assert points(drawn("stability")[panel], *look) == due != set()


def test_the_panels_of_stability_of_runs_are_those_of_the_table():
    rows, axes = table("stability"), drawn("stability_of_runs")
    for quantity, sign, colour, marker in (
        ("energy_error", 1, style.BLUE, "o"),
        ("smallest_gap", -1, style.VERMILLION, "s"),
        ("excess", 1, style.GREEN, "^"),
    ):
        due = {max(sign * row["value"], 1e-17) for row in of(rows, quantity=quantity)}
        assert {x for x, _ in points(axes["a"], colour, marker)} == due != set()
    for method, quantity, look in (
        ("stable", "contact_time", style.SERIES[0]),
        ("stable", "wall_time", style.SERIES[1]),
        ("textbook", "contact_time", (style.VERMILLION, "x")),
    ):
        due = {row["value"] for row in of(rows, part="times", quantity=quantity, method=method)}
        assert {x for x, _ in points(axes["b"], *look)} == due != set()
    extremes = of(rows, part="extremes")
    places = [*dict.fromkeys(row["case"] for row in extremes)]
    for event, look in LOOKS.items():
        own = [row for row in of(extremes, quantity=f"{event}_time") if row["z"] is not None]
        due = {(row["z"], places.index(row["case"])) for row in own}
        assert points(axes["e"], *look) == due != set()
    returns = of(rows, part="reversal", quantity="return_error")
    radii = sorted({row["radius"] for row in returns})
    for radius, look in zip(radii, (*style.SERIES, (style.ORANGE, "v")), strict=True):
        (exponent,) = of(rows, radius=radius, quantity="exponent", case="separation")
        due = {
            (exponent["value"] * row["count"] / math.log(2), row["value"])
            for row in of(returns, radius=radius)
        }
        assert points(axes["c"], *look) == due


def test_tails_are_those_of_the_table_with_their_laws():
    rows = table("tails")
    for (event, radius), look in zip(
        dict.fromkeys((row["event"], row["radius"]) for row in rows), tails.LOOKS, strict=False
    ):
        own = of(rows, event=event, radius=radius)
        shown = [
            (row["time"] / row["exact_mean"], row["estimate"], row["law"])
            for row in of(own, quantity="survival")
            if row["stderr"] and row["stderr"] < 0.3 * row["estimate"]
        ]
        rates = of(own, quantity="rate")
        axes = drawn("tails")["exponential" if rates else "tails"]
        assert points(axes, *look) == {(t, p) for t, p, _ in shown}
        line = next(n for n in axes.lines if n.get_color() == look[0] and n.get_marker() == "None")
        times, values = line.get_data()
        if rates:
            (rate,) = rates
            fall = rate["estimate"] * rate["exact_mean"] * np.ptp(times)
            assert values[0] / values[-1] == pytest.approx(math.exp(fall), rel=1e-12)
        else:
            laws = {t: law for t, _, law in shown}
            assert [laws[t] for t in times] == [*values]
            assert len(times) > 5


def test_curves_of_thresholds_are_exact_and_crosses_are_first_passages():
    hops, ratios = drawn("thresholds").values()
    for event, (colour, _) in LOOKS.items():
        law = leading_law(PAPER, event) if event in SHELLS else None
        if law is None:
            continue
        for axes in (hops, ratios)[event not in HOPS :]:
            curve = max(
                (line for line in axes.lines if line.get_color() == colour),
                key=lambda line: (line.get_linestyle() == "-", len(line.get_xdata())),
            )
            radii = law.limit * (1 - np.array(curve.get_xdata()))
            due = [exact.mean_times(PAPER.scene(radius))[event] for radius in radii]
            unit = law(radii) if axes is ratios else 1
            np.testing.assert_allclose(curve.get_ydata(), np.divide(due, unit), rtol=1e-9)
        if event in HOPS:
            first = table("distributions")[0]["scene"]
            rows = of(table("distributions"), scene=first, event=event, quantity="first_passage")
            due = {
                (1 - row["radius"] / law.limit, row["estimate"])
                for row in near(PAPER, law, of(rows, last=None))
            }
            assert points(hops, colour, "x") == due != set()


def test_curves_of_pressures_are_exact():
    radii, columns = curves.exact_curves(PAPER)
    for event, look in zip(("right_wall", "top_wall"), style.SERIES, strict=False):
        known = np.isfinite(radii)
        scenes = [PAPER.scene(radius) for radius in radii[known]]
        factors = [
            virial.pressure_factor(scene, event) * scene.accessible_fraction(event)
            for scene in scenes
        ]
        due = factors / columns[f"{event}_time"][known]
        line = next(
            n
            for n in drawn("pressure")["main"].lines
            if len(n.get_xdata()) == len(radii) and n.get_color() == look[0]
        )
        np.testing.assert_allclose(line.get_ydata()[known], due, rtol=1e-9)


def test_rates_that_are_not_constant_are_dotted():
    rows = of(table("distributions"), scene=table("distributions")[0]["scene"])
    shown = [line for line in drawn("distributions")["rates"].lines if line.get_linewidth() == 1.4]
    found = {
        (line.get_color(), float(line.get_ydata()[0])): line.get_linestyle()
        for line in shown
        if len(line.get_xdata())
    }
    radii = dict.fromkeys(row["radius"] for row in of(rows, event=rows[0]["event"]))
    for radius, (colour, _) in zip(radii, style.SERIES, strict=False):
        own = of(rows, radius=radius, event=rows[0]["event"])
        tests = [row for row in own if row["quantity"] in ("rate", "trend")]
        (rate,) = of(tests, quantity="rate")
        constant = all(row["p"] > 1e-3 for row in tests)
        assert (found[colour, rate["estimate"] * rate["exact_mean"]] == "-") == constant


def test_the_histogram_has_the_densities_of_its_bins():
    with style.context():
        axes = draw("hop_histogram", PAPER, tables_of("paper")).axes
    rows = tables_of("paper")["hop_histogram"]
    for i, (_, group) in enumerate(groupby(rows, key=lambda row: row["radius"])):
        own, (colour, marker) = list(group), style.SERIES[i]
        for panel, bins in zip(axes, ("wide", "equal"), strict=False):
            mean = own[0]["exact_mean"]
            due = [
                (
                    (row["left"] + row["right"]) / 2 / mean,
                    row["density"] * mean,
                    row["stderr"] * mean,
                )
                for row in of(own, bins=bins)
            ]
            shown = np.array(bars(panel, colour, marker))
            assert len(shown) > 5
            for point in shown:
                assert np.isclose(due, point, rtol=1e-9).all(axis=1).any()
