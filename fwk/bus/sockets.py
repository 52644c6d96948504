"""Sockets of the inner buses: multicast on the loopback interface only."""

import socket

GROUP = "239.255.76.67"  # LCM's default group
LOOPBACK = "127.0.0.1"
BUFFER_BYTES = 4 << 20
_IP_MULTICAST_ALL = 49  # not named by Python


Address = tuple[str, int]


def told(address: Address) -> str:
    """Returns the origin of a datagram as text."""
    return f"port {address[1]}" if address[0] == LOOPBACK else f"{address[0]}, port {address[1]}"


def multicast_receiver(port: int, buffer_bytes: int = BUFFER_BYTES) -> socket.socket:
    """Opens a non-blocking socket that hears the group on `port`, together with others of this user."""
    made = multicast_holder(port)
    made.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, buffer_bytes)
    membership = socket.inet_aton(GROUP) + socket.inet_aton(LOOPBACK)
    made.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, membership)
    made.setblocking(False)
    return made


def multicast_holder(port: int) -> socket.socket:
    """Opens a socket that keeps `port` of the group for this user, and hears nothing.

    Raises:
        OSError: another program has the port.
    """
    made = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)  # SO_REUSEADDR would share the port with other users
    # Otherwise the socket would hear the network, too, as soon as any program here joins the group there.
    made.setsockopt(socket.IPPROTO_IP, _IP_MULTICAST_ALL, 0)
    try:
        made.bind((GROUP, port))
    except OSError:
        made.close()
        raise
    return made


def own_socket(port: int) -> socket.socket:
    """Opens a non-blocking socket that sends from `port` to this machine only, and receives what is sent to `port`."""
    made = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    made.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, BUFFER_BYTES)
    made.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton(LOOPBACK))
    made.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
    try:
        made.bind((LOOPBACK, port))
    except OSError:
        made.close()
        raise
    made.setblocking(False)
    return made
