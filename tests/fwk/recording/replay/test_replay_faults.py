"""Replay of faults of a run: late iterations that never ran, messages that a reader never got."""

import json
from collections.abc import Sequence
from pathlib import Path

import pytest

from fwk import Component, Config, Reads, Writes
from fwk.lcm.event_log import SYNC, LogError, LogWriter
from fwk.lcm.messages import encode
from fwk.model.plain_values import value_messages
from fwk.model.plan import Plan
from fwk.model.plan_document import document_of
from fwk.model.tick_events import (
    FinalDone,
    HostLate,
    HostLost,
    HostStarted,
    HostStopped,
    MessageLost,
    StageBegun,
    StageDone,
    TickEvent,
    events_message,
)
from fwk.recording.replay.recording import Recording
from fwk.recording.replay.replay import Replay
from fwk.testing.plans import plan_of
from lcmtypes.core import header_t, plan_t, protocol_t, settings_change_t, tick_record_t
from lcmtypes.robot import imu_t
from lcmtypes.soccer import pose_t

SENSOR, COUNTER = 0, 1  # components, their hosts and the channels that they write
ACQUIRE, THINK, ACT = 1, 5, 7
LATE = HostLate(COUNTER)
STOPPED = HostStopped(COUNTER)


class GainConfig(Config):
    gain: float = 1.0
    """Factor of what is heard."""


class Sensor(Component):
    """Counts its iterations."""

    stage = "sensor_acquire"
    imu: Writes[imu_t]

    def loop(self) -> None:
        self.imu.value.heading_rad += 1.0
        self.imu.write()


class Counter(Component):
    """Sums up what it hears; reports in `finalize` how often it ran and with which settings."""

    stage = "think"
    config: GainConfig
    imu: Reads[imu_t]
    pose: Writes[pose_t]

    def loop(self) -> None:
        self.pose.value.x_m += 1.0
        self.pose.value.heading_rad += self.config.gain * sum(each.heading_rad for each in self.imu.fresh)
        self.pose.write()

    def finalize(self) -> None:
        self.pose.value.y_m = self.config.gain
        self.pose.write()


class Idler(Component):
    """Does nothing, in a stage after the counter's."""

    stage = "act"

    def loop(self) -> None:
        pass


PLAN = plan_of({"r/sensor": Sensor, "r/counter": Counter})
SHARED = plan_of(
    {"r/sensor": Sensor, "r/counter": Counter, "r/idler": Idler}, groups=[["r/sensor"], ["r/counter", "r/idler"]]
)


class Made:
    """A log that is built tick by tick."""

    def __init__(self, path: Path, plan: Plan = PLAN) -> None:
        self.path = path
        self._log = LogWriter(path, print)
        self._tick = 0
        said = plan_t()
        said.version = protocol_t.VERSION
        said.json = json.dumps(document_of(plan))
        self._log.append("fwk/plan", said.encode(), 0)

    def sensed(self, number: int) -> None:
        """Adds the sensor's message of the next tick."""
        message = imu_t()
        message.heading_rad = float(number)
        self._write(message, "r/sensor", number, self._tick + 1, ACQUIRE)

    def counted(self, number: int, heading_rad: float, tick: int, stage: int = THINK, y_m: float = 0.0) -> None:
        """Adds the counter's message of a tick."""
        message = pose_t()
        message.x_m, message.y_m, message.heading_rad = float(number - (stage == header_t.FINAL)), y_m, heading_rad
        self._write(message, "r/counter", number, tick, stage)

    def counted_anew(self, number: int, heading_rad: float, tick: int) -> None:
        """Adds the first message of a restarted counter."""
        message = pose_t()
        message.x_m, message.heading_rad = 1.0, heading_rad
        self._write(message, "r/counter#2", number, tick, THINK)

    def tick(self, *events: TickEvent, marks: Sequence[int], gain: float = 0.0) -> None:
        """Adds a tick: the sensor runs, then these events follow; the counter is first sent `gain`."""
        self._tick += 1
        made = tick_record_t()
        made.version, made.tick, made.time_us = protocol_t.VERSION, self._tick, self._tick * 50_000
        began: list[TickEvent] = [HostStarted(host, 1, 0) for host in (SENSOR, COUNTER)] if self._tick == 1 else []
        sensed: list[TickEvent] = [stage(ACQUIRE), done(SENSOR, self._tick, ACQUIRE), stage(THINK)]
        first: list[TickEvent] = [event for event in events if isinstance(event, HostStopped)]
        rest: list[TickEvent] = [event for event in events if not isinstance(event, HostStopped)]
        made.events = events_message([*began, *first, *sensed, *rest])
        made.n_marks, made.channel, made.sequence = 2, [SENSOR, COUNTER], list(marks)
        if gain:
            change = settings_change_t()
            change.component, change.number, change.values = COUNTER, 1, value_messages({"gain": gain})
            made.settings = [change]
        self._log.append("fwk/record", encode(made, "fwk/record"), made.time_us)

    def replayed(self, *only: str) -> Replay:
        """Returns the replay of the log."""
        self._log.close()
        made = Replay(Recording(self.path), only)
        made.run()
        return made

    def _write(self, message: imu_t | pose_t, writer: str, number: int, tick: int, where: int) -> None:
        header = message.header
        header.tick, header.stage, header.sequence, header.writer = tick, where, number, writer
        header.time_us = tick * 50_000
        self._log.append("r/imu" if isinstance(message, imu_t) else "r/pose", message.encode(), 0)


