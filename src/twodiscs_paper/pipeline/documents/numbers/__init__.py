"""The numbers that the manuscript prints: a module for each group, all in one table."""
