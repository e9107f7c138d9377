"""What the figure of effects is made of: its counts, its table, its jobs, the figure itself."""

import ast
import json
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from fabricated import Laws, command, make_table, store
from figure_cases import shown_texts, unclear
from matplotlib.colors import to_rgba

from twodiscs import benchmark
from twodiscs.comparison import estimates, scores
from twodiscs.dynamics import counting
from twodiscs.dynamics.ensemble import REPLICAS
from twodiscs.dynamics.law import law_of
from twodiscs.dynamics.trajectory import follow
from twodiscs.figures.kit import style
from twodiscs.model.box import Box
from twodiscs.model.scene import Scene
from twodiscs.pipeline import jobs
from twodiscs.pipeline.configuration import scene_file
from twodiscs.pipeline.configuration.load import load
from twodiscs.pipeline.configuration.reading import read
from twodiscs.sampling.starts import draw_any_starts, origins
from twodiscs.sampling.streams import open_stream
from twodiscs.studies.effects import figure
from twodiscs.studies.effects import measure as effects
from twodiscs.studies.effects.table import Effects, EffectsCost
from twodiscs.theory import exact, tails

FILES = sorted((Path(__file__).parents[2] / "config" / "scenes").glob("*.yaml"))
NAMES = [path.stem for path in FILES]
PLAIN = Box(1.5, 1.0)
ROUGH = Scene(1.5, 1.0, 0.24, moment_of_inertia=0.5)
SEED = 1908


# Scenes and counts --------------------------------------------------------------------------------


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_a_scene_has_the_parameters_that_it_has_alone(path):
    """Those of its file laid over config.yaml, as Snakemake lays it."""
    below = read(path.parents[1] / "config.yaml")
    (alone,) = load(below | read(path)).scenes
    job = scene_file.effects_job(path, below["seed"])
    box, dynamics = {"box": job["box"]}, job["dynamics"]
    keys = alone.keys["dynamics"]
    assert [box | one for one in dynamics] == [alone.job("dynamics", key) for key in keys]
    assert (job["name"], job["seed"]) == (path.stem, below["seed"])
    other = scene_file.effects_job(path, SEED + 1)
    assert other["seed"] == SEED + 1
    assert not {one["seed"] for one in other["dynamics"]} & {one["seed"] for one in dynamics}


@pytest.mark.parametrize("scene", [ROUGH, ROUGH.with_radius(0.1), Scene(1.5, 1.0, 0.24)], ids=str)
def test_unmet_starts_are_those_whose_paths_have_no_collision(scene):
    """Against the trajectories that are written for people, start by start."""
    times, seed, replicas = (2.0, 6.0, 15.0), np.uint64(3), 48
    draw, prism = origins(scene)
    starts = np.zeros((12, replicas))
    draw_any_starts(open_stream(seed, 0), draw, (0, 0), starts, prism)
    components = 8 if scene.moment_of_inertia is None else 10
    first = []
    for start in starts.T:
        rows = follow(scene, tuple(map(float, start[:components])), times[-1])
        first.append(next((row[0] for row in rows if row[5] == "disc_collision"), np.inf))
    expected = [sum(moment > time for moment in first) for time in times]
    law = law_of(scene)
    found = effects.follow_survivors(seed, 0, 1, replicas, np.array(times), law, draw, prism)
    assert list(found) == expected
    assert 0 < expected[0] < replicas


def test_unmet_starts_add_up_over_blocks_and_times_descend():
    found = effects.survivors(ROUGH, (1.0, 10.0, 100.0), 2, 5)
    assert found == sorted(found, reverse=True)
    draw, prism = origins(ROUGH)
    arguments = REPLICAS, np.array([1.0, 10.0, 100.0]), law_of(ROUGH), draw, prism
    parts = [effects.follow_survivors(np.uint64(5), i, i + 1, *arguments) for i in range(2)]
    assert found == list(sum(parts))


