"""The study of effects: shares of unmet starts, plain times and costs.

Without these tests shares of unmet starts, plain times or costs of effects could be wrong.
"""

import json
from functools import cache
from itertools import count
from subprocess import CalledProcessError

import numpy as np
import pytest
from checkout import REPOSITORY
from exact_motion import path_events
from factory import BOX, Laws, empty, of, written
from marks import slow

from twodiscs.analysis.tables import MeanTimesTable
from twodiscs.dynamics.ensemble import REPLICAS
from twodiscs.figures import style
from twodiscs.model.events import EVENTS, WALLS
from twodiscs.model.scene import Box, Scene
from twodiscs.model.seeds import key, stream_seed
from twodiscs.sampling.initial_states import draw_states, start_sampler
from twodiscs.sampling.streams import open_stream
from twodiscs.theory import exact
from twodiscs_paper.configuration.yaml_files import load, read
from twodiscs_paper.studies.effects import figure, price
from twodiscs_paper.studies.effects import measure as effects
from twodiscs_paper.studies.effects.study import SCENES, EffectsCostTable, EffectsTable
from twodiscs_paper.studies.single import tail_constant

ROUGH = Scene(1.5, 1.0, 0.24, moment_of_inertia=0.5)
SEED = 1908


# Scenes and counts --------------------------------------------------------------------------------


@pytest.mark.parametrize("scene", [ROUGH, ROUGH.with_radius(0.1), slow(BOX.scene(0.24))], ids=str)
def test_unmet_starts_are_those_whose_paths_have_no_collision(scene, monkeypatch):
    """Against the trajectories that are written for people, start by start."""
    times, replicas = (2.0, 6.0, 15.0), 48
    monkeypatch.setattr(effects, "REPLICAS", replicas)
    starts = np.zeros((12, replicas))
    draw_states(open_stream(np.uint64(3), 0), start_sampler(scene), starts)
    components = 8 if scene.moment_of_inertia is None else 10
    first = []
    for start in starts.T:
        rows = path_events(scene, tuple(map(float, start[:components])), times[-1])
        first.append(next((row[0] for row in rows if row[1] == "disc_collision"), np.inf))
    expected = [sum(moment > time for moment in first) for time in times]
    assert effects.survivors(scene, times, 1, 3) == expected
    assert 0 < expected[0] < replicas


# The table ----------------------------------------------------------------------------------------


@cache
def request(name):
    """Return the ``SceneRequest`` of the file of a scene."""
    (scene,) = load({"seed": SEED} | read(REPOSITORY / f"config/scenes/{name}.yaml")).scenes
    return scene


def tables_of(*names):
    """Return {<name>/mean_times: rows} of scenes, drawn from the exact theory."""
    tables, rng = {}, np.random.default_rng(1)
    for name in names:
        laws = [Laws(request(name).box.scene(radius)) for radius in request(name).radii]
        points = [law.dynamics(rng, relative=1e-2, events=law.scene.events) for law in laws]
        tables[f"{name}/mean_times"] = MeanTimesTable.rows(points)
    return tables


BOXES = {name: request(name).box.parameters() for name in SCENES}


@pytest.fixture(scope="module")
def rows(tmp_path_factory):
    """The rows of effects.csv of the six scenes, with fabricated counts."""

    def survivors(scene, times, blocks, seed):
        return [2400, 2000, 1900] if scene.effects else [15, 1, 0]

    given = {"tables": tables_of(*SCENES), "scenes": BOXES, "seed": SEED}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(effects, "survivors", survivors)
        return written(tmp_path_factory.mktemp("effects"), EffectsTable, **given)


def test_starts_that_have_not_met_are_counted_at_every_radius_where_discs_meet_soon(monkeypatch):
    """By streams of the scene's name and of the radius, for rough and for smooth discs."""
    asked = []
    monkeypatch.setattr(effects, "survivors", lambda *given: asked.append(given) or [9, 5, 3])
    given = {"scenes": {"rough": BOXES["rough"]}, "seed": SEED, "blocks": 1}
    rows = of(effects.rows(tables_of("rough"), **given), quantity="never_met_share")
    scenes = [
        scene
        for radius in request("rough").radii
        for scene in (Box(**BOXES["rough"]).scene(radius), BOX.scene(radius))
        if exact.mean_times(scene)["disc_collision"] <= 5
    ]
    assert [(row["radius"], row["effects"], row["replicas"]) for row in rows] == [
        (scene.radius, json.dumps(scene.effects), REPLICAS) for scene in scenes for _ in range(3)
    ]
    assert [row["count"] for row in rows] == [9, 5, 3] * len(scenes)
    streams = [stream_seed(SEED, "rough", "unmet", key(scene.radius)) for scene in scenes]
    due = [(scene, effects.TIMES, 1, seed) for scene, seed in zip(scenes, streams, strict=True)]
    assert asked == due


def test_rows_have_the_exact_times_with_and_without_effects(rows):
    for name in SCENES:
        asked, seen = request(name), []
        for row in (r for r in of(rows, scene=name) if r["quantity"] != "never_met_share"):
            event, radius = row["quantity"].removesuffix("_time"), row["radius"]
            seen.append((radius, event))
            assert json.loads(row["effects"]) == asked.effects
            assert row["exact"] == exact.mean_times(asked.box.scene(radius))[event]
            box = Box(row["width"], row["height"])
            plain = exact.mean_times(box.scene(radius))[event] if box.fits(radius) else None
            assert row["plain"] == plain
        assert seen == [(r, event) for r in asked.radii for event in asked.quantities.mean_times]
    assert of(rows, scene="torus", plain=None)
    assert {row["status"] for row in of(rows, scene="field")} == {"reached", "impossible"}


