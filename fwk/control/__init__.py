"""The control protocol of a run: address, client, server, requests, settings."""
