"""From counts to estimates, errors and scores, to tables, and to the check."""
