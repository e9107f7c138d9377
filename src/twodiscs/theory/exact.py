"""Exact volume, areas, rates and mean times of every scene: the face of the theory.

Speeds are uniform on the unit sphere in four dimensions, so the mean time between events of an
ergodic component is (3π/2) V/A, or half of it for a hop, whose surface is crossed from both sides
(Chernov, J. Stat. Phys. 88, 1 (1997)). Scenes with effects have other constants and weights. More
than two discs have an exact value in some scenes; where none is known it is None, which is another
state than impossible: ``Scene.is_possible``. Each family has its theory in ``families``.
"""

from __future__ import annotations

import math
from functools import lru_cache

from twodiscs.model.checks import InputError, check_choice, check_length
from twodiscs.model.events import DECLARED, EVENTS, HOPS
from twodiscs.model.family import of_family
from twodiscs.model.scene import check_scene

TYPE_CHECKING = False  # what reads types takes it for true; the module typing is not for free
if TYPE_CHECKING:
    from typing import TypedDict

    from twodiscs.model.scene import Scene

    class Exact(TypedDict):
        """All exact numbers of a scene."""

        regime: str
        ergodic_components: int | None
        largest_radius: float
        volume: float
        areas: dict[str, float]
        mean_times: dict[str, float | None]


#: The least share of the prism, in which both centres keep to their ranges, that must be free of
#: overlaps in a scene with effects: starts are drawn from the prism by rejection.
MIN_FRACTION = 1e-4


@lru_cache(maxsize=1024)
def measures(scene):
    """Return (volume, {event: area}) of a ``Scene``; the last thousand scenes are remembered."""
    return of_family(scene, "theory", "volume_and_areas")(scene)


def volume(scene: Scene) -> float:
    """Return the volume of the configuration space of a ``Scene``, in length⁴ (6 for balls).

    For N discs it is in length^2N, and None where no exact value is known. In a field it is
    ∫ (1 − U/E)₊^(D/2 − 1) dq, with the potential energy U, E = 1/2 and D =
    ``scene.velocity_components``. Raises ``InputError`` for anything that is not a ``Scene``.

    For two discs it is within a few roundings of the exact value, for every box and radius. For
    three discs relative errors are some 1e-14. For more in a channel they are less than 1e-12 if it
    is longer than the discs in a row, and some 1e-11 if not. Where more than two discs hardly fit
    they are larger.

    Example:

        td.volume(scene)
    """
    return measures(check_scene(scene))[0]


def areas(scene: Scene) -> dict[str, float]:
    """Return {event: area of its surface in configuration space} of a ``Scene``, in length³.

    Keys are ``EVENTS`` in their order. The area is exactly 0.0 where the event is impossible
    or has no place; that of all walls is 4 (right + top) in a plain scene. It is in length⁵ for
    balls, carries 1/√mass (1 for disc 1), and has the weight (1 − U/E)₊^((D − 1)/2) in a field (see
    ``volume``). For more than two discs it is None where no exact value is known. Accuracy and
    errors as for ``volume``.

    Example:

        td.areas(scene)["disc_collision"]
    """
    return dict(measures(check_scene(scene))[1])


def rate(scene: Scene, event: str) -> float:
    """Return how often ``event`` happens per unit of time, over all initial conditions; 0 if never.

    This is the mean over the whole configuration space. Where disc 1 reaches the right (top) wall
    from its own side of disc 2 only, a trajectory that can reach it hits it twice as often:
    ``mean_times``. None where no exact value is known. Raises ``InputError`` for anything that is
    not a ``Scene`` or one of ``EVENTS``.

    Example:

        td.rate(scene, "any_wall")
    """
    volume, areas = measures(check_scene(scene))
    check_choice("event", event, EVENTS)
    return of_family(scene, "theory", "rate")(scene, event, volume, areas)


def passing_rate(scene, hop):
    """Return how often the discs pass each other in a ``hop``, in both directions together.

    That is ``rate``, and on a periodic axis, where it is no event of the ``Scene``, how often their
    separation to the nearest image changes its sign at 0. Raises ``InputError`` for anything that
    is not a ``Scene`` or a hop.
    """
    check_choice("hop", hop, HOPS)
    if DECLARED[hop].axis not in check_scene(scene).periodic:
        return rate(scene, hop)
    rate_of = of_family(scene, "theory", "passing_rate", "passages along a periodic axis")
    return rate_of(scene, hop, volume(scene))


def event_rate(scene):
    """Return the wall hits and disc collisions per unit of time of a ``Scene``, hops not counted.

    None where no exact value is known. Raises ``InputError`` for anything that is not a ``Scene``.
    """
    walls, collisions = rate(scene, "any_wall"), rate(scene, "disc_collision")
    return None if walls is None else walls + collisions


