"""The explorer, a page in JavaScript: its theory, counts and errors.

Without these tests the explorer could show other formulas, counts or errors than the package.

Comparisons are held to five standard errors.
"""

import itertools
import json
import math
import random
import re

import pytest
from browser import ABSENT, BROWSER, browser
from checkout import REPOSITORY
from factory import EXPECTED, write_rows
from py_mini_racer import MiniRacer

from twodiscs.analysis.tables import AreasTable, VolumeTable
from twodiscs.model.scene import Box
from twodiscs.theory import exact
from twodiscs_paper.pipeline.documents import explorer

SOURCES = REPOSITORY / "workflow" / "explorer"
PARTS = [path for path in SOURCES.rglob("*") if path.is_file()]

#: The tables of the scene 1.5 × 1 that are expected.
TABLES = [EXPECTED / "paper" / f"{name}.csv" for name in ("volume", "areas", "mean_times")]

#: The scenes in the report; the explorer leaves out the one with an effect that it does not have.
SCENES = [
    {"name": "paper", "width": 1.5, "height": 1.0, "effects": {}},
    {"name": "balls", "width": 1.0, "height": 1.0, "effects": {"depth": 1.0, "field": 1.0}},
    {"name": "ring", "width": 30.0, "height": 20.0, "effects": {"periodic": "x"}},
]

#: Effects that the page has, for each number of velocity components less conserved momenta.
EFFECTS = [{}, *({"periodic": axes} for axes in ("x", "y", "xy"))]
EFFECTS += [{"field": field} for field in (1e-6, 0.3, 1.0, 40.0)]
EFFECTS += [{"periodic": "x", "field": field} for field in (0.5, 3.0)]


def written(path, scenes):
    """Write the explorer of ``scenes`` to ``path``, and return this."""
    path.write_text(explorer.explorer(PARTS, TABLES, scenes, seed=1908), encoding="utf-8")
    return path


def shown_scenes(text):
    """Return the scenes in the data of the page."""
    return json.loads(re.search(r'<script id="data"[^>]*>(.*?)</script>', text, re.S)[1])["scenes"]


def evaluated(expression, *scripts):
    """Return the value of an expression about the ``scripts``, by V8."""
    script = "".join((SOURCES / name).read_text(encoding="utf-8") for name in scripts)
    with MiniRacer() as engine:  # a process with an engine that is not closed does not end
        return json.loads(engine.eval(f"{script}\nJSON.stringify({expression})"))


# Formulas -----------------------------------------------------------------------------------------

BOXES = [Box(*sides) for sides in ((1.5, 1), (3, 1), (1, 1), (2, 1), (0.7, 1.2), (0.5, 2), (40, 1))]
BOXES += [Box(*sides, **effects) for effects in EFFECTS[1:] for sides in ((1.5, 1), (0.5, 2))]


def radii(box):
    """Return radii of a ``Box``: anywhere, at its limits, and ever closer to these."""
    if box.effects:
        return [fraction * box.last_radius for fraction in (0.01, 0.45, 0.7, 0.999, 1.001)]
    rng = random.Random(f"{box.width} {box.height}")
    some = [rng.uniform(0, box.largest_radius) for _ in range(40)]
    some += [10**-k * box.shortest for k in range(1, 7)]
    for limit in (box.largest_radius, box.width / 4, box.height / 4):
        some += [limit, *(math.nextafter(limit, side) for side in (0, 1))]
        some += [limit * (1 + sign * 10**-k) for k in range(1, 13) for sign in (-1, 1)]
    return some


