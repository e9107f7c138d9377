"""The kernels of more than two discs, and what they need."""
