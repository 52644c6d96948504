"""Commands that change a run: lifecycle, clock, settings, messages, debugging."""