def test_formulas_and_limits_in_javascript_are_those_of_the_package():
    given = [[box.width, box.height, radius, box.effects] for box in BOXES for radius in radii(box)]
    limits = [[box.width, box.height, box.effects] for box in BOXES]
    computed, found = evaluated(
        f"[{json.dumps(given)}.map((of) => exact(...of)),"
        f" {json.dumps(limits)}.map((box) => [largestRadius(...box), thresholds(...box)])]",
        "theory.js",
    )
    for (width, height, radius, effects), ours in zip(given, computed, strict=True):
        box = Box(width, height, **effects)
        assert (ours is not None) == box.fits(radius), (box, radius)
        if ours is None:
            continue
        scene = box.scene(radius)
        worst = 1e-11 if effects else 1e-12
        assert ours["volume"] == pytest.approx(exact.volume(scene), rel=worst, abs=0)
        for kind, known in {"times": exact.mean_times(scene), "areas": exact.areas(scene)}.items():
            assert [*ours[kind]] == [*explorer.PAGE_EVENTS]
            for event, value in ours[kind].items():
                good = known[event]
                same = value is None if good is None else math.isclose(value, good, rel_tol=worst)
                assert same, (box, radius, event, kind, value, good)
    for box, (largest, named) in zip(BOXES, found, strict=True):
        # The package finds limits with effects by bisection.
        worst = 1e-12 if box.effects else 1e-15
        assert largest == pytest.approx(box.last_radius, rel=worst)
        assert [radius for radius, _ in named] == pytest.approx([*box.thresholds], rel=worst)


# Motion and errors --------------------------------------------------------------------------------

#: A function of a number of runs, a radius and a seed. It returns these runs in the box 1.5 × 1.
RUNS = """
((number, radius, seed) => {
    const runs = new Runs(1.5, 1, radius, seed);
    while (runs.done < number) runs.advance(10000, number);
    return runs;
})
"""


def test_scores_scatter_by_one_over_seeds():
    """The mean square of scores of Student's law with 99 degrees of freedom, at 5 sigma."""
    number = 600
    *scores, again = evaluated(
        f"Array.from({{length: {number} + 1}}, (_, i) => {{"
        f" const many = {RUNS}(ENOUGH, 0.2, 1000 + i % {number});"
        " return [0, 2, 3].map(i => many.measured(i).z); })",
        *("theory.js", "dynamics.js"),
    )
    assert again == scores[0]  # of the same seed
    for z in zip(*scores, strict=True):
        square = sum(score * score for score in z) / number
        assert abs(square - 99 / 97) < 5 * math.sqrt(2.2 / number)


@pytest.mark.parametrize(("done", "count"), [(100, 100), (99, 100), (100, 99)])
def test_an_error_needs_as_many_runs_and_events_as_the_page_says(done, count):
    measured = (
        "((done, count) => { const runs = new Runs(1.5, 1, 0.2, 1); runs.done = done;"
        " runs.sums.fill(count); runs.squares.fill(400); return runs.measured(0); })"
    )
    found = evaluated(f"{measured}({done}, {count})", "theory.js", "dynamics.js")
    assert (found["error"] is not None) == (found["z"] is not None) == (min(done, count) == 100)


#: Boxes, radii and effects; the last but one is at an energy at which discs never reach the top.
MOVING = [
    ((1.5, 1.0, 0.2), {}),
    ((3.0, 1.0, 0.49), {}),
    ((1.5, 1.0, 0.3), {"periodic": "x", "friction": 3.0}),
    ((1.5, 1.0, 0.2), {"periodic": "y"}),
    ((1.0, 1.0, 0.2), {"periodic": "xy", "friction": 1.0}),
    ((1.5, 1.0, 0.37), {"field": 1.0}),
    ((3.0, 1.0, 0.24), {"field": 20.0, "friction": 2.0}),
    ((1.5, 1.0, 0.3), {"periodic": "x", "field": 3.0, "friction": 3.0}),
]

