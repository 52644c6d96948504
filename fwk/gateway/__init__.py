"""The gateway: one process that sees everything; it records, mirrors to the public bus, and feeds the display."""