def test_rows_of_shares(rows):
    rows = of(rows, quantity="never_met_share")
    assert {row["scene"] for row in rows} == {"rough"}
    rows = of(rows, radius=0.24)
    assert [row["duration"] for row in rows] == 2 * [1e2, 1e3, 1e4]
    rough, smooth, starts = rows[2], rows[3], effects.MEETING_BLOCKS * REPLICAS
    share = 1900 / starts
    assert rough["estimate"] == pytest.approx(share)
    assert rough["stderr"] == pytest.approx((share * (1 - share) / starts) ** 0.5)
    assert [row["status"] for row in rows] == 3 * ["sampled"] + 2 * ["too-few"] + ["none-seen"]
    assert smooth["stderr"] is rows[5]["estimate"] is None
    # P(none within t) is the integral of P(T > s)/τ beyond t, with P → C/s³.
    scene, s = BOX.scene(0.24), np.geomspace(100.0, 1e7, 4001)
    tail = tail_constant(scene, "disc_collision") / s**3
    due = np.trapezoid(tail * s, np.log(s)) / exact.mean_times(scene)["disc_collision"]
    assert smooth["plain"] == pytest.approx(due, rel=1e-4)


# The figure ---------------------------------------------------------------------------------------

RATIOS = {"without_effects": 1.0, "plain": 0.99, "plain_walls": 1.05}


def costs():
    """Return rows of effects_cost.csv: ratios of 0.5, 0.6, … in their order."""
    ratios = RATIOS | {name: 0.5 + 0.1 * i for i, name in enumerate((*SCENES, *price.ADDITIONS))}
    rows = [{"variant": v, "ratio": r} for v, r in (ratios | {"all effects": 0.007}).items()]
    return [empty(EffectsCostTable, instructions=4000 + i, **row) for i, row in enumerate(rows)]


def test_curves_go_through_the_exact_ratios(rows):
    names = "rough", "torus"  # whose exact values take less time
    boxes = {name: Box(**BOXES[name]) for name in names}
    plain = Box(boxes["rough"].width, boxes["rough"].height)
    for event in figure.SHOWN_EVENTS:
        for name in names:
            x, y = figure._curve(boxes[name], plain, event)
            own = of(rows, scene=name, quantity=f"{event}_time")
            inside = np.isfinite(y)
            assert inside.any() == bool(own)
            for row in [r for r in own if r["exact"] and r["plain"]]:
                # Radii are dense: between two of them a straight line is within 2 % of the curve.
                found = np.interp(row["radius"], x[inside], y[inside])
                assert found == pytest.approx(row["exact"] / row["plain"], rel=0.02)


def test_costs_are_the_times_over_the_package_without_effects():
    """A symbol is at its ratio, which stands beside it, and so does the number of instructions."""
    axes = style.new_figure(2.0).subplots()
    figure._costs(axes, costs(), {})
    ratios = [line.get_xdata()[1] for line in axes.lines[: len(costs())]]
    assert ratios == pytest.approx([1 / row["ratio"] for row in costs()])
    numbers = {(text.get_text(), text.xy[1]) for text in axes.texts}
    for i, row in enumerate(costs()):
        assert {(f"{1 / row['ratio']:.3g}", i), (f"{row['instructions']}", i)} <= numbers
    assert [label.get_text() for label in axes.get_yticklabels()][3:] == [*SCENES, *price.ADDITIONS]


# The cost of an event -----------------------------------------------------------------------------


def test_costs_are_of_every_scene_and_of_what_is_watched(monkeypatch):
    """The speeds are fabricated: seconds are the events of the plain scene, halved without hops."""
    watched = {}

    def lockstep(blocks, scene=price.SCENE, events=EVENTS):
        watched[bool(scene.effects), tuple(events)] = scene
        return 2.0 if scene.effects else 4.0, 1.0 if events == EVENTS else 0.5

    bare = {"instructions(lockstep)": 10, f"lockstep({price.QUICK_OPTIONS['blocks']})": (8.0, 1.0)}
    monkeypatch.setattr(price, "lockstep", lockstep)
    monkeypatch.setattr(price, "result_without_effects", bare.get)
    monkeypatch.setattr(price, "instructions", lambda work: 20)
    rows = EffectsCostTable.rows({}, {name: BOXES[name] for name in ("torus", "rough")})
    assert {row["variant"]: row["ratio"] for row in rows} == {
        "without_effects": 1.0, "plain": 0.5, "torus": 0.5, "rough": 0.25, "plain_walls": 1.0,
        "friction": 0.25, "all effects": 0.5,
    }  # fmt: skip
    assert {(True, ("disc_collision",)), (False, (*WALLS, "any_wall"))} <= watched.keys()
    assert [row["variant"] for row in of(rows, instructions=10)] == ["without_effects"]
    monkeypatch.setattr(price.time, "process_time", count(1000.0).__next__)
    assert price.timed(dict) == ({}, 1.0)


@pytest.mark.slow
def test_the_engine_without_effects_counts_the_same_events_with_as_many_instructions():
    assert price.result_without_effects("lockstep(2)")[0] == price.lockstep(2)[0]
    found = price.result_without_effects("instructions(lockstep)")
    assert found == price.instructions(price.lockstep)
    rough = "__import__('twodiscs').Scene(1.5, 1, 0.2, moment_of_inertia=0.5)"
    with pytest.raises(CalledProcessError):  # the compiler never sees the code of an effect
        price.result_without_effects(f"lockstep(1, {rough}, ('any_wall',))")
