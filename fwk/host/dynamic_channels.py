"""Channels that components of this host open and close while the run goes on."""

from collections.abc import Sequence

from fwk.engine.channel_buffer import ChannelBuffer
from fwk.engine.component_group import ComponentGroup
from fwk.host.inputs import Inputs
from fwk.host.outputs import Outputs
from fwk.model.channel_table import ChannelTable, OpenChannel
from fwk.model.plan import NOBODY, ChannelPlan, Plan
from lcmtypes.core import channels_change_t


class DynamicChannels:
    """Adapts inputs and outputs of a host to the blackboard's decisions; `table` is the table as the host starts."""

    def __init__(
        self, plan: Plan, host: int, group: ComponentGroup, table: ChannelTable, inputs: Inputs, outputs: Outputs
    ) -> None:
        self._plan = plan
        self._own = set(plan.hosts[host].components)
        self._group = group
        self._inputs = inputs
        self._outputs = outputs
        self._writer_host = {
            state.index: plan.components[state.writer[0]].host for state in table.matching("*") if state.writer
        }

    def take_over(self, changes: Sequence[channels_change_t]) -> list[ChannelBuffer]:
        """Applies the decisions among `changes` before an iteration; returns the buffers of newly read channels."""
        new: list[ChannelBuffer] = []
        for fact in self._group.new_facts(changes):
            read, opened = self._group.take_over(fact), fact.channel
            if opened is None:
                continue
            if fact.kind == "write":
                self._writer_host[opened.index] = self._plan.components[fact.component].host
                self._inputs.set_writer(opened.index, self._writer_host[opened.index])
                if fact.component in self._own:
                    self._outputs.open(opened.index, opened.name)
            elif read and opened.index not in self._inputs:
                new.append(self._inputs.open(self._channel(opened), self._writer_host.get(opened.index)))
            elif not read and opened.index in self._inputs:
                self._inputs.close_channel(opened.index)
                new = [buffer for buffer in new if buffer.plan.index != opened.index]
        return new

    def _channel(self, opened: OpenChannel) -> ChannelPlan:
        if opened.index < len(self._plan.channels):
            return self._plan.channels[opened.index]
        return ChannelPlan(opened.index, opened.name, opened.type_name, NOBODY, ())
