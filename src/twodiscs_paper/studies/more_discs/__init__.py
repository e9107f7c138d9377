"""More than two discs: mean times by theory, Monte Carlo and dynamics at the same area per disc."""
