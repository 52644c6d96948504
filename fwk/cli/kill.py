"""`fwk kill NAME...`."""

from fwk.cli.asking import BusPort, Json, Names, Timeout
from fwk.cli.steering import WAIT_S, steer


def kill(names: Names, bus_port: BusPort = None, timeout_s: Timeout = WAIT_S, as_json: Json = False) -> None:
    """Ends components at once, in the middle of an iteration too, and does not start them again.

    Nothing of that iteration is seen by anybody; `finalize` is not called. `fwk start` brings them back.
    Exit code 0: it has happened; 1: it took too long; 2: it cannot be done.
    """
    steer("kill", names, bus_port, timeout_s, as_json)
