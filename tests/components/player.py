"""Players that write down what they heard, and the conductor."""

import os
import zlib
from pathlib import Path
from typing import Any

import numpy as np

import trouble
import weather  # noqa: F401 - loses datagrams if its settings ask for it
from fwk import Clock, Component, Config, Each, Reads, TimeSource, Writes, channel
from fwk.lcm.codec import encoder  # the bytes of lcm-gen, sooner
from lcmtypes.play import burst_t, heard_t, note_t


class PlayerConfig(Config):
    bursts: int = 3
    """Most bursts of an iteration."""
    ballast: int = 50
    """Bytes of the largest burst."""
    work: int = 0
    """Rounds of pointless work in an iteration."""
    tone: int = 0
    """Part of the digest."""
    trouble: str = ""
    """The fault, see trouble.py."""
    trouble_tick: int = 0
    """First tick of the fault, unless it is in init or finalize."""
    trouble_stage: str = ""
    """Stage of the fault; the first if empty."""
    trouble_again: bool = False
    """The fault also occurs after a restart."""


class Player(Component):
    """Hears all players and writes down what it heard."""

    stage = "think"
    reaches_outside = False

    config: PlayerConfig
    clock: Clock
    rng: np.random.Generator
    notes: Each[Reads[note_t]] = channel("*/note")
    bursts: Each[Reads[burst_t]] = channel("*/burst")
    note: Writes[note_t]
    burst: Writes[burst_t]

    def init(self) -> None:
        self.leave_trace("pid", os.getpid())
        self.make_trouble("init")
        self.note.value.digest = self.config.tone

    def loop(self) -> None:
        note = self.note.value
        note.iterations += 1
        self.leave_trace("tick", self.clock.tick)
        before = self.digest()
        note.heard = [self.heard(reader) for reader in self.readers()]
        for _ in range(self.config.work):
            zlib.crc32(bytes(100_000))
        note.frozen = before == self.digest()
        note.digest = zlib.crc32(before.to_bytes(8, "big"), note.digest)
        self.note.write()
        for _ in range(self.rng.integers(self.config.bursts + 1)):
            self.burst.value.ballast = self.rng.bytes(self.config.ballast)
            self.burst.write()
        if self.clock.tick >= self.config.trouble_tick > 0 and self.config.trouble_stage in ("", self.clock.stage):
            self.make_trouble("loop")

    def finalize(self) -> None:
        self.make_trouble("finalize")

    def leave_trace(self, kind: str, number: int) -> None:
        if Path("traces").is_dir():
            new = Path("traces", f"{self.name.replace('/', '_')}.{kind}.new")
            new.write_text(str(number))
            new.rename(new.with_suffix(""))

    def make_trouble(self, where: str) -> None:
        done = Path("trouble-" + self.name.replace("/", "_"))
        if self.config.trouble.startswith(where + ":") and (self.config.trouble_again or not done.exists()):
            done.touch()
            trouble.MAKE[self.config.trouble.partition(":")[2]]()

    def digest(self) -> int:
        found = 0
        for reader in self.readers():
            message_type: Any = reader.message_type
            encode = encoder(message_type)
            assert encode
            fresh = [*map(encode, reader.fresh)]
            for data in [*fresh, fresh[-1] if fresh else encode(reader.value)]:
                found = zlib.crc32(data, found)
        return found

    def readers(self) -> list[Reads[Any]]:
        return [*self.notes.values(), *self.bursts.values()]

    def heard(self, reader: Reads[Any]) -> heard_t:
        made, numbers = heard_t(), [message.header.sequence for message in reader.fresh]
        made.channel, made.count = reader.channel, len(numbers)
        made.first, made.last = (numbers[0], numbers[-1]) if numbers else (0, 0)
        made.newest_tick, made.newest_stage = reader.header.tick, reader.header.stage
        return made


class Conductor(Component):
    """Time source: sets the time of the next tick."""

    stage = "pre_loop"

    clock: Clock
    rng: np.random.Generator
    time_source: TimeSource

    def loop(self) -> None:
        self.time_source.next_us = self.clock.now_us + int(self.rng.integers(30_000, 70_000))
