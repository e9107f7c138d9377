"""The study of passages: κ, exponents, and diffusion in single files.

Without these tests κ, exponents, and D of files could be wrong by factors, or their errors.

Statistical comparisons allow five standard errors: with some 20 of them a false alarm comes in
fewer than 2e-5 of all seeds.
"""

import math
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from factory import EXPECTED, LONG_RUNS, cells, deviation, empty, of
from marks import slow

from twodiscs.dynamics.two import strip
from twodiscs.figures import style
from twodiscs.model.scene import Box, Scene
from twodiscs.sampling.many import insertions
from twodiscs.theory.flux import rates
from twodiscs_paper.catalogue import STUDIES
from twodiscs_paper.configuration.yaml_files import load
from twodiscs_paper.studies.passages import figure, figure_diffusion, figure_transmission, near
from twodiscs_paper.studies.passages.models import file, plane
from twodiscs_paper.studies.passages.parts import displacements, on_ring, with_friction
from twodiscs_paper.studies.passages.parts.in_long_file import one_long_file
from twodiscs_paper.studies.passages.powers import fits
from twodiscs_paper.studies.passages.study import PassagesTable

BOX, HOP = Box(1.5, 1.0), "horizontal_hop"


def power_rows(power, halvings, inertia=None):
    """Return rows of κ or 1 − κ that fall as a power of the distance."""
    rows = []
    for n in halvings:
        value = 2.0 ** (-n * power)
        row = {"quantity": "coefficient", "distance": 2.0**-n, "stderr": 0.01 * value}
        row |= {"scene": "paper", "event": HOP, "discs": 2, "moment_of_inertia": inertia}
        rows.append(empty(PassagesTable, **row, estimate=value if inertia else 1 - value))
    return rows


def test_a_power_is_fitted_to_the_last_octaves():
    """The fit takes each hop by itself, in any order of rows; test_long_runs has its errors."""
    far = power_rows(0.9, [3])  # not among the last five
    smooth = power_rows(1 / 3, range(4, 9))
    rough, alone = power_rows(0.5, [4, 3], inertia=0.5), power_rows(0.5, [4], inertia=1.0)
    beyond = [row | {"estimate": 1.01, "event": "vertical_hop"} for row in smooth]
    *steps, first, step, second = fits([*smooth[::-1], *far, *rough, *alone, *beyond])
    assert [row["quantity"] for row in (*steps, step)] == ["exponent"] * 6
    assert first["estimate"] == pytest.approx(1 / 3)
    assert (first["distance"], first["replicas"]) == (2.0**-8, 5)
    assert second["estimate"] == pytest.approx(0.5)
    assert (second["moment_of_inertia"], second["quantity"]) == (0.5, "last_exponent")


def smooth(function):
    """Return a ``function`` that takes smooth discs without friction for those of its scene.

    Their kernels are compiled in any case.
    """
    plain = partial(replace, moment_of_inertia=None, friction=0.0)
    return lambda scene, *given, **how: function(plain(scene), *given, **how)


@pytest.fixture
def small(monkeypatch):
    """Make the study one of few distances and hops."""
    for name, value in {
        "study.INERTIAS": (0.5, 1.0), "study.BLOCKED_RADII": (0.28,), "near.MOST_HOPS": 2**12,
        "parts.near_threshold.MOST_HOPS": 2**12, "parts.in_the_limit.LIMIT_BLOCKS": 4,
        "parts.near_threshold.SMOOTH_HALVINGS": range(6, 9), "parts.on_ring.RING": range(3, 4),
        "parts.near_threshold.ROUGH_HALVINGS": range(6, 9), "parts.in_long_file.LONG_FILE": 18,
        "parts.in_long_file.LONG_REPLICAS": 8, "parts.in_long_file.RECORDS": 64,
        "parts.in_pore.PORE_BLOCKS": 8, "parts.in_pore.PORE_REPLICAS": 2**12,
    }.items():  # fmt: skip
        monkeypatch.setattr(f"twodiscs_paper.studies.passages.{name}", value)


# A file of discs ----------------------------------------------------------------------------------


def rows_of_file(monkeypatch, discs, *given):
    """Return the rows of a long file of a few ``discs``."""
    monkeypatch.setitem(one_long_file.__globals__, "LONG_FILE", discs)
    return [*one_long_file("", BOX, *given)]


