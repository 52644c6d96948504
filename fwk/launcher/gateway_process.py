"""The gateway process: gateway, recorder, log targets and tool servers put together."""

import signal
import socket
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path

from fwk.bus.network import UdpNetwork
from fwk.bus.public import PublicBus
from fwk.component.images import Ring
from fwk.gateway.channel_server import ChannelServer
from fwk.gateway.command_bridge import CommandBridge
from fwk.gateway.connections import Sink
from fwk.gateway.gateway import Gateway
from fwk.gateway.unwrap import Unwrap, plain_channels
from fwk.launcher.reservations import Reservations
from fwk.launcher.run_files import RunFiles
from fwk.lcm.event_log import LogError
from fwk.logs import targets
from fwk.model.plan import Plan
from fwk.model.signals import ignore
from fwk.recording import sinks
from fwk.supervisor.options import RunOptions

DELETED = b"deleted"
"""Beginning of the packet that names a deleted file of the run to the supervisor."""
UNWRITTEN = b"unwritten"
"""Beginning of the packet that says what could not be recorded."""


def run_gateway(
    plan: Plan,
    run: int,
    options: RunOptions,
    control: socket.socket,
    display: socket.socket,
    rings: Mapping[str, Ring],
    reservations: Reservations,
) -> int:
    """Serves until the supervisor closes `control`; returns the exit code."""
    # The gateway ends when the supervisor's end of `control` is closed, also by the supervisor's death.
    ignore(signal.SIGTERM)
    control.setblocking(False)
    public = PublicBus(plan.public_url) if plan.public_url else None
    network = UdpNetwork(reservations.keep_for_gateway())
    gateway = Gateway(plan, run, network, control, public)
    bridge = CommandBridge(plan, gateway.take_in, gateway.clock)
    channel_server = ChannelServer(plan, gateway.dynamic.table, bridge.call, reservations.gateway)
    gateway.watch(channel_server.fileno(), channel_server.handle)
    plain = plain_channels(plan)
    ours = plain - set(plan.outside)  # the public bus had these messages before
    if public:
        mirror = Unwrap(sinks.Mirror(plan, public, gateway.publisher), ours, gateway.dynamic.plain)
        gateway.sinks.append(targets.above(mirror, plan.log.bus))
    recorders: list[sinks.Recorder] = []
    gateway.sinks += [
        *targets.files(plan.log, options.run_dir, gateway.log.error),
        *targets.syslog(plan.log, plan.name, gateway.log.error),
        channel_server,
        bridge,
        *targets.components(plan, gateway.take_in, gateway.log),
        targets.above(sinks.Display(plan, display, gateway.log.error), plan.log.console),
        sinks.Newest(plan, control, lambda: gateway.lost + sum(each.dropped for each in recorders)),
    ]
    unwritten = ""
    if options.record:
        try:
            recorder = _recorder(plan, options.record, rings, gateway.log.error)
            recorders.append(recorder)
            recorded: Sink = Unwrap(recorder, plain, gateway.dynamic.plain)
            if not plan.record.has_all_channels:
                recorded = sinks.ChosenChannels(recorded, plan.record)
            gateway.sinks.insert(0, targets.above(recorded, plan.log.recording))
        except LogError as error:
            gateway.log.error(f"{error}; the run goes on without a recording")
            unwritten = "there is no recording"
    run_files = RunFiles(options, gateway.log.error)
    gateway.sinks.append(run_files)
    network.run(gateway.serve())
    if dropped := sum(each.dropped for each in recorders):
        unwritten = f"the recording lacks {dropped} messages that could not be written"
    if cut_bytes := sum(each.cut_bytes for each in recorders):
        unwritten = f"the recording lacks {cut_bytes} bytes that another program has cut off"
    control.setblocking(True)
    for what, text in ((DELETED, run_files.deleted), (UNWRITTEN, unwritten)):
        if text:
            with suppress(OSError):  # the supervisor has died
                control.send(what + b"\0" + text.encode())
    return 0


def _recorder(plan: Plan, path: Path, rings: Mapping[str, Ring], report: Callable[[str], None]) -> sinks.Recorder:
    """Makes the recorder that the plan asks for; OpenCV is imported only to record frames."""
    if not plan.record.frames:
        return sinks.Recorder(plan, path, report)
    from fwk.recording.frame_recorder import FrameRecorder

    return FrameRecorder(plan, path, {channel: rings[channel] for channel in plan.record.frames}, report)