#: A function of a scene. It returns the measured events of 1000 runs, the changes of some means of
#: an ensemble by its motion, in standard errors, and the kicks and worst conserved value of a path.
MOTION = """
(([width, height, radius, effects]) => {
    const runs = new Runs(width, height, radius, 7, effects);
    while (runs.done < 1000) runs.advance(10000, 1000);
    const pair = (random) => new Pair(width, height, radius, effects, runs.draw(random));
    const random = new Random(11), n = 10000, sums = Array(5).fill(0), squares = Array(5).fill(0);
    const means = ({ x1, y1, x2, y2, u1, v2 }) =>
        [Math.abs(x1 - x2), Math.abs(y1 - y2), y1 + y2, u1 ** 2, v2 ** 4];
    for (let i = 0; i < n; i++) {
        const moved = pair(random), before = means(moved);
        for (let left = 0.7; left > 0; left -= moved.flight) moved.step(left);
        means(moved).forEach((value, k) => {
            sums[k] += value - before[k];
            squares[k] += (value - before[k]) ** 2;
        });
    }
    const changes = sums.map((sum, k) => sum && sum / Math.sqrt(squares[k]));
    const one = pair(new Random(3)), { halfX, halfY, ringX, ringY, field } = one;
    let worst = 0, kicks = 0, time = 0, waits = 0;
    for (let i = 0; i < 20000; i++) {
        const kicked = one.step(Infinity) === KICK;
        kicks += kicked;
        waits += kicked && one.wait ** 2;
        time += one.flight;
        const { x1, y1, x2, y2, u1, v1, u2, v2 } = one;
        const kinetic = u1 * u1 + v1 * v1 + u2 * u2 + v2 * v2;
        worst = Math.max(worst, Math.abs(kinetic + 2 * field * (y1 + y2 + 2 * halfY) - 1),
            2 * radius - Math.hypot(x1 - x2, y1 - y2),
            ringX ? Math.abs(u1 + u2) : Math.max(Math.abs(x1), Math.abs(x2)) - halfX,
            ringY ? Math.abs(v1 + v2) : Math.max(Math.abs(y1), Math.abs(y2)) - halfY);
    }
    const measured = COUNTED.map((_, i) => runs.measured(i));
    return { measured, changes, worst, kicks, time, waits };
})
"""


def test_motion_is_that_of_theory():
    given = json.dumps([[*sides, effects] for sides, effects in MOVING])
    found = evaluated(f"{given}.map({MOTION})", "theory.js", "dynamics.js")
    compared = 0
    for (sides, effects), seen in zip(MOVING, found, strict=True):
        times = exact.mean_times(Box(*sides[:2], **effects).scene(sides[2]))
        for event, measured in zip(explorer.PAGE_EVENTS, seen["measured"], strict=True):
            if times[event] is None:
                assert measured["count"] == 0, (effects, event)
            elif measured["error"]:
                assert abs(measured["time"] - times[event]) < 5 * measured["error"], effects
                assert (measured["z"] > 0) == (measured["time"] > times[event]), effects
                compared += 1
        # The invariant measure stays as it is.
        assert max(map(abs, seen["changes"])) < 5, (effects, seen["changes"])
        # Roundings of 20000 events walk: energies are exact to some hundred last digits.
        assert seen["worst"] < 1e-11, effects
        expected = effects.get("friction", 0) * seen["time"]
        assert abs(seen["kicks"] - expected) <= 5 * math.sqrt(expected), effects
        # An exponential time t with mean 1 has the means 2 of t² and 24 of t⁴.
        if kicks := seen["kicks"]:
            square = effects["friction"] ** 2 * seen["waits"] / kicks
            assert abs(square - 2) < 5 * math.sqrt(20 / kicks), effects
    assert compared > 15


#: A function of runs. It returns their intervals between horizontal hops in bins and the number of
#: all of them, then those of one long trajectory, which is cut nowhere.
INTERVALS = """
((runs) => {
    const { bins: found, end, total: all } = runs.histograms[1], bins = Array(BINS).fill(0);
    const pair = new Pair(...runs.scene, runs.draw(new Random(5)));
    let total = 0, last = NaN;
    for (let time = 0; time < 6e5; time += pair.flight) {
        pair.step(Infinity);
        if (pair.horizontal < 0) continue;
        const interval = time + pair.horizontal - last;
        if (interval < end) bins[Math.floor(BINS * interval / end)]++;
        total++;
        last = time + pair.horizontal;
    }
    return [[[...found], all], [bins, total]];
})
"""


