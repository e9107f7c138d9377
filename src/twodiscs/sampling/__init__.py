"""Compiled random numbers, draws from the invariant measure, Monte Carlo."""
