"""Finds the process that has a UDP port."""

from fwk.bus.udp_sockets import owners, process_name, sockets_on


def port_owner(port: int) -> str:
    """Returns the processes that have a UDP port, as text: ` (pid 12: nc)`; of other users' only the user is known."""
    users = {socket.inode: socket.user for socket in sockets_on(port)}
    if not users:
        return ""
    named = [_named(process) for process in sorted({process for _, process in owners(users)})]
    return f" ({', '.join(named or [f'user {user}' for user in sorted(set(users.values()))])})"


def _named(process: int) -> str:
    name = process_name(process)
    return f"pid {process}: {name}" if name else f"pid {process}"
