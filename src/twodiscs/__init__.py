"""Two hard discs in a box: exact times between events, Monte Carlo and molecular dynamics.

    import twodiscs as td

    scene = td.Scene(1.5, 1.0, 0.2)
    td.mean_times(scene)["vertical_hop_time"]     # exact
    td.simulate(scene, error=1e-3, seed=1)        # by molecular dynamics, with errors, beside it

Lengths are in any one unit. Disc 1 has mass 1 and the total energy is 1/2, so times are lengths
over a speed of 1. A wrong argument raises an ``InputError``, a ``ValueError``, with one sentence.

A scene and the amount of work may be positional arguments, all others are keywords:
``td.sample(scene, 1e6, seed=7)``. A quantity has one name, in print, as a key and as a column:
``volume``, ``vertical_hop_area``, ``vertical_hop_time``.

The random streams of a result depend on the ``seed``, the method, the box and the radius. With the
``name`` of a scene in a configuration and the configured seed, results are those of the pipeline,
bit for bit. The tutorial is docs/python.md of the repository.
"""

from __future__ import annotations

# For editors. The import of the module typing would take as long as all other imports here.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence
    from os import PathLike
    from typing import Literal, TypedDict, TypeVar, Unpack

    import numpy as np
    import pandas as pd
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from twodiscs.comparison.measured.by_quantity import areas, exact, mean_times
    from twodiscs.comparison.measured.measurements import Intervals, Measurement, Measurements
    from twodiscs.comparison.measured.observe import Observed
    from twodiscs.comparison.measured.pressure import free_energy, pressure
    from twodiscs.comparison.measured.scan import Scan
    from twodiscs.comparison.measured.trajectory import Trajectory
    from twodiscs.comparison.measured.transmission import Transmission
    from twodiscs.model.box import Box
    from twodiscs.model.checks import InputError
    from twodiscs.model.effects import EFFECTS
    from twodiscs.model.events import EVENTS
    from twodiscs.model.scene import Scene
    from twodiscs.theory.exact import rate, volume

    class Effects(TypedDict, total=False):
        """The effects and ``discs`` as optional keywords."""

        depth: float | None
        radius_ratio: float
        mass_ratio: float
        periodic: str | Sequence[Axis]
        field: float
        moment_of_inertia: float | None
        friction: float
        discs: int

    Function = TypeVar("Function", bound=Callable)

    # Names that an editor completes; python docs/make/pages.py renews them.
    Event = Literal[
        "vertical_hop",
        "horizontal_hop",
        "disc_collision",
        "right_wall",
        "top_wall",
        "any_wall",
    ]
    Hop = Literal[
        "vertical_hop",
        "horizontal_hop",
    ]
    Quantity = Literal[
        "volume",
        "vertical_hop_area",
        "horizontal_hop_area",
        "disc_collision_area",
        "right_wall_area",
        "top_wall_area",
        "any_wall_area",
    ]
    # end of names
    Axis = Literal["x", "y", "z"]


__version__ = "0.2.0"

#: The modules of names that are imported at their first use (PEP 562).
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
    "areas": "comparison.measured.by_quantity",
    "exact": "comparison.measured.by_quantity",
    "free_energy": "comparison.measured.pressure",
    "mean_times": "comparison.measured.by_quantity",
    "pressure": "comparison.measured.pressure",
    "rate": "theory.exact",
    "volume": "theory.exact",
}

__all__ = [
    "EFFECTS", "EVENTS", "Box", "InputError", "Intervals", "Measurement", "Measurements",
    "Observed", "Scan", "Scene", "Trajectory", "Transmission", "animate", "areas", "diffusion",
    "exact", "exact_table", "free_energy", "intervals", "load", "load_result", "mean_times",
    "observe", "plot", "pressure", "rate", "sample", "scan", "simulate", "starts", "trajectory",
    "transmission", "volume",
]  # fmt: skip


def __getattr__(name: str):
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib import import_module

    value = globals()[name] = getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
    return value


def __dir__() -> list[str]:
    return [*__all__, "__version__"]


