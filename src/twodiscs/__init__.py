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
    from collections.abc import Callable, Iterable, Mapping, Sequence
    from os import PathLike
    from typing import TypedDict, Unpack

    import numpy as np
    import pandas as pd
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from twodiscs.comparison.measured.measurements import Intervals, Measurement, Measurements
    from twodiscs.comparison.measured.observe import Observed
    from twodiscs.comparison.measured.scan import Scan
    from twodiscs.comparison.measured.trajectory import Trajectory
    from twodiscs.comparison.measured.transmission import Transmission
    from twodiscs.model.box import Box
    from twodiscs.model.checks import InputError
    from twodiscs.model.effects import EFFECTS
    from twodiscs.model.events import EVENTS
    from twodiscs.model.scene import Scene
    from twodiscs.theory.exact import areas, exact, mean_times, rate, volume

    class Effects(TypedDict, total=False):
        """The effects and ``discs`` as keywords, each of which may be left out."""

        depth: float | None
        radius_ratio: float
        mass_ratio: float
        periodic: str | Sequence[str]
        field: float
        moment_of_inertia: float | None
        discs: int


__version__ = "0.2.0"

#: Names that are at home elsewhere; they are imported when they are first used (PEP 562).
_HOMES = {
    "Box": "model.box",
    "EFFECTS": "model.effects",
    "EVENTS": "model.events",
    "InputError": "model.checks",
    "Intervals": "comparison.measured.measurements",
    "Measurement": "comparison.measured.measurements",
    "Measurements": "comparison.measured.measurements",
    "Observed": "comparison.measured.observe",
    "Scan": "comparison.measured.scan",
    "Scene": "model.scene",
    "Trajectory": "comparison.measured.trajectory",
    "Transmission": "comparison.measured.transmission",
    "areas": "theory.exact",
    "exact": "theory.exact",
    "mean_times": "theory.exact",
    "rate": "theory.exact",
    "volume": "theory.exact",
}

__all__ = [
    "EFFECTS", "EVENTS", "Box", "InputError", "Intervals", "Measurement", "Measurements",
    "Observed", "Scan", "Scene", "Trajectory", "Transmission", "animate", "areas", "exact",
    "exact_table", "intervals", "load", "load_result", "mean_times", "observe", "plot",
    "rate", "sample", "scan", "simulate", "starts", "trajectory", "transmission", "volume",
]  # fmt: skip


def __getattr__(name: str):
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib import import_module

    value = globals()[name] = getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
    return value


def __dir__() -> list[str]:
    return [*__all__, "__version__"]


def exact_table(
    width: float, height: float, radii: Iterable[float], **effects: Unpack[Effects]
) -> pd.DataFrame:
    """Return the exact numbers of a box over ``radii``: a row a radius.

    Columns are regime, ergodic_components, volume, and <event>_area and <event>_time of every
    event; a time is NaN where the event is impossible. ``width``, ``height`` and ``effects`` are
    those of ``Scene``. Raises ``InputError`` for a radius that does not fit, and for none at all.

    Example:

        td.exact_table(1.5, 1.0, [0.1, 0.2])["vertical_hop_time"]
    """
    from twodiscs.comparison.measured import measurements

    return measurements.exact_table(width, height, radii, effects)


