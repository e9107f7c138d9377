"""The configuration: keys, defaults and the parameters of jobs.

Without these tests a key could be lost, a default wrong, or an edit concern the wrong jobs.

Mistakes in a configuration are in ``test_bad_input.py``.
"""

from copy import deepcopy
from itertools import pairwise

import pytest
from checkout import REPOSITORY
from snakemake.utils import update_config

from twodiscs.dynamics.stages import STAGES
from twodiscs.model.events import EVENT_AXES, EVENTS, HOPS
from twodiscs.model.scene import Box, Scene
from twodiscs.model.seeds import job_seed, stream_seed
from twodiscs_paper.configuration.request import RequestedQuantities
from twodiscs_paper.configuration.yaml_files import ConfigError, check_results, load, read

PLAIN = {"scenes": [{"name": "one", "box": {"width": 1.5, "height": 1}}]}


def one(**keys):
    """The only scene of a configuration: a 1.5 × 1 box with these keys."""
    (request,) = load({"scenes": [PLAIN["scenes"][0] | keys]}).scenes
    return request


# Files of the repository


def test_the_draft_is_a_quick_look_at_the_scenes_of_the_default_configuration():
    mapping = read(REPOSITORY / "config/config.yaml")
    full = load(mapping)
    # As --configfile does: the draft's lists replace, its blocks are merged.
    update_config(mapping, read(REPOSITORY / "config/draft.yaml"))
    draft = load(mapping)
    assert (full.results, draft.results) == ("results", "results/draft")
    for quick, slow in zip(draft.scenes, full.scenes, strict=True):
        assert (quick.name, quick.box) == (slow.name, slow.box)
        assert quick.quantities.names == slow.quantities.names
        assert len(quick.radii) <= 10 < len(slow.radii)
        assert quick.dynamics["accuracy"] == dict.fromkeys(EVENTS, 1e-2)


# Defaults and forms


@pytest.mark.parametrize(("width", "height"), [(1.5, 1), (3e6, 1e6), (1e-6, 3e-6), (1, 500)])
def test_a_name_and_a_box_are_enough(width, height):
    box = {"width": width, "height": height}
    assert one(box=box).quantities.names == {f"{event}_time" for event in EVENTS}
    request = one(box=box, watch=True)
    assert len(request.radii) == 24
    parts = (f"{event}_{part}" for event in EVENTS for part in ("area", "time"))
    assert request.quantities.names == {"volume", "hop_histogram", "trajectory", *parts}
    assert len(request.quantities.hop_histogram) == 4
    assert all(Scene(width, height, r).vertical_hops for r in request.quantities.hop_histogram)
    assert Scene(width, height, request.quantities.trajectory).regime == "all-hops"
    assert request.dynamics["accuracy"] == dict.fromkeys(EVENTS, 3e-4)
    assert request.event_budget is None


def test_the_check_and_the_cost_of_a_scene_read_the_points_of_all_stages():
    configuration, scene = load(PLAIN), one()
    for table in ("check", "cost"):
        assert [*configuration.points(scene.name, table)] == [*scene.keys]
    assert [*scene.keys] == ["monte_carlo", "dynamics", "intervals"]
    assert [*configuration.points(scene.name, "hop_histogram")] == ["intervals"]


def test_a_watch_block_is_everything_that_is_watched():
    request = one(watch={"mean_times": ["top_wall", "right_wall"]})
    assert request.quantities.names == {"right_wall_time", "top_wall_time"}
    assert request.quantities.mean_times == ("right_wall", "top_wall")
    assert request.keys["monte_carlo"] == request.keys["intervals"] == {}
    assert tuple(request.keys["dynamics"].values()) == request.radii
    assert request.exact_radii("theory") == request.exact_radii("grid") == [*request.radii]
    assert "hop" not in repr(request.arguments("dynamics")["error"])
    assert request.tables == ("grid", "theory", "mean_times", "check", "cost")


def test_what_is_false_is_off():
    watch = {"volume": True, "areas": False, "hop_histogram": False, "trajectory": False}
    request = one(watch=watch)
    assert request.quantities.names == {"volume"}
    assert request.keys["dynamics"] == {}
    assert request.arguments("monte_carlo")["quantities"] == ["volume"]
    assert request.tables == ("grid", "theory", "volume", "check", "cost")
    thicker = one(watch=watch, monte_carlo={"shell": 0.1})
    assert thicker.arguments("monte_carlo") == request.arguments("monte_carlo")