def test_rough_discs_stay_apart_where_smooth_ones_follow_their_law():
    """At 100, in 2^18 starts: binomial and Poisson, five sigma each: one false alarm in 1e6.

    The share of smooth discs is within 40 % of its law by then: what is left to go falls as τ/t.
    """
    starts = 256 * REPLICAS
    (rough,) = effects.survivors(ROUGH, (100.0,), 256, 1)
    smooth_scene = Scene(1.5, 1.0, 0.1)
    (smooth,) = effects.survivors(smooth_scene, (100.0,), 256, 1)
    share = estimates.binomial_estimate(rough, starts, 1.0)
    assert abs(share.value - 2.28e-3) < 5 * share.stderr + 5 * 5e-5  # from 2^20 other starts
    law = starts * effects._law(smooth_scene, 100.0)
    assert abs(smooth - law) < 5 * law**0.5 + 0.4 * law
    assert 10 < law < 0.05 * rough


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ((0.2, (1.0,), 1, 1), "scene must be a Scene"),
        ((ROUGH, (2.0, 1.0), 1, 1), "times must ascend"),
        ((ROUGH, (1.0,), 0, 1), "blocks must"),
        ((ROUGH, (1.0,), 1, -1), "seed must"),
    ],
)
def test_bad_requests_are_refused(arguments, said):
    with pytest.raises(ValueError, match=said):
        effects.survivors(*arguments)


# The table ----------------------------------------------------------------------------------------


@cache
def request(name):
    """Return the ``SceneRequest`` of a file."""
    (scene,) = load({"seed": SEED} | read(FILES[NAMES.index(name)])).scenes
    return scene


def rows_of(found, folder):
    """Return the rows of effects.csv of points, {name: what ``job`` returned}, as if from files."""
    return list(effects.rows(store(folder, found)))


@pytest.mark.parametrize("name", ["rough", "unequal"])
def test_a_cheap_run_agrees_with_theory(name, tmp_path):
    """A small budget at a third of the radii: within Bonferroni's bound for one alarm in 1e6."""
    asked = scene_file.effects_job(FILES[NAMES.index(name)], SEED)
    cheap = [one | {"event_budget": 10**6} for one in asked["dynamics"][1::3]]
    box = Box(**asked["box"])
    found = effects.job(**asked | {"box": box, "dynamics": cheap}, blocks=1)
    rows = rows_of({name: found}, tmp_path)
    z = [abs(row["z"]) for row in rows if row["z"] is not None]
    assert max(z) < scores.bonferroni_bound(len(z), 1e-6)
    measured = {(row["radius"], row["quantity"]) for row in rows if row["stderr"]}
    for one in cheap:
        assert {(one["radius"], f"{event}_time") for event in figure.SHOWN_EVENTS} <= measured
    assert bool(found["unmet"]) == (name == "rough")
    # The same job as that of the scene alone: seeds depend on nothing else.
    alone = request(name)
    given = alone.job("dynamics", list(alone.keys["dynamics"])[1]) | {"event_budget": 10**6}
    assert found["dynamics"][0] == counting.count_events(
        box.scene(given["radius"]), given["accuracy"], given["event_budget"], given["seed"]
    )


def fabricated(rng, name):
    """Return what ``job`` would of a scene, drawn from the exact theory."""
    asked = request(name)
    points = [
        Laws(scene).dynamics(rng, relative=1e-2, events=scene.events)
        for scene in map(asked.box.scene, asked.radii)
    ]
    survivors = [
        {"radius": 0.24, "effects": some, "starts": 10**6, "counts": counts}
        for some, counts in ((asked.effects, [2400, 2000, 1900]), ({}, [15, 1, 0]))
    ]
    return {
        "name": name,
        "box": asked.box.parameters(),
        "dynamics": points,
        "unmet": survivors if name == "rough" else [],
    }


@pytest.fixture(scope="module")
def found():
    """What is counted of the six scenes, fabricated."""
    rng = np.random.default_rng(1)
    return {name: fabricated(rng, name) for name in NAMES}


@pytest.fixture(scope="module")
def rows(found, tmp_path_factory):
    """The rows of effects.csv of the six scenes."""
    return rows_of(found, tmp_path_factory.mktemp("points"))


