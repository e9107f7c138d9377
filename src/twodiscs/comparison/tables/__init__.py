"""The tables of a scene: the columns of each beside the function that makes its rows."""
