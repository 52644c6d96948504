"""Terminal output of a run: live display, plain lines, summary."""
