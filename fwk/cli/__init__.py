"""What people type: `fwk-launch`, `fwk` with its commands, and the live display."""
