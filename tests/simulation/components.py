"""Generic components: each sends a digest of everything that it sees."""

import zlib
from functools import partial
from typing import Any, ClassVar

import numpy as np
from lcmtypes.simulation import burst_t, call_t, heard_t, note_t, order_t, question_t, reply_t, rumour_t, taken_t

from fwk import (
    Blackboard,
    Calls,
    Clock,
    Component,
    Config,
    Each,
    MainLoop,
    PluginControl,
    Reads,
    Serves,
    TimeSource,
    Writes,
    channel,
)
from fwk.lcm.messages import sequence_of
from tests.simulation.machine import machine

CALLS = "outside/call"
"""The channel that programs outside write."""
STAGES: tuple[str, ...] = ("sense", "plan", "think", "act", "tidy")
"""Stages of simulated systems; a plan has some of them, in this order."""
RUMOURS = 2
"""Channels that components open at run time: `rumour/r0` and so on."""


class SimulatedCrashError(Exception):
    """A component fails, as its settings demand."""


class PlayerConfig(Config):
    """Actions of a player besides hearing all others."""

    tune: int = 0
    """Part of every note: shows which settings were in force."""
    work_us: int = 0
    """Longest wall time of an iteration."""
    bursts: int = 1
    """Most messages of an iteration besides the note."""
    ballast: int = 0
    """Bytes of the largest burst."""
    crash_tick: int = 0
    """Tick in which the component fails, once; 0: none."""
    crash_in: str = "loop"
    """Function in which the component fails: init, loop or finalize; again: in a further iteration of a tick."""
    eager: float = 0.3
    """Probability of a request in an iteration."""
    early: bool = False
    """Whether the component writes in `init`."""


class Player(Component):
    """Reads all other components and writes down what it read."""

    stage: ClassVar[str | tuple[str, ...]] = "think"

    config: PlayerConfig
    clock: Clock
    rng: np.random.Generator
    notes: Each[Reads[note_t]] = channel("*/note")
    bursts: Each[Reads[burst_t]] = channel("*/burst")
    note: Writes[note_t]
    burst: Writes[burst_t]

    def init(self) -> None:
        self.asked = ""
        self.tick = 0
        self.crash("init")
        if self.config.early:
            self.burst.value.number = -1
            self.burst.write()

    def loop(self) -> None:
        machine.iterations.append((machine.process(), self.name, self.clock.tick, self.note_place))
        if self.config.work_us:
            machine.work(int(self.rng.integers(self.config.work_us + 1)))
        note = self.note.value
        note.iteration += 1
        note.tune = self.config.tune
        note.asked, self.asked = "", ""
        note.step = STAGES.index(self.clock.stage) if self.clock.stage else -1
        note.heard, note.told, note.taken = [], [], []
        digest = note.digest & 0xFFFFFFFF
        for reader in self.heard_by():
            note.heard.append(heard_of(reader))
            for data in raw_of(reader):
                digest = zlib.crc32(data, digest)
        self.act()
        note.asked = self.asked
        for text in note.told:
            digest = zlib.crc32(text.encode(), digest)
        note.digest = digest
        for _ in range(int(self.rng.integers(self.config.bursts + 1)) if self.config.bursts else 0):
            self.burst.value.number += 1
            self.burst.value.ballast = self.rng.bytes(int(self.rng.integers(self.config.ballast + 1)))
            self.burst.write()
        self.note.write()
        if self.clock.tick >= self.config.crash_tick > 0:
            self.crash("loop")
            if self.tick == self.clock.tick:
                self.crash("again")
        self.tick = self.clock.tick

    def finalize(self) -> None:
        self.note.value.told = ["farewell"]
        self.note.value.heard, self.note.value.taken = [], []
        self.note.write()
        self.crash("finalize")

    @property
    def note_place(self) -> int:
        """Returns the position of the running iteration in its tick, as in headers."""
        return self.note._stamp.stage

    def heard_by(self) -> list[Reads[Any]]:
        """Returns every reader of the component, in a fixed order."""
        return [*self.notes.values(), *self.bursts.values()]

    def act(self) -> None:
        """Performs the action of this kind of component."""

    def tell(self, text: str) -> None:
        """Adds to the inputs that this iteration saw."""
        self.note.value.told.append(text)

    def moved(self) -> bool:
        """Returns whether the component sends a request in this iteration."""
        return bool(self.rng.random() < self.config.eager)

    def crash(self, where: str) -> None:
        """Fails if the settings demand it, once in a run.

        Raises:
            SimulatedCrashError: the settings demand it here.
        """
        if self.config.crash_in == where and self.config.crash_tick and machine.once(f"{self.name} {where}"):
            raise SimulatedCrashError(f"{self.name} fails in {where}")


class Drifter(Player):
    """A continuous player."""

    stage = ()
    rate_hz = 50.0


class Conductor(Player):
    """Time source: sets the time of the next tick."""

    time_source: TimeSource

    def act(self) -> None:
        self.time_source.next_us = self.clock.now_us + int(self.rng.integers(20_000, 90_000))


class Boss(Player):
    """Gives orders to all workers and asks them questions."""

    order: Each[Calls[order_t]]
    question: Each[Calls[question_t, reply_t]]

    def init(self) -> None:
        super().init()
        self.futures: list[tuple[str, Any]] = []

    def act(self) -> None:
        self.tell(" ".join(f"{name}:{future.sequence}:{future.state}" for name, future in self.futures))
        self.futures = [(name, future) for name, future in self.futures if not future.finished]
        for name, orders in self.order.items():
            for _ in range(int(self.rng.integers(3)) if self.moved() else 0):
                orders.value.number += 1
                self.futures.append((name, orders.call(timeout_s=float(self.rng.choice([0.1, 1.0])))))
        for name, questions in self.question.items():
            if self.moved():
                questions.value.number += 1
                self.futures.append((name, questions.call(timeout_s=0.5)))


