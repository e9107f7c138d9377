"""One folder an analysis: what it measures, its table, its figure, its entry in the catalogue."""
