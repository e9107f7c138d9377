"""More than two discs: states of the invariant measure, and Monte Carlo of volume and areas."""
