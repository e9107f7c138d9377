"""Exact values by the names of quantities, as functions of the face return them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from itertools import product
from typing import TYPE_CHECKING, Any, Unpack

from twodiscs.analysis.tables import TheoryTable
from twodiscs.model.calls import checked_call, warn
from twodiscs.model.checks import InputError, check_length
from twodiscs.model.events import EVENTS
from twodiscs.model.formats import did_you_mean, quote
from twodiscs.model.scene import Box, check_scene
from twodiscs.theory import exact as theory
from twodiscs.theory import n_discs

if TYPE_CHECKING:
    import pandas as pd

    from twodiscs import Effects
    from twodiscs.model.scene import Scene
    from twodiscs.theory.exact import Exact


class Quantities(dict):
    """{quantity: value}; any other key raises a ``KeyError`` that lists the quantities."""

    def __missing__(self, name):
        raise KeyError(f"{quote(name)} is none of {', '.join(self)}{did_you_mean(name, self)}")


def areas(scene: Scene) -> dict[str, float]:
    """Return the areas of the surfaces of all events in configuration space.

    Parameters
    ----------
    scene : Scene
        The box, the discs and their effects.

    Returns
    -------
    dict
        {"<event>_area": area} in the order of ``EVENTS``. Areas are in length³ for two discs,
        length⁵ for balls. An area is exactly 0.0 if the event is impossible or does not exist in
        the scene, and None if no exact value is known, for more than two discs. The area of all
        walls is 4 (right + top) in a plain scene. Areas have a factor 1/√mass (1 for disc 1), and
        the weight (1 − U/E)₊^((D − 1)/2) in a field (see ``volume``, also for the accuracy).

    Raises
    ------
    InputError
        For anything that is not a ``Scene``.

    Examples
    --------
    >>> round(td.areas(scene)["disc_collision_area"], 12)
    0.988197171469
    """
    return Quantities((f"{event}_area", area) for event, area in theory.areas(scene).items())


def mean_times(scene: Scene) -> dict[str, float | Any]:
    """Return the mean times between two events of each kind.

    Disc 1 has mass 1 and the total energy is 1/2. Wall times are times of disc 1 on the
    trajectories that can reach the wall. If a blocked hop keeps disc 1 from it in one half of
    configuration space, they fill the other half. If a larger disc 1 stays on its side and still
    reaches both walls, the time is one over the mean of its two rates. For more than two discs wall
    times are averages over all initial conditions.

    Parameters
    ----------
    scene : Scene
        The box, the discs and their effects.

    Returns
    -------
    dict
        {"<event>_time": mean time} in the order of ``EVENTS``. Times are lengths over unit speed. A
        time is None if the event is impossible, or if no exact value is known, for more than two
        discs. The accuracy is that of ``volume``.

    Raises
    ------
    InputError
        For anything that is not a ``Scene``.

    Examples
    --------
    >>> round(td.mean_times(scene)["vertical_hop_time"], 12)
    1.338047200916
    >>> td.mean_times(td.Scene(1.5, 1.0, 0.3))["horizontal_hop_time"] is None
    True
    """
    return Quantities((f"{event}_time", time) for event, time in theory.mean_times(scene).items())


def exact(scene: Scene) -> Exact:
    """Return all exact numbers of a scene as one dict, ready for JSON.

    Parameters
    ----------
    scene : Scene
        The box, the discs and their effects.

    Returns
    -------
    dict
        Keys are regime, ergodic_components, largest_radius, volume, areas and mean_times, the last
        two with the dicts of the functions of these names. Values that are not known for more than
        two discs are None.

    Raises
    ------
    InputError
        For anything that is not a ``Scene``.

    Notes
    -----
    It takes milliseconds for two discs, and less than a second for three and for most channels of
    more. Four to seven discs in a channel that is hardly longer than their row, or shorter, may
    take minutes; a ``UserWarning`` then says this before the work begins.

    Examples
    --------
    >>> td.exact(scene)["regime"]
    'all-hops'
    """
    if n_discs.takes_minutes(check_scene(scene)):
        warn(
            f"the exact numbers of {scene.discs} discs in a channel that is hardly longer than "
            "their row may take some minutes; simulate and sample take seconds"
        )
    return theory.exact(scene) | {"areas": areas(scene), "mean_times": mean_times(scene)}


@checked_call
def exact_table(
    width: float, height: float, radii: float | Iterable[float], **effects: Unpack[Effects]
) -> pd.DataFrame:
    """Return the exact numbers of a box over ``radii``, one row per radius.

    Parameters
    ----------
    width, height : float
        Sides of the box, in length, from 1e-60 to 1e60.
    radii : float or iterable of float
        Radii of disc 1, in length, at least one of which must fit.
    **effects
        The effects and ``discs`` of ``Scene``.

    Returns
    -------
    DataFrame, shape (radii, 2 + 1 + 12)
        Its index is the radius. Columns are regime, ergodic_components, volume, and <event>_area
        and <event>_time of every event. A time is NaN if the event is impossible or no exact value
        is known. Units are those of ``volume``, ``areas`` and ``mean_times``. Last are the radii
        that do not fit, whose regime says why.

    Raises
    ------
    InputError
        If no radius fits, for an empty list, and for an unknown effect.

    Examples
    --------
    >>> td.exact_table(1.5, 1.0, [0.1, 0.2])["vertical_hop_time"].round(6)
    radius
    0.1    1.673843
    0.2    1.338047
    Name: vertical_hop_time, dtype: float64
    """
    import pandas as pd

    box = Box(width, height, **effects)
    scenes, refused = fitting_scenes([box], radii)
    rows = [
        {
            "radius": scene.radius,
            "regime": scene.regime,
            "ergodic_components": scene.ergodic_components,
            **{row["quantity"]: row["exact"] for row in TheoryTable.rows(box, [scene.radius])},
        }
        for scene in scenes
    ]
    rows += [{"radius": one["radius"], "regime": why} for one, why in refused]
    frame = pd.DataFrame(rows).set_index("radius")
    parts = [row.get("ergodic_components") for row in rows]
    if any(part is None or part.bit_length() > 63 for part in parts):
        frame["ergodic_components"] = pd.Series(parts, frame.index, object)
    known = ["volume", *(f"{event}_{kind}" for kind in ("area", "time") for event in EVENTS)]
    frame[known] = frame[known].astype(float)
    frame.attrs["box"] = box.parameters()
    return frame


def as_list(values):
    """Return some values as a list, or None for a single one, a text or a dict."""
    single = isinstance(values, str | bytes | Mapping) or not isinstance(values, Iterable)
    return None if single or getattr(values, "ndim", 1) == 0 else [*values]


def fitting_scenes(boxes, radii):
    """Return the scenes of ``boxes`` at some ``radii``, and [(parameters, why it does not fit)].

    Raises ``InputError`` if none of them fits.
    """
    if isinstance(radii, str | bytes | Mapping):
        raise InputError(f"radii must be a list of numbers, not {quote(radii)}")
    radii = [radii] if (found := as_list(radii)) is None else found
    scenes, refused = [], []
    for box, radius in product(boxes, [check_length("radius", radius) for radius in radii]):
        try:
            scenes.append(box.scene(radius))
        except InputError as error:
            refused.append((vars(box) | {"radius": radius}, str(error)))
    if not scenes:
        raise InputError(refused[0][1] if refused else "radii must have one radius, but has none")
    return scenes, refused
