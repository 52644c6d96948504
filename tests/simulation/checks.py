"""The promises that every history is checked against."""

import dataclasses
import shutil
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from random import Random

from fwk.lcm.messages import Header
from fwk.model.plan import NOBODY
from fwk.recording.replay.branch import Branch
from fwk.recording.replay.recording import Recording, RecordingError
from fwk.recording.replay.replay import Replay
from tests.simulation.oracle import contradictions
from tests.simulation.recorded import Log
from tests.simulation.scenario import Hosting, Scenario
from tests.simulation.system import Outcome, run
from tests.simulation.trace import Trace, message_words

_HOSTINGS: tuple[Hosting, ...] = ("process", "robot", "single", "mixed")
_SAID_MAX = 5


@dataclass(frozen=True)
class Failure:
    """A promise that a history breaks."""

    promise: str
    """The promise in a word: stuck, error, oracle, single, lost, settings, replay, branch, faults, hosting, end."""
    text: str

    def __str__(self) -> str:
        return f"{self.promise}: {self.text}"


@dataclass(frozen=True)
class Verdict:
    """Result of the histories of one scenario."""

    failures: tuple[Failure, ...]
    runs: int
    ticks: int
    wall_us: int
    events: int


def verdict_of(scenario: Scenario) -> Verdict:
    """Runs a scenario with and without its faults, and replays it; returns the promises that it breaks."""
    folder = Path(tempfile.mkdtemp(prefix="fwk-simulate-", dir=_memory()))
    try:
        outcome = run(scenario, folder)
        outcomes = [outcome]
        failures = [*_alone(outcome, scenario)]
        if not failures and scenario.exact:
            failures += _compared(scenario, outcome, folder, outcomes)
    finally:
        shutil.rmtree(folder)
    return Verdict(
        tuple(failures),
        len(outcomes),
        sum(each.ticks for each in outcomes),
        sum(each.wall_us for each in outcomes),
        sum(each.events for each in outcomes),
    )


def trace_of(scenario: Scenario) -> Trace:
    """Runs a scenario and returns its events, step by step."""
    folder = Path(tempfile.mkdtemp(prefix="fwk-simulate-", dir=_memory()))
    trace = Trace(True)
    try:
        run(scenario, folder, trace)
    finally:
        shutil.rmtree(folder)
    return trace


def _memory() -> str | None:
    return "/dev/shm" if Path("/dev/shm").is_dir() else None


def _alone(outcome: Outcome, scenario: Scenario) -> Iterator[Failure]:
    """Checks one run by itself."""
    if outcome.errors:
        yield Failure("error", outcome.errors[0])
        return
    if outcome.stuck:
        yield Failure("stuck", outcome.stuck)
        return
    if outcome.failed and not scenario.may_fail:
        yield Failure("end", outcome.reason)
    log = outcome.log
    if found := contradictions(log):
        yield Failure("oracle", "\n".join(found[:_SAID_MAX]))
    yield from _single(outcome)
    yield from _lost(outcome, log, scenario)
    yield from _settings(outcome, log)
    yield from _replayed(outcome)
    yield from _branched(outcome, scenario)


def _single(outcome: Outcome) -> Iterator[Failure]:
    """No process runs an iteration twice."""
    seen = set()
    for iteration in outcome.iterations:
        if iteration in seen:
            process, component, tick, step = iteration
            yield Failure("single", f"{process} runs {component} twice in tick {tick}, step {step}")
            return
        seen.add(iteration)


def _lost(outcome: Outcome, log: Log, scenario: Scenario) -> Iterator[Failure]:
    """Every message that is not recorded is counted and named; without outside faults no message is lost."""
    channels = {each["index"]: each["name"] for each in log.plan["channels"]}
    marks = {channel: mark for record in log.records for channel, mark in record.marks.items()}
    missing = 0
    for index, mark in marks.items():
        if index in channels:
            here = {header.sequence for header, _ in log.messages.get(channels[index], [])}
            missing += sum(number not in here for number in range(1, mark + 1))
            doubled = len(log.messages.get(channels[index], [])) - len(here)
            if doubled:
                yield Failure("lost", f"{channels[index]}: {doubled} messages are recorded twice")
    if missing > outcome.lost:
        yield Failure("lost", f"{missing} messages are not in the recording, {outcome.lost} are counted as lost")
    if missing and not any("lost" in line.text for line in log.lines):
        yield Failure("lost", f"{missing} messages are lost and no line names them")
    if missing and scenario.exact:
        yield Failure("lost", f"{missing} messages are lost in a run that nothing from outside disturbed")
    if not outcome.failed and len(log.records) != outcome.ticks:
        yield Failure("lost", f"{len(log.records)} of {outcome.ticks} ticks are recorded")


