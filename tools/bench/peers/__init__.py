"""One module a peer: `supervisor(shape)` and `component(shape, index)`, see `tools.bench.sides`."""