def test_intervals_of_runs_are_those_of_one_long_trajectory():
    """Also where hardly any interval that begins in a run ends in it, as with a mean of 100."""
    found = evaluated(f"{INTERVALS}({RUNS}(4000, 0.24, 7))", "theory.js", "dynamics.js")
    fractions = [[n / total for n in itertools.accumulate(bins)] for bins, total in found]
    assert 0.95 < fractions[0][-1] < 1
    for some, other in zip(*fractions, strict=True):
        # Twice the error of independent intervals, for they are not.
        spread = math.sqrt(some * (1 - some) * sum(1 / total for _, total in found))
        assert abs(some - other) < 10 * spread + 1e-9


# Points and the file ------------------------------------------------------------------------------


def test_points_are_those_of_the_tables():
    for event, by in explorer.points({path.stem: path for path in TABLES}).items():
        assert min(len(by["dynamics"]), len(by["monte_carlo"])) > 20
        for radius, time, error in by["monte_carlo"] + [row for row in by["dynamics"] if row[2]]:
            right = exact.mean_times(Box(1.5, 1).scene(radius))[event]
            assert abs(time - right) < 5 * error < 5 * 0.2 * time, (event, radius)
    assert explorer.points({})["vertical_hop"] == {"dynamics": [], "monte_carlo": []}


@pytest.mark.parametrize("effects", EFFECTS[:4])
def test_times_by_monte_carlo_know_the_conserved_momenta(effects, tmp_path):
    scene = Box(1.5, 1, **effects).scene(0.2)
    given = {"radius": 0.2, "stderr": 1e-3, "bias": 0.0}
    areas = [(f"{event}_area", area, area) for event, area in exact.areas(scene).items()]
    write_rows(tmp_path, AreasTable, ("quantity", "estimate", "exact"), areas, **given)
    write_rows(tmp_path, VolumeTable, ["estimate"], [[exact.volume(scene)]], **given)
    own = SCENES[0] | {"name": tmp_path.name, "effects": effects}
    page = explorer.explorer(PARTS, [*TABLES, *tmp_path.glob("*.csv")], [own], seed=1)
    times = exact.mean_times(scene)
    for event, by in shown_scenes(page)[0]["points"].items():
        assert len(by["monte_carlo"]) == (times[event] is not None)
        for _, time, error in by["monte_carlo"]:
            assert time == pytest.approx(times[event])
            area = exact.areas(scene)[event]
            relative = math.hypot(1e-3 / exact.volume(scene), 1e-3 / area)
            assert error == pytest.approx(time * relative)


@pytest.mark.parametrize(("some", "shown"), [((0, 1, 2), (0, 2)), ((0,), (0,)), ((1,), ())])
def test_the_page_is_one_file_and_names_the_scenes_that_are_left_out(tmp_path, some, shown):
    path = written(tmp_path / "explorer.html", [SCENES[i] for i in some])
    text = path.read_text(encoding="utf-8")
    assert not re.search(r"""(?:src|href)=["']|@import|url\(|fetch\(|XMLHttpRequest""", text)
    assert path.stat().st_size < 100_000
    assert [scene["name"] for scene in shown_scenes(text)] == [SCENES[i]["name"] for i in shown]
    assert ("because of their effects: balls." in text) == ("balls" in text) == (1 in some)


def test_a_scene_with_all_effects_of_the_page_is_shown():
    effects = {"periodic": "x", "field": 0.5, "friction": 0.2}
    page = explorer.explorer(PARTS, [], [SCENES[0] | {"effects": effects}], seed=1)
    assert effects.items() <= shown_scenes(page)[0].items()


# In a browser -------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def driven(tmp_path_factory):
    """A function of what stands behind # that opens the explorer of some scenes in a browser."""
    if BROWSER is None:
        pytest.skip(ABSENT)
    folder = tmp_path_factory.mktemp("browser")
    with browser(folder) as chromium:

        def opened(asked="", scenes=SCENES, **options):
            path = written(folder / "explorer.html", scenes)
            chromium.open(f"{path.as_uri()}#{asked}", **options)
            return chromium

        yield opened
        assert chromium.problems == []


