"""The stages of a build: the kinds of work that are one job at each radius of a scene.

The workflow reads this module. Runs compile, so they are imported when one is made.
"""

from collections.abc import Callable
from dataclasses import dataclass

from twodiscs.points.dynamics_point import DynamicsPoint
from twodiscs.points.intervals_point import IntervalsPoint
from twodiscs.points.monte_carlo_point import MonteCarloPoint


@dataclass(frozen=True)
class Stage:
    """A kind of work (sample, simulate, intervals): its call, its run, its sums and its tables.

    It has one name in the configuration, in paths and as a target of Snakemake.

    ``call`` is the function of the face that does this work with the same settings; a file of sums
    has it as its kind. ``point`` is the class of the sums, and ``import_run`` returns the class of
    the run. ``tables`` are the names of the tables that are made of its points.
    """

    call: str
    point: type
    import_run: Callable
    tables: tuple

    @property
    def name(self):
        """The name of the stage, which its points know."""
        return self.point.stage

    def run(self, scene, settings):
        """Return the run in a ``Scene``; ``settings`` are the other arguments of the call."""
        return self.import_run().of(scene, settings)


def _import_monte_carlo():
    from twodiscs.sampling.montecarlo import MonteCarloRun

    return MonteCarloRun


def _import_dynamics():
    from twodiscs.dynamics.runs import DynamicsRun

    return DynamicsRun


def _import_intervals():
    from twodiscs.dynamics.runs import IntervalsRun

    return IntervalsRun


#: The tables of all points of a scene.
SHARED_TABLES = ("check", "cost")

#: {name: stage}
STAGES = {
    stage.name: stage
    for stage in (
        Stage("sample", MonteCarloPoint, _import_monte_carlo, ("volume", "areas", *SHARED_TABLES)),
        Stage("simulate", DynamicsPoint, _import_dynamics, ("mean_times", *SHARED_TABLES)),
        Stage("intervals", IntervalsPoint, _import_intervals, ("hop_histogram", *SHARED_TABLES)),
    )
}

#: The names of all tables that are made of points.
POINT_TABLES = tuple(dict.fromkeys(name for stage in STAGES.values() for name in stage.tables))
