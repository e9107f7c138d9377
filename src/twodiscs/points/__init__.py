"""Points: the sums of a job at one radius, and the estimates that follow from them."""
