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

Functions that draw or simulate have these arguments:

- ``seed``, 1 by default: the seed of the random numbers, from 0 to 2⁶³ − 1. Random streams also
  depend on the method, the box and the radius.
- ``name``: the name of a scene in a configuration. With it and the configured seed, results are
  those of the pipeline, bit for bit.
- ``cores``, 1 by default: cores to work on. Results do not depend on their number.
- ``progress``: whether to show a progress bar; if left out, only in a terminal or a notebook.

The tutorial is docs/python.md of the repository.
"""

from __future__ import annotations

# For editors. The import of the module typing would take as long as all other imports here.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import Literal, TypedDict

    from twodiscs.figures.plot import animate, plot
    from twodiscs.measure.cost import Cost, Price, cost
    from twodiscs.measure.exact_values import areas, exact, exact_table, mean_times
    from twodiscs.measure.intervals import Intervals, intervals
    from twodiscs.measure.load import load, load_result
    from twodiscs.measure.measurements import Measurement, Measurements, sample, simulate
    from twodiscs.measure.observe import Observed, diffusion, observe, starts
    from twodiscs.measure.pressure import free_energy, pressure
    from twodiscs.measure.scan import Scan, scan
    from twodiscs.measure.trajectory import Trajectory, trajectory
    from twodiscs.measure.transmission import Transmission, transmission
    from twodiscs.model.checks import AccuracyWarning, InputError
    from twodiscs.model.effects import EFFECTS
    from twodiscs.model.events import EVENTS
    from twodiscs.model.scene import Box, Scene
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

    # Names that an editor completes; python docs/make/pages.py renews them.
    Event = Literal[
        "vertical_hop", "horizontal_hop", "disc_collision", "right_wall", "top_wall", "any_wall",
    ]  # fmt: skip
    Hop = Literal[
        "vertical_hop", "horizontal_hop",
    ]  # fmt: skip
    Quantity = Literal[
        "volume", "vertical_hop_area", "horizontal_hop_area", "disc_collision_area",
        "right_wall_area", "top_wall_area", "any_wall_area",
    ]  # fmt: skip
    # end of names
    Axis = Literal["x", "y", "z"]


__version__ = "1.0.0"

#: {module: its names}; a module is imported at the first use of one of them (PEP 562).
_NAMES = {
    "measure.cost": "Cost Price cost",
    "measure.intervals": "Intervals intervals",
    "measure.load": "load load_result",
    "measure.measurements": "Measurement Measurements sample simulate",
    "measure.observe": "Observed diffusion observe starts",
    "measure.pressure": "free_energy pressure",
    "measure.exact_values": "areas exact exact_table mean_times",
    "measure.scan": "Scan scan",
    "measure.trajectory": "Trajectory trajectory",
    "measure.transmission": "Transmission transmission",
    "figures.plot": "animate plot",
    "model.checks": "AccuracyWarning InputError",
    "model.effects": "EFFECTS",
    "model.events": "EVENTS",
    "model.scene": "Box Scene",
    "theory.exact": "rate volume",
}
_HOMES = {name: module for module, names in _NAMES.items() for name in names.split()}

__all__ = [
    "EFFECTS", "EVENTS", "AccuracyWarning", "Box", "Cost", "InputError", "Intervals", "Measurement",
    "Measurements", "Observed", "Price", "Scan", "Scene", "Trajectory", "Transmission", "animate",
    "areas", "cost", "diffusion", "exact", "exact_table", "free_energy", "intervals", "load",
    "load_result", "mean_times", "observe", "plot", "pressure", "rate", "sample", "scan",
    "simulate", "starts", "trajectory", "transmission", "volume",
]  # fmt: skip


def __getattr__(name: str):
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib import import_module

    value = globals()[name] = getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
    return value


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
