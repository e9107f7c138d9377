"""Power laws of mean times where an event dies out."""
