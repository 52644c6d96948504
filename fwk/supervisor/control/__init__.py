"""Control requests to a running system, and the views that it gives."""
