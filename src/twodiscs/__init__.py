"""Two hard discs in a box: exact times between events, Monte Carlo and molecular dynamics.

    import twodiscs as td

    scene = td.Scene(1.5, 1.0, 0.2)
    td.mean_times(scene)["vertical_hop"]          # exact
    td.simulate(scene, error=1e-3, seed=1)        # by molecular dynamics, with errors, beside it

Lengths are in any one unit. Disc 1 has mass 1 and the total energy is 1/2, so times are lengths
over a speed of 1. What is wrong with an argument is said by an ``InputError``, a ``ValueError``.

The random streams of a result depend on the ``seed``, the method, the box and the radius. With the
``name`` of a scene in a configuration and the configured seed, results are those of the pipeline,
bit for bit. The tutorial is docs/python.md.
"""

from __future__ import annotations

# What an editor reads; the module typing would take as long to import as all else here.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence
    from os import PathLike

    import numpy as np
    import pandas as pd
    from matplotlib.figure import Figure

    from twodiscs.comparison.measurements import Intervals, Measurement, Measurements
    from twodiscs.comparison.transmission import Transmission
    from twodiscs.model.box import Box
    from twodiscs.model.checks import InputError
    from twodiscs.model.effects import EFFECTS
    from twodiscs.model.events import EVENTS
    from twodiscs.model.scene import Scene
    from twodiscs.theory.exact import areas, exact, mean_times, rate, volume

__version__ = "0.1.0"

#: Names that are at home elsewhere; they are imported when they are first used (PEP 562).
_HOMES = {
    "Box": "model.box",
    "EFFECTS": "model.effects",
    "EVENTS": "model.events",
    "InputError": "model.checks",
    "Intervals": "comparison.measurements",
    "Measurement": "comparison.measurements",
    "Measurements": "comparison.measurements",
    "Scene": "model.scene",
    "Transmission": "comparison.transmission",
    "areas": "theory.exact",
    "exact": "theory.exact",
    "mean_times": "theory.exact",
    "rate": "theory.exact",
    "volume": "theory.exact",
}

__all__ = [
    "EFFECTS", "EVENTS", "Box", "InputError", "Intervals", "Measurement", "Measurements", "Scene",
    "Transmission", "animate", "areas", "exact", "exact_table", "intervals", "load", "mean_times",
    "plot", "rate", "sample", "simulate", "starts", "trajectory", "transmission", "volume",
]  # fmt: skip


def __getattr__(name: str):
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib import import_module

    value = globals()[name] = getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
    return value


def __dir__() -> list[str]:
    return [*__all__, "__version__"]


def exact_table(width: float, height: float, radii: Iterable[float], **effects) -> pd.DataFrame:
    """Return the exact numbers of a box over ``radii``: a row a radius.

    Columns are regime, ergodic_components, volume, and <event>_area and <event>_time of every
    event; a time is NaN where the event is impossible. ``effects`` are those of ``Scene``.
    """
    from twodiscs.comparison import measurements

    return measurements.exact_table(width, height, radii, effects)


def simulate(
    scene: Scene,
    error: float | Mapping[str, float] = 1e-3,
    seed: int = 1,
    budget: float = 2e9,
    events: Sequence[str] | None = None,
    name: str | None = None,
) -> Measurements:
    """Measure mean times by molecular dynamics: {event: ``Measurement``}, in time.

    Trajectories from the invariant measure are followed until every relative standard error is
    below ``error`` (one for all, or {event: error}), or ``budget`` wall and disc events are
    simulated. ``events`` are those to watch, all that have a place in the scene if None. The first
    call compiles for some seconds; compiled code is kept.
    """
    from twodiscs.comparison import measurements

    return measurements.simulate(scene, error, seed, budget, events, name)


