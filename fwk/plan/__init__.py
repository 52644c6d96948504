"""From a launch file to a plan, or to all of its mistakes at once."""
