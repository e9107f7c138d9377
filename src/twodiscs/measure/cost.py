"""The cost of an accuracy: the processor time of an error, for each quantity and method.

Independent samples have the relative error √(c/t) after a processor time t. The cost c is the time
of a block of samples times its squared relative error, so it holds for every error above the floor
of the method. The variance of a sample of volume or area follows from exact values. The variance of
counts, and the time of all blocks, come from a pilot: a run of some blocks on this machine.
"""

from __future__ import annotations

import math
import platform
import time
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from twodiscs.measure.exact_values import as_list
from twodiscs.measure.result import Printed, data_frame
from twodiscs.model.calls import checked_call
from twodiscs.model.checks import THINNEST_SHELL, check_error, check_fraction
from twodiscs.model.events import EVENTS
from twodiscs.model.formats import format_number, format_seconds, quote
from twodiscs.model.many_geometry import has_volume
from twodiscs.model.scene import Scene, check_scene
from twodiscs.points.monte_carlo_point import WALL_AREAS
from twodiscs.theory import exact
from twodiscs.theory.clusters import corner_variance

if TYPE_CHECKING:
    import pandas as pd

#: The relative errors whose times are shown.
PRICED_ERRORS = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6)

#: Processor seconds of a pilot of dynamics, about, and of a pilot that measures the speed only.
PILOT_SECONDS, SPEED_SECONDS = 0.3, 0.1

#: Rows of a trajectory with a price, and rows of a pilot of it.
PRICED_ROWS, PILOT_ROWS = 1e6, 1000

#: The fewest initial states of a pilot.
PILOT_REPLICAS = 128

#: Fewer counts of an event do not tell their variance. It is then this multiple of the mean, which
#: is known: a rare hop may be undone soon.
VARIANCE_COUNTS, CLUSTER_VARIANCE = 200, 1.3

#: The relative error of exact values of this number of discs, and of more discs in a channel.
EXACT_ERRORS, CHANNEL_ERROR = {2: 1e-15, 3: 1e-14}, 1e-12


