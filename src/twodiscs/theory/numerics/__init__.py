"""Quadrature, and reference values of many digits."""
