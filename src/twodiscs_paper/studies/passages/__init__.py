"""Which hops are passages, and what they make of diffusion along a channel."""