def sample(
    scene: Scene,
    samples: float = 10**7,
    seed: int = 1,
    quantities: Sequence[str] | None = None,
    shell: float = 0.02,
    name: str | None = None,
) -> Measurements:
    """Measure volume and areas by Monte Carlo: {quantity: ``Measurement``}, in length⁴ and length³.

    ``quantities`` are some of "volume" and "<event>_area", all if None. ``samples`` configurations
    are drawn, rounded up to whole blocks. Areas are those of shells, whose thickness is a share
    ``shell`` of the radius or of the room that is left: z is against the exact expectation of that.
    """
    from twodiscs.comparison import measurements

    return measurements.sample(scene, samples, seed, quantities, shell, name)


def intervals(
    scene: Scene, hop: str, number: float = 10**6, seed: int = 1, name: str | None = None
) -> Intervals:
    """Draw ``number`` intervals between hops of one kind: their mean, bins and density at 0.

    ``hop`` is "vertical_hop" or "horizontal_hop". Numbers are rounded up to whole blocks of 2¹⁶.
    """
    from twodiscs.comparison import measurements

    return measurements.intervals(scene, hop, number, seed, name)


def transmission(
    scene: Scene, hop: str, hops: float = 2**17, seed: int = 1, name: str | None = None
) -> Transmission:
    """Measure which hops of one kind are passages, that is, not soon undone.

    The ``Transmission`` has the coefficient κ, the fraction of hops that are passages, with its
    error; the mean time between passages; and the curve κ(t), in ``frame()``. ``hops``, an integer
    rounded up to whole blocks, are followed both ways in time for the one, and forwards for the
    other. Raises ``InputError`` for a hop that is blocked or along a periodic axis.
    """
    from twodiscs.comparison import transmission

    return transmission.transmission(scene, hop, hops, seed, name)


def starts(scene: Scene, number: float, seed: int = 1, name: str | None = None) -> np.ndarray:
    """Draw ``number`` states of the invariant measure: an array with named columns.

    x1, y1, x2, y2 are the centres, from that of the box; u1, v1, u2, v2 the velocities. Balls have
    z1, z2, w1, w2 besides, and rough discs s1, s2, the speeds of their surfaces.
    """
    from twodiscs.comparison import measurements

    return measurements.starts(scene, number, seed, name)


def trajectory(
    scene: Scene,
    seed: int = 1,
    start: Sequence[float] | None = None,
    duration: float | None = None,
    name: str | None = None,
) -> pd.DataFrame:
    """Follow one trajectory: a row an event, with its time, name, and the centres of the discs.

    It starts where the first one of ``starts`` with this seed is, or at the state ``start``, whose
    discs must be inside and apart, at an energy of 1/2. Without a ``duration`` it lasts some eight
    mean times of the rarest open hop, or some 6000 events. Hops are events here. ``attrs["scene"]``
    is the scene.
    """
    from twodiscs.comparison import measurements

    return measurements.trajectory(scene, seed, start, duration, name)


def plot(result, path: str | PathLike | None = None, figure: str | None = None) -> Figure:
    """Draw a result, and write it to ``path`` (.pdf, .png or .svg) if that is given.

    ``result`` is a trajectory, a result of ``simulate``, ``sample`` or ``intervals``, or a list of
    such results at several radii of one box, which are drawn beside the exact curves; a scene or
    box is sketched. ``figure`` names one of several that suit, as the workflow does.
    """
    from twodiscs.figures import plot

    return plot.plot(result, path, figure)


def animate(trajectory: pd.DataFrame, path: str | PathLike) -> None:
    """Write an animation of a hop of a trajectory to ``path``, a .gif or .png file."""
    from twodiscs.figures import plot

    plot.animate(trajectory, path)


def load(folder: str | PathLike) -> dict[str, pd.DataFrame]:
    """Read every table in a folder of results, "results/paper" say: {name: table}.

    ``attrs`` of a table hold its units and the meanings of its columns, and where it comes from:
    path, sha256, and what the configuration said.
    """
    from twodiscs.pipeline.results import frames

    return frames.load(folder)
