"""Requests that steer a running system, and the views that it gives."""
