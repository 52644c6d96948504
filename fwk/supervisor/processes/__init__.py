"""The host processes of a run: their states, starts, restarts and ends."""