def test_hop_histograms_have_three_forms():
    request = one(watch={"hop_histogram": [0.2, 0.1]})
    assert request.quantities.hop_histogram == (0.1, 0.2)
    numbers = {"event_budget": 10**11, "intervals": 10**6}
    assert request.histogram == {"event": "vertical_hop", **numbers}
    request = one(watch={"hop_histogram": {"radii": [0.249], "event": "horizontal_hop"}})
    assert request.quantities.hop_histogram == (0.249,)  # next to a threshold, but it ends
    block = one(watch={"hop_histogram": {"event": "horizontal_hop", "intervals": "1e4"}})
    assert block.quantities.hop_histogram == (0.025, 0.075, 0.125, 0.175)
    asked = block.arguments("intervals")
    assert (asked["hop"], asked["number"]) == ("horizontal_hop", 10**4)


def test_accuracy_has_three_forms():
    def asked(accuracy):
        return one(accuracy=accuracy).dynamics["accuracy"]

    assert asked("1e-3") == dict.fromkeys(EVENTS, 1e-3)
    assert asked("reference") == dict.fromkeys(EVENTS, 1e-4)
    mixed = asked({"default": "draft", "top_wall": 0.5})
    assert mixed == dict.fromkeys(EVENTS, 1e-2) | {"top_wall": 0.5}
    assert asked({"top_wall": 1})["any_wall"] == 3e-4


def test_numbers_have_one_form(tmp_path):
    mapping = deepcopy(PLAIN)
    load(mapping)
    assert mapping == PLAIN  # which stays as it was
    forms = [
        {"radii": [0.2, 0.1], "event_budget": "2e6", "accuracy": "1e-3"},
        {"radii": ["2e-1", 0.1], "event_budget": 2e6, "accuracy": 0.001},
        {"radii": [0.1, "0.2"], "event_budget": 2000000, "accuracy": "1.0E-3"},
    ]
    boxes = [{"width": 1.5, "height": 1}, {"width": "1.5", "height": 1.0}]
    requests = [one(box=box, **form) for box in boxes for form in forms]
    assert len({repr(request) for request in requests}) == 1
    assert requests[0].keys["dynamics"] == {"0.1": 0.1, "0.2": 0.2}
    assert type(requests[0].box.height) is float
    assert type(requests[0].event_budget) is int
    (tmp_path / "huge.yaml").write_text("width: 1.0e+30")  # no double is this integer
    assert read(tmp_path / "huge.yaml") == {"width": 1e30}


# Parameters of jobs


def jobs(request):
    """The parameters of every job of a scene, beside the box, by job."""
    every = {(table,): request.exact_radii(table) for table in ("theory", "grid")}
    every["trajectory",] = request.quantities.trajectory, request.trajectory_seed
    points = [(stage, key) for stage in STAGES for key in request.keys[stage]]
    return every | {point: request.arguments(point[0]) for point in points}


BASE = {"radii": [0.1, 0.2], "watch": dict.fromkeys(RequestedQuantities.__dataclass_fields__, True)}


def edited(**keys):
    return jobs(one(**{**BASE, **keys}))


@pytest.mark.parametrize(
    ("edit", "concerned"),
    [
        ({"accuracy": 1e-2}, {"dynamics"}),
        ({"event_budget": 10}, {"dynamics"}),
        ({"monte_carlo": {"samples": 10}}, {"monte_carlo"}),
        ({"monte_carlo": {"shell": 0.1}}, {"monte_carlo"}),
        ({"watch": BASE["watch"] | {"mean_times": ["any_wall"]}}, {"dynamics"}),
        ({"watch": BASE["watch"] | {"areas": ["any_wall"]}}, {"monte_carlo"}),
        ({"watch": BASE["watch"] | {"volume": False}}, {"monte_carlo"}),
        ({"watch": BASE["watch"] | {"trajectory": 0.2}}, {"trajectory"}),
        ({"watch": BASE["watch"] | {"hop_histogram": {"intervals": 9}}}, {"intervals"}),
    ],
)
def test_an_edit_concerns_the_jobs_that_depend_on_it(edit, concerned):
    before, after = edited(), edited(**edit)
    assert before.keys() == after.keys()
    assert {job[0] for job in before if repr(before[job]) != repr(after[job])} == concerned


@pytest.mark.parametrize(
    "watched", [{}, {"hop_histogram": {"intervals": 9}}, {"hop_histogram": {"event_budget": 10**6}}]
)
def test_a_shard_depends_on_no_accuracy_and_no_budget(watched):
    edit = {"accuracy": 1e-2, "event_budget": 10, "monte_carlo": {"samples": 10}}
    before, after = one(**BASE), one(**{**BASE, **edit, "watch": BASE["watch"] | watched})
    for stage in STAGES:
        assert before.arguments(stage) != after.arguments(stage) or not watched
        assert before.shard_arguments(stage) == after.shard_arguments(stage)


