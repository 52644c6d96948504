"""Channels that components of this host open and close while the run goes on."""

from collections.abc import Sequence

from fwk.engine.channel_buffer import ChannelBuffer
from fwk.engine.component_group import ComponentGroup
from fwk.host.inputs import Inputs
from fwk.host.outputs import Outputs
from fwk.model.channel_table import ChannelTable, Opening
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
            instance.index: plan.components[instance.writer[0]].host
            for instance in table.matching("*")
            if instance.writer
        }

    def take_over(self, changes: Sequence[channels_change_t]) -> list[ChannelBuffer]:
        """Applies the decisions among `changes` before an iteration; returns the buffers of newly read channels."""
        new: list[ChannelBuffer] = []
        for fact in self._group.new_facts(changes):
            read, opening = self._group.take_over(fact), fact.opening
            if opening is None:
                continue
            if fact.kind == "write":
                self._writer_host[opening.channel] = self._plan.components[fact.component].host
                self._inputs.set_writer(opening.channel, self._writer_host[opening.channel])
                if fact.component in self._own:
                    self._outputs.open(opening.channel, opening.name)
            elif read and opening.channel not in self._inputs:
                new.append(self._inputs.open(self._channel(opening), self._writer_host.get(opening.channel)))
            elif not read and opening.channel in self._inputs:
                self._inputs.close_channel(opening.channel)
                new = [buffer for buffer in new if buffer.plan.index != opening.channel]
        return new

    def _channel(self, opening: Opening) -> ChannelPlan:
        if opening.channel < len(self._plan.channels):
            return self._plan.channels[opening.channel]
        return ChannelPlan(opening.channel, opening.name, opening.type_name, NOBODY, ())
