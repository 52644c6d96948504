"""`fwk reload NAME...`."""

from fwk.cli.asking import BusPort, Json, Names, Timeout
from fwk.cli.steering import WAIT_S, steer


def reload(names: Names, bus_port: BusPort = None, timeout_s: Timeout = WAIT_S, as_json: Json = False) -> None:
    """Restarts components with their changed code; the others run on.

    The modules of the application are imported anew in the processes of these components.
    Exit code 0: it has happened; 1: a component failed, or it took too long; 2: it cannot be done.
    """
    steer("reload", names, bus_port, timeout_s, as_json)