def machine():
    """Return the name of the processor, as far as the system tells it."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = ()
    names = (line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    return next(names, "") or platform.processor() or platform.machine()


# Dynamics -----------------------------------------------------------------------------------------


class Pilot(NamedTuple):
    """The mean block of a component of a run: its processor seconds, events and replicas.

    ``errors`` are the relative errors of one block by event, ``first_round`` is the fewest blocks
    of a run that waits for an error.
    """

    seconds: float
    events: float
    replicas: int
    errors: dict
    first_round: int


def timed(work, seconds, fewest=1):
    """Return (sums, number of blocks, processor seconds of a block) of ``work(first, stop)``.

    The blocks take roughly ``seconds``, and are at least ``fewest``.
    """
    from twodiscs.sampling.threads import call_in_thread

    def run(blocks):
        start = time.thread_time()
        sums = work(0, blocks)
        return sums, (time.thread_time() - start) / blocks

    call_in_thread(run, 1)  # compiles or loads the kernel
    _, first = call_in_thread(run, 1)
    blocks = max(fewest, int(seconds / max(first, 1e-5)))
    sums, each = call_in_thread(run, blocks)
    return sums, blocks, each


def pilots(run, seconds=PILOT_SECONDS):
    """Return {component: ``Pilot``} of a ``DynamicsRun``: "all", and rare hops in their strips."""
    return {name: _pilot(run, name, seconds) for name in run.components}


def _pilot(run, name, seconds):
    from twodiscs.dynamics.engine import find_engine
    from twodiscs.dynamics.runs import relative_errors

    scene, engine, one = run.scene, find_engine(run.scene), run.components[name]
    duration = run.replica_duration
    replicas = engine.rates.block_replicas(scene, duration)
    sums, blocks, each = timed(one.work, seconds, -(-PILOT_REPLICAS // replicas))
    if name == "all":
        number, errors = blocks * replicas, {}
        burst_variance = np.array([corner_variance(scene, event, duration) for event in EVENTS])
        measured = relative_errors(*sums, number, burst_variance).tolist()
        for event, count, error in zip(EVENTS, sums[0].tolist(), measured, strict=True):
            if event in run.target and scene.is_possible(event):
                expected = engine.rates.expected_rate(scene, event) * duration
                few = count < VARIANCE_COUNTS and expected
                errors[event] = math.sqrt(CLUSTER_VARIANCE / (expected * number)) if few else error
    else:
        error = float(one.error_over_target(sums, blocks)[0])
        if not math.isfinite(error):
            error = math.sqrt(one.planned / blocks)
        errors = {name: error * run.target[name]}
    errors = {event: error * math.sqrt(blocks) for event, error in errors.items()}
    return Pilot(each, one.simulated_in(sums) / blocks, replicas, errors, one.first_round)


def blocks_wanted(scene, pilots, target):
    """Return {component: blocks} that a run to the errors ``target``, {event: error}, takes."""
    from twodiscs.sampling.rounds import ROUND_MARGIN

    blocks = {}
    for name, pilot in pilots.items():
        own = [e for e in target if e in pilot.errors and (name != "all" or e not in pilots)]
        noise = max(((pilot.errors[e] / target[e]) ** 2 for e in own), default=0.0)
        needed = (exact.replicas_needed(scene, e, target[e]) / pilot.replicas for e in own)
        needed = max(needed, default=0.0) if name == "all" else 0.0
        blocks[name] = max(pilot.first_round, ROUND_MARGIN * noise, needed)
    return blocks


# Prices -------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Price:
    """The price of a quantity by one method.

    Parameters
    ----------
    quantity, method : str
        Their names.
    c : float
        The processor seconds of a run times its squared relative error.
    least_seconds : float
        The processor seconds of the smallest run.
    floor : float, default 0
        The relative error that remains however long you compute: of a shell, or of rounding.

    Examples
    --------
    >>> price = td.Price("volume", "rejection", c=1e-6, least_seconds=0.01)
    >>> price.least_error, price.seconds(1e-4)
    (0.01, 100.0)
    """

    quantity: str
    method: str
    c: float
    least_seconds: float
    floor: float = 0.0

    @property
    def least_error(self) -> float:
        """The relative error of the smallest run."""
        return max(self.floor, math.sqrt(self.c / self.least_seconds))

    def seconds(self, error: float) -> float | None:
        """Return the processor time to reach a relative ``error``.

        Parameters
        ----------
        error : float
            The relative error.

        Returns
        -------
        float or None
            In seconds, at least that of the smallest run; None below the floor.

        Examples
        --------
        >>> td.Price("volume", "shells", c=1e-6, least_seconds=0.01, floor=1e-3).seconds(1e-4)
        """
        return None if error < self.floor else max(self.least_seconds, self.c / error**2)


def _prices_of_times(scene, pilots):
    """Yield the prices of mean times from ``pilots``.

    An event without a count whose rate is not known has none.
    """
    for event in scene.events:
        for name, pilot in pilots.items():
            if math.isfinite(pilot.errors.get(event, math.inf)):
                method = "dynamics" if name == "all" else "strips"
                c, least = pilot.errors[event] ** 2 * pilot.seconds, pilot.first_round
                yield Price(f"{event}_time", method, c, least * pilot.seconds)


def _prices_of_samples(scene, shell):
    """Yield the prices of the volume and of areas by each sampler."""
    from twodiscs.sampling.montecarlo import samplers

    wanted = ["volume", *(f"{event}_area" for event in scene.events if scene.is_possible(event))]
    makers = samplers(scene) if scene.discs == 2 or has_volume(scene) else {}
    for method, make in makers.items():
        sampler = make(scene, wanted, shell, 0)
        sums, blocks, each = timed(sampler.count, SPEED_SECONDS)
        known = variances(scene, sampler, sums, blocks)
        for quantity in wanted:
            name = method if quantity == "volume" or scene.discs > 2 else f"shells, {method}"
            if quantity in known:
                variance, floor = known[quantity]
                yield Price(quantity, name, variance * each, each, floor)


def variances(scene, sampler, sums, blocks):
    """Return {quantity: (squared relative error of a block, floor)}, without those not known.

    They follow from exact values for two discs, from the sums of the ``blocks`` for more.
    """
    if scene.discs == 2:
        return _variances_of_hits(scene, sampler.constants["quantities"], sampler.block)
    point = sampler.point({(0, blocks): (sums,)})
    sampled = {quantity: point.sampled(quantity) for quantity in point.quantities}
    sampled["any_wall_area"] = point.all_walls()
    return {
        quantity: (one.estimate.relative_stderr**2 * blocks, 0.0)
        for quantity, one in sampled.items()
        if one is not None and one.estimate is not None
    }


def _variances_of_hits(scene, sampled, samples):
    """Return {quantity: (squared relative error of a number of samples, floor)}, exactly.

    ``sampled`` are the quantities of a ``Sampler``. Samples in the shells of two walls are taken as
    independent.
    """
    means, expected = {}, {}
    for quantity, part in sampled.items():
        event, value = quantity.removesuffix("_area"), exact.volume(scene)
        if quantity != "volume":
            value = exact.shell_expectation(scene, event, part["epsilon"])
        if share := value / part["measure"]:
            means[quantity] = share
            expected[quantity] = 1 / share - 1, value
    if "any_wall_area" not in sampled and {*WALL_AREAS} <= means.keys():
        right, top = (sampled[wall]["measure"] for wall in WALL_AREAS)
        hits = [means[wall] for wall in WALL_AREAS]
        value = right * hits[0] + top * hits[1]
        both = math.prod(hits) / means["volume"] if "volume" in means else math.prod(hits)
        square = right**2 * hits[0] + top**2 * hits[1] + 2 * right * top * both
        expected["any_wall_area"] = square / value**2 - 1, 4 * value
    areas = {"volume": exact.volume(scene)}
    areas |= {f"{event}_area": area for event, area in exact.areas(scene).items()}
    return {
        # A share of all samples is 1 to a rounding, or a rounding more.
        quantity: (max(variance, 0.0) / samples, abs(value / areas[quantity] - 1))
        for quantity, (variance, value) in expected.items()
        if areas[quantity]
    }


def _price_of_exact(scene):
    """Yield the price of all exact values, if they are known."""
    if exact.event_rate(scene) is None:
        return
    exact.exact(scene)  # imports what it takes
    other = scene.with_radius(math.nextafter(scene.radius, 0))  # whose values are in no cache
    start = time.perf_counter()
    exact.exact(other)
    seconds, floor = time.perf_counter() - start, EXACT_ERRORS.get(scene.discs, CHANNEL_ERROR)
    yield Price("all exact values", "exact", floor**2 * seconds, seconds, floor)


def _price_of_trajectory(scene):
    """Return the price of ``PRICED_ROWS`` rows, fewer for many discs, which have no error."""
    from twodiscs.dynamics.engine import find_engine
    from twodiscs.dynamics.paths import most_rows
    from twodiscs.dynamics.rows import Rows
    from twodiscs.measure.trajectory import trajectory_table
    from twodiscs.sampling.initial_states import components, states

    engine, start = find_engine(scene), states(scene, 1, 0)[: len(components(scene)), 0]
    duration = PILOT_ROWS / engine.paths.trajectory_rate(scene)

    def work(first, stop):
        rows = engine.paths.path_rows(scene, start, duration * (stop - first), 0)
        return len(trajectory_table(scene, Rows.joined([*rows])))

    made, blocks, each = timed(work, SPEED_SECONDS)
    rows = min(PRICED_ROWS, most_rows(scene))
    name = f"{format_number(rows, '.2g')} rows"
    return Price("trajectory", name, 0.0, each * blocks / made * rows)


class Cost(Printed):
    """The prices of the quantities of a scene by each method; ``cost`` returns one.

    It prints as a table: processor times for relative errors, the error of the smallest run, and
    the floor, the error that remains however long you compute.

    Parameters
    ----------
    scene : Scene
        The scene.
    errors : list of float
        The relative errors whose times it shows.
    prices : list of Price
        A price for each quantity and method.
    pilots : dict
        The pilots of dynamics, {component: ``Pilot``}.

    Attributes
    ----------
    machine : str
        The processor on which it was measured.

    Examples
    --------
    >>> found = td.cost(scene)
    >>> found["volume", "rejection"].seconds(1e-4) > found["volume", "rejection"].seconds(1e-3)
    True
    """

    def __init__(self, scene, errors, prices, pilots):
        self.scene, self.errors, self.prices, self.pilots = scene, errors, prices, pilots
        self.machine = machine()

    def __getitem__(self, key: tuple[str, str]) -> Price:
        """Return the ``Price`` of a (quantity, method)."""
        prices = {(price.quantity, price.method): price for price in self.prices}
        if key not in prices:
            raise KeyError(f"{quote(key)} is no (quantity, method) such as {next(iter(prices))}")
        return prices[key]

    def seconds(self, error: float) -> float:
        """Return the processor time of ``simulate(scene, error)``: of all mean times together.

        Parameters
        ----------
        error : float
            The relative error of every mean time.

        Returns
        -------
        float
            In seconds, without a budget.

        Examples
        --------
        >>> td.cost(scene).seconds(1e-4) > 1
        True
        """
        target = dict.fromkeys(self.scene.events, check_error("error", error))
        wanted = blocks_wanted(self.scene, self.pilots, target)
        return sum(wanted[name] * pilot.seconds for name, pilot in self.pilots.items())

    @property
    def rows(self) -> list[dict[str, object]]:
        """The rows of ``frame()``; a time below the floor is None."""
        names = "quantity", "method", "c", "least_error", "least_seconds", "floor"
        return [
            {name: getattr(price, name) for name in names}
            | {f"seconds_{error:g}": price.seconds(error) for error in self.errors}
            for price in self.prices
        ]

    def frame(self) -> pd.DataFrame:
        """Return the prices as a table.

        Returns
        -------
        DataFrame
            One row per quantity and method, the index. Its columns are c, in s; the relative error
            and the seconds of the smallest run; the floor; and the seconds for each error, NaN
            below the floor.

        Examples
        --------
        >>> float(td.cost(scene, 1e-3).frame().loc[("volume", "rejection"), "floor"])
        0.0
        """
        return data_frame(self.rows, index=["quantity", "method"]).astype(float)

    def _texts(self) -> pd.DataFrame:
        """Return the texts of the printed table."""

        def times(seconds):
            return [format_seconds(seconds(error)) for error in self.errors]

        rows = [["all mean times", "simulate", *times(self.seconds), "", ""]]
        for price in self.prices:
            least = format_number(price.least_error, ".1e") if 0 < price.least_error < 1 else "–"
            floor = format_number(price.floor, ".1e") if price.floor else ""
            rows.append([price.quantity, price.method, *times(price.seconds), least, floor])
        names = [np.format_float_scientific(e, trim="-", exp_digits=1) for e in self.errors]
        return data_frame(rows, ["quantity", "method", *names, "least", "floor"])

    @property
    def note(self) -> str:
        """The meaning of the columns of the printed table, and the machine that measured it."""
        from twodiscs.dynamics.paths import row_bytes

        return (
            f"Processor time to reach a relative error on one core of {self.machine}. The smallest "
            "run has the least error; the floor remains however long you compute. A trajectory has "
            f"no error, and {row_bytes(self.scene)} bytes for each row."
        )


@checked_call
def cost(
    scene: Scene,
    errors: float | str | Iterable[float | str] | None = None,
    *,
    shell: float = 0.02,
) -> Cost:
    """Measure what an accuracy costs: processor times for relative errors, by each method.

    Mean times have dynamics, and rare hops strips of initial states next to their surface. Volume
    and areas have samples of the prism, conditioned samples where the discs hardly fit, or
    insertions of more than two discs; areas have thin shells. All have the exact value, if it is
    known. A trajectory, which has no error, has the time of 10⁶ rows, or of the most that fit.
    Speeds and the variance of counts are measured by pilots, together about a second.

    Parameters
    ----------
    scene : Scene
        The box, the discs and their effects.
    errors : float or iterable of float, optional
        Relative errors, above 0 and at most 1, or presets of ``simulate``; if left out, 1e-2, 1e-3,
        1e-4, 1e-5 and 1e-6.
    shell : float, default 0.02
        The thickness of the shells of areas, as in ``sample``.

    Returns
    -------
    Cost
        It prints as a table; ``frame()`` has its numbers.

    Raises
    ------
    InputError
        For an error or a shell out of range, and if initial states cannot be drawn.

    Examples
    --------
    >>> found = td.cost(scene, 1e-3)
    >>> found["horizontal_hop_time", "dynamics"].seconds(1e-3) < 60
    True
    """
    from twodiscs.dynamics.runs import DynamicsRun

    found = as_list(PRICED_ERRORS if errors is None else errors)
    errors = [check_error("errors", error) for error in ([errors] if found is None else found)]
    check_fraction("shell", shell, THINNEST_SHELL)
    run = DynamicsRun(check_scene(scene), dict.fromkeys(scene.events, 1.0), 10**15, 0)
    measured = pilots(run)
    prices = [*_prices_of_times(scene, measured), *_prices_of_samples(scene, shell)]
    prices += [*_price_of_exact(scene), _price_of_trajectory(scene)]
    return Cost(scene, errors, prices, measured)
