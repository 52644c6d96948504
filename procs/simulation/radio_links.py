"""A team's radio: each message reaches each mate or not, some time later, independently of the others."""

import heapq
import math
from collections.abc import Sequence
from typing import Generic, TypeVar

import numpy as np
from pydantic import BaseModel, ConfigDict

from procs.model.realism import Realism

T = TypeVar("T")


class RadioSettings(BaseModel):
    """Quality of the radio. 0: ideal."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    loss: float = 0.0
    """Probability that a message does not arrive, for each receiver on its own. ER-Force: 3 % of the commands."""
    delay_s: float = 0.0
    """Time from sending to arrival. An estimate of a wireless network; robots read a message in the next tick."""
    delay_jitter_s: float = 0.0
    """A message takes up to that much longer; drawn evenly, so messages may overtake each other."""
    outages_1_min: float = 0.0
    """Interruptions of each link in a minute."""
    outage_s: float = 0.0
    """Mean duration of an interruption."""
    bandwidth_bit_s: float = 0.0
    """Rate of the team's channel; what is beyond it is lost. 0: no limit. Rule book of 2016: 2.2 Mbit/s."""


PRESETS: dict[Realism, RadioSettings] = {
    "none": RadioSettings(),
    "friendly": RadioSettings(loss=0.01, delay_s=0.002, delay_jitter_s=0.01, bandwidth_bit_s=2.2e6),
    "realistic": RadioSettings(
        loss=0.03, delay_s=0.005, delay_jitter_s=0.02, outages_1_min=0.5, outage_s=0.3, bandwidth_bit_s=2.2e6
    ),
    "harsh": RadioSettings(
        loss=0.06, delay_s=0.01, delay_jitter_s=0.04, outages_1_min=1.0, outage_s=0.6, bandwidth_bit_s=1.1e6
    ),
}


class RadioLinks(Generic[T]):
    """Messages on their way, in the order of arrival; equal arrivals in the order of sending."""

    def __init__(self, receivers: Sequence[str], rng: np.random.Generator) -> None:
        self._receivers = tuple(receivers)
        self._rng = rng
        self._sent = 0
        self._under_way: list[tuple[int, int, str, T]] = []
        self._pairs = [(one, two) for place, one in enumerate(self._receivers) for two in self._receivers[:place]]
        self._back_us: dict[frozenset[str], int] = {}
        """Pair of robots to the time at which the interruptions of their link have ended."""
        self._passed_us = -1
        self._credit_bit = 0.0
        self._sent_us: dict[str, int] = {}
        """Time of the last message of each robot that the channel had room for."""

    def pass_time(self, now_us: int, settings: RadioSettings, burst_s: float) -> None:
        """Interrupts links and refills the channel; call it once a tick, before messages are sent.

        The channel makes up for idle time of `burst_s`.
        """
        passed_s = 0.0 if self._passed_us < 0 else (now_us - self._passed_us) / 1e6
        burst_bit = settings.bandwidth_bit_s * burst_s
        first = self._passed_us < 0
        self._passed_us = now_us
        self._credit_bit = (
            burst_bit if first else min(burst_bit, self._credit_bit + settings.bandwidth_bit_s * passed_s)
        )
        drawn = self._rng.random((len(self._pairs), 2))
        likely = -math.expm1(-settings.outages_1_min * passed_s / 60)
        for pair, (luck, length) in zip(self._pairs, drawn.tolist(), strict=True):
            if luck < likely:
                back_us = now_us + round(-settings.outage_s * math.log1p(-length) * 1e6)
                self._back_us[frozenset(pair)] = max(back_us, self._back_us.get(frozenset(pair), 0))

    def in_turn(self, waiting: list[tuple[str, T, int]]) -> list[tuple[str, T, int]]:
        """Returns the messages of a tick, with sender and size in bytes, in the order in which the channel takes them.

        If it has too little room for all, robots that have waited longest are first.
        """
        if sum(8 * size_bytes for _, _, size_bytes in waiting) <= self._credit_bit:
            return waiting
        return sorted(waiting, key=lambda each: self._sent_us.get(each[0], -1))

    def send(self, sender: str, message: T, now_us: int, settings: RadioSettings, size_bytes: int = 0) -> None:
        """Sends to all receivers but the sender. Draws two random numbers a receiver, whatever the settings."""
        too_much = settings.bandwidth_bit_s > 0 and self._credit_bit <= 0
        if not too_much:
            self._credit_bit -= 8 * size_bytes  # below 0 for a message that takes longer than a burst
            self._sent_us[sender] = now_us
        for receiver in self._receivers:
            if receiver == sender:
                continue
            luck, jitter = self._rng.random(2).tolist()
            cut = self._back_us.get(frozenset((sender, receiver)), 0) > now_us
            if luck < settings.loss or cut or too_much:
                continue
            arrival_us = now_us + round((settings.delay_s + jitter * settings.delay_jitter_s) * 1e6)
            self._sent += 1
            heapq.heappush(self._under_way, (arrival_us, self._sent, receiver, message))

    def receive(self, now_us: int) -> dict[str, list[T]]:
        """Returns the messages that arrived since the last call, by receiver."""
        arrived: dict[str, list[T]] = {}
        while self._under_way and self._under_way[0][0] <= now_us:
            _, _, receiver, message = heapq.heappop(self._under_way)
            arrived.setdefault(receiver, []).append(message)
        return arrived
