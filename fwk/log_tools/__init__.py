"""Tools that make new logs of existing ones."""
