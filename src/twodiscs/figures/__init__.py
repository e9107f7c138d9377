"""Figures: one module for each, and the style that they share."""