def test_two_discs_in_a_file_move_as_their_hops_are_correlated(monkeypatch):
    """Against the exact rate, and D by correlations of hops, which another kernel counts.

    Displacements at two times are correlated, so that their difference has a smaller error.
    """
    scene = Box(1.5, 1.0, periodic="x").scene(0.21875)
    rows = list(on_ring.one_ring("ring", BOX, None, 2**18, 1))
    due, *_ = of(rows, quantity="diffusion", method="hops")
    assert due["radius"] == scene.radius
    rows = rows_of_file(monkeypatch, 2, scene.radius, [None], 2, None, 2048)
    (hops,), (ordered,) = (of(rows, quantity=name) for name in ("rate", "diffusion"))
    assert abs(hops["estimate"] - near.passing_rate(scene, HOP)) < 5 * hops["stderr"]
    early, late = of(rows, quantity="displacement")[4::2]
    number = (late["time"] - early["time"]) * hops["estimate"]
    moved = {"estimate": (late["estimate"] - early["estimate"]) / number}
    moved["stderr"] = math.hypot(early["stderr"], late["stderr"]) / number
    assert max(deviation(one, due) for one in (ordered, moved)) < 5


@pytest.mark.parametrize(("inertia", "blocks"), [(None, 2), (0.5, 255), (0.5, 256)])
def test_diffusion_on_a_ring_is_the_slope_of_squares_after_the_start(inertia, blocks, monkeypatch):
    """⟨n²⟩ = 5 + t/2τ has D/(ν ℓ²) = 1/2; rates of rough discs have an error from 256 blocks on."""
    scene = near.scene_at(BOX, HOP, 3, periodic="x", moment_of_inertia=inertia)
    ring = near.NearThreshold("ring", scene, HOP, 3, 1)

    def hop_sums(scene, hop, times, blocks, seed, on_surface=True):
        hops = np.array(times) / ring.mean
        means = np.array([-0.1 + 0 * hops, 5 + hops / 2, hops]) * near.HOPS_PER_BLOCK
        return np.linspace(0.9, 1.1, blocks)[:, None, None] * means, 1

    monkeypatch.setattr(near, "hop_sums", hop_sums)
    monkeypatch.setattr(near, "affordable_blocks", lambda *_: blocks)
    correlated, rate, moved = ring.diffusion(1)
    assert correlated["estimate"] == moved["reference"] == pytest.approx(0.8)
    assert rate["estimate"] == pytest.approx(1 / ring.mean)
    assert (rate["stderr"] is None) == (blocks == 255)
    assert moved["estimate"] == pytest.approx(0.5)
    assert moved["stderr"] > 0
    # Displacements over at least a mean time, from a mean time on.
    assert moved["time"] == rate["time"] == 2 * max(correlated["time"], ring.mean)


@pytest.mark.parametrize("inertia", [None, slow(0.5)])
def test_hops_in_a_file_are_those_of_monte_carlo(inertia, monkeypatch):
    scene = Scene(2.25, 1.0, 0.2, discs=3, periodic="x", moment_of_inertia=inertia)
    (hops,) = of(rows_of_file(monkeypatch, 3, 0.2, [None], 3, inertia, 512), quantity="rate")
    value, error = (
        2 / scene.discs * rates(scene, part)["horizontal_hop"]  # two discs take part in a hop
        for part in insertions.sample(scene, 10**5, 4)
    )
    assert error < 0.05 * value
    assert deviation(hops, {"estimate": value, "stderr": error}) < 5


# Long files -------------------------------------------------------------------------------------


def test_the_density_of_points_is_that_of_an_ideal_gas():
    """Discs of no size have S = 1; with two components of velocity c² = 2 kT/m at the length ℓ."""
    assert file.exact_density(1e-3, 3e-4, 1e3) == pytest.approx((1, math.sqrt(2)), abs=1e-5)


@pytest.mark.parametrize("rate", [None, 0.5])
def test_points_on_a_ring_fly_until_they_are_kicked(rate):
    """⟨x²⟩ = 2v²(γt − 1 + exp(−γt))/γ² without collisions, v²t² without kicks.

    Three points whose momentum is 0 have two of five components of velocity along the ring.
    """
    places, _ = file.recorded(Scene(3.0, 1.0, 1e-6, discs=3, periodic="x"), 4.0, 2, 1000, 1, rate)
    for time, squares in zip((4.0, 8.0), file.squares(places, [1, 2]), strict=True):
        turns = (rate or 0.0) * time
        share = 2 * (turns - 1 + math.exp(-turns)) / turns**2 if rate else 1.0
        due, found = 2 / 5 / 3 * time**2 * share, file.sample_mean(squares)
        assert abs(found.value - due) < 5 * found.stderr < 0.25 * due


