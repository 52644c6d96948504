"""Components of the recorded run: each uses another part of the framework."""

import numpy as np
from lcmtypes.workshop import lift_t, pulse_t, reading_t

from fwk import (
    Blackboard,
    Clock,
    Commands,
    Component,
    Config,
    Image,
    MainLoop,
    PluginControl,
    ReadsEach,
    Sends,
    VisionMaster,
    Writes,
    channel,
)


class MeterConfig(Config):
    gain: float = 1.0
    """Goes into each reading."""
    fails_at_tick: int = 0
    """Tick in which the first process of the component fails; 0: never."""


class Meter(Component):
    """Adds up random numbers; its first process fails once."""

    stage = "sensor_acquire"
    clock: Clock
    config: MeterConfig
    rng: np.random.Generator
    reading: Writes[reading_t]
    pulse: Writes[pulse_t]

    def init(self) -> None:
        self.iterations = 0

    def loop(self) -> None:
        self.iterations += 1
        if self.clock.tick == self.config.fails_at_tick and self.iterations > 1:
            raise RuntimeError("the meter fails on purpose")
        self.reading.value.total += int(self.rng.integers(100))
        self.reading.value.gain = self.config.gain
        self.reading.write()
        self.pulse.value.count += 1
        self.pulse.write()

    def finalize(self) -> None:
        self.reading.value.total = -self.reading.value.total
        self.reading.write()


class Camera(Component):
    """Takes pictures of 8 x 8 pixels."""

    stage = "sensor_acquire"
    image: VisionMaster
    rng: np.random.Generator

    def loop(self) -> None:
        self.image.publish(self.rng.integers(0, 256, (8, 8), np.uint8))


class Finder(Component):
    """Sums up the pixels of the newest picture."""

    stage = "sensor_process"
    image: Image
    found: Writes[reading_t]

    def loop(self) -> None:
        pixels = self.image.pixels
        if pixels is not None:
            self.found.value.total += int(pixels.astype(int).sum())
        self.found.write()


class Watcher(Component):
    """Continuous: sums up all readings."""

    rate_hz = 100
    readings: ReadsEach[reading_t] = channel("*/reading")
    found: Writes[reading_t] = channel("watched")

    def loop(self) -> None:
        for _, reader in self.readings.items():
            self.found.value.total += sum(each.total for each in reader.fresh)
        self.found.write()


class Lifter(Component):
    """Carries commands out, the high ones not."""

    stage = "act"
    lift: Commands[lift_t]
    height: Writes[reading_t]

    def loop(self) -> None:
        while command := self.lift.take():
            if command.value.height_m > 10.0:
                command.reject("too high")
                continue
            self.height.value.total += round(command.value.height_m)
            self.height.write()
            command.done()


class Planner(Component):
    """Sends commands, opens and closes channels, takes the main loop over, stops and starts another component."""

    stage = "think"
    clock: Clock
    lift: Sends[lift_t]
    blackboard: Blackboard
    main_loop: MainLoop
    plugins: PluginControl

    def init(self) -> None:
        self.note = None

    def loop(self) -> None:
        tick, board = self.clock.tick, self.blackboard
        if tick % 5 == 0:
            self.lift.value.height_m = float(tick)
            self.lift.send()
        if tick in (4, 24):
            self.note = board.open_for_writing(reading_t, "note")
        if tick == 18 and self.note:
            board.close(self.note)
            self.note = None
        if self.note and self.note.is_open:
            self.note.value.total = tick
            self.note.write()
        if tick == 6:
            self.main_loop.take_over(["sensor_acquire", "think", "act", "act"])
        elif tick == 9:
            self.main_loop.give_back()
        elif tick == 14:
            self.plugins.stop("a/meter")
        elif tick == 17:
            self.plugins.start("a/meter")


class Reader(Component):
    """Sums up notes that are opened while the run goes on."""

    stage = "act"
    blackboard: Blackboard
    total: Writes[reading_t]

    def init(self) -> None:
        self.notes = self.blackboard.open_multiple_for_reading(reading_t, "*/note")

    def loop(self) -> None:
        for _, reader in self.notes.items():
            self.total.value.total += sum(each.total for each in reader.fresh)
        self.total.value.total += len(self.blackboard.events)
        self.total.write()
