"""Work in blocks: their random streams, and rounds."""