def _answering(function: Function) -> Function:
    """Return a ``function`` of the face that raises a ``WrongCall`` for wrong arguments."""

    def call(*given, **named):
        try:
            return function(*given, **named)
        except TypeError as error:
            if error.__traceback__.tb_next is not None:  # the call was right
                raise
        from twodiscs.model.checks import wrong_call

        raise wrong_call(function.__name__, function, given, named)

    for name in ("__module__", "__name__", "__qualname__", "__doc__", "__annotations__"):
        setattr(call, name, getattr(function, name))
    call.__wrapped__ = function
    return call


@_answering
def exact_table(
    width: float, height: float, radii: Iterable[float], **effects: Unpack[Effects]
) -> pd.DataFrame:
    """Return the exact numbers of a box over ``radii``, one row per radius.

    Parameters
    ----------
    width, height : float
        Sides of the box, in length, from 1e-60 to 1e60.
    radii : iterable of float
        Radii of disc 1, in length, each of which must fit.
    **effects
        The effects and ``discs`` of ``Scene``.

    Returns
    -------
    DataFrame, shape (radii, 2 + 1 + 12)
        Its index is the radius. Columns are regime, ergodic_components, volume, and <event>_area
        and <event>_time of every event. A time is NaN if the event is impossible or no exact value
        is known. Units are those of ``volume``, ``areas`` and ``mean_times``.

    Raises
    ------
    InputError
        For a radius that does not fit, for an empty list, and for an unknown effect.

    Examples
    --------
    >>> td.exact_table(1.5, 1.0, [0.1, 0.2])["vertical_hop_time"].round(6)
    radius
    0.1    1.673843
    0.2    1.338047
    Name: vertical_hop_time, dtype: float64
    """
    from twodiscs.comparison.measured import measurements

    return measurements.exact_table(width, height, radii, effects)


@_answering
def simulate(
    scene: Scene,
    error: float | str | Mapping[Event, float | str] | None = None,
    *,
    duration: float | None = None,
    seed: int = 1,
    budget: float = 2e9,
    events: Event | Iterable[Event] | None = None,
    name: str | None = None,
    cores: int = 1,
    progress: bool | None = None,
) -> Measurements:
    """Measure mean times by molecular dynamics: {quantity: ``Measurement``}, in time.

    Many independent trajectories start in the invariant measure. Each has the same duration T, a
    power of two that depends on the scene. The mean count in T is exactly T times the rate, for
    every T. Trajectories are added until every relative standard error is below ``error``, or
    ``budget`` events are simulated; with a ``duration``, until that time is simulated.

    Work comes in whole blocks of 1024 trajectories, 2.4e5 events each for a radius of 0.2 in a box
    of 1.5 × 1. Without a ``duration`` the minimum is 32 blocks, 7.7e6 events there, or fewer within
    the ``budget``, but at least one block. If this is more than asked for, the ``note`` of the
    result says so. For quick results with many discs give ``budget=1e6``.

    Parameters
    ----------
    scene : Scene
        The box, the discs and their effects.
    error : float, str or dict, optional
        The relative standard error, above 0 and at most 1, or "draft" (1e-2), "paper" (3e-4) or
        "reference" (1e-4): one for all, or {event: error}. It is 1e-3 if neither ``error`` nor
        ``duration`` is given.
    duration : float, optional
        The simulated time of all trajectories together, in time. It is rounded up to whole blocks.
        All events are then counted in the same trajectories, rare hops too.
    seed : int, default 1
        Seed of the random numbers, from 0 to 2⁶³ − 1.
    budget : float, default 2e9
        The most wall hits and disc collisions, an integer from 1 on.
    events : str or iterable of str, optional
        Events to count, some of ``EVENTS``; if left out, all that exist in the scene.
    name : str, optional
        The name of a scene in a configuration, for the random numbers of its build.
    cores : int, default 1
        Cores to work on. Results do not depend on their number.
    progress : bool, optional
        Whether to show a progress bar; if left out, only in a terminal or a notebook.

    Returns
    -------
    Measurements
        {quantity: ``Measurement``}; ``more(error=…)`` goes on from it.

    Raises
    ------
    InputError
        For an unknown event, for a number out of range, for both ``error`` and ``duration``, and
        for a ``duration`` with more events than the ``budget``.

    Notes
    -----
    The first call compiles for some seconds; compiled code is kept. Ctrl-C stops a call without
    delay, but a script first ends a compilation, which takes some 10 to 30 s.

    Examples
    --------
    >>> md = td.simulate(scene, error=0.02, seed=1, events="vertical_hop")
    >>> abs(md["vertical_hop_time"].z) < 5
    True
    >>> td.simulate(scene, duration=1e4, seed=1)["any_wall_time"].count > 1e4
    True
    """
    from twodiscs.comparison.measured import measurements

    return measurements.simulate(
        scene, error, duration, seed, budget, events, name, cores, progress
    )


