"""Which formulas of the source are right."""
