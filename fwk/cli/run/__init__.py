"""What belongs to starting a run: its directory, its files, its profile."""
