"""Plain data that all processes of a run share: names, plan, ports, channel table."""
