"""`fwk start NAME...`."""

from fwk.cli.asking import BusPort, Json, Names, Timeout
from fwk.cli.steering import WAIT_S, steer


def start(names: Names, bus_port: BusPort = None, timeout_s: Timeout = WAIT_S, as_json: Json = False) -> None:
    """Starts components that were stopped or have failed.

    They go on with the sequence numbers of their channels. A component whose needs do not run is refused.
    Exit code 0: it has happened; 1: a component failed, or it took too long; 2: it cannot be done.
    """
    steer("start", names, bus_port, timeout_s, as_json)
