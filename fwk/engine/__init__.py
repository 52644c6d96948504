"""The iteration contract: visibility, inputs, iterations, boundary decisions. Without sockets, clock or processes."""
