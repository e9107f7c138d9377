"""Figures of a scene, drawings of geometry, and the kit that both use."""
