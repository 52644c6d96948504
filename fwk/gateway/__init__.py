"""The gateway: follows the run, shows every channel on the public bus, takes foreign messages in."""
