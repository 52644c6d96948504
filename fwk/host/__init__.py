"""A host process: its components, from `init` to `finalize`."""
