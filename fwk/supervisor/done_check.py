"""Checks the content of a done before it counts."""

from fwk.lcm.messages import MessageError
from fwk.model.requests import mistake_in
from fwk.supervisor.core import Core
from lcmtypes.core import done_t, recorded_t

MESSAGES_MAX = 1_000_000
"""Most messages of a channel in one iteration; readers list those that they lack."""
_KINDS = (done_t.STAGE, done_t.ITERATION, done_t.FINAL)


class DoneCheck:
    """Refuses impossible dones, so that a broken process does not bring the supervisor down."""

    def __init__(self, core: Core) -> None:
        plan = core.plan
        dynamic = range(len(plan.channels), len(plan.channels) + plan.spare_channels)
        self._sizes = len(plan.components), dynamic.stop, len(plan.stages)
        self._hosts = core.hosts
        self._newest = core.ledger.latest
        self._components = [set(host.components) for host in plan.hosts]
        self._may_write = [
            {channel.index for channel in plan.channels if channel.writer in host.components} | set(dynamic)
            for host in plan.hosts
        ]
        self._outside = {channel.index for channel in plan.channels if channel.writer < 0}

    def check(self, done: done_t, asks: bool) -> None:
        """Checks the done of a host.

        Args:
            done: the done.
            asks: whether it has requests or losses.

        Raises:
            MessageError: the done names channels, components or stages that its host does not have.
        """
        mistake = self._foreign_mark(done, self._may_write[done.host])
        if not mistake and not asks and done.kind in _KINDS:
            return
        mistake = mistake or mistake_in(done, *self._sizes)
        if not mistake:
            asking = {each.component for asked in (done.main_loop, done.plugins, done.channels) for each in asked}
            asking |= {each.component for each in done.lost_frames}
            foreign = asking - self._components[done.host]
            mistake = f"a request of component {min(foreign)}, which it does not have" if foreign else ""
        if mistake:
            raise MessageError(f"done of {self._hosts[done.host].name} with {mistake}")

    def check_recorded(self, recorded: recorded_t) -> None:
        """Checks a report of the gateway.

        Raises:
            MessageError: the report has a mark of a channel that programs outside do not write.
        """
        mistake = self._foreign_mark(recorded, self._outside)
        if mistake:
            raise MessageError(f"report of the gateway with {mistake}")

    def _foreign_mark(self, message: done_t | recorded_t, may_write: set[int]) -> str:
        for channel, sequence in zip(message.channel, message.sequence, strict=True):
            if channel not in may_write:
                return f"a mark of channel {channel}, which it does not write"
            newest = self._newest(channel)
            if not 0 <= sequence <= newest + MESSAGES_MAX:
                return f"mark {sequence} of channel {channel}, whose newest message is {newest}"
        return ""
