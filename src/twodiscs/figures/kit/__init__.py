"""What the figures share: style, panels, curves, and how events and limits are called."""