@_answering
def scan(
    width: float,
    height: float,
    radii: Iterable[float],
    error: float | str | Mapping[Event, float | str] | None = None,
    *,
    duration: float | None = None,
    seed: int = 1,
    budget: float = 2e9,
    events: Event | Iterable[Event] | None = None,
    name: str | None = None,
    cores: int = 1,
    progress: bool | None = None,
    **effects: Unpack[Effects],
) -> Scan:
    """Measure mean times by molecular dynamics at several ``radii`` of a box.

    Parameters
    ----------
    width, height : float
        Sides of the box, in length, from 1e-60 to 1e60.
    radii : iterable of float
        Radii of disc 1, in length, all different.
    error : float, str or dict, optional
        As in ``simulate``, but 1e-2 if neither ``error`` nor ``duration`` is given.
    duration : float, optional
        The simulated time at each radius, as in ``simulate``.
    seed : int, default 1
        Seed of the random numbers, from 0 to 2⁶³ − 1. Each radius has different random numbers.
    budget : float, default 2e9
        The most wall hits and disc collisions at each radius, an integer from 1 on.
    events : str or iterable of str, optional
        Events to count, some of ``EVENTS``; if left out, all that exist in the scene.
    name : str, optional
        The name of a scene in a configuration, for the random numbers of its build.
    cores : int, default 1
        Cores to work on. Results do not depend on their number.
    progress : bool, optional
        Whether to show a progress bar; if left out, only in a terminal or a notebook.
    **effects
        The effects and ``discs`` of ``Scene``.

    Returns
    -------
    Scan
        A sequence of ``Measurements`` in the order of radii, whose errors are independent. ``plot``
        draws it beside the exact curves, and ``frame()`` is a table.

    Raises
    ------
    InputError
        As ``simulate``, for equal radii, and for an unknown effect.

    Examples
    --------
    >>> found = td.scan(1.5, 1.0, [0.1, 0.2], error=0.05, events="any_wall")
    >>> [abs(part["any_wall_time"].z) < 5 for part in found]
    [True, True]
    """
    from twodiscs.comparison.measured import scan

    return scan.scan(
        width, height, radii, error, duration, seed, budget, events, name, cores, progress, effects
    )


@_answering
def sample(
    scene: Scene,
    samples: float = 10**7,
    *,
    seed: int = 1,
    quantities: Quantity | Iterable[Quantity] | None = None,
    shell: float = 0.02,
    name: str | None = None,
    cores: int = 1,
    progress: bool | None = None,
) -> Measurements:
    """Measure volume and areas of configuration space by Monte Carlo: {quantity: ``Measurement``}.

    Areas are estimated by shells: z compares with the exact expectation of the shell.

    Parameters
    ----------
    scene : Scene
        The box, the discs and their effects.
    samples : float, default 1e7
        Configurations to draw, an integer from 1 on. It is rounded up to whole blocks, of 2²⁰ for
        two plain discs; ``note`` of the result has the number that was drawn.
    seed : int, default 1
        Seed of the random numbers, from 0 to 2⁶³ − 1.
    quantities : str or iterable of str, optional
        Some of "volume" and "<event>_area"; all if left out.
    shell : float, default 0.02
        The thickness of a shell, between 0 and 1, as a fraction of the radius or, if that is
        smaller, of the distance to the radius at which the surface vanishes.
    name : str, optional
        The name of a scene in a configuration, for the random numbers of its build.
    cores : int, default 1
        Cores to work on. Results do not depend on their number.
    progress : bool, optional
        Whether to show a progress bar; if left out, only in a terminal or a notebook.

    Returns
    -------
    Measurements
        {quantity: ``Measurement``}, for two discs in length⁴ and length³, for balls in length⁶ and
        length⁵, for N discs in length²ᴺ and length²ᴺ⁻¹; ``more(samples=…)`` goes on from it.

    Raises
    ------
    InputError
        For an unknown quantity or a number out of range.

    Examples
    --------
    >>> volume = td.sample(scene, 1e6, seed=1, quantities="volume")["volume"]
    >>> abs(volume.value - td.volume(scene)) < 5 * volume.stderr
    True
    """
    from twodiscs.comparison.measured import measurements

    return measurements.sample(scene, samples, seed, quantities, shell, name, cores, progress)


