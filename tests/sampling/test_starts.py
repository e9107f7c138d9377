"""Initial states of two discs: the invariant measure, and the flux through a hop.

Without these tests initial states could have another law than the invariant measure, or the flux on
a surface.
"""

import math

import numpy as np
import pytest
from effect_scenes import PAPER, SCENES, distance_square
from marks import slow
from sampling import uniformity

from twodiscs.dynamics.two import strip
from twodiscs.model.events import HOPS
from twodiscs.model.scene import Scene
from twodiscs.sampling import initial_states
from twodiscs.sampling.initial_states import STATE_ROWS, draw_states, start_sampler, states
from twodiscs.sampling.jit import compiled
from twodiscs.sampling.rejection import fraction_if_accepted, propose_anywhere, rejection_sampler
from twodiscs.sampling.streams import open_stream

SMOOTH = {"plain": PAPER, "plain, narrow": PAPER.with_radius(0.3)}

#: D is 2, 3, 4 and 6 in the scenes of one effect; here it is 5 and 3, 6 and 4 again.
STARTS = {
    **SCENES,
    "upright channel": Scene(1.5, 1.0, 0.2, periodic="y", mass_ratio=0.2),
    "rough channel": Scene(1.5, 1.0, 0.2, periodic="x", moment_of_inertia=1.0, mass_ratio=2.0),
    "balls between plates": Scene(1.5, 1.0, 0.2, depth=0.8, periodic="xz", mass_ratio=5.0),
    "strong field": Scene(1.5, 1.0, 0.15, field=1.5, mass_ratio=0.5),
}


# The law ----------------------------------------------------------------------------------------


def rejected(scene, surface, n):
    """Return places {axis: (q1, q2)} by plain rejection: ``n`` proposals, the weight by numpy."""
    rng = np.random.default_rng(17)
    places, power = {}, scene.velocity_components / 2 - 1
    for axis in scene.axes:
        beside = scene.radii if axis in scene.walled else (0, 0)
        half = [scene.side(axis) / 2 - room for room in beside]
        places[axis] = np.array([rng.uniform(-h, h, n) for h in half])
        if axis == surface:
            places[axis][:] = rng.uniform(-min(half), min(half), n)
            power += 1 / 2
    weight = np.maximum(uniformity.energy_left(scene, *places["y"]), 0.0) ** power
    kept = distance_square(scene, places) >= scene.contact_distance**2
    kept &= rng.random(n) < weight
    return {axis: both[:, kept] for axis, both in places.items()}


def assert_same_law(scene, drawn, plain):
    """Means of coordinates, squares and products agree within five standard errors."""

    def functions(places):
        q = [row for axis in scene.axes for row in places[axis]]
        yield from q
        yield from (a * b for i, a in enumerate(q) for b in q[: i + 1])
        yield distance_square(scene, places)
        yield (q[0] * q[-1]) ** 2

    for a, b in zip(functions(drawn), functions(plain), strict=True):
        error = math.sqrt(a.var() / a.size + b.var() / b.size)
        assert abs(a.mean() - b.mean()) <= 5 * error


@pytest.mark.parametrize("scene", [PAPER, *STARTS.values()], ids=["plain", *STARTS])
def test_starts_have_the_law_of_the_invariant_measure(scene):
    found, spins = uniformity.parts(scene, states(scene, 50_000, 17))
    places = {axis: both[:2] for axis, both in found.items()}
    assert_same_law(scene, places, rejected(scene, None, 300_000))
    unit = uniformity.scaled_components(scene, found, spins)
    uniformity.assert_uniform_on_sphere(unit)
    # The direction of motion does not depend on the place.
    for a in (distance_square(scene, places), found["y"][0]):
        assert np.max(np.abs(np.corrcoef([a, *unit**2])[0, 1:])) <= 5 / math.sqrt(a.size)


#: The kernels of others take seconds to compile; two of these have momentum along an axis.
FAST = ("unequal", "larger", "channel", "friction", "upright channel", "combination")
SURFACES = [
    (pytest.param if name in FAST else slow)(name, axis)
    for name, scene in STARTS.items()
    for axis in "xy"
    if axis in scene.walled
] + [("plain", "y"), ("plain, narrow", "y")]


