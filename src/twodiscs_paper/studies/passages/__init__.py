"""Which hops are passages, and how fast discs diffuse by hops along a channel."""
