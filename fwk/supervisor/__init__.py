"""The supervisor: owns the clock, the marks, the main loop and every process of a run."""