def test_rows_have_the_exact_times_with_and_without_effects(rows):
    for name in NAMES:
        asked = request(name)
        own = [r for r in rows if r["scene"] == name and r["quantity"] != "never_met_share"]
        assert [row["radius"] for row in own] == [
            r for r in asked.radii for _ in asked.watch.mean_times
        ]
        for row in own:
            assert ast.literal_eval(row["effects"]) == asked.effects
            event, radius = row["quantity"].removesuffix("_time"), row["radius"]
            assert row["exact"] == exact.mean_times(asked.box.scene(radius))[event]
            box = Box(row["width"], row["height"])
            plain = exact.mean_times(box.scene(radius))[event] if box.fits(radius) else None
            assert row["plain"] == plain
    assert any(row["plain"] is None for row in rows if row["scene"] == "torus")
    statuses = {row["status"] for row in rows if row["scene"] == "field"}
    assert statuses == {"reached", "impossible"}


def test_rows_of_shares(rows):
    rows = [row for row in rows if row["quantity"] == "never_met_share"]
    assert {row["scene"] for row in rows} == {"rough"}
    assert [row["duration"] for row in rows] == 2 * [1e2, 1e3, 1e4]
    rough, smooth = rows[2], rows[3]
    assert rough["estimate"] == pytest.approx(1.9e-3)
    assert rough["stderr"] == pytest.approx((1.9e-3 * (1 - 1.9e-3) / 1e6) ** 0.5)
    assert [row["status"] for row in rows] == 3 * ["sampled"] + 2 * ["too-few"] + ["none-seen"]
    assert smooth["stderr"] is None
    assert rows[5]["estimate"] is None
    # P(none within t) is the integral of P(T > s)/τ beyond t, with P → C/s³.
    scene, s = PLAIN.scene(0.24), np.geomspace(100.0, 1e7, 4001)
    tail = tails.tail_constant(scene, "disc_collision") / s**3
    assert smooth["plain"] == pytest.approx(
        np.trapezoid(tail * s, np.log(s)) / exact.mean_times(scene)["disc_collision"], rel=1e-4
    )


def test_the_job_of_a_scene_is_that_of_its_file(tmp_path, monkeypatch):
    """Parameters as the rule hands them on: in a file, with one radius and few events."""
    asked = scene_file.effects_job(FILES[NAMES.index("unequal")], SEED)
    asked["dynamics"] = [asked["dynamics"][0] | {"event_budget": 10**5}]
    parameters, output = tmp_path / "parameters.json", tmp_path / "unequal.json"
    parameters.write_text(json.dumps(asked))
    words = ["point", "studies.effects.measure", "--parameters", f"@{parameters}"]
    assert command(monkeypatch, jobs, *words, "--output", output) == 0
    point = json.loads(output.read_text())
    assert point == effects.job(**asked | {"box": Box(**asked["box"])})


def test_the_job_of_the_table_gathers_the_points(found, rows, tmp_path, monkeypatch):
    paths = store(tmp_path / "points", found)
    output = tmp_path / "effects.csv"
    assert make_table(monkeypatch, "effects", {}, output, "--points", *paths) == 0
    assert Effects.read(output) == rows
    assert list(dict.fromkeys(row["scene"] for row in rows)) == NAMES


# The figure ---------------------------------------------------------------------------------------

RATIOS = {"plain": 1.0, "plain_walls": 1.05}


def costs():
    """Return rows of effects_cost.csv: ratios of 0.5, 0.6, … in their order."""
    ratios = RATIOS | {name: 0.5 + 0.1 * i for i, name in enumerate(NAMES)}
    start = {"benchmark": "effects", "unit": "1/s"}
    return [
        EffectsCost.empty(**start, variant=name, value=1e8 * ratio, ratio=ratio)
        for name, ratio in ratios.items()
    ]


@pytest.fixture(scope="module")
def drawn(rows):
    """The figure of the six scenes."""
    with style.context():
        return figure.draw(tables={"effects": rows, "effects_cost": costs()})


