"""How all scenes agree with the exact theory, beyond the scores of check.csv."""
