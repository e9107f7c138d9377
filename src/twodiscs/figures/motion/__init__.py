"""Figures of the motion: paths of the discs, pressures on the walls, times between hops."""
