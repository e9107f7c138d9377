"""The folder of results: its manifest, its verdict, and its comparison with expected results."""
