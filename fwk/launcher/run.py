"""Runs a plan in the foreground: composes supervisor, zygote, gateway and display."""

import secrets
from functools import partial

from fwk.bus.network import UdpNetwork
from fwk.bus.port_lock import PortLock, PortsInUseError
from fwk.clock import US_PER_S
from fwk.component.images import SLOTS, Ring
from fwk.control.server import ControlNameError, Server
from fwk.host.debugger import DebuggerMissingError, DebugRequest, check
from fwk.host.process import name_process, raise_file_limit
from fwk.host.profile import ProfileRequest, ProfilerMissingError, check_profiler
from fwk.launcher.helper_processes import HelperProcesses
from fwk.launcher.reservations import Reservations
from fwk.launcher.signals import StopSignals
from fwk.lcm import envelope, messages
from fwk.lcm.messages import MessageError
from fwk.model.plan import Plan
from fwk.supervisor.barrier import WINDOW
from fwk.supervisor.options import Outcome, RunOptions
from fwk.supervisor.processes.zygote import Zygote
from fwk.supervisor.supervisor import INTERRUPTED, Machine, Supervisor

__all__ = [
    "ControlNameError",
    "DebuggerMissingError",
    "Outcome",
    "PortsInUseError",
    "ProfilerMissingError",
    "RunOptions",
    "run",
]


def run(plan: Plan, options: RunOptions, lock: PortLock) -> Outcome:
    """Runs a plan in the foreground until it is done, interrupted or broken; `lock` is that of its ports.

    Raises:
        PortsInUseError: another run or another program on this machine has a port.
        ControlNameError: another process has the name of a control socket.
        DebuggerMissingError: debugpy is requested and not installed.
        ProfilerMissingError: a profile is requested and pyinstrument is not installed.
    """
    debug = _debug_request(plan, options)
    profile = _profile_request(plan, options)
    raise_file_limit()
    reservations = Reservations(plan, lock)
    number = secrets.randbits(62)
    rings = _rings(plan, options)
    zygote = Zygote(plan, number, rings, reservations.hosts, debug, profile, reservations.not_for_hosts)
    helpers = HelperProcesses(plan, number, options, rings, reservations)
    reservations.gateway.close()  # the gateway's process has it
    network = UdpNetwork(reservations.own)
    name_process(plan.name, "supervisor")
    machine = Machine(zygote, StopSignals(), partial(Server, reservations.supervisor), rings, reservations.hosts, debug)
    supervisor = Supervisor(plan, options, number, network, machine)
    reason, failed = network.run(supervisor.work(helpers))
    status, failures = network.run(supervisor.stop())
    if failures and not failed:
        reason, failed = f"failed: {'; '.join(failures)}", True
    newest = _decoded(plan, helpers.stop())
    if not failed:
        reason, failed = ending(reason, helpers)
    zygote.close()
    reservations.release()
    return Outcome(
        1 if failed else 0,
        supervisor.loop.tick,
        supervisor.time_us / US_PER_S,
        supervisor.wall_s,
        reason,
        status,
        newest,
        helpers.lost,
        helpers.deleted,
    )


def ending(reason: str, helpers: HelperProcesses) -> tuple[str, bool]:
    """Returns the reason for the end of a run whose components are well, and whether it failed nevertheless.

    A recording that a full disk has cut short is a failure, unless the user ended the run: the log named it then.
    """
    if broken := helpers.gave_up or helpers.deleted:
        return f"broken: {broken}", True
    if helpers.unwritten and reason != INTERRUPTED:
        return f"{reason}, but {helpers.unwritten}", True
    return reason, False


def _rings(plan: Plan, options: RunOptions) -> dict[str, Ring]:
    """Creates a ring for each camera; where frames are recorded, it also covers the recorder's delay."""
    recorded = plan.record.frames if options.record else ()
    cameras = [channel.name for channel in plan.channels if channel.images]
    large = SLOTS + (SLOTS - 1) * WINDOW
    return {name: Ring.create(name, large if name in recorded else SLOTS) for name in cameras}


def _profile_request(plan: Plan, options: RunOptions) -> ProfileRequest | None:
    for component in plan.components:
        if component.name == options.profile:
            check_profiler()
            return ProfileRequest(component, options.run_dir)
    return None


def _debug_request(plan: Plan, options: RunOptions) -> DebugRequest | None:
    for component in plan.components:
        if component.name == options.debug:
            request = DebugRequest(component.host, component, options.debugpy_port)
            check(request)
            return request
    return None


def _decoded(plan: Plan, newest: dict[str, bytes]) -> dict[str, object]:
    """Decodes the newest messages of the plan's channels."""
    types = {channel.name: messages.type_named(channel.type_name) for channel in plan.channels}
    made: dict[str, object] = {}
    for channel, data in newest.items():
        try:
            made[channel] = envelope.decode(types[channel], data, channel)
        except MessageError:
            continue
    return made
