"""Figures of the motion: where the discs went, how often they met a wall, when they hopped."""
