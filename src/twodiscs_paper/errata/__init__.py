"""Which formulas of the source are right, and what decides it."""
