"""Molecular dynamics: one event, the ensemble, counts, intervals, a trajectory."""
