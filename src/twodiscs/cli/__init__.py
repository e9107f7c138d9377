"""Command-line entry points: one thin module for each workflow rule, and ``twodiscs`` for people."""
