"""Writes to the log in several ways."""

import os
import sys
import threading
from pathlib import Path

from fwk import Clock, Component, Config, Logger, Writes
from lcmtypes.robot import imu_t
from thinking import think


class TalkerConfig(Config):
    lines: int = 0
    """Lines and errors in the first iteration."""
    printed: int = 0
    """Lines printed in the first iteration."""
    long: int = 0
    """Letters of a long line."""
    asks: bool = False
    """Whether the component prints a line without an end."""
    thread: bool = False
    """A thread ends by an exception."""
    thinks: bool = False
    """Whether the component uses a plain module that logs."""
    fails_at: int = 0
    """Tick in which it raises."""
    leaves_at: int = 0
    """Tick in which its first process ends."""


class Talker(Component):
    """Logs and prints."""

    stage = "think"
    reaches_outside = False
    config: TalkerConfig
    clock: Clock
    log: Logger
    imu: Writes[imu_t]

    def init(self) -> None:
        if self.config.leaves_at:
            self.log.info("begins")

    def loop(self) -> None:
        if self.clock.tick == self.config.leaves_at and not Path("left").exists():
            Path("left").touch()
            os._exit(3)
        self.log.debug(f"in tick {self.clock.tick}")
        if self.clock.tick == 3:
            self._talk()
        if self.clock.tick == self.config.fails_at:
            raise RuntimeError("not this tick")
        self.imu.value.heading_rad += 1.0
        self.imu.write()

    def _talk(self) -> None:
        for number in range(self.config.lines):
            self.log.info(f"chatter {number}")
            if number % 100 == 0:
                self.log.error(f"error {number}")
        for number in range(self.config.printed):
            print(f"printed {number}")
        if self.config.printed:
            print("to the other stream", file=sys.stderr)
            os.write(2, b"\xfe no text\n")
        if self.config.long:
            self.log.warning("x" * self.config.long)
        if self.config.asks:
            print("how much? ", end="", flush=True)
        if self.config.thinks:
            think(self.clock.tick)
        if self.config.thread:
            thread = threading.Thread(target=lambda: 1 / 0, name="aside")
            thread.start()
            thread.join()
