"""Work in blocks: their random streams, rounds, and strata."""
