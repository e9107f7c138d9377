"""Exact volume, areas, rates and mean times of every scene: the face of the theory.

Speeds are uniform on the unit sphere in four dimensions, so the mean time between events of an
ergodic component is (3π/2) V/A, or half of it for a hop, whose surface is crossed from both sides
(Chernov, J. Stat. Phys. 88, 1 (1997)). Scenes with effects have other constants and weights. For
more than two discs exact values are known in some scenes. A value that is not known is None;
``Scene.is_possible`` tells whether the event is impossible. ``find_theory`` finds the module that
computes them.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, TypedDict

from twodiscs.model.checks import check_choice
from twodiscs.model.events import EVENTS, WALL_HITS
from twodiscs.model.scene import Scene, check_scene
from twodiscs.theory import clusters, n_discs, plain, weighted

if TYPE_CHECKING:
    from twodiscs import Event


class Exact(TypedDict):
    """All exact numbers of a scene."""

    regime: str
    ergodic_components: int | None
    largest_radius: float
    volume: float
    areas: dict[str, float]
    mean_times: dict[str, float | None]


#: The least fraction of the prism (both centres in their ranges) without overlap in a scene with
#: effects. Initial states are drawn from the prism by rejection.
MIN_FRACTION = 1e-4

#: Crossings of the periodic cell between two events that the usual cost of an event includes.
CROSSINGS_PER_EVENT = 64

#: The time of a kick over the time of an event.
KICK_WORK = 15


#: The modules with the theory of each family of scenes.
THEORIES = {"plain": plain, "effects": weighted, "many": n_discs}


def find_theory(scene):
    """Return the module with the theory of a ``Scene``."""
    return THEORIES[check_scene(scene).family]


def volume(scene: Scene) -> float:
    """Return the volume of the configuration space of a scene.

    For two discs it is within a few roundings of the exact value, for every box and radius. For
    three discs relative errors are some 1e-14. For more discs in a channel they are less than 1e-12
    if it is longer than the discs in a row, and some 1e-11 if not. Errors are larger if more than
    two discs hardly fit.

    Parameters
    ----------
    scene : Scene
        The box, the discs and their effects.

    Returns
    -------
    float
        In length⁴ for two discs, length⁶ for balls, length²ᴺ for N discs; None if no exact value is
        known. In a field it is ∫ (1 − U/E)₊^(D/2 − 1) dq, with the potential energy U, E = 1/2 and
        D = ``scene.velocity_components``.

    Raises
    ------
    InputError
        For anything that is not a ``Scene``.

    Examples
    --------
    >>> round(td.volume(scene), 12)
    0.236114482448
    """
    return find_theory(scene).volume(scene)


def areas(scene: Scene) -> dict[str, float]:
    """Return {event: area of its surface in configuration space} of a ``Scene``.

    ``td.areas`` says what the areas are.
    """
    return dict(find_theory(scene).areas(scene))


def rate(scene: Scene, event: Event) -> float:
    """Return the mean number of an event per unit of time, over all initial conditions.

    This is the mean over the whole configuration space. If disc 1 reaches the right (top) wall from
    one side of disc 2 only, a trajectory that can reach the wall hits it twice as often (see
    ``mean_times``).

    Parameters
    ----------
    scene : Scene
        The box, the discs and their effects.
    event : str
        One of ``EVENTS``.

    Returns
    -------
    float
        In 1/time; 0 if the event never happens, None if no exact value is known.

    Raises
    ------
    InputError
        For anything that is not a ``Scene`` or one of ``EVENTS``.

    Examples
    --------
    >>> round(td.rate(scene, "any_wall"), 12)
    2.804358669238
    """
    return find_theory(scene).rate(scene, check_choice("event", event, EVENTS))


def event_rate(scene):
    """Return the wall hits and disc collisions per time, without hops; None if not known."""
    walls, collisions = rate(scene, "any_wall"), rate(scene, "disc_collision")
    return None if None in (walls, collisions) else walls + collisions


def work_per_event(scene):
    """Return an upper bound on the cost of an event over the usual cost, 1 between walls.

    On a periodic axis discs leave their cell between two events, very often if they are small. The
    usual cost includes ``CROSSINGS_PER_EVENT`` such crossings. A kick by friction costs about as
    much as ``KICK_WORK`` events.
    """
    crossings = sum(scene.fastest / scene.side(axis) for axis in scene.periodic)
    usual = max(1.0, crossings / CROSSINGS_PER_EVENT / event_rate(scene))
    return usual + KICK_WORK * scene.friction / event_rate(scene)


def events_per_interval(scene, hop):
    """Return the mean number of wall and disc events between two hops, weighted by their work."""
    return mean_times(scene)[hop] * event_rate(scene) * work_per_event(scene)


def mean_times(scene: Scene) -> dict[str, float | None]:
    """Return {event: mean time between two of them} of a ``Scene``.

    ``td.mean_times`` says what the times are.
    """
    rates = {event: rate(scene, event) for event in EVENTS}
    return {
        event: scene.accessible_fraction(event) / value if value else None
        for event, value in rates.items()
    }


def exact(scene: Scene) -> Exact:
    """Return all exact numbers of a ``Scene``, as ``td.exact`` does, but by events."""
    return {
        "regime": check_scene(scene).regime,
        "ergodic_components": scene.ergodic_components,
        "largest_radius": scene.largest_radius,
        "volume": volume(scene),
        "areas": areas(scene),
        "mean_times": mean_times(scene),
    }


def replicas_needed(scene, event, error):
    """Return the least number of replicas in which the ``error`` of an ``event`` includes bursts.

    Fewer replicas may have seen none of the bursts of rough discs (see ``clusters``), and give too
    small an error. ``error`` is relative. Smooth discs have no bursts and need 0. For more than
    two discs it is an estimate: that of two of the discs in the same box, divided by the number of
    pairs. Any pair may begin in a neck, and the other discs only shorten its bursts. Each disc is
    in N − 1 pairs, whose bursts at the walls add up.
    """
    pairs, others = math.comb(scene.discs, 2), scene.discs - 1
    if event in WALL_HITS:
        error /= others
    return clusters.replicas_needed(replace(scene, discs=2), event, error) / pairs


def free_fraction(scene):
    """Return the fraction of the prism without overlap, weighted in a field."""
    ranges = (
        scene.side(axis) - (0 if axis in scene.periodic else 2 * radius)
        for axis in scene.axes
        for radius in scene.radii
    )
    return volume(scene) / math.prod(ranges)


def fraction_near(scene, hop, distance):
    """Return the fraction of configuration space within a ``distance`` of a ``hop``.

    It is the probability, in the invariant measure, of a separation of at most ``distance`` along
    the axis of the hop, a length up to √2 times the smaller radius.
    """
    return find_theory(scene).volume_near(scene, hop, distance) / volume(scene)


def shell_expectation(scene, event, epsilon):
    """Return the exact expectation of a shell of thickness ``epsilon`` at the surface of ``event``.

    It is the volume of the shell over ε, or over 2ε for hops, in length³. It tends to the area of
    the surface as ε → 0. The distances g from the surface in configuration space are

        vertical hop     |g| ≤ ε, g = (y1 − y2)/√2         horizontal hop   likewise in x
        disc collision   0 ≤ g ≤ ε, g = (distance − σ)/√2
        right wall       0 ≤ g ≤ ε, g = a − x1             top wall         0 ≤ g ≤ ε, g = b − y1

    Just beyond the radius at which a hop becomes blocked, its area is 0, but its shell is not yet
    empty. ``weighted.shell_expectation`` has the shells of scenes with effects, in which masses may
    differ. In a plain scene ``any_wall`` has no shell.
    """
    return find_theory(scene).shell_expectation(scene, event, epsilon)
