"""Pressures and free energy, exact and measured, in units of the mass of disc 1 and its speed.

The total energy is 1/2 in D components of velocity, so that kT = 1/D. A wall of the length h has
the pressure F/h. The force F of all N discs on it is N times the rate of disc 1 at that wall times
the mean momentum of a hit (``theory.virial``). With the ranges A and B of the centres, the virial
theorem for the two walls together is

    h A P_right + w B P_top = 2 N kT (1 + σ ν_coll/(√2 N c_D))

with the rate ν_coll of all collisions: a pressure without wall hits. For two discs √2 N is √8.

On a torus P w h/(N kT) = 1 + σ ν_coll/(√2 N c_D) with D = 2N − 2, because the total momentum is 0.
The 1 belongs to all N discs: P is kT ∂lnV/∂(w h) at a fixed shape, and V scales as a length to the
power 2N. The force of collisions is σ kT (−∂lnV/∂σ), and their rate −(c_D/√2) ∂lnV/∂σ (``flux``).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, overload

from twodiscs.measure.measurements import Measurement, Measurements, derived, text_table
from twodiscs.model.checks import InputError
from twodiscs.model.events import EVENT_AXES, WALLS
from twodiscs.model.formats import quote
from twodiscs.model.scene import Scene
from twodiscs.points.dynamics_point import DynamicsPoint
from twodiscs.theory import exact, n_discs, virial


class Pressures(dict):
    """{quantity: ``Measurement``} of one ``scene``; prints as a table."""

    def __init__(self, scene, measurements):
        self.scene = scene
        super().__init__({one.quantity: one for one in measurements})

    def __repr__(self):
        return f"{self.scene}\n\n{text_table(self.values()).to_string(index=False)}"


def _require_simple(scene):
    """Raise ``InputError`` for scenes that have no single pressure."""
    if scene.field:
        raise InputError(
            f"field must be 0 for a pressure, which depends on the height, not {scene.field!r}"
        )
    if scene.radius_ratio != 1 and scene.walled:
        raise InputError(
            "radius_ratio must be 1 for a pressure, because only the hits of disc 1 are counted, "
            f"not {scene.radius_ratio!r}"
        )
    if scene.walled == ("z",):
        raise InputError(
            "scene must have walls along x or y for a pressure, or no walls at all, but it has "
            "walls along z only"
        )


def terms(scene):
    """Return {quantity: (constant, {event: factor of its rate})} of all pressures of a ``Scene``.

    The virial pressure is among them between walls, for equal discs, and without any wall.
    """
    _require_simple(scene)
    n, kt = scene.discs, 1 / scene.velocity_components
    volume = math.prod(scene.sides)
    ideal = n * kt / volume
    if not scene.walled:
        momentum = virial.momentum_per_hit(scene) / scene.fastest
        collisions = scene.contact_distance * momentum / (len(scene.axes) * volume)
        return {
            "virial_pressure": (ideal, {"disc_collision": collisions}),
            "ideal_pressure": (ideal, {}),
            "compressibility_factor": (1.0, {"disc_collision": collisions / ideal}),
        }
    pressures, weighted, norm = {}, {}, 0.0
    for wall in WALLS:
        axis = EVENT_AXES[wall]
        if axis in scene.walled:
            force, reach = n * virial.momentum_per_hit(scene), float(scene.reach(axis))
            area = volume / scene.side(axis)
            pressures[f"{wall}_pressure"] = 0.0, {wall: force / area}
            if axis not in map(EVENT_AXES.get, weighted):  # one wall of an axis is enough
                weighted[wall], norm = force * reach, norm + area * reach
    mean = {wall: weight / norm for wall, weight in weighted.items()}
    pressures["wall_pressure"] = 0.0, mean
    if (weights := virial.weights(scene)) is not None:
        kinetic = 2 * n * kt / norm
        collisions = {"disc_collision": -kinetic * weights["disc_collision"]}
        pressures["virial_pressure"] = kinetic, collisions
    pressures["ideal_pressure"] = ideal, {}
    ratio = {wall: factor / ideal for wall, factor in mean.items()}
    pressures["compressibility_factor"] = 0.0, ratio
    return pressures


@overload
def pressure(of: Scene) -> dict[str, float | Any]: ...
@overload
def pressure(of: Measurements) -> Mapping[str, Measurement]: ...
def pressure(of):
    """Return the pressures of a scene, exact or from the rates that dynamics measured.

    The unit is energy/length² (energy/length³ for balls) where the mass of disc 1 is 1 and the
    total energy 1/2. kT is 1/D, with D = ``scene.velocity_components``.

    Parameters
    ----------
    of : Scene or Measurements
        A scene for exact values, or a result of ``simulate``.

    Returns
    -------
    dict
        {quantity: number}, or {quantity: ``Measurement``} with errors, exact values and z:

        - right_wall_pressure, top_wall_pressure: the force of all discs on a wall over its length
        - wall_pressure: their mean with the weights h A and w B, with the ranges A and B of the
          centres; the error includes the correlation of the two
        - virial_pressure: the same mean from the collisions of the discs only; on a torus, the
          mean of the pressures along its axes
        - ideal_pressure: N kT/(w h), the pressure of points
        - compressibility_factor: wall_pressure over ideal_pressure; on a torus, virial_pressure
          over ideal_pressure

        A number is None if no exact value is known, for more than two discs. A result has the
        pressures whose events it counted. On a periodic axis there are no walls.

    Raises
    ------
    InputError
        In a field, for unequal radii between walls, if only z has walls, and for anything but a
        ``Scene`` or a result of ``simulate``.

    Notes
    -----
    The sum rule wall_pressure = virial_pressure is the virial theorem of Clausius: exact values
    agree to rounding, measured values within their errors. It holds between walls for any number of
    equal discs, smooth or rough.

    Examples
    --------
    >>> exact = td.pressure(scene)
    >>> round(exact["right_wall_pressure"], 12), round(exact["compressibility_factor"], 12)
    (0.609598818993, 1.943912364366)
    >>> abs(exact["wall_pressure"] / exact["virial_pressure"] - 1) < 1e-12
    True
    >>> abs(td.pressure(td.simulate(scene, 0.02, seed=1))["virial_pressure"].z) < 5
    True
    """
    if isinstance(of, Scene):
        return {name: _combine_rates(of, *term) for name, term in terms(of).items()}
    if isinstance(of, Measurements) and isinstance(of.point, DynamicsPoint):
        scene, rows = of.scene, {row["event"]: row for row in of.rows}
        return Pressures(
            scene,
            [
                _measured(of, rows, name, constant, factors)
                for name, (constant, factors) in terms(scene).items()
                if factors.keys() <= rows.keys()
            ],
        )
    raise InputError(f"of must be a Scene or a result of simulate, not {quote(of)}")


def _combine_rates(scene, constant, factors):
    """Return a constant plus factors times exact rates, None if a rate is not known."""
    rates = {event: exact.rate(scene, event) for event in factors}
    if None in rates.values():
        return None
    return constant + sum(factors[event] * rate for event, rate in rates.items())


def _measured(result, rows, name, constant, factors):
    """Return the ``Measurement`` of a constant plus factors times measured rates."""
    scene, counted = result.scene, [rows[event] for event in factors]
    power = "²³"[len(scene.axes) - 2]
    unit = "" if name.endswith("factor") else f"energy/length{power}"
    due = _combine_rates(scene, constant, factors)
    if not counted:
        return Measurement(name, constant, 0.0, due, None, 0, "exact", unit)
    count = min(row["count"] for row in counted)
    if any(row["estimate"] is None for row in counted):
        return Measurement(name, None, None, due, None, count, "derived", unit)
    # A time is that of the trajectories that can have the event, which are a share of all.
    pressure = constant + sum(
        factors[event] * scene.accessible_fraction(event) / result[f"{event}_time"].u
        for event in factors
    )
    return derived(name, pressure, due, unit, count)


@overload
def free_energy(of: Scene) -> float | Any: ...
@overload
def free_energy(of: Measurements) -> Measurement: ...
def free_energy(of):
    """Return the excess free energy over an ideal gas, exact or from the measured volume.

    It is −ln(V/V_ideal) in units of kT. V is the volume of configuration space, and V_ideal the
    volume for points in the same box, (w h)ᴺ, or (w h d)ᴺ for balls. It equals minus the excess
    entropy over k, because discs that do not overlap have no potential energy. Its derivatives by
    the sides are the forces on the walls.

    Parameters
    ----------
    of : Scene or Measurements
        A scene for the exact value, or a result of ``sample`` that has the volume.

    Returns
    -------
    float or Measurement
        In units of kT, without dimension. The number is None if no exact value is known, for more
        than two discs.

    Raises
    ------
    InputError
        In a field, and for anything but a ``Scene`` or a result of ``sample``.

    Examples
    --------
    >>> round(td.free_energy(scene), 12)
    2.254368712677
    >>> abs(td.free_energy(td.sample(scene, 1e6, seed=1)).z) < 5
    True
    """
    is_result = isinstance(of, Measurements) and "volume" in of
    scene = of.scene if is_result else of
    if not isinstance(scene, Scene):
        raise InputError(f"of must be a Scene or a result of sample, not {quote(of)}")
    if scene.field:
        raise InputError(f"field must be 0 for the free energy of hard discs, not {scene.field!r}")
    ideal = scene.discs * math.fsum(map(math.log, scene.sides))
    if not is_result:
        if scene.discs > 2:
            known = n_discs.known_derivatives(scene, False)
            return None if known is None else ideal - known.log_volume
        return ideal - math.log(exact.volume(scene))
    from uncertainties.umath import log

    volume = of["volume"]
    exact_energy = None if volume.exact is None else ideal - math.log(volume.exact)
    energy = ideal - log(volume.u)
    return derived("excess_free_energy", energy, exact_energy, "kT", volume.count)
