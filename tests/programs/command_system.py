"""A small system with commands and requests: a lifter that carries out, a calculator that answers, two that want it.

What was carried out stands in what the lifter writes: each command once, in the order in which it was begun.
"""

from tests.programs.orchestra import WEATHER

TYPES = """
package lift;

struct lift_t {
  core.header_t header;
  core.command_t command;
  double height_m;
}

struct sum_request_t {
  core.header_t header;
  core.command_t command;
  int32_t n;
  int64_t numbers[n];
}

struct sum_t {
  core.header_t header;
  core.answer_t answer;
  int64_t sum;
}

struct lifted_t {
  core.header_t header;
  string  sender;
  int64_t sequence;
  double  height_m;
}

struct tally_t {
  core.header_t header;
  int64_t sent;
  int64_t done;
  int64_t ended;         // in whatever way
  int64_t sum;
  int32_t n;
  string  reasons[n];    // of those that were not done, each once
}
"""

PARTS = '''
"""Who lifts, who adds up, who wants it done."""

import os
import signal
from pathlib import Path

import numpy as np

import weather
from fwk import Calls, Clock, Commands, Component, Config, Sends, Serves, Writes, channel
from lcmtypes.lift import lift_t, lifted_t, sum_request_t, sum_t, tally_t


def leave_trace(name, kind, number):
    if Path("traces").is_dir():
        new = Path("traces", f"{name.replace('/', '_')}.{kind}.new")
        new.write_text(str(number))
        new.rename(new.with_suffix(""))


class LifterConfig(Config):
    at_once: int = 2
    """Most commands of an iteration."""
    ticks: int = 2
    """How long one takes."""


class Lifter(Component):
    """Lifts to the height that it is told, a few at a time; heights below zero it fails to reach."""

    stage = "act"
    config: LifterConfig
    clock: Clock
    lift: Commands[lift_t]
    lifted: Writes[lifted_t]

    def init(self):
        leave_trace(self.name, "pid", os.getpid())
        self.until = {}

    def loop(self):
        leave_trace(self.name, "tick", self.clock.tick)
        for command in list(self.lift.open):
            if self.clock.tick >= self.until[command.sender, command.sequence]:
                command.done()
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
    """Adds up what it is asked to."""

    stage = "worldstate"
    clock: Clock
    sum: Serves[sum_request_t, sum_t]

    def init(self):
        leave_trace(self.name, "pid", os.getpid())

    def loop(self):
        leave_trace(self.name, "tick", self.clock.tick)
        for request in self.sum:
            if request.value.n == 0:
                request.reject("nothing to add up")
                continue
            request.reply.sum = sum(request.value.numbers)
            request.done()


class WorkerConfig(Config):
    timeout_s: float = 3.0
    """How long it waits for a lift."""
    flood: int = 0
    """Commands of an iteration, instead of one now and then."""


class Worker(Component):
    """Wants sums and lifts, by chance, and counts what has become of them."""

    stage = "think"
    config: WorkerConfig
    clock: Clock
    rng: np.random.Generator
    lift: Sends[lift_t] = channel("r/lift")
    sum: Calls[sum_request_t, sum_t] = channel("r/sum")
    tally: Writes[tally_t]

    def init(self):
        leave_trace(self.name, "pid", os.getpid())
        self.futures = []
        self.reasons = set()

    def loop(self):
        leave_trace(self.name, "tick", self.clock.tick)
        tally = self.tally.value
        for future in [future for future in self.futures if future.finished]:
            self.futures.remove(future)
            tally.ended += 1
            tally.done += future.done
            if future.done and hasattr(future, "reply"):
                tally.sum += future.reply.sum
            if not future.done:
                self.reasons.add(f"{future.state}: {future.reason}")
        for _ in range(self.config.flood or int(self.rng.integers(3))):
            self.lift.value.height_m = round(float(self.rng.uniform(-1.0, 5.0)), 3)
            self.futures.append(self.lift.send(timeout_s=self.config.timeout_s))
        if self.rng.random() < 0.7:
            self.sum.value.numbers = [int(each) for each in self.rng.integers(100, size=self.rng.integers(4))]
            self.futures.append(self.sum.call())
        tally.sent = tally.ended + len(self.futures)
        tally.reasons = sorted(self.reasons)
        self.tally.write()
'''

LAUNCH = """
name: lift
speed: max
components:
  r/lifter: {{ use: "lift_parts:Lifter" }}
  r/adder: {{ use: "lift_parts:Adder" }}
  one/worker: {{ use: "lift_parts:Worker" }}
  two/worker: {{ use: "lift_parts:Worker" }}
public_url: "{public_url}"
"""


def command_system(public_url: str) -> dict[str, str]:
    """The files of a user's folder."""
    return {
        "lcmtypes/lift.lcm": TYPES,
        "lift_parts.py": PARTS,
        "weather.py": WEATHER,
        "launch/lift.yaml": LAUNCH.format(public_url=public_url),
    }
