"""How tests of dynamics decide that a number is not the exact one: by five standard errors."""

import numpy as np

from twodiscs.dynamics.engine import find_engine
from twodiscs.dynamics.ensemble import REPLICAS
from twodiscs.dynamics.runs import relative_errors
from twodiscs.model.events import EVENTS
from twodiscs.theory.exact import mean_times


def five(found, due, error):
    """Assert that a number is within five errors of another one."""
    assert abs(found - due) <= 5 * error, (found, due, error)


def same_sizes(counts, other):
    """Compare κ, the share of single hops and the mean size up to 64 hops of clusters.

    ``counts`` are the numbers of clusters by size, ``other`` are sizes.
    """
    own = np.repeat(np.arange(counts.size), counts)
    for of in (lambda n: n % 2 / n, lambda n: n == 1, lambda n: np.minimum(n, 64)):
        values = [np.asarray(of(sizes), float) for sizes in (own, other)]
        errors = [part.std() / np.sqrt(part.size) for part in values]
        five(values[0].mean(), values[1].mean(), np.hypot(*errors))


def check_rates(scene, seed, blocks, duration=None):
    """Five sigma on every event: with 60 comparisons a false alarm in 3e-5 of all seeds.

    This holds for events with a thousand expected counts; impossible events have no count. Products
    of one replica are those of its counts.
    """
    duration = duration or find_engine(scene).rates.replica_duration(scene)
    given = scene, EVENTS, seed, 0
    one, products = find_engine(scene).counts.run_blocks(*given, 1, duration, replicas=1)
    assert np.array_equal(products, np.triu(np.outer(one, one)))
    sums, products = find_engine(scene).counts.run_blocks(*given, blocks, duration)
    errors = relative_errors(sums, products, blocks * REPLICAS)
    for event, total, error in zip(EVENTS, sums, errors, strict=True):
        time = mean_times(scene)[event]
        if time is not None:
            expected = scene.copies(event) * duration / time * blocks * REPLICAS
            assert expected < 1000 or abs(total - expected) <= 5 * error * total, event
        elif event in scene.events:
            assert total == 0