def value(text):
    """Return the number in a cell."""
    return float(text.replace("−", "-").replace("\u202f", "").removesuffix(" %"))


def assert_right(page, asked, box, radius):
    """Assert that the opened page counts, after ``asked`` runs, what the exact theory says."""
    times = exact.mean_times(box.scene(radius))
    page.until(f"runs.done === {asked}")
    cells = "[...at('events').rows].map(row => [...row.cells].map(cell => cell.innerText))"
    rows, measured = page.look(f"renew(), [{cells}, COUNTED.map((_, i) => runs.measured(i))]")
    for event, row, seen in zip(explorer.PAGE_EVENTS, rows, measured, strict=True):
        if times[event] is None:
            assert row[1:] == ["0", "–", "–", "–" if box.effects else "never", "–"]
            continue
        count, _, error, known, z = map(value, row[1:])
        assert known == pytest.approx(times[event], rel=3e-3), event
        assert abs(z) < 5, event
        assert count == seen["count"]
        assert z == pytest.approx(seen["z"], abs=0.1 + 0.05 * abs(seen["z"]))
        assert error == pytest.approx(100 * seen["error"] / seen["time"], rel=0.06)


@pytest.mark.parametrize(("width", "scheme"), [(1280, "light"), (768, "dark"), (390, "light")])
def test_keyboards_and_readers_of_screens_reach_everything(driven, width, scheme):
    assert driven("seed=7&runs=10", width=width, scheme=scheme).violations() == []


def test_who_wants_no_motion_starts_it_himself_and_it_can_be_paused(driven):
    page = driven("seed=7", reduced=True)
    page.look("new Promise(done => setTimeout(done, 300))")
    assert page.look("[runs.done, drawn.time, at('pause').textContent]") == [0, 0, "Run"]
    page.look("at('pause').click()")
    page.until("runs.done > 10 && drawn.time > 0")
    assert page.look(r"/, [1-9][\d\u202f]*(\.\d million)? events$/.test(at('status').textContent)")
    page.look("at('pause').click()")
    before = page.look("[runs.done, drawn.time]")
    page.look("new Promise(done => setTimeout(done, 300))")
    assert page.look("[runs.done, drawn.time]") == before


#: Boxes in any unit, and how a radius of 0.2 shorter sides and the next one are written.
UNITS = [
    ((0.03, 0.02), "0.004", "0.00401"),
    ((3e-6, 1e-5), "6e-7", "6.01e-7"),
    ((150.0, 100.0), "20", "20.1"),
]


@pytest.mark.parametrize("width", [1280, 390])
@pytest.mark.parametrize(("sides", "radius", "next_radius"), UNITS)
def test_lengths_are_in_any_unit_and_fit_the_window(driven, sides, radius, next_radius, width):
    box, scene = Box(*sides), SCENES[0] | {"width": sides[0], "height": sides[1]}
    page = driven("seed=7&runs=2000", scenes=[scene], width=width)
    assert_right(page, 2000, box, float(radius))
    right = "[...document.querySelectorAll('main *')].map(e => e.getBoundingClientRect().right)"
    assert page.look(f"Math.max(document.documentElement.scrollWidth, ...{right})") <= width
    shown = "LENGTHS.map(name => numberOf(name).value)"
    assert [*map(float, page.look(shown))] == [*sides, float(radius)]
    low, high = page.look("[at('radius').min, at('radius').max].map(value => unit * value)")
    assert low < 0.03 * box.largest_radius
    assert 0.99 * box.largest_radius < high < box.largest_radius
    # Times of other radii are on their axis.
    low, high = page.look("SHOWN_TIMES.map(time => unit * time)")
    for fraction in (0.05, 0.9):
        found = exact.mean_times(box.scene(fraction * box.largest_radius))
        assert all(low < found[event] < high for event in explorer.PAGE_EVENTS if found[event])
    page.look("at('radius').stepUp(), at('radius').dispatchEvent(new Event('input'))")
    assert page.look(f"{shown}[2]") == page.look("at('radius').ariaValueText") == next_radius


