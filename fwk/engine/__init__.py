"""The iteration contract: visibility, inputs, iterations, boundary decisions; without sockets, clock or processes."""
