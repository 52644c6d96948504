"""A team's radio: each message reaches each mate or not, some time later, independently of the others."""

import heapq
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

import numpy as np

T = TypeVar("T")


@dataclass(frozen=True)
class RadioSettings:
    """Quality of the radio."""

    loss: float = 0.0
    """Probability that a message does not arrive, for each receiver on its own."""
    delay_s: float = 0.0
    delay_jitter_s: float = 0.0
    """A message takes up to that much longer; drawn evenly, so messages may overtake each other."""


class RadioLinks(Generic[T]):
    """Messages on their way, in the order of arrival; equal arrivals in the order of sending."""

    def __init__(self, receivers: Sequence[str], rng: np.random.Generator) -> None:
        self._receivers = tuple(receivers)
        self._rng = rng
        self._sent = 0
        self._under_way: list[tuple[int, int, str, T]] = []

    def send(self, sender: str, message: T, now_us: int, settings: RadioSettings) -> None:
        """Sends to all receivers but the sender. Draws two random numbers a receiver, whatever the settings."""
        for receiver in self._receivers:
            if receiver == sender:
                continue
            luck, jitter = self._rng.random(2).tolist()
            if luck < settings.loss:
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
