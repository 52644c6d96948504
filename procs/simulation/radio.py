"""Radio of a team: delivers each robot's messages to its mates, with loss and delay."""

import numpy as np
from pydantic import Field

from fwk import Clock, Component, Config, Each, Reads, Writes
from lcmtypes.soccer import team_inbox_t, team_message_t
from procs.simulation.radio_links import RadioLinks, RadioSettings


class RadioConfig(Config):
    """Quality of the radio."""

    loss: float = Field(default=0.03, ge=0.0, le=1.0)
    """Probability that a message does not reach a mate, independent for each mate; 1 switches the radio off."""
    delay_s: float = Field(default=0.0, ge=0.0)
    """Time from sending to arrival, besides the tick that every message takes."""
    delay_jitter_s: float = Field(default=0.02, ge=0.0)
    """Largest further delay of a message."""


class Radio(Component):
    """Stands for the air between the robots of a team. The launch file gives the channels: `cyan*/team_message`.

    An inbox is written only in ticks in which something arrives. No robot gets its own messages.
    """

    stage = "post_loop"

    messages: Each[Reads[team_message_t]]
    inboxes: Each[Writes[team_inbox_t]]
    config: RadioConfig
    clock: Clock
    rng: np.random.Generator

    def init(self) -> None:
        """Tunes in."""
        self._links: RadioLinks[team_message_t] = RadioLinks(list(self.inboxes), self.rng)

    def loop(self) -> None:
        """Sends the messages of this tick, delivers those that have arrived."""
        settings = RadioSettings(self.config.loss, self.config.delay_s, self.config.delay_jitter_s)
        for robot, said in self.messages.items():
            for message in said.fresh:
                self._links.send(robot, message, self.clock.now_us, settings)
        for robot, arrived in self._links.receive(self.clock.now_us).items():
            inbox = self.inboxes[robot]
            inbox.value.messages = arrived
            inbox.write()