def _settings(outcome: Outcome, log: Log) -> Iterator[Failure]:
    """An acknowledged setting is in force from then on, until a newer one is."""
    names = {each["name"]: each["index"] for each in log.plan["components"]}
    for name, value, tick in outcome.acknowledged:
        recorded = [(record.tick, new["tune"]) for record in log.records for who, new in record.settings
                    if who == names[name]]  # fmt: skip
        if log.records and tick <= log.records[-1].tick and not any(new == value for _, new in recorded):
            yield Failure("settings", f"{name}.tune = {value} was acknowledged in tick {tick} and is not recorded")
        for note in log.decoded.get(f"{name.rpartition('/')[0]}/note", []):
            if note.header.tick <= tick or note.header.stage >= 1000:
                continue
            newest = [new for at, new in recorded if at <= note.header.tick]
            if newest and note.tune not in [newest[-1], *[new for at, new in recorded if at >= note.header.tick]]:
                where = f"tick {note.header.tick}, stage {note.header.stage}"
                yield Failure("settings", f"{name} has tune {note.tune} in {where}, not {newest[-1]}")
                return


def _replayed(outcome: Outcome) -> Iterator[Failure]:
    """A replay of the recording writes the same bytes."""
    if not outcome.ticks:
        return
    try:
        replay = Replay(Recording(outcome.path))
        replay.run()
    except RecordingError as error:
        yield Failure("replay", str(error))
        return
    written = {channel.name for channel in replay.recording.plan.channels if channel.writer != NOBODY}
    recorded = sum(len(data) for name, data in outcome.log.messages.items() if name in written)
    if replay.differences:
        yield Failure("replay", str(min(replay.differences, key=lambda difference: difference.key)))
    elif replay.compared < recorded:
        yield Failure("replay", f"{replay.compared} of {recorded} messages were compared")


def _branched(outcome: Outcome, scenario: Scenario) -> Iterator[Failure]:
    """An unchanged branch of the recording continues with the same messages."""
    if outcome.ticks < 2:
        return
    tick, sink = Random(scenario.seed).randrange(1, outcome.ticks), _Kept()
    branch = Branch(Recording(outcome.path))
    try:
        branch.run(tick)
        branch.check_state()
        branch.go_on(outcome.ticks, sink)
    except RecordingError as error:
        yield Failure("branch", f"after tick {tick}: {error}")
        return
    begin, end = _marks_at(outcome.log, tick), _marks_at(outcome.log, outcome.ticks)
    for channel, messages in outcome.log.messages.items():
        if channel not in end:  # a dynamic one
            continue
        visible = range(begin.get(channel, 0) + 1, end[channel] + 1)
        expected = {header.sequence: data for header, data in messages if header.sequence in visible}
        written = {Header.of(data).sequence: data for data in sink.messages.get(channel, [])}
        lost = set(visible) - expected.keys()  # on the way to the recording
        written = {number: data for number, data in written.items() if number not in lost}
        if written != expected:
            number = next(each for each in visible if written.get(each) != expected.get(each))
            one, other = written.get(number), expected.get(number)
            words = [message_words(channel, each) if each else "nothing" for each in (one, other)]
            yield Failure("branch", f"after tick {tick}: {words[0]} instead of {words[1]}")
            return


def _marks_at(log: Log, tick: int) -> dict[str, int]:
    """Returns the newest visible message of each channel of the plan at the end of a tick."""
    names = {each["index"]: each["name"] for each in log.plan["channels"]}
    found: dict[str, int] = {}
    for record in log.records:
        if record.tick <= tick:
            found |= {names[index]: mark for index, mark in record.marks.items() if index in names}
    return found


class _Kept:
    """Sink that keeps the messages by channel."""

    def __init__(self) -> None:
        self.messages: dict[str, list[bytes]] = {}

    def message(self, channel: str, data: bytes, _time_us: int) -> None:
        """Keeps a message."""
        self.messages.setdefault(channel, []).append(data)

    def tick(self) -> None:
        """Does nothing."""

    def close(self) -> None:
        """Does nothing."""


def _compared(scenario: Scenario, outcome: Outcome, folder: Path, outcomes: list[Outcome]) -> Iterator[Failure]:
    """Compares a run with the same run without faults, and in other processes."""
    random = Random(scenario.seed)
    others: list[tuple[str, Scenario]] = []
    if not scenario.weather.calm or scenario.actions:
        others.append(("faults", scenario.calm()))
    if scenario.regroupable and random.random() < 0.4:
        hosting = random.choice([each for each in _HOSTINGS if each != scenario.hosting])
        others.append(("hosting", dataclasses.replace(scenario.calm(), hosting=hosting)))
    for promise, other in others:
        found = run(other, folder)
        outcomes.append(found)
        if found.errors or found.stuck:
            yield Failure("error" if found.errors else "stuck", f"{promise}: {found.errors or found.stuck}")
            return
        difference = _first_difference(outcome.log, found.log)
        if difference:
            against = "without faults" if promise == "faults" else f"with hosting '{other.hosting}'"
            yield Failure(promise, f"differs from the run {against}: {difference}")
            return


def _first_difference(here: Log, there: Log) -> str:
    for place, (one, other) in enumerate(zip(here.order, there.order, strict=False)):
        if one != other:
            return f"message {place}: {message_words(*one)} instead of {message_words(*other)}"
    if len(here.order) != len(there.order):
        return f"{len(here.order)} messages instead of {len(there.order)}"
    return ""
