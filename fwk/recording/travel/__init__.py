"""Time travel: a replay in the debugger that goes back."""
