"""What a component can ask for: each module is one aspect."""
