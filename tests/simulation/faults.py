"""Faults of a simulated world: the weather between processes, and actions on one process at a moment."""

from dataclasses import dataclass
from random import Random
from typing import Literal

ActionKind = Literal[
    "kill",  # the process ends at once
    "kill_at_send",  # the process ends before it sends its datagram number `amount` from now on
    "cut_off",  # the same, and until then only the supervisor hears it: readers and gateway lack its last messages
    "stop",  # the process stops for `amount` microseconds
    "stop_at_send",  # the same, before its datagram number `amount` from now on
    "jump",  # the clock of the machine jumps ahead by `amount` microseconds
    "set",  # a tool sets the component's `tune` to `amount`
    "steer",  # a tool asks to start, stop, restart, load or unload the component
    "pause",  # a tool pauses the run and lets it go on after `amount` microseconds
    "call",  # a program outside publishes the number `amount`
]
OUTSIDE: frozenset[ActionKind] = frozenset({"kill", "kill_at_send", "cut_off", "set", "steer", "pause", "call"})
"""Actions from outside: two runs with them may differ, but each replays."""


@dataclass(frozen=True)
class Action:
    """Something that happens to one process."""

    kind: ActionKind
    after_tick: int
    """The record of this tick has been sent."""
    delay_us: int
    """Wall time after that."""
    target: str = ""
    """Component whose process is affected; or `supervisor`, `gateway`."""
    amount: int = 0
    word: str = ""
    """Action that `steer` requests."""


@dataclass(frozen=True)
class Weather:
    """Faults of datagrams and processes; each number is a probability unless its comment says otherwise."""

    latency_us: int = 20
    """Longest usual time of a datagram on its way."""
    loss: float = 0.0
    duplicate: float = 0.0
    delay: float = 0.0
    delay_us: int = 0
    """Longest additional time of a delayed datagram; later ones overtake it."""
    slow_start_us: int = 0
    """Longest additional time that a process takes to start."""
    hiccup: float = 0.0
    """Probability that a process stops for a moment before it continues."""
    hiccup_us: int = 0
    disk_us: int = 0
    """Longest time that the recorder takes for a tick."""

    @property
    def calm(self) -> bool:
        """Returns whether there are no faults."""
        return self == Weather()


def weather_of(random: Random) -> Weather:
    """Draws a weather: each kind of fault is absent, rare or frequent."""

    def rate(most: float) -> float:
        return round(most * random.random() ** 3, 4) if random.random() < 0.5 else 0.0

    def time_us(most_us: int) -> int:
        return int(most_us * random.random() ** 3)

    return Weather(
        latency_us=random.choice([1, 20, 200]),
        loss=rate(0.3),
        duplicate=rate(0.3),
        delay=rate(0.3),
        delay_us=time_us(100_000),
        slow_start_us=time_us(2_000_000) if random.random() < 0.3 else 0,
        hiccup=rate(0.1),
        hiccup_us=time_us(50_000),
        disk_us=time_us(300_000) if random.random() < 0.2 else 0,
    )
