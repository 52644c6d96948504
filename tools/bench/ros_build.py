"""Builds the C++ side of the ROS peers: messages with gencpp, one program with g++."""


def build() -> None:
    """See the module."""
