"""The face: what ``import twodiscs as td`` gives, and where each name is defined."""

# isort: off
import collections.abc
import typing

# The physics: a scene, its effects and its events; exact values.
from .model.scene import Box as Box, Scene as Scene
from .model.effects import EFFECTS as EFFECTS
from .model.events import EVENTS as EVENTS
from .theory.exact import rate as rate, volume as volume
from .measure.exact_values import areas as areas, exact as exact, mean_times as mean_times
from .measure.exact_values import exact_table as exact_table
from .measure.pressure import free_energy as free_energy, pressure as pressure

# The motion: one trajectory, averages over many, their initial states.
from .measure.trajectory import Trajectory as Trajectory, trajectory as trajectory
from .measure.observe import Observed as Observed, observe as observe, starts as starts
from .measure.observe import diffusion as diffusion, frames as frames

# Counts with errors: dynamics, Monte Carlo, hops; over radii; their cost.
from .measure.measurements import Measurement as Measurement, Measurements as Measurements
from .measure.measurements import sample as sample, simulate as simulate
from .measure.intervals import Intervals as Intervals, intervals as intervals
from .measure.transmission import Transmission as Transmission, transmission as transmission
from .measure.scan import Scan as Scan, scan as scan
from .measure.cost import Cost as Cost, Price as Price, cost as cost

# Figures and files.
from .figures.plot import animate as animate, plot as plot
from .measure.load import load as load, load_result as load_result

# Mistakes.
from .model.checks import AccuracyWarning as AccuracyWarning, InputError as InputError

__version__: str

# Keywords and names that an editor completes; python docs/make/pages.py renews them.
class Effects(typing.TypedDict, total=False):
    """The effects and ``discs`` as optional keywords."""

    depth: float | None
    radius_ratio: float
    mass_ratio: float
    periodic: str | collections.abc.Sequence[Axis]
    field: float
    moment_of_inertia: float | None
    friction: float
    discs: int

class Scanned(typing.TypedDict, total=False):
    """The same for ``scan``, which takes lists of numbers."""

    depth: float | collections.abc.Iterable[float] | None
    radius_ratio: float | collections.abc.Iterable[float]
    mass_ratio: float | collections.abc.Iterable[float]
    periodic: str | collections.abc.Sequence[Axis]
    field: float | collections.abc.Iterable[float]
    moment_of_inertia: float | collections.abc.Iterable[float] | None
    friction: float | collections.abc.Iterable[float]
    discs: int | collections.abc.Iterable[int]

Event = typing.Literal[
    "vertical_hop", "horizontal_hop", "disc_collision", "right_wall", "top_wall", "any_wall",
]  # fmt: skip
Hop = typing.Literal[
    "vertical_hop", "horizontal_hop",
]  # fmt: skip
Quantity = typing.Literal[
    "volume", "vertical_hop_area", "horizontal_hop_area", "disc_collision_area", "right_wall_area",
    "top_wall_area", "any_wall_area",
]  # fmt: skip
# end of names
Axis = typing.Literal["x", "y", "z"]
