"""Events, effects, the scene and its box; imports only the standard library."""
