"""Drawings of the box and of its configuration space."""
