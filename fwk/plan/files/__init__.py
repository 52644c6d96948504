"""Reading launch files: YAML with places, includes, templates, overrides, validation."""
