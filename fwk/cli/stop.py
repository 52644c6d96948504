"""`fwk stop NAME...`."""

from fwk.cli.asking import BusPort, Json, Names, Timeout
from fwk.cli.steering import WAIT_S, steer


def stop(names: Names, bus_port: BusPort = None, timeout_s: Timeout = WAIT_S, as_json: Json = False) -> None:
    """Stops components between two ticks: they finalize and leave the loop.

    What they wrote last stays visible to their readers. Stopped components do not start again by themselves.
    Exit code 0: it has happened; 1: a component failed, or it took too long; 2: it cannot be done.
    """
    steer("stop", names, bus_port, timeout_s, as_json)
