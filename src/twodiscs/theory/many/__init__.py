"""More than two discs: exact numbers, if they are known, and relations for any number of discs."""
