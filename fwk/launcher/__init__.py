"""The composition root: puts the processes of a run together."""
