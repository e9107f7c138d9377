"""Exact, Monte Carlo and molecular-dynamics hopping and collision times of two hard discs in a box."""
