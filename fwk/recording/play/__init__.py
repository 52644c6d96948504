"""Play: gives a log back to the public bus."""
