"""The jobs of the workflow, one module for each kind of shell line."""
