"""The kit of all figures: style, panels, curves, and the names of events and limits."""
