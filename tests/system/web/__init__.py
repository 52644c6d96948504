"""Tests of the console in a browser; they share one run, console and browser."""
