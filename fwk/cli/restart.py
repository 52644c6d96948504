"""`fwk restart NAME...`."""

from fwk.cli.asking import BusPort, Json, Names, Timeout
from fwk.cli.steering import WAIT_S, steer


def restart(names: Names, bus_port: BusPort = None, timeout_s: Timeout = WAIT_S, as_json: Json = False) -> None:
    """Stops components between two ticks and starts them again.

    Failures of before are forgotten; so a component that was given up is tried again.
    Exit code 0: it has happened; 1: a component failed, or it took too long; 2: it cannot be done.
    """
    steer("restart", names, bus_port, timeout_s, as_json)
