"""How each family of scenes is sampled: initial states, and Monte Carlo of volume and areas."""