def type_number(page, name, text):
    """Type a ``text`` into the number field of a name."""
    field = f"Object.assign(numberOf('{name}'), {{value: '{text}'}})"
    page.look(f"{field}.dispatchEvent(new Event('change'))")


def test_the_address_holds_the_scene_and_brings_it_back(driven):
    page = driven("seed=7")
    problem = "at('problem').innerText"
    for text in ("", "-1", "0", "1,5,0", "1e999"):  # which are no lengths
        type_number(page, "width", text)
        assert page.look("[runs.scene[0], +at('width').nextElementSibling.value]") == [1.5, 1.5]
        assert page.look(problem) == f'width must be a number above 0, such as 0.5, not "{text}".'
    type_number(page, "radius", "9")
    assert page.look(problem) == "radius 9 is out of range: this page shows 0.383."
    type_number(page, "radius", "0,123")
    assert page.look(problem) == ""
    type_number(page, "width", "2.75")
    # The wheel over a field changes it only if the field has steps.
    assert page.look("NUMBERS.map(name => numberOf(name).type)") == ["text"] * 5
    address = page.look("location.hash.slice(1)")
    assert address == "seed=7&width=2.75&height=1&radius=0.123"
    page = driven(address)
    assert page.look("runs.scene.slice(0, 3)") == [2.75, 1, 0.123]
    assert "no points of this box" in page.look("at('points').textContent")
    page.look("location.hash = '#width=3&height=1&radius=0.24'")
    page.until("runs.scene[0] === 3")
    assert page.look("runs.scene.slice(0, 3)") == [3, 1, 0.24]


def test_effects_are_in_the_address_and_in_any_unit(driven):
    assert driven("seed=7", scenes=SCENES[2:]).look("state.periodic") == "x"
    page = driven("radius=4&seed=7&periodic=x&field=0.01&runs=2000", scenes=SCENES[2:])
    assert_right(page, 2000, Box(30, 20, periodic="x", field=0.01), 4)
    for text, taken in (("0.5", "0.5"), ("1e9", "30")):
        type_number(page, "friction", text)
        assert page.look("location.hash").endswith(f"&friction={taken}")
    page.look("at('y').click()")
    assert page.look("[state.field, at('field').disabled, state.periodic]") == [0, True, "xy"]
    assert "&periodic=xy&" in page.look("location.hash")
    assert "field" not in page.look("location.hash")
    assert page.look("runs.exact.times.any_wall") is None
    page.look("for (const axis of 'xy') at(axis).click()")
    assert "periodic" not in page.look("location.hash")
    assert page.look("runs.exact.times.any_wall") > 0


def test_what_the_address_cannot_ask_for_is_named(driven):
    wrong = "radius=abc, width=-1, height=0, periodic=z, field=-1, friction=Infinity, mass_ratio=2"
    for good, bad in (("seed=7", wrong), ("periodic=y", "field=1")):
        page = driven(f"{good}&{bad.replace(', ', '&')}")
        assert f"asks for {bad}: " in page.look("at('problem').innerText"), bad
        assert page.look("[...runs.scene.slice(0, 3), state.field]") == [1.5, 1, 0.2, 0]


def test_the_cursor_reads_the_exact_times_and_the_histogram(driven):
    page = driven("radius=0.3&seed=7&runs=2000")
    assert_right(page, 2000, Box(1.5, 1), 0.3)
    page.look("timesPlot.look(timesPlot.at(0.3, 1)[0])")
    readout = page.look("timesPlot.readout.value")
    assert readout.startswith("r = 0.3: ")
    assert f"{exact.mean_times(Box(1.5, 1).scene(0.3))['disc_collision']:.4g}" in readout
    assert "horizontal hops never" in readout
    page.look("intervalsPlot.look(intervalsPlot.at(1.01, 1)[0])")
    assert f"exponential {math.exp(-1.01):.3g}" in page.look("intervalsPlot.readout.value")
