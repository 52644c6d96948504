"""A host process: one or more components, run in step with the supervisor's ticks."""
