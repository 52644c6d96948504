"""The plan: a launch file, checked and fully resolved before the first process starts."""