def work_per_event(scene):
    """Return how many times as much an event costs as usual, at most; 1 in a box without ends."""
    work = of_family(check_scene(scene), "theory", "work_per_event")
    return work(scene, event_rate(scene))


def events_per_interval(scene, hop):
    """Return the mean number of wall and disc events between two hops, weighted by their work."""
    return mean_times(scene)[hop] * event_rate(scene) * work_per_event(scene)


def mean_times(scene: Scene) -> dict[str, float | None]:
    """Return {event: mean time between two of them}, for disc 1 of mass 1 and total energy 1/2.

    Keys are ``EVENTS`` in their order, values lengths over unit speed, or None where the event is
    impossible. Wall times are those of disc 1 on the trajectories that can reach the wall: half of
    configuration space where a blocked hop keeps disc 1 from it in the other half. Where a larger
    disc 1 keeps its side and still reaches both walls, the time is one over the mean of its two
    rates. For more than two discs it is also None where no exact value is known, and wall times
    are averages over all initial conditions. Accuracy and errors as for ``volume``.

    Example:

        td.mean_times(scene)["vertical_hop"]
    """
    rates = {event: rate(scene, event) for event in EVENTS}
    return {event: scene.share(event) / value if value else None for event, value in rates.items()}


def exact(scene: Scene) -> Exact:
    """Return all exact numbers of a ``Scene`` as one dict, ready for JSON.

    Keys: regime, ergodic_components, largest_radius, volume, areas, mean_times. Values that are not
    known for more than two discs are None. Raises
    ``InputError`` for anything that is not a ``Scene``.

    Example:

        td.exact(scene)["regime"]
    """
    return {
        "regime": check_scene(scene).regime,
        "ergodic_components": scene.ergodic_components,
        "largest_radius": scene.largest_radius,
        "volume": volume(scene),
        "areas": areas(scene),
        "mean_times": mean_times(scene),
    }


def replicas_needed(scene, event, error):
    """Return how many initial states show the crowds of an ``event``, for a relative ``error``.

    That is 0 for smooth discs; see ``clusters``.
    """
    return of_family(scene, "theory", "replicas_needed")(scene, event, error)


def free_fraction(scene):
    """Return the share of the prism in which the discs are free, weighted in a field."""
    ranges = (
        scene.side(axis) - (0 if axis in scene.periodic else 2 * radius)
        for axis in scene.axes
        for radius in scene.radii
    )
    return volume(scene) / math.prod(ranges)


def fraction_near(scene, hop, distance):
    """Return the share of configuration space where the discs are almost level along a hop's axis.

    That is the probability, in the invariant measure, of a separation of at most ``distance`` along
    the axis of ``hop``, a length up to √2 times the smaller radius. Raises ``InputError`` for
    anything that is not a ``Scene`` or a hop, and for another distance.
    """
    check_choice("hop", hop, HOPS)
    distance = check_length("distance", distance)
    fraction_of = of_family(
        check_scene(scene), "theory", "fraction_near", "fractions near a surface"
    )
    limit = math.sqrt(2) * min(scene.radii)
    if distance > limit:
        raise InputError(f"distance must not exceed {limit!r}, but it is {distance!r}")
    return fraction_of(scene, hop, distance, volume(scene))


def shell_expectation(scene, event, epsilon):
    """Return what a shell of thickness ``epsilon`` around the surface of ``event`` estimates.

    That is the exact volume of the shell over ε, or over 2ε for hops, in length³; it tends to the
    area of the surface as ε → 0. Distances g in configuration space from the surface:

        vertical hop     |g| ≤ ε, g = (y1 − y2)/√2         horizontal hop   likewise in x
        disc collision   0 ≤ g ≤ ε, g = (distance − σ)/√2
        right wall       0 ≤ g ≤ ε, g = a − x1             top wall         0 ≤ g ≤ ε, g = b − y1

    Just beyond the radius where a hop becomes blocked its shell is not empty yet, though its area
    is 0. Shells of scenes with effects, whose discs may differ in mass, are in
    ``weighted.shell_expectation``. Raises ``InputError`` for anything that is not a ``Scene``, for
    an ``epsilon`` that is not a length up to the radius, for an event that has no place in the
    scene, and for ``any_wall``, which has no shell of its own in a plain scene.
    """
    expectation = of_family(check_scene(scene), "theory", "shell_expectation", "shells")
    check_choice("event", event, shells(scene))
    epsilon = check_length("epsilon", epsilon)
    if epsilon > scene.radius:
        raise InputError(
            f"epsilon must not exceed the radius {scene.radius!r}, but it is {epsilon!r}"
        )
    return expectation(scene, event, epsilon)


def shells(scene):
    """Return the events whose surface has a shell of its own; not of more than two discs."""
    return of_family(check_scene(scene), "theory", "shells")(scene)
