"""Estimates of the studies: columns of tables, means, straight lines, the law of χ²."""

import math

import numpy as np
import scipy  # which imports ``special`` when it is used

from twodiscs.model.checks import InputError
from twodiscs.points.estimates import Estimate


def columns(rows, *names):
    """Return the columns of ``rows`` with these ``names``, as arrays; empty cells are NaN."""
    return np.array([[row[name] for row in rows] for name in names], float)


def sample_mean(values):
    """Return the mean of independent ``values`` along their first axis, as an ``Estimate``.

    The error comes from their spread. For values in two dimensions the result is a list of
    estimates, one for each column. Raises ``InputError`` for fewer than two values, which have no
    spread.
    """
    values = np.asarray(values, float)
    n = len(values)
    if n < 2:
        raise InputError(f"values must be at least two, not {n}")
    means, errors = values.mean(axis=0), np.std(values, axis=0, ddof=1) / math.sqrt(n)
    if values.ndim == 1:
        return Estimate(float(means), float(errors), n)
    return [Estimate(float(m), float(e), n) for m, e in zip(means, errors, strict=True)]


class LinearFit:
    """The straight line through values ``y`` over ``x``, by least squares.

    ``errors`` are the standard errors of ``y``. ``slope`` is an ``Estimate``, ``constant`` the
    value at x = 0, ``chi2`` the sum of squared residuals in units of the errors.
    """

    def __init__(self, x, y, errors):
        x, y, weights = np.asarray(x, float), np.asarray(y, float), 1 / np.asarray(errors, float)
        (slope, self.constant), covariance = np.polyfit(x, y, 1, w=weights, cov="unscaled")
        residuals = weights * (y - self.constant - slope * x)
        self.chi2 = float(residuals @ residuals)
        self.slope = Estimate(float(slope), math.sqrt(covariance[0, 0]), x.size)


def chi2_p(chi2, degrees):
    """Return the probability of a larger χ² with ``degrees`` of freedom."""
    return float(scipy.special.gammaincc(degrees / 2, chi2 / 2))
