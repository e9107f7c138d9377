"""The kernels of more than two discs, and their constants."""