def test_damped_sound_has_its_limits():
    """t ≪ 1/γ: sound at constant temperature, S ℓ c t; t ≫ 1/γ: F √t, on a ring that is long."""
    scene, variance = Scene(768.0, 1.0, 0.28, discs=1024, periodic="x"), 0.1
    speed, root = file.thermal_speed(scene), math.sqrt(variance)
    early = file.damped(scene, variance, 1e-6 * speed, 3 / speed)
    assert early == pytest.approx(root * 0.75 * 3, rel=0.03)
    late = 2 * 0.75 * root * math.sqrt(256 / (16 * math.pi))
    assert file.damped(scene, variance, 16 * speed, 256 / speed) == pytest.approx(late, rel=0.05)
    # In squares of the length of the ring for a disc.
    due = file.damped(scene, variance, speed, 9.0) / 0.75**2
    assert file.law(scene, speed, 9.0, variance) == pytest.approx(due, rel=1e-12)


def test_sound_has_a_law_until_it_comes_back_around_the_ring():
    scene, density = Scene(96.0, 1.0, 0.28, discs=128, periodic="x"), file.Density(0.1, 4.5)
    around = scene.width / (density.speed * file.thermal_speed(scene))
    assert file.sound(scene, density, 0.51 * around) is None
    half = file.sound(scene, density, 0.499 * around)
    assert half == pytest.approx(scene.width**2 / 128 / 4.5**2 / 4, rel=1e-4)
    early = 0.01 * around
    slope = file.thermal_speed(scene) * 0.75 / density.speed
    assert file.sound(scene, density, early) == pytest.approx(0.99 * slope * early)


def test_order_changes_by_exchanges_alone():
    """Three discs on a ring of 3: all go around once; then the first two change places."""
    together = np.arange(3.0)[:, None, None] * np.ones((4, 2))
    assert file.squares(together, [1, 2]).tolist() == [[1, 1], [4, 4]]
    places = np.array([[0.5, 1.5, 2.5], [1.5, 2.5, 3.5], [3.5, 4.5, 5.5], [4.6, 4.5, 5.5]])
    places = places[:, :, None]
    numbers = file.order(places, 3.0)
    assert numbers[:, :, 0].tolist() == [[0, 1, 2]] * 3 + [[1, 0, 2]]
    found = file.ordered_places(places, numbers, 3.0)
    np.testing.assert_allclose(found[:3], places[:3])
    np.testing.assert_allclose(found[3, :, 0], [4.5, 4.6, 5.5])
    (walk,) = file.squares(numbers, [1])
    assert walk == pytest.approx([2 / 9])


@pytest.mark.parametrize("inertia", [None, slow(0.5)])
def test_long_files_have_the_law_of_their_density(inertia, small, monkeypatch):
    """F within five standard errors of theory and, where discs pass, of the measured density."""
    monkeypatch.setattr(displacements, "OPEN_HALVINGS", (4,))
    monkeypatch.setattr(displacements, "ONE_INERTIA", inertia)
    rows = list(displacements.displacements("long", 1.5, 1.0, [0.28, 0.3], 1, 16))
    judged = [row for row in rows if row.get("z") is not None]
    assert [row["quantity"] for row in judged] == ["single_file"] * 3
    assert all(abs(row["z"]) < 5 for row in judged)
    # Four kicks while a disc with the thermal speed goes as far as the channel is high.
    assert [row["friction"] for row in judged] == pytest.approx([4 / math.sqrt(2 * 18 - 1)] * 3)
    # Blocked: no exchange, so that discs and places move alike.
    moved, place = (of(rows, quantity=name, radius=0.28) for name in ("displacement", "file"))
    for one, other in zip(moved, place, strict=True):
        assert one["estimate"] == pytest.approx(other["estimate"], rel=1e-9)
    # F √t between two times, from squares of the file; their law is that of the kicks.
    for row in judged:
        same = {name: row[name] for name in ("radius", "friction")}
        own = {one["time"]: one for one in of(rows, quantity="file", **same)}
        late, early = (own[row["time"] / share] for share in (1, 4))
        for name in ("estimate", "reference"):
            slope = (late[name] - early[name]) / math.sqrt(early["time"])
            assert row[name] == pytest.approx(slope, rel=1e-9)
        if row["distance"] < 0:
            scene = Scene(0.75 * 18, 1.0, row["radius"], discs=18, periodic="x")
            due = file.law(scene, row["friction"], row["time"])
            assert late["reference"] == pytest.approx(due, rel=1e-12)
    # F is ∝ √S.
    (bulk,) = of(rows, quantity="density")
    (law,) = (row for row in judged if row["distance"] > 0)
    relative = bulk["stderr"] / bulk["estimate"] / 2
    assert law["reference_stderr"] == pytest.approx(relative * law["reference"], rel=1e-12)


