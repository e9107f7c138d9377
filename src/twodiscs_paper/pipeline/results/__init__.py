"""What stands in the folder of results: fingerprints, and the comparison with what is expected."""