@_answering
def intervals(
    scene: Scene,
    hop: Hop,
    number: float = 10**6,
    *,
    seed: int = 1,
    name: str | None = None,
    cores: int = 1,
    progress: bool | None = None,
) -> Intervals:
    """Draw intervals between hops of one kind: their mean, bins and density at 0.

    Parameters
    ----------
    scene : Scene
        The box, the smooth discs and their effects.
    hop : str
        "vertical_hop" or "horizontal_hop"; for more than two discs a hop of any pair.
    number : float, default 1e6
        Intervals to draw, an integer from 1 on. It is rounded up to whole blocks of 2¹⁶ (for more
        than two discs a block has about 2¹⁶ to 2¹⁷), within 1e11 events; ``note`` of the result has
        the number that was drawn.
    seed : int, default 1
        Seed of the random numbers, from 0 to 2⁶³ − 1.
    name : str, optional
        The name of a scene in a configuration, for the random numbers of its build.
    cores : int, default 1
        Cores to work on. Results do not depend on their number.
    progress : bool, optional
        Whether to show a progress bar; if left out, only in a terminal or a notebook.

    Returns
    -------
    Intervals
        Times are in time, densities in 1/time; ``more(number=…)`` goes on from it.

    Raises
    ------
    InputError
        For a blocked hop, for rough discs without friction, and for more than two discs if it is
        not known whether they can hop.

    Examples
    --------
    >>> abs(td.intervals(scene, "vertical_hop", 1e5, seed=1).mean.z) < 5
    True
    """
    from twodiscs.comparison.measured import measurements

    return measurements.intervals(scene, hop, number, seed, name, cores, progress)


@_answering
def transmission(
    scene: Scene,
    hop: Hop,
    hops: float = 2**17,
    *,
    seed: int = 1,
    name: str | None = None,
    cores: int = 1,
    progress: bool | None = None,
) -> Transmission:
    """Measure the fraction of hops of one kind that are passages, that is, not soon undone.

    Let t be the time that a disc of speed 1 takes along the box. There is a coefficient κ if hops
    are rare, at most one in 200 to 500 t. Hops count as independent after a pause of 48 t. This
    makes κ too large by about 1e-3 for hops of this frequency, and by less for rarer hops; the
    error does not include it.

    With N > 2 discs a hop is undone by the next hop of the same pair. t is then the time that a
    disc of the mean speed takes across the room of two discs, t √(2/N) of the box, and hops are
    those of two neighbours.

    Parameters
    ----------
    scene : Scene
        The box, its discs, at most 19, and their effects.
    hop : str
        "vertical_hop" or "horizontal_hop", along an axis with walls; of more than two discs also
        along a ring.
    hops : float, default 2¹⁷
        Hops to follow, forwards and backwards in time for κ, forwards for the curve: an integer
        from 1 on. It is rounded up to whole blocks.
    seed : int, default 1
        Seed of the random numbers, from 0 to 2⁶³ − 1.
    name : str, optional
        The name of a scene in a configuration, for the random numbers of its build.
    cores : int, default 1
        Cores to work on. Results do not depend on their number.
    progress : bool, optional
        Whether to show a progress bar; if left out, only in a terminal or a notebook.

    Returns
    -------
    Transmission
        The coefficient κ, the fraction of hops that are passages, with its error; the mean time
        between passages of any pair, in time, if the rate of hops is known exactly; and the curve
        κ(t), in ``frame()``. ``more(hops=…)`` goes on from it.

    Raises
    ------
    InputError
        For a hop that is blocked; for two discs along a periodic axis, and for more across a ring;
        for 20 discs or more, or so large ones that a hop has almost no room among the others.

    Examples
    --------
    >>> rare = td.Scene(1.5, 1.0, 0.246)
    >>> 0.5 < td.transmission(rare, "horizontal_hop", 2**12, seed=1).coefficient.value < 1
    True
    """
    from twodiscs.comparison.measured import transmission

    return transmission.transmission(scene, hop, hops, seed, name, cores, progress)


