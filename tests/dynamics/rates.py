"""How tests of the ensemble decide that it does not have the exact rates."""

from twodiscs.dynamics import runs
from twodiscs.dynamics.ensemble import REPLICAS
from twodiscs.dynamics.runs import relative_errors
from twodiscs.model.events import EVENTS
from twodiscs.theory.exact import mean_times


def check_rates(scene, seed, blocks, duration=None):
    """Five sigma on every event: with 60 comparisons a false alarm in 3e-5 of all seeds.

    This holds for events with a thousand expected counts; impossible events have no count.
    """
    duration = duration or runs.replica_duration(scene)
    sums, products = runs.run_blocks(scene, EVENTS, seed, 0, blocks, duration)
    errors = relative_errors(sums, products, blocks * REPLICAS)
    for event, total, error in zip(EVENTS, sums, errors, strict=True):
        time = mean_times(scene)[event]
        if time is not None:
            expected = scene.copies(event) * duration / time * blocks * REPLICAS
            assert expected < 1000 or abs(total - expected) <= 5 * error * total, event
        elif event in scene.events:
            assert total == 0
