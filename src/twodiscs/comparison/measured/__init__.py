"""What the face returns: measurements beside exact values, that print, save and show themselves."""