@pytest.mark.parametrize("friction", [None, 0.5])
def test_logged_hops_are_those_of_the_recorded_motion(friction):
    """Another loop has the same places to roundings, and the time and the discs of each hop."""
    given = Scene(2.25, 1.0, 0.2, discs=3, periodic="x"), 0.5, 8, 40, 3, friction
    places, hops = file.recorded(*given)
    logs, n_alone = [*file.logged(*given)], 0
    for k, (own, times, pairs) in enumerate(logs):
        np.testing.assert_allclose(own[:, :, 0], places[:, :, k], atol=1e-9)
        assert times.size == pairs.size == hops[k] * 3 / 2
        changed = np.diff(file.order(own, 2.25)[:, :, 0], axis=0) != 0
        interval, count = np.unique((times // 0.5).astype(int), return_counts=True)
        for alone in interval[count == 1]:
            (pair,) = pairs[times // 0.5 == alone]
            assert [*np.flatnonzero(changed[alone])] == [*divmod(pair, 3)]
            n_alone += 1
    assert n_alone > 20


def test_hops_of_a_disc_are_correlated_with_the_same_disc_and_with_others():
    """On a ring of four 0 passes 1, comes back, passes 1 and 2; 1 and 3 hop over the seam twice."""
    times, pairs = np.array([1.0, 1.5, 3.0, 4.0, 6.0, 6.5]), np.array([1, 1, 1, 2, 4 + 3, 4 + 3])
    places = np.array([0.1, 1.0, 2.0, 3.9])
    found = file.hop_correlations(places, times, pairs, [0.6, 2.2, 2.7, 9.0], 5.0)
    # 0: + − + and + with 2; 1: − + − and − + with 3; 2: −; 3: + −, too late to count.
    assert found == [8, [-2] * 4, [0, 1, 0, 1]]
    found = file.hop_correlations(places, times, pairs, [0.6, 2.7], 5.0)
    assert found == [8, [-2, -2], [0, 0]]


def test_the_measured_density_is_exact_in_an_ordered_channel():
    """At r = 0.28: five standard errors."""
    scene = Scene(24.0, 1.0, 0.28, discs=32, periodic="x")
    places = file.many_initial_states.states(scene, 300, 1)[None, :32]
    found = file.measured_density(scene, places)
    due = file.exact_density(1.0, 0.28, 0.75).variance
    assert found.stderr < 0.12 * due
    assert abs(found.value - due) < 5 * found.stderr


def test_the_measured_density_is_the_limit_of_long_waves():
    """Discs that leave the places of a lattice independently have S(q) = 1 − exp(−q²s²)."""
    scene, n = Scene(24.0, 1.0, 0.28, discs=32, periodic="x"), 32
    offsets = 0.05 * np.random.default_rng(1).standard_normal((1, n, 1000))
    found = file.measured_density(scene, 0.75 * np.arange(n)[:, None] + offsets)
    shortest = (2 * math.pi / scene.width * file.WAVES * 0.05) ** 2
    assert abs(found.value) < 5 * found.stderr < 0.1 * shortest


KEPT = {"kept": []} | {
    name: PassagesTable.read(LONG_RUNS / name / "passages.csv")
    for name in ("files", "displacements")
}


def joined(name, box):
    """Return the rows of all parts that there are for a box, except those with friction."""
    scene = {"name": name, "box": {"width": box.width, "height": box.height}, "radii": [0.1]}
    parts = STUDIES["passages"].parts(load({"seed": 1, "scenes": [scene]}))
    given = [one | ({"box": box} if "box" in one else {}) for one in parts.values()]
    parts = [PassagesTable.part(**one) for one in given if one["part"] != "with_friction"]
    found = [empty(PassagesTable, **row) for part in parts for row in part]
    return [empty(PassagesTable, **row) for row in PassagesTable.rows({"all": found})]


def filled(rows):
    """Return {(quantity, method, whether discs are rough): columns that any such row fills}.

    Rates are left out: if they are from few blocks, or without friction, they have fewer.
    """
    found = {}
    for row in (row for row in rows if row["quantity"] != "rate"):
        kind = row["quantity"], row["method"], row["moment_of_inertia"] is not None
        found.setdefault(kind, set()).update(name for name, v in row.items() if v is not None)
    return found


@pytest.mark.parametrize("rough", [False, slow(True)])
def test_the_table_is_written(rough, tmp_path, small, monkeypatch):
    """The fast one takes the hops of smooth discs for those of rough discs, which has no score."""
    if not rough:
        monkeypatch.setattr(near, "hop_sums", smooth(near.hop_sums))
    seeds, seed_of = [], near.hop_seed
    for module in ("near", "parts.in_long_file"):
        name = f"twodiscs_paper.studies.passages.{module}.hop_seed"
        monkeypatch.setattr(name, lambda *of: seeds.append(seed_of(*of)) or seeds[-1])
    PassagesTable.write(tmp_path / "passages.csv", joined("paper", BOX))
    rows = PassagesTable.read(tmp_path / "passages.csv")
    assert len({*seeds}) == len(seeds) > 20  # every estimate has separate streams
    judged = [row for row in rows if rough or row["moment_of_inertia"] is None]
    assert max(abs(row["z"]) for row in judged if row["z"] is not None) < 5
    kept = PassagesTable.read(EXPECTED / "passages.csv")
    assert {row["quantity"] for row in rows} == {row["quantity"] for row in kept}
    names = "event", "width", "height", "discs", "radius", "distance", "friction", "quantity"
    assert filled(rows) == filled(kept)
    pores, kept_pores = of(rows, scene="pore"), of(kept, scene="pore")
    assert cells(pores, *names) == cells(kept_pores, *names)
    limit, kept_limit = (of(some, quantity="amplitude") for some in (rows, kept))
    assert cells(limit, *names) == cells(kept_limit, *names)
    for row, other in zip(pores, kept_pores, strict=True):
        assert row["exact_mean"] == pytest.approx(other["exact_mean"], rel=1e-12)
        assert deviation(row, other) < 5
    # Nothing but the passages tells time between passages from time between hops.
    times, kappa = of(rows, quantity="passage_time"), of(rows, quantity="coefficient")
    for time, fraction in zip(times, kappa, strict=True):
        assert time["estimate"] * fraction["estimate"] == pytest.approx(time["exact_mean"])


def test_a_box_on_its_side_has_vertical_hops_and_no_ring(small, monkeypatch):
    """Along a ring of its width the discs would be jammed before they cannot pass."""
    monkeypatch.setattr(near, "hop_sums", smooth(near.hop_sums))
    rows = joined("square", Box(1.0, 4.0))
    assert {row["event"] for row in rows if row["scene"] != "pore"} == {"vertical_hop", None}
    with style.context():
        for module in (figure, figure_transmission, figure_diffusion):
            for some in (of(rows, method="limit"), rows):
                assert module.draw(Box(1.0, 4.0), {"passages": some} | KEPT)


# Friction ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("kicked", [False, slow(True)])
def test_rows_with_friction(kicked, monkeypatch):
    """Hops have their exact rate: friction does not change it, and in the strip it has a kernel.

    Exponents of τ/κ are those of the long run by test_long_runs.
    """
    if not kicked:
        monkeypatch.setattr(strip, "run_blocks", smooth(strip.run_blocks))
    rows = list(with_friction.one_friction("paper", BOX, 40.0, (6, 8, 12), 2**19, 3))
    (rate,) = of(rows, quantity="rate")
    assert abs(rate["z"]) <= 5
    assert rate["stderr"] < 0.05 * rate["reference"]
    assert len(of(rows, quantity="local_exponent")) == 2
    assert list(fits([empty(PassagesTable, **row) for row in rows])) == []


@pytest.mark.parametrize("halvings", [8, 10])
def test_the_limit_of_long_necks_is_that_of_diffusion_in_the_plane(halvings):
    """Against its first orders: the ends of the channel, and the shape of the room in the neck."""
    scene = near.scene_at(BOX, HOP, halvings, friction=160.0)
    room, sigma, a = scene.height - 4 * scene.radius, scene.contact_distance, scene.range_x
    share = math.sqrt(room * sigma) / a
    due = 3 / 4 * (1 - 1.880 * share + 0.75 * room / sigma)
    assert abs(with_friction.diffusive_limit(scene, HOP) - due) < 2 * share**2


def test_the_limit_of_long_necks_does_not_depend_on_roundings():
    """Lengths in another unit have other roundings. The room is 3e-5 of the contact distance."""
    scene = near.scene_at(BOX, HOP, 16)
    lengths = np.array([scene.range_x, scene.clearance(HOP), scene.contact_distance])
    found = [plane.scaled_coefficient(*(lengths * unit)) for unit in (1.0, 0.3, 7.0)]
    assert found == pytest.approx([found[0]] * 3, rel=1e-12)
