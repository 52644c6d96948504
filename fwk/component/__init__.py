"""What component authors use: Component, Config and the aspects that a component asks for."""