def test_texts_of_the_figure_stand_clear(drawn):
    with style.context():
        assert unclear(drawn) == []
        said = " ".join(text for text, _ in shown_texts(drawn))
    assert all(f"{name}: " in said for name in NAMES)


def of_colour(axes, colour):
    """Return the lines of ``axes`` in this colour."""
    return [line for line in axes.lines if to_rgba(line.get_color()) == to_rgba(colour)]


def test_curves_go_through_the_exact_ratios_and_symbols_are_the_estimates(drawn, rows):
    for i, event in enumerate(figure.SHOWN_EVENTS):
        main = drawn.axes[2 * i]
        for k, name in enumerate(NAMES):
            colour = figure._look(k)[0]
            own = [r for r in rows if r["scene"] == name and r["quantity"] == f"{event}_time"]
            (curve,) = [line for line in of_colour(main, colour) if len(line.get_xdata()) > 20]
            x, y = curve.get_data()
            assert np.isfinite(y).any() == bool(own)
            known = [r for r in own if r["exact"] and r["plain"]]
            for row in known:
                # Radii are dense: between two of them a straight line is within 2 % of the curve.
                inside = np.isfinite(y)
                ratio = row["exact"] / row["plain"]
                assert np.interp(row["radius"], x[inside], y[inside]) == pytest.approx(
                    ratio, rel=0.02
                )
            shown = [line for line in of_colour(main, colour) if line.get_marker() != "None"]
            values = {round(v, 12) for line in shown for v in line.get_ydata() if v is not None}
            assert {round(r["estimate"] / r["plain"], 12) for r in known if r["stderr"]} <= values


def test_a_curve_ends_where_its_event_does(drawn):
    ends = {"vertical_hop": 0.375, "disc_collision": PLAIN.largest_radius}
    for i, event in enumerate(ends):
        for line in drawn.axes[2 * i].lines:
            x, y = line.get_data()
            if len(x) > 20 and np.isfinite(y).any():
                last = x[np.isfinite(y)][-1]
                assert ends[event] - 1e-3 < last < ends[event]
    colour = figure._look(NAMES.index("rough"))[0]
    rough = next(line for line in of_colour(drawn.axes[0], colour) if len(line.get_xdata()) > 20)
    y = rough.get_ydata()
    np.testing.assert_allclose(y[np.isfinite(y)], 1.25, rtol=1e-12)


def test_costs_are_over_the_plain_scene(drawn):
    axes = drawn.axes[-1]
    shown = [line.get_xdata()[0] for line in axes.lines if line.get_marker() not in ("None", "")]
    expected = [1 / row["ratio"] for row in costs() if row["variant"] != "plain"]
    assert shown == pytest.approx(expected)


def test_looks_differ_however_many_scenes():
    looks = [figure._look(i) for i in range(36)]
    assert len(set(looks)) == 36
    assert len({colour for colour, _ in looks[:6]}) == len({marker for _, marker in looks[:6]}) == 6


# What an event costs ------------------------------------------------------------------------------


def test_costs_are_of_every_scene_and_of_what_is_watched(monkeypatch):
    """The speeds are fabricated: seconds are the events of the plain scene, halved without hops."""
    watched = {}

    def lockstep(blocks, scene, events):
        watched[scene.has_effects, tuple(events)] = scene
        return 2.0 if scene.has_effects else 4.0, 1.0 if len(events) == 6 else 0.5

    monkeypatch.setattr(benchmark, "lockstep", lockstep)
    rows = benchmark.effects_rows(
        {"torus": {"periodic": "xy"}, "rough": {"moment_of_inertia": 0.5}}
    )
    assert {row["variant"]: row["ratio"] for row in rows} == {
        "plain": 1.0, "torus": 1.0, "rough": 0.5, "plain_walls": 2.0
    }  # fmt: skip
    assert (True, ("disc_collision",)) in watched
    assert (False, ("right_wall", "top_wall", "any_wall")) in watched
