"""One module for each peer: `supervisor(shape)` and `component(shape, index)`, see `tools.bench.sides`."""