def test_seeds_differ_between_scenes_methods_and_radii_and_follow_the_root():
    every = []
    for seed in (1, 2):
        mapping = {"seed": seed, "scenes": [PLAIN["scenes"][0] | BASE | {"name": n} for n in "ab"]}
        for request in load(mapping).scenes:
            every.append(request.trajectory_seed)
            for stage, key in (job for job in jobs(request) if len(job) == 2):
                scene = request.box.scene(float(key))
                every.append(job_seed(scene, stage, request.seed, request.name))
    assert len(set(every)) == len(every) == 2 * 2 * (2 + 2 + 4 + 1)
    assert one(watch=True).trajectory_seed == stream_seed(1908, "one", "trajectory", "0.24")
    # theory.csv also holds the radii of the histograms, whose exact means are compared.
    assert edited()["theory",] == [0.0375, 0.1, 0.112, 0.188, 0.2, 0.262]


# Effects

#: The events that have a place with walls along x or y only.
ALONG = {axis: tuple(e for e in EVENTS if EVENT_AXES.get(e, axis) == axis) for axis in "xy"}

#: Quantities of a scene, the events that exist in it, and the radii of its hop histograms.
CALLS = [
    ({"radius_ratio": 0.5, "mass_ratio": 2}, {}, EVENTS, (0.05, 0.15, 0.25, 0.35)),
    ({"periodic": ["x"]}, {}, ALONG["y"], (0.0375, 0.112, 0.188, 0.262)),
    ({"periodic": ["y"]}, {}, ALONG["x"], (0.025, 0.075, 0.125, 0.175)),
    ({"periodic": ["y", "x"]}, {}, ("disc_collision",), ()),
    ({"periodic": ["z"]}, {"depth": 1.2}, EVENTS, (0.0435, 0.131, 0.217, 0.304)),
    ({"field": 1}, {}, EVENTS, (0.0375, 0.112, 0.188, 0.262)),
    ({"moment_of_inertia": 0.5}, {}, EVENTS, ()),
    ({"moment_of_inertia": 0.5, "friction": 1}, {}, EVENTS, (0.0375, 0.112, 0.188, 0.262)),
    ({}, {"discs": 3}, EVENTS, ()),
]  # fmt: skip


@pytest.mark.parametrize(("effects", "more", "events", "histograms"), CALLS)
def test_everything_is_what_has_a_place(effects, more, events, histograms):
    """A depth is a key of the box, and the number of discs one of the scene."""
    texts = {name: str(value) for name, value in more.items()}
    keys = texts if "discs" in more else {"box": PLAIN["scenes"][0]["box"] | texts}
    request = one(effects=effects, **keys, watch=True)
    assert request.quantities.areas == request.quantities.mean_times == events
    assert request.quantities.hop_histogram == histograms
    assert request.histogram["event"] == next((e for e in events if e in HOPS), None)
    assert (request.quantities.trajectory is None) == (effects == {"periodic": ["y", "x"]})
    named = {name: "".join(sorted(v)) if isinstance(v, list) else v for name, v in effects.items()}
    named |= more
    for radius in request.radii + request.quantities.hop_histogram:
        assert request.box.scene(radius) == Scene(1.5, 1, radius, **named)
    assert request.effects == named
    asked = one(effects=effects, **keys, watch={"areas": True, "mean_times": True})
    assert asked.quantities.areas == asked.quantities.mean_times == events


def test_default_radii_keep_to_what_there_is():
    """Equal steps to 0.9 of the largest; thresholds of hops follow from the energy too."""
    channel = one(effects={"periodic": ["x"]}, radii={"smallest": 0.05, "count": 5})
    largest = Scene(1.5, 1, 0.1, periodic="x").largest_radius
    steps = [b - a for a, b in pairwise(channel.radii)]
    assert channel.radii[0] == 0.05
    assert channel.radii[-1] == pytest.approx(0.9 * largest, rel=0.01)
    assert max(steps) == pytest.approx(min(steps), rel=0.1)
    # With g = 2 two discs one above the other have the energy up to r = 1/(4g).
    strong = one(effects={"field": 2}, watch={"hop_histogram": {"event": "horizontal_hop"}})
    assert strong.quantities.hop_histogram == (0.0125, 0.0375, 0.0625, 0.0875)
    assert one(effects={"field": 2}, watch=True).quantities.trajectory == 0.0625
    # The larger disc has a hundredth of the side.
    assert one(effects={"radius_ratio": 4}).radii[0] == 0.0025
    assert one(effects={"radius_ratio": 0.25}).radii[0] == 0.01
    assert len(one(radii={"count": 1}, effects={"field": 1}).radii) == 1
    # Radii that are included do not move the others.
    grid = one(effects={"field": 1}, radii={"count": 4}).radii
    include = {"count": 4, "include": [0.123, grid[2]]}
    assert one(effects={"field": 1}, radii=include).radii == tuple(sorted({*grid, 0.123}))


