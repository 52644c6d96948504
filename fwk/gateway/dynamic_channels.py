"""The dynamic channels of a run as the gateway follows them, from announcements and tick records."""

from collections.abc import Iterable

from fwk.host.inputs import Inputs
from fwk.lcm import envelope
from fwk.lcm.messages import MessageError
from fwk.model.channel_table import ChannelTable, Fact, facts_in
from fwk.model.plan import NOBODY, ChannelPlan, Plan
from lcmtypes.core import channels_change_t


class FollowedChannels:
    """Listens to dynamic channels as soon as they are announced, and knows which exist."""

    def __init__(self, plan: Plan, inputs: Inputs) -> None:
        self.table = ChannelTable(plan)
        """The channels that exist, including the dynamic ones."""
        self.plain: set[str] = set()
        """Dynamic channels whose type has no header."""
        self.announced = 0
        """Number of the newest change whose channels were announced."""
        self._plan = plan
        self._inputs = inputs

    def announce(self, change: channels_change_t) -> None:
        """Listens to channels before they are written for the first time."""
        self._listen(facts_in(change))
        self.announced = change.number

    def apply(self, change: channels_change_t) -> None:
        """Applies a change that takes effect in the tick that is being recorded."""
        facts = facts_in(change)
        self.table.apply(facts)
        self._listen(facts)
        for fact in facts:
            opened = fact.channel
            if opened is None or opened.index < len(self._plan.channels):
                continue
            self.plain.discard(opened.name)
            if envelope.is_plain(opened.type_name):
                self.plain.add(opened.name)
            if fact.kind == "write":
                self._inputs.set_writer(opened.index, self._plan.components[fact.component].host)

    def check(self, changes: Iterable[channels_change_t]) -> None:
        """Checks changes before they are applied.

        Raises:
            MessageError: they name a channel or a component that the plan does not have.
        """
        facts = [fact for change in changes for fact in facts_in(change)]
        channels = len(self._plan.channels) + self._plan.spare_channels
        if any(fact.channel and not 0 <= fact.channel.index < channels for fact in facts):
            raise MessageError("a tick record with a channel that the plan does not have")
        if any(not 0 <= fact.component < len(self._plan.components) for fact in facts):
            raise MessageError("a tick record with a component that the plan does not have")

    def _listen(self, facts: Iterable[Fact]) -> None:
        """Listens to channels that were never open before."""
        for fact in facts:
            opened = fact.channel
            if opened and opened.index not in self._inputs:
                self._inputs.open(ChannelPlan(opened.index, opened.name, opened.type_name, NOBODY, ()))
