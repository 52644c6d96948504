"""Finds ports for a run beside other runs."""

import re
from dataclasses import replace

from fwk.bus.port_lock import PortLock, PortsInUseError
from fwk.launcher.machine import MachineError, check_ports
from fwk.model.plan import Plan
from fwk.model.ports import Ports

_TRIES = 24
_BLOCK = 64  # size of the lock blocks of ports
_PORTS_END = 65536
_URL_PORT = re.compile(r"(?<=:)\d+(?=\?|$)")


def on_free_ports(plan: Plan) -> tuple[Plan, PortLock]:
    """Returns the plan on the first free ports from its own on, and their lock; its public bus moves along.

    The lock keeps runs apart that start at the same moment.

    Raises:
        PortsInUseError: no ports are free.
    """
    ports = Ports.of(plan)
    length = -(-(ports.end - ports.base) // _BLOCK) * _BLOCK
    for number in range(_TRIES):
        moved = replace(plan, bus_port=plan.bus_port + number * length, public_url=_moved(plan.public_url, number))
        if Ports.of(moved).end > _PORTS_END:
            break
        try:
            lock = PortLock(Ports.of(moved), plan.file or plan.name, moved.public_url)
        except PortsInUseError:
            continue
        try:
            check_ports(moved)
        except MachineError:
            lock.release()
            continue
        return moved, lock
    raise PortsInUseError(
        f"{plan.name}: no {length} free ports from {plan.bus_port} on; end another run, or use --bus-port"
    )


def _moved(url: str, number: int) -> str:
    return _URL_PORT.sub(lambda port: str(int(port[0]) + number), url)
