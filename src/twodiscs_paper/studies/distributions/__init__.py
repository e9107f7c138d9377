"""How the times to the next hop are distributed."""
