"""Figures of a scene, the drawings of geometry, and the kit that they share."""
