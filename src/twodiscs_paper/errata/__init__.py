"""Which formulas of the source are right, with the evidence."""