@pytest.mark.parametrize(("name", "hop"), SURFACES)
def test_starts_on_a_surface_have_the_law_of_the_flux(name, hop):
    scene = SMOOTH.get(name) or STARTS[name]
    sampler, drawn = start_sampler(scene, surface="xy".index(hop)), np.zeros((STATE_ROWS, 50_000))
    draw_states(open_stream(np.uint64(17), 0), sampler, drawn)
    found, spins = uniformity.parts(scene, drawn)
    places = {axis: both[:2] for axis, both in found.items()}
    assert np.array_equal(*places[hop])
    assert_same_law(scene, places, rejected(scene, hop, 300_000))
    normal, *others = uniformity.scaled_components(scene, found, spins, hop)
    rest = np.sqrt(1 - normal**2)
    uniformity.assert_uniform(rest ** (scene.velocity_components - 1))
    assert abs(np.mean(np.sign(normal))) <= 5 / math.sqrt(normal.size)
    uniformity.assert_uniform_on_sphere(np.array(others) / rest)


# States -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("scene", [PAPER, *SCENES.values()], ids=["plain", *SCENES])
def test_states_are_the_first_ones_of_their_stream(scene):
    """A block has the same starts in every process, for any number of them."""
    many = states(scene, 20, 3, 1)
    assert many.shape == (STATE_ROWS, 20)
    assert np.array_equal(states(scene, 7, 3, 1), many[:, :7])
    for other in (states(scene, 20, 3, 2), states(scene, 20, 4, 1)):
        assert not np.any(other[:8] == many[:8])


@pytest.mark.parametrize("discs", [2, 3])
def test_given_centres_are_moved_by_whole_periods(discs):
    """Discs of a larger number into the cell, disc 2 of two to the image nearest to disc 1."""
    scene = Scene(1.5, 1.0, 0.1, periodic="xy"[: 4 - discs], discs=discs)
    given = {n: np.linspace(-9.0, k, 50) for k, n in enumerate(initial_states.components(scene))}
    moved = {name: column.copy() for name, column in given.items()}
    shifts = initial_states.move_into_cell(scene, moved)
    for name, column in given.items():
        shift = shifts.get(name, 0.0)
        assert moved[name] + shift == pytest.approx(column)
        if (axis := name[0]) in scene.periodic:
            near, side = moved[f"{axis}1"] if discs == 2 else 0.0, scene.side(axis)
            assert np.max(np.abs(moved[name] - near)) <= side / 2 * (1 + 1e-9)
            assert shift / side == pytest.approx(np.round(shift / side))


# Proposals in the neck of a hop -----------------------------------------------------------------


@compiled
def accepted(state, prism, proposals):
    """Return how many of some proposals in a neck are accepted."""
    count = 0
    for _ in range(proposals):
        _, y1, _, dx, dy, dz = propose_anywhere(state, prism, prism.neck)
        fraction = fraction_if_accepted(state, prism, y1, dx, dy, dz, prism.components - 2)
        count += fraction >= 0.0
    return count


@pytest.mark.parametrize(
    ("scene", "hop"),
    [
        # In a field the energy of the lower places of a neck counts in the measure. Either disc is
        # the larger, and the heavier one.
        *(
            (Scene(1.5, 1.0, 0.49 / (1 + r), field=0.3, radius_ratio=r, mass_ratio=m), HOPS[1])
            for r in (0.6, 1.6)
            for m in (0.25, 4.0)
        ),
        (Scene(1.5, 1.0, 0.2, field=0.5, mass_ratio=4.0), "vertical_hop"),
        # Wide necks: some proposals have the opposite order.
        (Scene(1.5, 1.0, 0.1, mass_ratio=2.0), "horizontal_hop"),
        (Scene(1.5, 1.0, 0.05, radius_ratio=2.0), "vertical_hop"),
        # A periodic axis that is not that of the neck.
        (Scene(1.0, 1.5, 0.24, periodic="x", mass_ratio=2.0), "vertical_hop"),
        # A disc has less room in depth than their separation, or some proposals have the opposite
        # order in depth.
        *(
            (Scene(1.5, 1.0, radius, field=0.3, depth=depth, radius_ratio=r), HOPS[1])
            for radius, depth, r in (
                (0.2, 0.6, 1.0),
                (0.04, 1.0, 12.0),
                (0.48, 1.0, 1 / 12),
                (0.29, 2.0, 1.0),
            )
        ),
    ],
    ids=repr,
)
def test_the_chance_of_a_proposal_is_exact(scene, hop):
    """At 5 sigma."""
    band, proposals = strip.choose_strip(scene, hop), 200_000
    prism, chance = rejection_sampler(scene, hop, band.within), strip.acceptance(scene, hop, band)
    assert 0.001 < chance <= 1
    found = accepted(open_stream(np.uint64(1), 0), prism, proposals) / proposals
    assert abs(found - chance) < 5 * math.sqrt(chance * (1 - chance) / proposals)
