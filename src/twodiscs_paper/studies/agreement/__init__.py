"""How well all scenes together agree with the exact theory, beyond the scores of check.csv."""
