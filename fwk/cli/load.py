"""`fwk load NAME...`."""

from fwk.cli.asking import BusPort, Json, Names, Timeout
from fwk.cli.steering import WAIT_S, steer


def load(names: Names, bus_port: BusPort = None, timeout_s: Timeout = WAIT_S, as_json: Json = False) -> None:
    """Starts components together with everything that they need.

    What they need: components that the launch file says, and the vision masters of their images.
    Exit code 0: it has happened; 1: a component failed, or it took too long; 2: it cannot be done.
    """
    steer("load", names, bus_port, timeout_s, as_json)