def simulate(
    scene: Scene,
    error: float | str | Mapping[str, float | str] = 1e-3,
    seed: int = 1,
    budget: float = 2e9,
    events: Sequence[str] | None = None,
    name: str | None = None,
    *,
    cores: int = 1,
    progress: bool | None = None,
) -> Measurements:
    """Measure mean times by molecular dynamics: {event: ``Measurement``}, in time.

    Trajectories from the invariant measure are followed until every relative standard error is
    below ``error``, or ``budget`` wall and disc events are simulated. An error is above 0 and at
    most 1, or "draft" (1e-2), "paper" (3e-4) or "reference" (1e-4), as in a configuration: one for
    all, or {event: error}. Work comes in whole blocks of 1024 trajectories, 2.4e5 events each
    for a radius of 0.2 in a box of 1.5 × 1. The least is 32 blocks, 7.7e6 events there, however
    large the error, or as many as the ``budget`` affords, one block at least: for a quick look at
    many discs say ``budget=1e6``. ``events`` are those to watch, all that have a place in the scene
    if None. ``seed`` is an integer ≥ 0.

    On any number of ``cores`` the numbers are the same. ``progress`` shows how far it is; None
    means in a terminal or a notebook alone. The first call compiles for some seconds; compiled code
    is kept. Ctrl-C stops at once; a script that is compiling finishes that first, in some 10 to
    30 s. ``more(error=…)`` of the result goes on from it. Raises ``InputError`` for an unknown
    event or a number out of range.

    Example:

        td.simulate(scene, error=1e-2).save("hops.json")
    """
    from twodiscs.comparison.measured import measurements

    return measurements.simulate(scene, error, seed, budget, events, name, cores, progress)


def scan(
    width: float,
    height: float,
    radii: Iterable[float],
    error: float | str | Mapping[str, float | str] = 1e-2,
    seed: int = 1,
    budget: float = 2e9,
    events: Sequence[str] | None = None,
    name: str | None = None,
    *,
    cores: int = 1,
    progress: bool | None = None,
    **effects: Unpack[Effects],
) -> Scan:
    """Measure mean times by molecular dynamics at several ``radii`` of a box: a ``Scan``.

    It is a sequence of the results of ``simulate`` in the order of radii, whose errors are
    independent; ``plot`` draws it beside the exact curves, and ``frame()`` is a table. ``width``,
    ``height`` and ``effects`` are those of ``Scene``, ``budget`` is that of each radius, and all
    else is as in ``simulate``.

    Example:

        td.plot(td.scan(1.5, 1.0, [0.1, 0.2], error=0.05), figure="mean_wall_time")
    """
    from twodiscs.comparison.measured import scan

    return scan.scan(
        width, height, radii, error, seed, budget, events, name, cores, progress, effects
    )


def sample(
    scene: Scene,
    samples: float = 10**7,
    seed: int = 1,
    quantities: Sequence[str] | None = None,
    shell: float = 0.02,
    name: str | None = None,
    *,
    cores: int = 1,
    progress: bool | None = None,
) -> Measurements:
    """Measure volume and areas by Monte Carlo: {quantity: ``Measurement``}, in length⁴ and length³.

    ``quantities`` are some of "volume" and "<event>_area", all if None. ``samples`` configurations
    are drawn, an integer that is rounded up to whole blocks. Areas are those of shells, whose
    thickness is a fraction ``shell``, between 0 and 1, of the radius or of the room that is left: z
    is against the exact expectation of that. For balls the units are length⁶ and length⁵.

    ``seed``, ``cores`` and ``progress`` are as in ``simulate``; ``more(samples=…)`` of the result
    goes on from it. Raises ``InputError`` for an unknown quantity or a number out of range.

    Example:

        td.sample(scene, 1e6)["volume"].stderr
    """
    from twodiscs.comparison.measured import measurements

    return measurements.sample(scene, samples, seed, quantities, shell, name, cores, progress)


def intervals(
    scene: Scene,
    hop: str,
    number: float = 10**6,
    seed: int = 1,
    name: str | None = None,
    *,
    cores: int = 1,
    progress: bool | None = None,
) -> Intervals:
    """Draw ``number`` intervals between hops of one kind: their mean, bins and density at 0.

    ``hop`` is "vertical_hop" or "horizontal_hop", of more than two discs one of any pair. Numbers
    are rounded up to whole blocks of 2¹⁶ (of more than two discs of about that or up to twice as
    many), as far as 1e11 events allow. Times are in time, densities in 1/time. ``seed``, ``cores``
    and ``progress`` are as in ``simulate``; ``more(number=…)`` of the result goes on from it.
    Raises ``InputError`` for a hop that is blocked, for rough discs, and for more than two discs of
    whose hops nothing is known.

    Example:

        td.intervals(scene, "vertical_hop", 1e5).mean.value
    """
    from twodiscs.comparison.measured import measurements

    return measurements.intervals(scene, hop, number, seed, name, cores, progress)


