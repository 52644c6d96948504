"""`fwk pause`."""

from fwk.cli.asking import BusPort, Json, Timeout
from fwk.cli.clock import ask_clock


def pause(bus_port: BusPort = None, timeout_s: Timeout = 30.0, as_json: Json = False) -> None:
    """Lets simulated time stand still after the running tick; what components do is not changed by that.

    Meanwhile components can be stopped, started, restarted and given settings, which count from the next tick on. A run
    with `clock: wall` refuses.
    """
    ask_clock("pause", bus_port, timeout_s, as_json)
