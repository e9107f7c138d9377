"""Hopping and collision times of two hard discs in a box: exact, by sampling, by dynamics."""
