"""Exact volume, areas, mean times, their limits and the laws of their distributions."""
