"""Traders open, write, read and close channels at random; a diary holds a digest of what each of them sees."""

import contextlib
import zlib
from typing import Any

import numpy as np

from fwk import Blackboard, Clock, Component, Config, Logger, Reads, Writes
from fwk.clock import sleep_s
from fwk.component.blackboard import OpenWrites
from lcmtypes.robot import imu_t, odometry_t
from lcmtypes.soccer import obstacle_t


class TraderConfig(Config):
    gain: float = 1.0


class Trader(Component):
    stage = "think"
    blackboard: Blackboard
    clock: Clock
    config: TraderConfig
    log: Logger
    rng: np.random.Generator
    diary: Writes[imu_t]

    def init(self) -> None:
        self.goods = self.blackboard.open_multiple_for_reading(imu_t, "*/good?")
        self.own = self.blackboard.open_for_writing(imu_t, "spot")
        self.writing: dict[str, OpenWrites[imu_t]] = {}
        self.reading: dict[str, Reads[imu_t]] = {}
        self.wrong: OpenWrites[odometry_t] | None = None
        self.plain: OpenWrites[obstacle_t] | None = None
        self.oddments = self.blackboard.open_multiple_for_reading(obstacle_t, "*/odd?")
        self.digest = 0

    def loop(self) -> None:
        board = self.blackboard
        seen: list[object] = [board.events, board.instances()]
        readers = {**self.goods, **self.reading}
        for name, each in readers.items():
            seen += [name, [message.header.sequence for message in each.fresh], each.value.heading_rad]
        for name, odds in self.oddments.items():
            seen += [name, odds.header.sequence, odds.header.writer, [odd.x_m for odd in odds.fresh]]
        seen += [(each.channel, each.is_open, each.refused) for each in self.writing.values()]
        seen += [board.writer("a/diary"), board.readers("a/diary"), board.has_writer("shop/good1")]
        if self.wrong and self.wrong.is_open:
            self.wrong.write()
        if self.plain and self.plain.is_open:
            self.plain.value.x_m += 1.0
            self.plain.write()
        self.digest = zlib.crc32(repr(seen).encode(), self.digest)
        self.diary.value.heading_rad = self.config.gain * self.digest
        self.diary.write()
        if self.own.is_open:
            self.own.value.heading_rad = float(self.digest)
            self.own.write()
        for writer in self.writing.values():
            if writer.is_open and self.rng.random() < 0.7:
                writer.value.heading_rad = float(self.digest % 1000)
                writer.write()
        name = f"shop/good{self.rng.integers(4)}"
        what = self.rng.integers(8)
        if what == 0:
            self.writing[name] = board.open_for_writing(imu_t, name)
        elif what == 1 and name in self.writing:
            self.close(self.writing.pop(name))
        elif what == 2:
            self.reading[name] = board.open_for_reading(imu_t, name)
        elif what == 3 and name in self.reading:
            self.close(self.reading.pop(name))
        elif what == 4:
            other = f"{'abc'[self.rng.integers(3)]}/{['spot', 'diary'][self.rng.integers(2)]}"
            self.reading[other] = board.open_for_reading(imu_t, other)
        elif what == 5:
            self.close(self.wrong)
            self.wrong = board.open_for_writing(odometry_t, name)
        elif what == 6:
            self.close(self.wrong)
        elif what == 7:
            self.close(self.plain)
            self.plain = board.open_for_writing(obstacle_t, f"/shop/odd{self.rng.integers(2)}")

    def close(self, handle: Any) -> None:
        with contextlib.suppress(ValueError):
            self.blackboard.close(handle)


class Wanderer(Trader):
    """A trader with a rate of its own: the main loop does not wait for it."""

    stage = ()  # type: ignore[assignment]
    rate_hz = 0

    def loop(self) -> None:
        before = self.everything()
        sleep_s(0.05 * self.rng.random())
        assert self.everything() == before
        super().loop()

    def everything(self) -> object:
        board = self.blackboard
        values = [(name, each.value.heading_rad, each.refreshed) for name, each in self.goods.items()]
        return board.events, board.instances(), values, self.own.is_open


class Bystander(Component):
    """Reads a diary and takes no part in the trade."""

    stage = "act"
    diary: Reads[imu_t]
    echo: Writes[imu_t]

    def loop(self) -> None:
        self.echo.value.heading_rad = self.diary.value.heading_rad
        self.echo.write()
