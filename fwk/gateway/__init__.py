"""The gateway: follows the run, mirrors every channel to the public bus, takes in messages from outside."""
