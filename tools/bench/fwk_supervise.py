"""fwk's supervisor with a stop-watch: python -m tools.bench.fwk_supervise SHAPE_FILE [recorded] [grouped].

It equals `fwk.launcher.run.run` with two differences: the driver determines the number of ticks and gets the time of
each, and without `recorded` there is no gateway, so that its cost can be measured.
"""

import json
import secrets
import socket
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from fwk.bus.network import Steps, UdpNetwork
from fwk.bus.port_lock import PortLock
from fwk.host.process import raise_file_limit
from fwk.launcher.helper_processes import HelperProcesses
from fwk.launcher.reservations import Reservations
from fwk.model.plan import Plan
from fwk.model.ports import Ports
from fwk.plan.load import LaunchOptions, load_plan
from fwk.supervisor.options import RunOptions
from fwk.supervisor.processes.hosts import StartFailedError
from fwk.supervisor.processes.zygote import Zygote
from fwk.supervisor.supervisor import Machine, Supervisor
from tools.bench import fwk_launch_file
from tools.bench.shape import Shape
from tools.bench.supervise import WARM_UP_TICKS, WARM_UP_US
from tools.bench.timing import now_us

_NEVER = 1 << 62


class MeasuredSupervisor(Supervisor):
    """Runs ticks on the driver's request."""

    def measure(self, control: socket.socket) -> Steps[None]:
        """Starts everything, warms up, answers the driver until the end of the run.

        Raises:
            StartFailedError: components were not ready.
        """
        yield from self._hosts.start_all(self._report)
        with control.makefile("rw") as lines:

            def answer(what: dict[str, Any]) -> None:
                lines.write(json.dumps(what) + "\n")
                lines.flush()

            yield from self.loop.run_tick()
            first_us = now_us()
            while self.loop.tick < WARM_UP_TICKS or now_us() < first_us + WARM_UP_US:
                yield from self._tick()
            answer({"first_tick_us": first_us})
            for line in lines:
                words = line.split()
                if words[0] == "stop":
                    break
                answer((yield from self._ticks(int(words[1]), float(words[2]))))
        yield from self.loop.finish()

    def _ticks(self, ticks: int, seconds: float) -> Steps[dict[str, Any]]:
        tick_us: list[int] = []
        repeated = self.loop.barrier.repeated
        end_us = now_us() + int(seconds * 1e6)
        while len(tick_us) < ticks and (start_us := now_us()) <= end_us:
            yield from self._tick()
            tick_us.append(now_us() - start_us)
        return {"tick_us": tick_us, "repeated": self.loop.barrier.repeated - repeated}

    def _tick(self) -> Steps[None]:
        yield from self.loop.run_tick()


def run(plan: Plan, folder: str, recorded: bool, control: socket.socket) -> None:
    """Runs a plan under the driver's command."""
    number = secrets.randbits(62)
    options = RunOptions(
        Path(folder), speed=plan.speed, record=Path(folder, "log.lcm") if recorded else None, plain=True
    )
    reservations = Reservations(plan, PortLock(Ports.of(plan), plan.name, plan.public_url))
    zygote = Zygote(plan, number, {}, reservations.hosts, not_for_hosts=reservations.not_for_hosts)
    children = HelperProcesses(plan, number, options, {}, reservations) if recorded else None
    network = UdpNetwork(reservations.own)
    supervisor = MeasuredSupervisor(plan, options, number, network, Machine(zygote))
    if not recorded:
        supervisor.loop.tick_log.taken = _NEVER  # there is no gateway to wait for
    try:
        network.run(supervisor.measure(control))
    except StartFailedError as failure:
        control.sendall(json.dumps({"error": str(failure)}).encode() + b"\n")
    network.run(supervisor.stop())
    if children:
        children.stop()
    zygote.close()


def main(words: Sequence[str]) -> None:
    """Checks the launch file and runs it."""
    shape_file, *wishes = words
    shape = Shape.read(shape_file)
    recorded = "recorded" in wishes
    file = fwk_launch_file.write(shape, shape_file, grouped="grouped" in wishes)
    plan = load_plan(file, LaunchOptions(bus_port=shape.base_port))
    raise_file_limit()
    control = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    control.connect(str(Path(shape.folder, "control")))
    run(plan, shape.folder, recorded, control)


if __name__ == "__main__":
    main(sys.argv[1:])
