"""Command lines: one thin module for each workflow rule, and ``twodiscs`` for people."""
