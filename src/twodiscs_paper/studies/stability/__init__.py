"""How each method behaves in numerically hard cases."""
