"""What a digit costs by each method."""
