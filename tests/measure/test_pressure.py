"""Pressures, free energies and diffusion, with their errors.

Without it a factor of a wall or a covariance could be lost.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from effect_scenes import PAPER, SCENES, THREE
from factory import Laws
from marks import slow

import twodiscs as td
from twodiscs.analysis.tables import MeanTimesTable
from twodiscs.measure.measurements import Measurements
from twodiscs.model.events import WALLS

EXACT = {
    "plain": PAPER,
    "blocked": td.Scene(1.5, 1.0, 0.3),
    "narrow": td.Scene(3.0, 1.0, 0.4),
    "rough": SCENES["rough"],
    "balls": SCENES["balls"],
    "masses": td.Scene(1.5, 1.0, 0.2, mass_ratio=3),
    "channel": SCENES["channel"],
    "three": THREE,
    "file": td.Scene(3.0, 0.6, 0.18, discs=5),
    "torus": td.Scene(1.5, 1.0, 0.2, radius_ratio=0.6, mass_ratio=3, periodic="xy"),
    "three on a torus": td.Scene(1.5, 1.0, 0.22, discs=3, periodic="xy"),
}


@pytest.mark.parametrize("name", EXACT)
def test_forces_are_derivatives_of_the_free_energy(name):
    """−∂(F/kT)/∂w by differences, with the ideal gas that free energies leave out."""
    scene = EXACT[name]
    kt, step = 1 / scene.velocity_components, 1e-5
    for wall, side in (("right_wall", "width"), ("top_wall", "height")):
        if f"{wall}_pressure" not in td.pressure(scene):
            assert scene.periodic
            continue
        length = getattr(scene, side)
        low, high = (td.free_energy(replace(scene, **{side: length + s})) for s in (-step, step))
        due = kt * (scene.discs - length * (high - low) / (2 * step)) / math.prod(scene.sides)
        assert td.pressure(scene)[f"{wall}_pressure"] == pytest.approx(due, rel=2e-7)


@pytest.mark.parametrize("name", ["three", "file", "three on a torus"])
@pytest.mark.parametrize("unit", [2.0**-190, 2.0**180])
def test_only_a_volume_has_a_limit_of_its_unit(name, unit):
    """Free energies have logarithms, and rates have a unit of their own."""
    scene = EXACT[name]
    other = replace(scene, **{side: getattr(scene, side) * unit for side in scene.LENGTHS})
    assert td.free_energy(other) == pytest.approx(td.free_energy(scene), rel=1e-13)
    assert td.volume(other) is None
    assert td.free_energy(replace(other, discs=4, radius=other.radius / 2)) is None
    ideal = scene.discs * math.log(scene.width * scene.height)
    assert td.free_energy(scene) == pytest.approx(ideal - math.log(td.volume(scene)), rel=1e-12)
    for event in scene.events:
        assert td.rate(other, event) * unit == pytest.approx(td.rate(scene, event), rel=1e-14)


@pytest.mark.parametrize("name", ["torus", "three on a torus"])
def test_without_walls_the_pressure_is_the_derivative_by_the_area(name):
    """At a fixed shape. Of two discs of any masses it is that of the co-volume, πσ²/(S − πσ²)."""
    scene, step = EXACT[name], 1e-5
    kt, area = 1 / scene.velocity_components, scene.width * scene.height
    low, high = (
        td.free_energy(replace(scene, width=scene.width * scale, height=scene.height * scale))
        for scale in (1 - step, 1 + step)
    )
    due = kt / area * (scene.discs - (high - low) / (4 * step))
    found = td.pressure(scene)
    assert found["virial_pressure"] == pytest.approx(due, rel=1e-8)
    assert found["compressibility_factor"] == pytest.approx(due * area / scene.discs / kt)
    if name == "torus":
        excluded = math.pi * scene.contact_distance**2
        assert due * area / kt == pytest.approx(2 + excluded / (area - excluded), rel=1e-8)


WALLED = [n for n in EXACT if n not in ("balls", "masses", "channel", "torus", "three on a torus")]


@pytest.mark.parametrize("name", WALLED)
def test_walls_and_collisions_tell_one_pressure(name):
    found = td.pressure(EXACT[name])
    assert found["wall_pressure"] == pytest.approx(found["virial_pressure"], rel=1e-10)
    sides = sorted((found["right_wall_pressure"], found["top_wall_pressure"]))
    assert sides[0] <= found["wall_pressure"] <= sides[1]
    ratio = found["wall_pressure"] / found["ideal_pressure"]
    assert found["compressibility_factor"] == pytest.approx(ratio, rel=1e-14)


@pytest.mark.parametrize(
    "name", ["plain", "blocked", slow("rough"), "three", slow("torus"), "three on a torus"]
)
def test_measured_pressures_are_the_exact_ones(name, recwarn):
    """20 scores at 5 sigma: one false alarm in 87,000."""
    scene = EXACT[name]
    # Crowds of collisions of rough discs take more replicas.
    times = td.simulate(scene, duration=2e6 if name == "rough" else 1e5, seed=4)
    found = td.pressure(times)
    assert list(found) == list(td.pressure(scene))
    events = ("right_wall", "top_wall") if scene.walled else ("disc_collision",)
    pressure = found["wall_pressure" if scene.walled else "virial_pressure"]
    assert pressure.count == min(times[f"{event}_time"].count for event in events)
    # One measured number over a known one.
    due = pressure.u / found["ideal_pressure"].u
    assert (found["compressibility_factor"].u - due).std_dev < 1e-9 * due.std_dev
    assert found["ideal_pressure"].count == 0
    assert not recwarn.list
    for quantity, exact in td.pressure(scene).items():
        one = found[quantity]
        assert one.exact == exact
        if quantity != "ideal_pressure":
            assert one.stderr < 0.02 * one.value
            assert abs(one.z) < 5, quantity


@pytest.mark.parametrize("number", [20, 0])
@pytest.mark.parametrize("rare", ["right_wall", "top_wall"])
def test_a_pressure_has_an_error_if_none_of_its_times_is_too_rare_for_one(rare, number):
    point = Laws(PAPER).dynamics(np.random.default_rng(1), 1024, 1e-2)
    products = point.products | {f"{rare}*{rare}": number}
    point = replace(point, counts=point.counts | {rare: number}, products=products)
    found = td.pressure(Measurements("simulate", PAPER, MeanTimesTable.rows([point]), {}, point))
    known = {name for name, one in found.items() if one.stderr}
    assert known == {"virial_pressure", *(f"{wall}_pressure" for wall in {*WALLS} - {rare})}
    assert {name for name, one in found.items() if one.z is not None} == known
    assert (found[f"{rare}_pressure"].value is None) == (number == 0)


@pytest.mark.parametrize(
    ("name", "unit"), [("plain", "energy/length²"), ("balls", "energy/length³")]
)
def test_a_pressure_has_the_unit_of_a_force_on_a_side_of_the_box(name, unit):
    point = Laws(EXACT[name]).dynamics(np.random.default_rng(1), events=("right_wall", "top_wall"))
    rows = MeanTimesTable.rows([point])
    found = td.pressure(Measurements("simulate", point.scene, rows, {}, point))
    assert str(found).startswith(f"{point.scene}\n\n")
    units = {quantity: one.unit for quantity, one in found.items()}
    assert units.pop("compressibility_factor") == ""
    assert {*units.values()} == {unit}


def test_the_free_energy_is_measured_by_the_volume():
    """Five standard errors: one false alarm in two million."""
    found = td.free_energy(td.sample(PAPER, 1e6, seed=2))
    assert (found.exact, found.unit) == (td.free_energy(PAPER), "kT")
    assert abs(found.z) < 5
    assert found.z == pytest.approx((found.value - found.exact) / found.stderr)
    volume = td.sample(PAPER, 1e6, seed=2, quantities="volume")["volume"]
    assert found.stderr == pytest.approx(volume.stderr / volume.value)
    four = td.Scene(1.5, 1.0, 0.12, discs=4)  # whose volume is not known exactly
    assert td.free_energy(four) is td.free_energy(td.sample(four, 1)).exact is None
    pressures = td.pressure(four)
    assert {name for name in pressures if pressures[name] is not None} == {"ideal_pressure"}


# Diffusion ----------------------------------------------------------------------------------------


RING = td.Scene(2.0, 1.0, 0.1, discs=3, periodic="x")


@pytest.mark.parametrize("scene", [SCENES["channel"], slow(SCENES["torus"]), RING], ids=str)
def test_squared_displacements_begin_ballistically(scene):
    """⟨u²⟩ t² with ⟨u²⟩ = (1 − 1/N)/D for N equal discs at total momentum 0, at five sigma."""
    found = td.diffusion(scene, [1e-3, 2e-3], 5e4, seed=3)
    n = scene.discs
    # Unit vectors of the D free components: each disc has its share of those along the axis.
    square = (n - 1) / n / scene.velocity_components
    for k, time in enumerate(found.times):
        # Collisions within the time take less than a hundredth of it.
        due = square * time**2
        assert abs(found.mean[k, 0] - due) < 5 * found.stderr[k, 0] + 0.01 * due
    assert found.mean[0, 1] == pytest.approx(found.mean[0, 0] / 2e-3)


@pytest.mark.parametrize(
    ("ring", "discs"), [(RING, (1, 2, 3)), (RING, (1,)), slow(SCENES["combination"], (1,))], ids=str
)
def test_displacements_are_of_disc_1_unless_all_are_equal(ring, discs, monkeypatch):
    """The discs of a ring are equal, or declared as different."""
    monkeypatch.setattr(td.Scene, "identical", property(lambda _: len(discs) > 1))

    def moved(start, now):
        return np.mean([(now[f"x{n}"] - start[f"x{n}"]) ** 2 for n in discs], axis=0)

    found = td.diffusion(ring, [1.0, 3.0, 4.0], 8193, seed=2)  # three blocks
    due = td.observe(ring, moved, found.times, 8193, seed=2).mean
    assert np.allclose(found.mean[:, 0], due, rtol=1e-12)
    # One time after the other, as of more states than the memory is to hold.
    monkeypatch.setattr("twodiscs.dynamics.averages.MOST_STATE_NUMBERS", 1)
    again = td.diffusion(ring, found.times, 8193, seed=2, cores=2)
    assert np.allclose(found.mean, again.mean, rtol=1e-12)


def test_diffusion_is_along_the_first_periodic_axis_or_a_given_one(monkeypatch):
    now = {"x1": 1, "x2": 1, "y1": 2, "y2": 2, "z1": 3, "z2": 3}
    called = lambda *given, **_: given[4](dict.fromkeys(now, 0), now)  # noqa: E731
    monkeypatch.setattr("twodiscs.measure.observe._averages", called)
    for periodic, axis, square in (("xy", None, 1), ("yz", None, 4), ("xyz", "z", 9)):
        scene = td.Scene(1.5, 1.0, 0.1, depth=1.0, periodic=periodic)
        assert td.diffusion(scene, [1.0], axis=axis) == square
