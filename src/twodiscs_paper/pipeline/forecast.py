"""The time of a job, and the errors that it reaches within its budget, from pilots of its run."""

import math
from typing import NamedTuple

from twodiscs.analysis.tables import shortfall
from twodiscs.measure.cost import blocks_wanted, timed, variances


class Forecast(NamedTuple):
    """The time of a run within its budget; ``reached`` are relative errors by event.

    ``events`` are those of dynamics.
    """

    seconds: float
    reached: dict
    events: float = 0.0

    def shortfall(self, run):
        """Return a sentence on the accuracy that a ``DynamicsRun`` will not reach, or None."""
        rows = [
            {
                "event": event,
                "target": run.target[event],
                "relative_stderr": error,
                "status": "budget" if error > run.target[event] else "reached",
            }
            for event, error in self.reached.items()
        ]
        return shortfall(rows, run.budget, self.events, self.seconds, "ends")


def forecast_dynamics(run, pilots, planned=False):
    """Return the ``Forecast`` of a ``DynamicsRun`` from the ``pilots`` of its components.

    If its blocks are ``planned``, it does all of these: its jobs are shards.
    """
    seconds, events, reached = 0.0, 0.0, {}
    for name, wanted in blocks_wanted(run.scene, pilots, run.target).items():
        one, pilot = run.components[name], pilots[name]
        affordable = max(1.0, one.budget / max(pilot.events, 1.0))
        blocks = one.planned if planned else min(wanted, affordable)
        seconds, events = seconds + blocks * pilot.seconds, events + blocks * pilot.events
        own = (e for e in pilot.errors if name != "all" or e not in pilots)
        reached |= {event: pilot.errors[event] / math.sqrt(blocks) for event in own}
    return Forecast(seconds, reached, events)


def forecast_samples(run, seconds):
    """Return the ``Forecast`` of a ``MonteCarloRun`` from a pilot of some ``seconds``."""
    one = run.components["all"]
    sums, blocks, each = timed(run.sampler.count, seconds)
    found = variances(run.scene, run.sampler, sums, blocks)
    errors = {
        quantity: math.sqrt(found[quantity][0] / one.planned)
        for quantity in run.quantities
        if quantity in found
    }
    return Forecast(each * one.planned, errors)
