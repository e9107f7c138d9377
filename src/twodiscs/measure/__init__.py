"""The calls of the face, one module each, and the results that they return."""
