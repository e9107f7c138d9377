"""Events, effects, the scene, its box and its radii; imports only the standard library."""
