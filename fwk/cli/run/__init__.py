"""Start of a run: `fwk-launch`, run directory, files, profile, video."""
