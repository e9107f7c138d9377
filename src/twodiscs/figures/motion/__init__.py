"""Figures of a trajectory: where the discs went, and the discs as they move."""