def stage(index: int) -> StageBegun:
    return StageBegun(index, index)


def done(host: int, tick: int, step: int) -> StageDone:
    return StageDone(host, tick, step)


def missed(number: int) -> MessageLost:
    """Adds the loss of that sensor message to the counter."""
    return MessageLost(COUNTER, SENSOR, number)


def differences(replay: Replay) -> list[str]:
    return [str(each) for each in replay.differences]


def test_late_iteration_that_never_ran_is_not_replayed(tmp_path: Path) -> None:
    made = Made(tmp_path / "log.lcm")
    made.sensed(1)
    made.counted(1, 1.0, tick=1)
    made.tick(done(COUNTER, 1, THINK), marks=(1, 1))
    made.sensed(2)
    made.tick(LATE, marks=(2, 1))
    made.sensed(3)
    made.counted(2, 1.0, tick=1, stage=header_t.FINAL, y_m=1.0)  # it never received the settings that were sent with it
    made.tick(STOPPED, FinalDone(COUNTER, 1), marks=(3, 2), gain=5.0)
    assert differences(made.replayed()) == []


def test_late_iteration_has_the_inputs_and_settings_of_its_tick(tmp_path: Path) -> None:
    made = Made(tmp_path / "log.lcm")
    made.sensed(1)
    made.tick(LATE, marks=(1, 0))
    made.sensed(2)
    made.counted(1, 1.0, tick=1)
    made.counted(2, 11.0, tick=2)
    made.tick(done(COUNTER, 1, THINK), done(COUNTER, 2, THINK), marks=(2, 2), gain=5.0)
    assert differences(made.replayed()) == []


def test_a_message_lost_in_the_run_is_lost_in_replay(tmp_path: Path) -> None:
    made = Made(tmp_path / "log.lcm")
    made.sensed(1)
    made.counted(1, 0.0, tick=1)
    made.tick(missed(1), done(COUNTER, 1, THINK), marks=(1, 1))
    made.sensed(2)
    made.counted(2, 2.0, tick=2)
    made.tick(done(COUNTER, 2, THINK), marks=(2, 2))
    replay = made.replayed()
    assert differences(replay) == []
    assert replay.compared == 4


def started_anew(folder: Path, *never_got: TickEvent) -> Made:
    """Adds two ticks; in the second a restarted process has answered for another component."""
    made = Made(folder / "log.lcm", SHARED)
    made.sensed(1)
    made.counted(1, 1.0, tick=1)
    made.tick(done(COUNTER, 1, THINK), marks=(1, 1))
    made.sensed(2)
    lost, started = HostLost(COUNTER), HostStarted(COUNTER, 2, 0)
    made.tick(lost, started, stage(ACT), *never_got, done(COUNTER, 2, ACT), marks=(2, 1))
    return made


def test_newcomer_has_messages_that_its_process_lost(tmp_path: Path) -> None:
    """Its process is new in tick 2, the component in tick 3; the newest message between is lost."""
    made = started_anew(tmp_path)
    made.sensed(3)
    made.counted_anew(2, 2.0, tick=3)
    made.tick(missed(3), done(COUNTER, 3, THINK), marks=(3, 2))
    assert differences(made.replayed()) == []


def test_newest_message_lost_by_a_new_process_is_absent_there(tmp_path: Path) -> None:
    made = started_anew(tmp_path, missed(2))
    made.sensed(3)
    made.counted_anew(2, 3.0, tick=3)
    made.tick(done(COUNTER, 3, THINK), marks=(3, 2))
    assert differences(made.replayed()) == []


def test_messages_that_the_recording_lacks_are_written_again(tmp_path: Path) -> None:
    made = Made(tmp_path / "log.lcm")
    made.counted(1, 1.0, tick=1)
    made.tick(done(COUNTER, 1, THINK), marks=(1, 1))
    made.sensed(2)
    made.tick(done(COUNTER, 2, THINK), marks=(2, 2))
    made.counted(3, 3.0, tick=3)
    made.tick(done(COUNTER, 3, THINK), marks=(3, 3))
    replay = made.replayed()
    assert {channel: numbers for channel, numbers in replay.lost.items() if numbers} == {}
    assert differences(replay)[0].startswith("r/pose: tick 3")  # 1 and 2 and 3 are 6
    assert replay.compared == 3
    assert made.replayed("r/counter").lost == {"r/imu": {1, 3}, "r/pose": set()}


def test_a_log_cut_in_its_plan_is_called_cut_off(tmp_path: Path) -> None:
    (tmp_path / "log").write_bytes(SYNC + bytes(36))
    with pytest.raises(LogError, match="cut off within its first event; it has 40 bytes"):
        Recording(tmp_path / "log")
