"""The kernels of two discs, with and without effects, and their constants."""
