"""How probable long intervals between events are."""
