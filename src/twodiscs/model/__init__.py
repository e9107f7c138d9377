"""Events, effects, the scene, its box and its radii. Standard library only."""
