# Measures a full tick of fwk and of its peers; writes docs/numbers.md and build/bench/numbers.json.
# BENCH holds options: make bench BENCH=--quick
.PHONY: bench bench-peers bench-types
bench: types
	.venv/bin/python -m tools.bench $(BENCH)

# Installs the peers that the benchmark compares with, each into an environment of its own below build/bench-peers.
bench-peers: types
	.venv/bin/python -m tools.bench.install

# The benchmark's own message; its code has to be there for mypy and the tests too.
types: bench-types
bench-types: $(READY)
	.venv/bin/python -P fwk/lcm/typegen.py tools/bench/messages/lcmtypes
