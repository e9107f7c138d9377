"""How each effect changes the mean times, and its cost."""
