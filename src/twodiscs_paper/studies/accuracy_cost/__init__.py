"""The processor time that a digit costs by each method."""
