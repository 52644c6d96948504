"""Channels that components of this process open and close while the run goes on."""

from collections.abc import Sequence

from fwk.engine.channel_buffer import ChannelBuffer
from fwk.host.component_group import Members
from fwk.host.inputs import Inputs
from fwk.host.outputs import Outputs
from fwk.model.channel_table import Instances, Opening
from fwk.model.plan import NOBODY, ChannelPlan, Plan
from lcmtypes.core import channels_change_t


class Opened:
    """Brings inputs and outputs of a process up to what is open; `instances` is the table as the process starts."""

    def __init__(
        self, plan: Plan, host: int, members: Members, instances: Instances, inputs: Inputs, outputs: Outputs
    ) -> None:
        self._plan = plan
        self._own = set(plan.hosts[host].components)
        self._members = members
        self._inputs = inputs
        self._outputs = outputs
        # Of each channel that was opened at run time: the host that writes it.
        self._writer = {
            instance.index: plan.components[instance.writer[0]].host
            for instance in instances.matching("*")
            if instance.writer
        }

    def take_over(self, changes: Sequence[channels_change_t]) -> list[ChannelBuffer]:
        """Before an iteration: what changed on the blackboard; returns boxes that are new."""
        new: list[ChannelBuffer] = []
        for fact in self._members.news(changes):
            read, opening = self._members.take_over(fact), fact.opening
            if opening is None:
                continue
            if fact.kind == "write":
                self._writer[opening.channel] = self._plan.components[fact.component].host
                self._inputs.comes_from(opening.channel, self._writer[opening.channel])
                if fact.component in self._own:
                    self._outputs.open(opening.channel, opening.name)
            elif read and opening.channel not in self._inputs:
                new.append(self._inputs.open(self._channel(opening), self._writer.get(opening.channel)))
            elif not read and opening.channel in self._inputs:
                self._inputs.close_channel(opening.channel)
                new = [box for box in new if box.plan.index != opening.channel]
        return new

    def _channel(self, opening: Opening) -> ChannelPlan:
        if opening.channel < len(self._plan.channels):
            return self._plan.channels[opening.channel]
        return ChannelPlan(opening.channel, opening.name, opening.type_name, NOBODY, ())
