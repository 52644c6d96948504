"""A lifter, an adder, and a worker that uses both."""

import os
from pathlib import Path

import numpy as np

import weather  # noqa: F401 - loses datagrams if its settings ask for it
from fwk import Call, Calls, Clock, Component, Config, Serves, Writes, channel
from lcmtypes.core import acknowledgement_t
from lcmtypes.lift import lift_t, lifted_t, sum_request_t, sum_t, tally_t


def leave_trace(name: str, kind: str, number: int) -> None:
    if Path("traces").is_dir():
        new = Path("traces", f"{name.replace('/', '_')}.{kind}.new")
        new.write_text(str(number))
        new.rename(new.with_suffix(""))


class LifterConfig(Config):
    at_once: int = 2
    """Most commands of an iteration."""
    ticks: int = 2
    """Duration of a lift."""


class Lifter(Component):
    """Lifts to the commanded heights, a few commands at a time; fails for heights below zero."""

    stage = "act"
    reaches_outside = False
    config: LifterConfig
    clock: Clock
    lift: Serves[lift_t]
    lifted: Writes[lifted_t]

    def init(self) -> None:
        leave_trace(self.name, "pid", os.getpid())
        self.until: dict[tuple[str, int], int] = {}

    def loop(self) -> None:
        leave_trace(self.name, "tick", self.clock.tick)
        for begun in list(self.lift.open):
            if self.clock.tick >= self.until[begun.sender, begun.sequence]:
                begun.done()
        while len(self.lift.open) < self.config.at_once and (command := self.lift.take()):
            if command.value.height_m > 100.0:
                command.reject("too high")
                continue
            lifted = self.lifted.value
            lifted.sender, lifted.sequence, lifted.height_m = command.sender, command.sequence, command.value.height_m
            self.lifted.write()
            if command.value.height_m < 0.0:
                command.fail("there is a floor")
                continue
            command.accept()
            self.until[command.sender, command.sequence] = self.clock.tick + self.config.ticks


class Adder(Component):
    """Answers requests for sums."""

    stage = "worldstate"
    reaches_outside = False
    clock: Clock
    sum: Serves[sum_request_t, sum_t]

    def init(self) -> None:
        leave_trace(self.name, "pid", os.getpid())

    def loop(self) -> None:
        leave_trace(self.name, "tick", self.clock.tick)
        for request in self.sum:
            if request.value.n == 0:
                request.reject("nothing to add up")
                continue
            request.reply.sum = sum(request.value.numbers)
            request.done()


class WorkerConfig(Config):
    timeout_s: float = 3.0
    """Timeout of a lift."""
    flood: int = 0
    """Commands of an iteration, instead of one now and then."""


class Worker(Component):
    """Requests sums and lifts at random, and counts the outcomes."""

    stage = "think"
    reaches_outside = False
    config: WorkerConfig
    clock: Clock
    rng: np.random.Generator
    lift: Calls[lift_t] = channel("r/lift")
    sum: Calls[sum_request_t, sum_t] = channel("r/sum")
    tally: Writes[tally_t]

    def init(self) -> None:
        leave_trace(self.name, "pid", os.getpid())
        self.futures: list[Call[acknowledgement_t] | Call[sum_t]] = []
        self.reasons: set[str] = set()

    def loop(self) -> None:
        leave_trace(self.name, "tick", self.clock.tick)
        tally = self.tally.value
        for future in [future for future in self.futures if future.finished]:
            self.futures.remove(future)
            tally.ended += 1
            tally.done += future.done
            if future.done and isinstance(future.reply, sum_t):
                tally.sum += future.reply.sum
            if not future.done:
                self.reasons.add(f"{future.state}: {future.reason}")
        for _ in range(self.config.flood or int(self.rng.integers(3))):
            self.lift.value.height_m = round(float(self.rng.uniform(-1.0, 5.0)), 3)
            self.futures.append(self.lift.call(timeout_s=self.config.timeout_s))
        if self.rng.random() < 0.7:
            self.sum.value.numbers = [int(each) for each in self.rng.integers(100, size=self.rng.integers(4))]
            self.futures.append(self.sum.call())
        tally.sent = tally.ended + len(self.futures)
        tally.reasons = sorted(self.reasons)
        self.tally.write()
