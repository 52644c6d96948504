"""LCM on plain sockets: the wire format, the ports of a run, and channels that notice what they lost."""
