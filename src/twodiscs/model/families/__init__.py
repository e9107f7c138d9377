"""The geometry of each family of scenes: largest radius, open hops, number of components."""
