"""Derives from the contract alone what every iteration must have seen; shares no code with the engine.

Visible to an iteration is every message whose done was taken before its stage began, and no other; in lockstep
these are the messages of all earlier (tick, stage). An iteration sees the messages that became visible since the last
iteration of its process. A component iterates in the ticks that `every` and `offset` select; in the others it takes
part without an iteration. The first iteration of a process that joins a run, and the first one after more than 16
ticks of absence, see only the newest message of each channel. Commands are taken out in the order of tick, stage,
sender and sequence.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from fwk.lcm.messages import Header
from fwk.model.service_channels import client_of
from lcmtypes.core import header_t
from tests.simulation.recorded import Log, Record

AWAY_TICKS = 16
Counts = dict[str, int]
"""Channel to the number of its newest visible message."""


@dataclass
class _Process:
    """Everything that a process of a host has seen so far."""

    incarnation: int
    seen: dict[str, Counts] = field(default_factory=dict)
    """By component: the messages visible to its newest iteration."""
    ticks: dict[str, int] = field(default_factory=dict)
    """By component: the tick of its newest iteration."""


def contradictions(log: Log) -> list[str]:
    """Returns every iteration that violates the contract, in words."""
    return list(_Oracle(log).findings())


class _Oracle:
    def __init__(self, log: Log) -> None:
        self._log = log
        plan = log.plan
        self._components = plan["components"]
        self._names = {each["name"]: each for each in self._components}
        self._lockstep = plan["clock"] == "simulated"
        self._channels = {each["index"]: each for each in plan["channels"]}
        self._written_by: dict[int, list[str]] = {}  # host to the channels of the plan that it writes
        for channel in plan["channels"]:
            if channel["writer"] >= 0:
                host = self._components[channel["writer"]]["host"]
                self._written_by.setdefault(host, []).append(channel["name"])
        self._holed = holed_channels(log)
        self._numbers: dict[tuple[str, int, int, int], list[int]] = {}  # channel, incarnation, tick, stage
        for name, messages in log.messages.items():
            for header, _ in messages:
                key = (name, _incarnation(header.writer), header.tick, header.stage)
                self._numbers.setdefault(key, []).append(header.sequence)
        self._taken: Counts = {}
        self._visible: Counts = {}
        self._at: dict[tuple[int, int], Counts] = {}  # tick, step of a stage: visible messages
        self._told: dict[int, Counts] = {}  # tick: messages announced to continuous components
        self._missed: set[tuple[int, str, int]] = set()  # host, channel, number
        self._incarnation: dict[int, int] = {}  # of each host
        self._stage_of: dict[tuple[int, int], int] = {}  # tick, step: index of the stage
        self._done: dict[int, list[tuple[int, int]]] = {}  # host to tick and step of each done of a stage

    def findings(self) -> Iterator[str]:
        """Goes through all records in order, then through all notes."""
        for record in self._log.records:
            yield from self._record(record)
        for name in self._names:
            yield from self._notes(name)

    def _record(self, record: Record) -> Iterator[str]:
        steps: list[tuple[int, int]] = []
        for kind, first, second, third in record.events:
            if kind == "done":
                self._take(first, second, third)
                self._done.setdefault(first, []).append((second, third))
            elif kind == "final":
                self._take(first, second, header_t.FINAL)
            elif kind == "outside":
                for channel in self._log.plan["channels"]:
                    if channel["writer"] < 0 and channel["index"] in record.marks:
                        self._taken[channel["name"]] = record.marks[channel["index"]]
            elif kind == "stage":
                self._visible = dict(self._taken)
                if (record.tick, second) in self._at:
                    yield f"tick {record.tick}: step {second} begins twice"
                self._at[record.tick, second] = self._visible
                self._stage_of[record.tick, second] = first
                steps.append((second, first))
            elif kind == "told":
                self._visible = dict(self._taken)
                self._told[record.tick] = self._visible
            elif kind == "missed" and second in self._channels:  # or it is a dynamic channel
                self._missed.add((first, self._channels[second]["name"], third))
            elif kind == "started":
                self._incarnation[first] = second
        if [step for step, _ in steps] != sorted(step for step, _ in steps):
            yield f"tick {record.tick}: its steps are out of order: {steps}"

    def _take(self, host: int, tick: int, stage: int) -> None:
        """Takes the done of a host."""
        for channel in self._written_by.get(host, ()):
            incarnation = self._incarnation.get(host, 0)
            if stage == header_t.FINAL:  # a process may have been stopped before it joined the run
                known = [each for name, each, at, step in self._numbers if (name, at, step) == (channel, tick, stage)]
                later = [
                    each
                    for each in known
                    if self._numbers[channel, each, tick, stage][-1] > self._taken.get(channel, 0)
                ]
                incarnation = min(later, default=incarnation)
            for number in self._numbers.get((channel, incarnation, tick, stage), ()):
                self._taken[channel] = max(number, self._taken.get(channel, 0))

    def _notes(self, name: str) -> Iterator[str]:
        component = self._names[name]
        host, continuous = component["host"], component["rate_hz"] is not None
        namespace = name.rpartition("/")[0]
        channel = f"{namespace}/note"
        process = _Process(0)
        iterations = 0
        newest, before = (0, 0), 0
        queue = _Queue(self._log, name)
        for (header, _), note in zip(
            self._log.messages.get(channel, []), self._log.decoded.get(channel, []), strict=True
        ):
            incarnation = _incarnation(header.writer)
            where = f"{header.writer} in tick {header.tick}, stage {header.stage}"
            if header.stage == header_t.FINAL:
                continue
            unknown = channel in self._holed and header.sequence != before + 1  # an earlier iteration is not recorded
            before = header.sequence
            if incarnation != process.incarnation:
                process, iterations = _Process(incarnation), 0
                queue.restarted()
            elif (header.tick, header.stage) <= newest:
                yield f"{where}: runs after tick {newest[0]}, stage {newest[1]}"
            if header.tick % component["every"] != component["offset"] % component["every"]:
                yield f"{where}: is not due in this tick"
            newest = (header.tick, header.stage)
            iterations += 1
            if unknown:
                iterations = note.iteration
            elif note.iteration != iterations:
                yield f"{where}: iteration {note.iteration} of its process, not {iterations}"
                iterations = note.iteration
            visible = self._told.get(header.tick) if continuous else self._at.get((header.tick, header.stage))
            if visible is None:
                yield f"{where}: runs in a stage that never began"
                continue
            if not unknown:
                yield from self._seen(where, name, host, process, header, note, visible)
            process.seen[name], process.ticks[name] = visible, header.tick
            yield from queue.iteration(where, header, note, visible)

    def _seen(
        self,
        where: str,
        name: str,
        host: int,
        process: _Process,
        header: Header,
        note: Any,
        visible: Counts,
    ) -> Iterator[str]:
        before = process.seen.get(name)
        continuous = self._names[name]["rate_hz"] is not None
        alone = self._joins(name, process, header.tick)
        for channel, heard in zip(self._heard(name), note.heard, strict=True):
            if channel in self._holed:
                continue
            after = (before or {}).get(channel, 0)
            last = visible.get(channel, 0)
            numbers = [number for number in range(after + 1, last + 1) if (host, channel, number) not in self._missed]
            if alone:
                numbers = numbers[-1:]
            right = (len(numbers), numbers[0], numbers[-1]) if numbers else (0, 0, 0)
            found = (heard.count, heard.first, heard.last)
            if found != right:
                yield f"{where}: heard of {channel} messages {found}, not {right} (count, first, last)"
            if numbers and heard.newest != numbers[-1]:
                yield f"{where}: newest of {channel} is {heard.newest}, not {numbers[-1]}"
            if self._lockstep and not continuous and numbers:
                yield from self._earlier(where, channel, header, numbers[-1])

    def _joins(self, name: str, process: _Process, tick: int) -> bool:
        """Returns whether an iteration is the first of a process that joins, or follows an absence of the component."""
        component = self._names[name]
        if name not in process.ticks and process.incarnation > 1:
            return True
        if component["rate_hz"] is not None:
            return name not in process.ticks and tick > 1
        last = process.ticks.get(name, 0)
        took_part = sorted(
            {
                at
                for at, step in self._done.get(component["host"], ())
                if last < at < tick and self._stage_of.get((at, step)) in component["stages"]
            }
        )
        newest = last or 1 - AWAY_TICKS  # in its first incarnation a component joins before tick 1
        for at in [*took_part, tick]:
            if at > newest + AWAY_TICKS:
                return True
            newest = at
        return False

    def _earlier(self, where: str, channel: str, header: Header, number: int) -> Iterator[str]:
        """Checks that the newest message seen in lockstep is of an earlier (tick, stage), whatever the records say."""
        for other, _ in self._log.messages.get(channel, []):
            late = other.stage != header_t.FINAL and (other.tick, other.stage) >= (header.tick, header.stage)
            if other.sequence == number and late and not self._is_continuous(other.writer):
                yield f"{where}: heard {channel} number {number} of tick {other.tick}, stage {other.stage}"

    def _is_continuous(self, writer: str) -> bool:
        component = self._names.get(writer.partition("#")[0])
        return component is None or component["rate_hz"] is not None

    def _heard(self, name: str) -> list[str]:
        """Returns the channels that a component reads, in the order of its notes."""
        channels = self._names[name]["channels"]
        return [
            *sorted(channels["notes"], key=_namespace),
            *sorted(channels["bursts"], key=_namespace),
            *channels.get("call", ()),
        ]


class _Queue:
    """The commands of one component, and the order in which the contract lets it take them out."""

    def __init__(self, log: Log, name: str) -> None:
        component = next(each for each in log.plan["components"] if each["name"] == name)
        self._sources: list[tuple[str, str, str]] = []  # kind, sender, channel
        for kind in ("order", "question"):
            channels = component["channels"].get(kind, ())
            if component["class_name"] == "Worker":
                self._sources += [(kind, client_of(one), one) for one in channels[1:]]
        self._log = log
        self._holed = holed_channels(log) & {channel for _, _, channel in self._sources}
        self._seen: Counts = {}
        self._waiting: dict[str, list[tuple[str, int]]] = {"order": [], "question": []}

    def restarted(self) -> None:
        """Forgets all earlier commands, as a new process does."""
        self._waiting = {"order": [], "question": []}

    def iteration(self, where: str, header: Header, note: Any, visible: Counts) -> Iterator[str]:
        """Checks which commands an iteration took out."""
        new: dict[str, list[tuple[int, int, str, int]]] = {"order": [], "question": []}
        for kind, sender, channel in self._sources:
            if channel in self._holed:
                continue
            last, before = visible.get(channel, 0), self._seen.get(channel, 0)
            for other, _ in self._log.messages.get(channel, []):
                if before < other.sequence <= last:
                    new[kind].append((other.tick, other.stage, sender, other.sequence))
            self._seen[channel] = last
        for kind, found in new.items():
            self._waiting[kind] += [(sender, number) for _, _, sender, number in sorted(found)]
        for taken in note.taken if not self._holed else ():
            waiting, command = self._waiting[taken.kind], (taken.sender, taken.sequence)
            if command not in waiting:
                yield f"{where}: took out {taken.kind} {command} again, too early, or out of order; next: {waiting[:3]}"
            else:
                del waiting[: waiting.index(command) + 1]


def holed_channels(log: Log) -> set[str]:
    """Returns the channels whose messages the recording lacks in part: their visibility is unknown."""
    channels = {each["index"]: each["name"] for each in log.plan["channels"]}
    marks = {
        channels[index]: mark for record in log.records for index, mark in record.marks.items() if index in channels
    }
    return {channel for channel, mark in marks.items() if len(log.messages.get(channel, ())) < mark}


def _incarnation(writer: str) -> int:
    return int(writer.partition("#")[2] or 1)


def _namespace(channel: str) -> str:
    return channel.rpartition("/")[0]
