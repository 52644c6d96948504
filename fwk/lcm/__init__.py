"""LCM in Python, without any knowledge of robots: wire format, codec, types, headers, event logs."""
