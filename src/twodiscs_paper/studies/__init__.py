"""A folder for each study: its measurement, its tables, its figures, its declaration."""
