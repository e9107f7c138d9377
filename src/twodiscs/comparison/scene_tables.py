"""The tables of a scene, by name: each is declared in a module of ``tables``.

The Snakefile reads this module, so NumPy and its users are imported only when rows are made.
"""

from twodiscs.comparison.tables.check import Check
from twodiscs.comparison.tables.cost import Cost
from twodiscs.comparison.tables.hop_histogram import HopHistogram
from twodiscs.comparison.tables.mean_times import MeanTimes
from twodiscs.comparison.tables.monte_carlo import Areas, Volume
from twodiscs.comparison.tables.theory import Grid, Theory
from twodiscs.comparison.tables.trajectory import Trajectory

__all__ = ["SCENE_TABLES", "Check", "Cost", "Grid"]

#: {name: table}
SCENE_TABLES = {
    table.name(): table
    for table in (Grid, Theory, Volume, Areas, MeanTimes, HopHistogram, Check, Cost, Trajectory)
}
