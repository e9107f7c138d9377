"""The exact theory of each family of scenes; ``theory.exact`` fetches it."""