def transmission(
    scene: Scene,
    hop: str,
    hops: float = 2**17,
    seed: int = 1,
    name: str | None = None,
    *,
    cores: int = 1,
    progress: bool | None = None,
) -> Transmission:
    """Measure which hops of one kind are passages, that is, not soon undone.

    The ``Transmission`` has the coefficient κ, the fraction of hops that are passages, with its
    error; the mean time between passages; and the curve κ(t), in ``frame()``. ``hops``, an integer
    rounded up to whole blocks, are followed both ways in time for the one, and forwards for the
    other. ``seed``, ``cores`` and ``progress`` are as in ``simulate``; ``more(hops=…)`` of the
    result goes on from it. There is a κ where hops are rare, one in 200 to 500 times that a disc of
    speed 1 takes along the box. Hops count as independent after a pause of 48 such times: that
    makes κ too large by about 1e-3 where hops are that frequent, and by less where they are rarer,
    beside its error. Raises ``InputError`` for a hop that is blocked or along a periodic
    axis, and for more than two discs: the next hop of any pair may be of another one, and then it
    undoes nothing.

    Example:

        td.transmission(td.Scene(1.5, 1.0, 0.246), "horizontal_hop", 2**14).coefficient
    """
    from twodiscs.comparison.measured import transmission

    return transmission.transmission(scene, hop, hops, seed, name, cores, progress)


def starts(
    scene: Scene,
    number: float,
    seed: int = 1,
    name: str | None = None,
    *,
    progress: bool | None = None,
) -> np.ndarray:
    """Draw ``number`` states of the invariant measure: an array (number,) with named columns.

    x1, y1, x2, y2 are the centres, from that of the box; u1, v1, u2, v2 the velocities. Balls have
    z1, z2, w1, w2 besides, and rough discs s1, s2, the speeds of their surfaces; N discs have x1 …
    xN, then y, u and v. ``number`` is an integer up to 10⁸; ``seed`` and ``progress`` are as in
    ``simulate``. States are independent; those of N discs too dense for anything else are the ends
    of chains of trial moves, one each. Raises ``InputError`` for a number out of range, and where
    starts cannot be drawn.

    Example:

        td.starts(scene, 1000)["x1"].mean()
    """
    from twodiscs.comparison.measured import measurements

    return measurements.starts(scene, number, seed, name, progress)


def trajectory(
    scene: Scene,
    seed: int = 1,
    start: Sequence[float] | np.ndarray | np.void | None = None,
    duration: float | None = None,
    name: str | None = None,
    *,
    progress: bool | None = None,
) -> Trajectory:
    """Follow one trajectory: a table with a row an event, its time, name, and the state after it.

    It starts where the first one of ``starts`` with this seed is, or at the state ``start``, whose
    discs must be inside and apart, at an energy of 1/2. Without a ``duration``, a time, it lasts
    some eight mean times of the rarest open hop, or some 6000 events, of more than two discs 1500.
    Hops are events here. On periodic axes places go on beyond the cell.

    The table is a pandas ``DataFrame``, with columns as in ``starts``; ``attrs["scene"]`` is the
    scene, and ``states_at(times)`` has the states between the rows. Raises ``InputError`` for a
    start that is no state, and a duration of more than 10⁷ events.

    Example:

        td.trajectory(scene, duration=10).states_at([1, 2.5])["x1"]
    """
    from twodiscs.comparison.measured import trajectory

    return trajectory.trajectory(scene, seed, start, duration, name, progress)


