"""The geometry of each family of scenes: what fits, which hops are open, how many components."""