@_answering
def starts(
    scene: Scene,
    number: float,
    *,
    seed: int = 1,
    name: str | None = None,
    progress: bool | None = None,
) -> np.ndarray:
    """Draw independent states of the invariant measure: an array with named columns.

    If N discs are too dense for rejection, each state is the end of a chain of trial moves.

    Parameters
    ----------
    scene : Scene
        The box, the discs and their effects.
    number : float
        The number of states, an integer from 1 to 1e8.
    seed : int, default 1
        Seed of the random numbers, from 0 to 2⁶³ − 1.
    name : str, optional
        The name of a scene in a configuration, for the random numbers of its build.
    progress : bool, optional
        Whether to show a progress bar; if left out, only in a terminal or a notebook.

    Returns
    -------
    structured array, shape (number,)
        Fields x1, y1, x2, y2 are the centres, from the centre of the box; u1, v1, u2, v2 are the
        velocities, which vx1, vy1, vx2, vy2 give, too. Balls also have z1, z2, w1, w2 (vz1, vz2),
        and rough discs s1, s2, the speeds of their surfaces. N discs have x1 … xN, then y, u, v
        and, if they are rough, s.

    Raises
    ------
    InputError
        For a number out of range, and if initial states cannot be drawn.

    Examples
    --------
    >>> states = td.starts(scene, 1000, seed=1)
    >>> bool(abs(states["x1"].mean()) < 5 * 0.32 / 1000**0.5)  # the centre of the box is the mean
    True
    >>> bool((states["vx1"] == states["u1"]).all())
    True
    """
    from twodiscs.comparison.measured import measurements

    return measurements.starts(scene, number, seed, name, progress)


@_answering
def trajectory(
    scene: Scene,
    duration: float | None = None,
    *,
    seed: int = 1,
    start: Sequence[float] | np.ndarray | np.void | None = None,
    name: str | None = None,
    progress: bool | None = None,
) -> Trajectory:
    """Follow one trajectory: a table with one row per event, its time, name and the state after it.

    Hops are among the events. On periodic axes positions go on beyond the cell.

    Parameters
    ----------
    scene : Scene
        The box, the discs and their effects.
    duration : float, optional
        The duration, in time, at most 10⁷ events. If left out, it is some eight mean times of the
        rarest open hop or some 6000 events, for more than two discs 1500.
    seed : int, default 1
        Seed of the random numbers, from 0 to 2⁶³ − 1. The initial state is the first one of
        ``starts`` with this seed.
    start : sequence of float or state, optional
        An initial state in the form of ``starts``, or its numbers: discs inside the box, without
        overlap, with the energy 1/2.
    name : str, optional
        The name of a scene in a configuration, for the random numbers of its build.
    progress : bool, optional
        Whether to show a progress bar; if left out, only in a terminal or a notebook.

    Returns
    -------
    Trajectory
        A pandas ``DataFrame``; ``states_at(times)`` and ``positions(times)`` give the states
        between its rows.

    Raises
    ------
    InputError
        For a start that is no state, and for a duration of more than 10⁷ events.

    Examples
    --------
    >>> path = td.trajectory(scene, 10, seed=1)
    >>> path["time"].iloc[-1]
    np.float64(10.0)
    >>> path.positions([1, 2.5]).shape  # time, disc, axis
    (2, 2, 2)
    """
    from twodiscs.comparison.measured import trajectory

    return trajectory.trajectory(scene, seed, start, duration, name, progress)


