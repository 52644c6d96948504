"""Opens the port of the console."""

import socket


class ServeError(Exception):
    """The console cannot be served; the text names the reason and a remedy."""


def listen(address: str, port: int) -> socket.socket:
    """Opens the port; 0 stands for any free one.

    Raises:
        ServeError: the port is taken, or the address is not one of this machine.
    """
    family = socket.AF_INET6 if ":" in address else socket.AF_INET
    listener = socket.socket(family, socket.SOCK_STREAM)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listener.bind((address, port))
        listener.listen()  # browsers that come before the first page is ready wait
    except OSError as error:
        listener.close()
        raise ServeError(f"cannot serve on {address}:{port}: {error.strerror}; choose another with --port") from error
    return listener
