"""The results of the face: measurements beside exact values, which print and save themselves."""
