"""Connecting components: channels, commands, needs, providers, start order."""
