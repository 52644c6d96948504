"""Commands that show a run: state, times, channels, log, cameras."""