def observe(
    scene: Scene,
    function: Callable[[np.ndarray, np.ndarray], np.ndarray],
    times: float | Iterable[float],
    replicas: float = 2**16,
    seed: int = 1,
    name: str | None = None,
    *,
    cores: int = 1,
    progress: bool | None = None,
) -> Observed:
    """Average what a function of yours sees of trajectories that start in the invariant measure.

    ``function(start, now)`` takes two arrays of states, as those of ``starts`` but read-only, at
    time 0 and at one of the ascending ``times`` ≥ 0, and returns an array with a number, or an
    array, for each of the states. On periodic axes places go on beyond the cell. ``replicas``, an
    integer, is rounded up to whole blocks of 4096.

    The ``Observed`` has ``mean`` and ``stderr`` at each time, from the spread between the replicas,
    which are independent; those of different times belong to the same replicas. ``seed``,
    ``cores`` and ``progress`` are as in ``simulate``. Raises ``InputError`` for times of more than
    10⁷ events, and a function that returns anything else.

    Example:

        td.observe(scene, lambda start, now: start["u1"] * now["u1"], [0, 1])
    """
    from twodiscs.comparison.measured import observe

    return observe.observe(scene, function, times, replicas, seed, name, cores, progress)


def plot(
    result: object,
    path: str | PathLike[str] | None = None,
    figure: str | None = None,
    ax: Axes | None = None,
) -> Figure:
    """Draw a result, and write it to ``path`` (.pdf, .png or .svg) if that is given.

    ``result`` is a trajectory, a ``Scan``, a result of ``simulate``, ``sample`` or ``intervals``, a
    list of such results at several radii of one box, which are drawn beside the exact curves, one
    of ``transmission`` or ``observe``, or a table of a scene that ``load`` returns. A scene or box
    of two plain discs is sketched.

    ``figure`` names one of several figures that suit:

    - mean times: ``mean_times`` (all events), ``mean_hop_time``, ``mean_collision_time``,
      ``mean_wall_time``, ``pressure``
    - volume and areas: ``volume``, ``areas`` (all events), ``vertical_hop_area``,
      ``horizontal_hop_area``, ``collision_area``, ``wall_area``
    - a scene or a box: ``model``, ``configuration_space``, ``largest_radius``,
      ``integration_regimes``, ``surface_shell``
    - ``hop_histogram``, ``hopping_trajectory``, ``transmission`` and ``observed``

    Without it all events that were measured are drawn; a warning names what is not.

    The first of ``figure.axes`` is the main panel; labels tell the others apart:
    ``{a.get_label(): a for a in figure.axes}["residuals"]``. In ``ax``, axes of your own, only the
    main panel of quantities over the radius is drawn, in the settings of your figure. A second call
    with the same ``ax`` adds another result, of another box too.

    A notebook shows what is returned; at a plain prompt a window does. Raises ``InputError`` if no
    figure shows the result, and if the path cannot be written.

    Example:

        td.plot(scene, "model.png")
    """
    from twodiscs.figures import plot

    return plot.plot(result, path, figure, ax)


def animate(trajectory: pd.DataFrame, path: str | PathLike[str]) -> None:
    """Write an animation of a trajectory to ``path``, a .gif or .png file.

    It shows a hop of two discs, or the beginning of the trajectory. Balls are seen along z, and the
    spin of rough discs is not shown. Raises ``InputError`` for anything but a trajectory.

    Example:

        td.animate(td.trajectory(scene, duration=20), "two.gif")
    """
    from twodiscs.figures import plot

    plot.animate(trajectory, path)


def load(folder: str | PathLike[str]) -> dict[str, pd.DataFrame]:
    """Read every table in a folder of results, "results/paper" say: {name: table}.

    ``attrs`` of a table hold its units and the meanings of its columns, and where it comes from:
    path, sha256, and what the configuration said. Raises ``InputError`` for a folder without
    tables, and a table that is damaged. After a build
    ``td.plot(td.load("results/paper")["mean_times"])`` draws one of them.
    """
    from twodiscs.comparison import frames

    return frames.load(folder)


def load_result(
    path: str | PathLike[str],
) -> Measurements | Intervals | Transmission | Scan:
    """Read what ``save(path)`` of a result wrote: the same object, which can go on with ``more``.

    Only the version of the package that wrote a file can read it. Raises ``InputError`` for another
    version, and for anything that is no such file.

    A checker of types wants to know which of the four it is before it goes on:
    ``assert isinstance(result, td.Measurements)``.

    Example:

        td.load_result("hops.json").more(error=5e-3)["vertical_hop"].z
    """
    from twodiscs.comparison.measured import result

    return result.load_result(path)
