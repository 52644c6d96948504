"""Looking at and steering a run from another terminal: the connection, its requests, and the side that asks."""