@_answering
def observe(
    scene: Scene,
    function: Callable[[np.ndarray, np.ndarray], np.ndarray],
    times: float | Iterable[float],
    replicas: float = 2**16,
    *,
    seed: int = 1,
    name: str | None = None,
    cores: int = 1,
    progress: bool | None = None,
) -> Observed:
    """Average your function over trajectories that start in the invariant measure.

    Parameters
    ----------
    scene : Scene
        The box, the discs and their effects.
    function : callable
        ``function(start, now)`` takes two read-only arrays of states in the form of ``starts``, at
        time 0 and at one of the ``times``. It returns an array with a number, or an array, for each
        of the states. On periodic axes positions go on beyond the cell.
    times : float or iterable of float
        Ascending, from 0 on, in time.
    replicas : float, default 2¹⁶
        Trajectories, an integer from 1 to 1e9. It is rounded up to whole blocks of 4096; ``note``
        of the result has the number that was followed.
    seed : int, default 1
        Seed of the random numbers, from 0 to 2⁶³ − 1.
    name : str, optional
        The name of a scene in a configuration, for the random numbers of its build.
    cores : int, default 1
        Cores to work on. Results do not depend on their number.
    progress : bool, optional
        Whether to show a progress bar; if left out, only in a terminal or a notebook.

    Returns
    -------
    Observed
        ``mean`` and ``stderr`` at each time, arrays of shape (times, …). The error comes from the
        spread between the replicas, which are independent. All times have the same replicas, so
        their averages are correlated.

    Raises
    ------
    InputError
        For times of more than 10⁷ events, and for a function that returns anything else.

    Examples
    --------
    >>> found = td.observe(scene, lambda start, now: start["u1"] * now["u1"], [0, 1], seed=1)
    >>> bool(abs(found.mean[0] - 1 / 4) < 5 * found.stderr[0])  # ⟨u₁²⟩ of four components
    True
    """
    from twodiscs.comparison.measured import observe

    return observe.observe(scene, function, times, replicas, seed, name, cores, progress)


@_answering
def diffusion(
    scene: Scene,
    times: float | Iterable[float],
    replicas: float = 2**16,
    *,
    axis: Axis | None = None,
    seed: int = 1,
    name: str | None = None,
    cores: int = 1,
    progress: bool | None = None,
) -> Observed:
    """Measure the diffusion of the discs along a periodic axis, from the invariant measure.

    Displacements are of single discs, averaged over all of them if they are equal, else of disc 1.
    Smooth discs conserve the total momentum along the axis, which is 0: two equal discs then move
    in opposite directions.

    Parameters
    ----------
    scene : Scene
        The box, which is periodic along ``axis``, the discs and their effects.
    times : float or iterable of float
        Ascending, above 0, in time.
    replicas : float, default 2¹⁶
        Trajectories, an integer from 1 to 1e9, rounded up to whole blocks of 4096.
    axis : str, optional
        "x", "y" or "z"; the first periodic one if left out.
    seed : int, default 1
        Seed of the random numbers, from 0 to 2⁶³ − 1.
    name : str, optional
        The name of a scene in a configuration, for the random numbers of its build.
    cores : int, default 1
        Cores to work on. Results do not depend on their number.
    progress : bool, optional
        Whether to show a progress bar; if left out, only in a terminal or a notebook.

    Returns
    -------
    Observed
        ``mean`` and ``stderr``, shape (times, 2), have two columns, which ``frame()`` names:
        squared_displacement ⟨Δx²⟩(t), in length², and diffusion, in length²/time. The latter is
        half of the slope since the previous time, or since 0 for the first. The error of a slope
        includes the correlation of its two ends.

    Raises
    ------
    InputError
        For an axis with walls, between which displacements have a bound, for times of more than
        10⁷ events, and for a time of 0.

    Notes
    -----
    The diffusion coefficient D is the limit of the second column for long times, if there is one.
    Long free flights along a smooth channel can make it grow like a logarithm, and single discs
    cannot diffuse on a ring if they cannot pass each other.

    Examples
    --------
    >>> ring = td.Scene(1.5, 1.0, 0.2, periodic="x")
    >>> found = td.diffusion(ring, [2, 4, 8], 1e4, seed=1)
    >>> bool(0.02 < found.frame()["diffusion"].iloc[-1] < 0.05)
    True
    """
    from twodiscs.comparison.measured import observe

    return observe.diffusion(scene, times, replicas, axis, seed, name, cores, progress)


