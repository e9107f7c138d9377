"""Figures and animations of a scene, drawings of its geometry, and the panels that they use."""
