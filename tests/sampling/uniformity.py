"""How tests of random numbers decide that a law is not the one they should have."""

import math

import numpy as np
from scipy.special import kolmogorov

#: Five sigma, two-sided: the rate of false alarms of each comparison.
FALSE_ALARM = 5.7e-7


def assert_uniform(values):
    """Kolmogorov–Smirnov: ``values`` are uniform on [0, 1]."""
    values = np.sort(values)
    n = values.size
    steps = np.arange(n + 1) / n
    distance = max(np.max(steps[1:] - values), np.max(values - steps[:-1]))
    assert kolmogorov(math.sqrt(n) * distance) > FALSE_ALARM, distance
