"""Counts of events in a given time, without an error to reach."""

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from twodiscs.dynamics.counting import CountingRun, engine_of
from twodiscs.model.checks import InputError, format_number


@dataclass(frozen=True)
class TimedRun(CountingRun):
    """Blocks of replicas, at least one, until all replicas together have a ``duration``.

    All events are counted in the same replicas. Rare hops have no strips, because trajectories in a
    strip have another duration. Raises ``InputError`` for a duration with more than ``budget``
    expected events.
    """

    duration: float

    def __post_init__(self):
        super().__post_init__()
        rate = engine_of(self.scene).expected_event_rate(self.scene)
        if self.duration * rate > self.budget:
            raise InputError(
                f"duration must be below {format_number(self.budget / rate, '.3g')}, where the "
                f"budget of {format_number(self.budget, 'g')} events is spent, not "
                f"{format_number(self.duration, 'g')}"
            )

    @cached_property
    def _rare(self):
        return []

    @property
    def _target(self):
        return dict.fromkeys(self._events)

    @cached_property
    def parts(self):
        """The ``SequentialRun`` of all blocks, {"all": run}."""
        engine = engine_of(self.scene)
        each = engine.replica_duration(self.scene) * engine.block_replicas(self.scene)
        blocks, waited = max(1, math.ceil(self.duration / each)), len(self._waited)
        run = replace(
            self._everything(self.budget),
            excess_of=lambda sums, blocks: np.zeros(waited),
            budget=math.inf,
            planned=blocks,
            first_round=blocks,
        )
        return {"all": run}