class Worker(Player):
    """Carries out orders and answers questions."""

    order: Serves[order_t]
    question: Serves[question_t, reply_t]

    def act(self) -> None:
        for command in list(self.order.open):
            if self.rng.random() < 0.5:
                command.done()
        while len(self.order) and self.rng.random() < 0.9:
            taken = self.order.take()
            assert taken
            self.note.value.taken.append(taken_of("order", taken))
            (taken.done, taken.accept, partial(taken.reject, "no"))[int(self.rng.integers(3))]()
        for request in self.question:
            self.note.value.taken.append(taken_of("question", request))
            request.reply.number = request.value.number * 2
            request.done()


class Usurper(Player):
    """Takes the main loop over and gives it back."""

    main_loop: MainLoop

    def act(self) -> None:
        self.tell(f"holder {self.main_loop.holder}")
        if self.main_loop.mine and self.rng.random() < 0.5:
            self.main_loop.give_back()
            self.asked = "-"
        elif self.moved():
            stages = self.main_loop.stages
            order = [stages[int(place)] for place in self.rng.integers(len(stages), size=int(self.rng.integers(1, 6)))]
            self.main_loop.take_over(order)
            self.asked = ",".join(order)


class Director(Player):
    """Stops, starts and replaces other components."""

    plugins: PluginControl

    def act(self) -> None:
        others = [name for name in self.plugins.components if name != self.name]
        if others and self.moved():
            action = str(self.rng.choice(["stop", "start", "restart", "load", "unload", "restart"]))
            name = str(self.rng.choice(others))
            getattr(self.plugins, action)(name)
            self.tell(f"asks to {action} {name}")


class Opener(Player):
    """Opens and closes channels during the run."""

    blackboard: Blackboard

    def init(self) -> None:
        super().init()
        self.opened: list[Any] = []
        self.number = 0
        self.at_init = self.seen()
        if self.moved():
            self.open()

    def seen(self) -> str:
        """Returns everything that the blackboard shows, as text."""
        views = [f"{view.name} {view.writer} {view.readers}" for view in self.blackboard.instances()]
        return f"{views} {[self.blackboard.has_writer(f'rumour/r{number}') for number in range(RUMOURS)]}"

    def open(self) -> None:
        """Opens a random channel in a random way."""
        name = f"rumour/r{int(self.rng.integers(RUMOURS))}"
        way = int(self.rng.integers(3))
        if way == 0:
            self.opened.append(self.blackboard.open_for_writing(rumour_t, name))
        elif way == 1:
            self.opened.append(self.blackboard.open_for_reading(rumour_t, name))
        else:
            self.opened.append(self.blackboard.open_multiple_for_reading(rumour_t, "rumour/*"))

    def act(self) -> None:
        self.tell(f"{self.at_init} {self.seen()} {[str(event) for event in self.blackboard.events]}")
        self.at_init = ""
        for handle in self.opened:
            self.use(handle)
        if len(self.opened) < 4 and self.moved():
            self.open()
        if self.opened and self.rng.random() < 0.15:
            handle = self.opened.pop(int(self.rng.integers(len(self.opened))))
            try:
                self.blackboard.close(handle)
            except ValueError as error:  # it was refused
                self.tell(str(error))

    def use(self, handle: Any) -> None:
        """Reads or writes the open channels."""
        if hasattr(handle, "write"):
            self.tell(f"{handle.channel} {handle.is_open} {handle.refused}")
            if handle.is_open and self.rng.random() < 0.8:
                self.number += 1
                handle.value.number = self.number
                handle.write()
            return
        for reader in [handle] if hasattr(handle, "fresh") else list(handle.values()):
            heard = heard_of(reader)
            digest = zlib.crc32(b"".join(raw_of(reader)))
            self.tell(f"{reader.channel} {heard.count} {heard.first} {heard.last} {heard.newest} {digest}")


class Rover(Opener):
    """Opens and closes channels at a rate of its own, which is slower than the ticks of some plans."""

    stage = ()
    rate_hz = 30.0


class Listener(Player):
    """Hears programs outside."""

    call: Reads[call_t] = channel(CALLS)

    def heard_by(self) -> list[Reads[Any]]:
        return [*super().heard_by(), self.call]


KINDS = {
    kind.__name__: kind
    for kind in (Player, Drifter, Conductor, Boss, Worker, Usurper, Director, Opener, Rover, Listener)
}
"""Every kind of component, by name."""


def taken_of(kind: str, command: Any) -> taken_t:
    """Returns the identity of a command."""
    made = taken_t()
    made.kind, made.sender, made.sequence = kind, command.sender, command.sequence
    return made


def raw_of(reader: Reads[Any]) -> list[bytes]:
    """Returns the messages that are new for this iteration, and the newest one, as sent."""
    return [*reader._fresh, reader._raw or b""]


def heard_of(reader: Reads[Any]) -> heard_t:
    """Returns what an iteration saw of a channel."""
    made = heard_t()
    fresh = reader._fresh
    made.count = len(fresh)
    made.newest = reader.header.sequence
    if fresh:
        made.first, made.last = sequence_of(fresh[0]), sequence_of(fresh[-1])
    return made
