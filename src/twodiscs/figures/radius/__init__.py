"""Figures over the radius: volume, areas and mean times, estimates against exact curves."""
