"""More than two discs: exact numbers where they are known, and what holds for every number."""
