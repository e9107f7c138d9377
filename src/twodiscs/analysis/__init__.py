"""The tables of a scene, the scores of their rows, and the check."""
