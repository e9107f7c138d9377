"""Sampling for each family of scenes: initial states, and Monte Carlo of volume and areas."""
