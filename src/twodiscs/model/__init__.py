"""What is studied: events, effects, the scene, its box and its radii. Standard library only."""