@pytest.mark.parametrize(
    "effects",
    [{}, {"radius_ratio": 1, "mass_ratio": "1.0", "periodic": [], "field": 0}, {"field": 0.0}],
)
def test_effects_that_are_absent_leave_no_trace(effects):
    assert one(effects=effects) == one()
    assert one(effects=effects).effects == {}


# Files that are built once


def test_what_is_about_a_plain_scene_needs_one():
    plain = PLAIN["scenes"][0] | {"name": "plain"}
    field = PLAIN["scenes"][0] | {"name": "field", "effects": {"field": 1}}
    assert load({"scenes": [field, plain]}).main.name == "plain"
    alone = load({"scenes": [field]})
    assert alone.main is None
    assert alone.shared == ("report",)
    with pytest.raises(ConfigError, match="shared must leave out 'tails' if every scene"):
        load({"scenes": [field], "shared": ["report", "tails"]})
    tiny = plain | {"box": {"width": 1e-50, "height": 1e-50}, "watch": {"volume": True}}
    with pytest.raises(ConfigError, match="shared must leave out 'stability' unless"):
        load({"scenes": [tiny], "shared": ["stability"]})
    assert load({"scenes": [tiny], "shared": ["errata"]}).main.name == "plain"


def test_radii_too_close_to_the_largest_are_refused_for_dynamics_alone():
    largest = Box(1.5, 1.0).largest_radius
    close, far = largest * (1 - 3e-14), largest * (1 - 1.01e-12)
    with pytest.raises(ConfigError, match=rf"{close!r} must not exceed 0\.3839745962\d+ for"):
        one(radii=[close])
    assert one(radii=[far]).radii == (far,)
    assert one(radii=[close], watch={"volume": True}).radii == (close,)


def test_more_discs_are_a_scene_of_their_own():
    request = one(discs=3, radii=[0.1, 0.2], watch=True)
    assert request.quantities.trajectory == 0.125  # half of h/4
    assert one(discs=3).radii[-1] == pytest.approx(0.9 * request.box.largest_radius, rel=0.02)
    ring = one(discs=3, radii=[0.1], effects={"periodic": "x"}, watch=True)
    assert ring.quantities.trajectory == 0.143  # half of the largest radius
    histogram = one(discs=3, radii=[0.1], watch={"hop_histogram": {"event": "horizontal_hop"}})
    assert histogram.quantities.hop_histogram == (0.025, 0.075, 0.125, 0.175)
    assert load({"scenes": [PLAIN["scenes"][0] | {"discs": 3, "radii": [0.1]}]}).plain == ()


def test_results_are_a_folder_that_holds_no_sources(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("docs", "out"):
        (tmp_path / name).mkdir()
    (tmp_path / "README.md").write_text("text")
    (tmp_path / "link").symlink_to(tmp_path.parent)
    for good in ("out", "out/new", "results", f"{tmp_path}/out", "link"):
        check_results(good, tmp_path)
    for bad in ("README.md", "README.md/new", f"{tmp_path}/docs", f"{tmp_path}/docs/new"):
        with pytest.raises(ConfigError, match=f"results must be .*, not '{bad}'"):
            check_results(bad, tmp_path)


def test_monte_carlo_samples_at_most_64_discs():
    at_most, more = (one(discs=discs, radii=[0.01], watch=True).quantities for discs in (64, 65))
    assert (at_most.volume, more.volume, more.areas) == (True, False, ())
    assert at_most.areas == more.mean_times == at_most.mean_times == EVENTS


def test_described_scenes_name_the_events_that_dynamics_detects():
    some = PLAIN["scenes"][0] | {"watch": {"mean_times": ["top_wall", "disc_collision"]}}
    none = some | {"name": "none", "watch": {"volume": True, "mean_times": False}}
    described = load({"scenes": [some, none]}).described()
    assert [scene["detected"] for scene in described] == [["disc_collision", "top_wall"], []]
