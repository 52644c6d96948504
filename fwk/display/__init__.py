"""What a run shows in a terminal: live screen, plain lines, summary."""
