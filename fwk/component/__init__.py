"""The API for component authors: Component, Config and the aspects that a component declares."""
