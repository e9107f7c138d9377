"""The molecular dynamics of two equal, smooth discs between walls."""

from twodiscs.dynamics.two import returns
from twodiscs.dynamics.two.lockstep import (
    block_replicas,
    cost_ratio,
    expected_rate,
    replica_duration,
    run_blocks,
    work_per_event,
)
from twodiscs.dynamics.two.path import (
    advance_all,
    events_of,
    kicks_of,
    new_wraps,
    state_of,
    unwrap,
    usual_duration,
)
from twodiscs.dynamics.two.path import event_rate as trajectory_rate
from twodiscs.dynamics.two.returns import (
    INTERVAL_SUMS,
    events_per_interval,
    interval_cost,
    intervals_of_chain,
    mean_interval,
)
from twodiscs.dynamics.two.strip import planned, rare_hops
from twodiscs.dynamics.two.strip import run_of as rare_run
from twodiscs.dynamics.two.strip import summary as rare_summary
from twodiscs.model.scene import hopping_along
from twodiscs.theory.exact import event_rate as expected_event_rate

__all__ = [
    "INTERVAL_SUMS", "PASSAGES", "advance_all", "block_replicas", "cost_ratio", "events_of",
    "events_per_interval", "expected_event_rate", "expected_rate", "interval_cost",
    "intervals_of_chain", "kicks_of", "mean_interval", "new_wraps", "planned", "rare_hops",
    "rare_run", "rare_summary", "record_intervals", "replica_duration", "run_blocks", "state_of",
    "trajectory_rate", "unwrap", "usual_duration", "work_per_event",
]  # fmt: skip

#: The module that follows hops, imported by this name: an edit of it renews no counts of events.
PASSAGES = "twodiscs.dynamics.two.passages"


def record_intervals(scene, hop, *given):
    """Record the intervals between hops, see ``returns``: along y, where chains are drawn."""
    return returns.record_intervals(*hopping_along(scene, hop, "y"), *given)
