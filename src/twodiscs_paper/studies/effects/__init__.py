"""What each effect does to the mean times, and what it costs."""
