"""Radio of a team: delivers each robot's messages to its mates, with loss and delay."""

import numpy as np
from pydantic import Field

from fwk import Clock, Component, Config, Each, Reads, Writes
from lcmtypes.soccer import team_inbox_t, team_message_t
from procs.model.realism import Realism, chosen
from procs.model.units import US_PER_S
from procs.simulation.radio_links import PRESETS, RadioLinks


class RadioConfig(Config):
    """Quality of the radio."""

    realism: Realism = "realistic"
    """Deviation of the radio from the ideal: none, friendly, realistic or harsh. Non-null settings override it."""
    loss: float | None = Field(default=None, ge=0.0, le=1.0)
    """Probability that a message does not reach a mate, independent for each mate; 1 switches the radio off."""
    delay_s: float | None = Field(default=None, ge=0.0, le=10.0)
    """Time from sending to arrival; a robot reads what has arrived when its next tick begins."""
    delay_jitter_s: float | None = Field(default=None, ge=0.0, le=10.0)
    """Largest further delay of a message."""
    outages_1_min: float | None = Field(default=None, ge=0.0, le=1e6)
    """Interruptions of the link between two robots in a minute."""
    outage_s: float | None = Field(default=None, ge=0.0, le=600.0)
    """Mean duration of an interruption."""
    bandwidth_bit_s: float | None = Field(default=None, ge=0.0)
    """Rate of the team's channel, to which messages beyond it are lost; 0: no limit. Rule book of 2016: 2.2 Mbit/s."""
    burst_s: float = Field(default=0.2, gt=0.0, le=10.0)
    """Idle time in s that the channel makes up for: so much data may be sent at once. An estimate."""


class Radio(Component):
    """Replaces the radio between the robots of a team. The launch file gives the channels: `cyan*/team_message`.

    An inbox is written only in ticks in which messages arrive. No robot gets its own messages.
    """

    stage = "post_loop"

    messages: Each[Reads[team_message_t]]
    inboxes: Each[Writes[team_inbox_t]]
    config: RadioConfig
    clock: Clock
    rng: np.random.Generator

    def init(self) -> None:
        """Creates the links."""
        self._links: RadioLinks[team_message_t] = RadioLinks(list(self.inboxes), self.rng)

    def loop(self) -> None:
        """Sends the messages of this tick, and delivers those that arrive until the next, in which robots read them."""
        settings = chosen(PRESETS[self.config.realism], self.config)
        self._links.pass_time(self.clock.now_us, settings, self.config.burst_s)
        waiting = [
            (robot, message, len(message.encode()) if settings.bandwidth_bit_s else 0)
            for robot, said in self.messages.items()
            for message in said.fresh
        ]
        for robot, message, size_bytes in self._links.in_turn(waiting):
            self._links.send(robot, message, self.clock.now_us, settings, size_bytes)
        read_us = self.clock.now_us + round(self.clock.period_s * US_PER_S)
        for robot, arrived in self._links.receive(read_us).items():
            inbox = self.inboxes[robot]
            inbox.value.messages = arrived
            inbox.write()