@_answering
def plot(
    result: object,
    path: str | PathLike[str] | None = None,
    *,
    figure: str | None = None,
    ax: Axes | None = None,
) -> Figure:
    """Draw a result, and write it to ``path`` if that is given.

    The first of ``figure.axes`` is the main panel; the others have labels:
    ``{a.get_label(): a for a in figure.axes}["residuals"]``. A notebook shows the returned figure,
    a plain prompt shows a window.

    Parameters
    ----------
    result : object
        A trajectory, a ``Scan``, a result of ``simulate``, ``sample``, ``intervals``,
        ``transmission``, ``observe`` or ``diffusion``, or a table of a scene from ``load``. A list
        of results of ``simulate``, ``sample`` or ``intervals`` at several radii of one box is drawn
        beside the exact curves. A scene or box of two plain discs has drawings of its geometry.
    path : path-like, optional
        A file that ends in .pdf, .png or .svg.
    figure : str, optional
        The name of a figure, see Notes, if several can show the result. Without it all measured
        events are drawn; a warning names quantities that are not.
    ax : matplotlib Axes, optional
        Your axes: only the main panel of quantities over the radius is drawn there, with the
        settings of your figure. A second call with the same ``ax`` adds another result, which may
        be of another box.

    Returns
    -------
    matplotlib Figure
        The figure, which is the figure of ``ax`` if that is given.

    Raises
    ------
    InputError
        If no figure shows the result, and if the path cannot be written.

    Notes
    -----
    Names of figures:

    - mean times: ``mean_times`` (all events), ``mean_hop_time``, ``mean_collision_time``,
      ``mean_wall_time``, ``pressure``
    - volume and areas: ``volume``, ``areas`` (all events), ``vertical_hop_area``,
      ``horizontal_hop_area``, ``collision_area``, ``wall_area``
    - a scene or a box: ``model``, ``configuration_space``, ``largest_radius``,
      ``integration_regimes``, ``surface_shell``
    - ``hop_histogram``, ``hopping_trajectory``, ``transmission`` and ``observed``

    Examples
    --------
    >>> figure = td.plot(scene, "model.png", figure="model")
    """
    from twodiscs.figures import plot

    return plot.plot(result, path, figure, ax)


@_answering
def animate(trajectory: pd.DataFrame, path: str | PathLike[str]) -> None:
    """Write an animation of a trajectory.

    It shows a hop of two discs, or the beginning of the trajectory. Balls are drawn as viewed along
    z, the nearer one in front. A mark at the edge of a rough disc turns with it.

    Parameters
    ----------
    trajectory : Trajectory
        The table that ``trajectory`` returns, with all rows.
    path : path-like
        A file that ends in .gif, .png (an animated PNG), .html (a page with a slider, which needs
        no network) or .mp4 (which needs the program ffmpeg).

    Raises
    ------
    InputError
        For anything but a trajectory, for one that does not last two frames, for a path that cannot
        be written, and for an .mp4 without ffmpeg.

    Examples
    --------
    >>> td.animate(td.trajectory(scene, 2, seed=1), "two.gif")
    """
    from twodiscs.figures import plot

    plot.animate(trajectory, path)


@_answering
def load(folder: str | PathLike[str]) -> dict[str, pd.DataFrame]:
    """Read every table in a folder of results.

    Parameters
    ----------
    folder : path-like
        The folder of a scene below results, such as "results/paper".

    Returns
    -------
    dict
        {name: ``DataFrame``}. ``attrs`` of a table has its units, the meanings of its columns, and
        its origin: path, sha256 and the configuration.

    Raises
    ------
    InputError
        For a folder without tables, and for a damaged table.

    Examples
    --------
    >>> tables = td.load("results/paper")  # doctest: +SKIP
    >>> figure = td.plot(tables["mean_times"])  # doctest: +SKIP
    """
    from twodiscs.comparison import frames

    return frames.load(folder)


@_answering
def load_result(
    path: str | PathLike[str],
) -> Measurements | Intervals | Transmission | Scan:
    """Read a result that ``save(path)`` wrote; ``more`` can go on from it.

    A type checker needs to know its class before you use it:
    ``assert isinstance(result, td.Measurements)``.

    Parameters
    ----------
    path : path-like
        The file. Only the version of the package that wrote it can read it.

    Returns
    -------
    Measurements, Intervals, Transmission or Scan
        The result.

    Raises
    ------
    InputError
        For a file of another version, and for any other file.

    Examples
    --------
    >>> td.simulate(scene, 0.1, seed=1, events="any_wall").save("walls.json")
    >>> more = td.load_result("walls.json").more(error=5e-4)
    >>> more["any_wall_time"].relative_stderr < 5e-4
    True
    """
    from twodiscs.comparison.measured import result

    return result.load_result(path)
