"""The manuscript, and the pages that are made from the sources."""
