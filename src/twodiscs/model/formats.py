"""Numbers as texts."""


def shortest_decimal(value, distance, avoid=()):
    """Return the number of fewest digits within ``distance`` of ``value`` and not in ``avoid``."""
    candidates = (float(f"{value:.{digits}g}") for digits in range(1, 18))
    return next(c for c in candidates if abs(c - value) <= distance and c not in avoid)
