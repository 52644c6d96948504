"""Commands that check without starting anything: launch files, the machine."""
