"""`fwk resume`."""

from fwk.cli.asking import BusPort, Json, Timeout
from fwk.cli.clock import ask_clock


def resume(bus_port: BusPort = None, timeout_s: Timeout = 30.0, as_json: Json = False) -> None:
    """Lets a paused run go on at the speed it had."""
    ask_clock("resume", bus_port, timeout_s, as_json)
