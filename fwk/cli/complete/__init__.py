"""Completion of commands, options and live values in bash, zsh and fish."""
