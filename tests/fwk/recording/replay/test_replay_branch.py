"""A branch in memory: state and sequence numbers continue; late, lost and absent participants are handled or named."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from pydantic import model_validator

from fwk import Clock, Component, Config, MainLoop, PluginControl, Reads, Writes
from fwk.cli.recordings.branch import BranchRequest, go_on_live
from fwk.lcm.messages import sequence_of
from fwk.model.plan import Plan
from fwk.model.tick_events import (
    FinalDone,
    HostLate,
    HostLost,
    HostStarted,
    HostStopped,
    MainLoopGiven,
    StageBegun,
    StageDone,
    TickEvent,
    events_of,
)
from fwk.recording.replay.branch import Branch
from fwk.recording.replay.other_classes import with_classes
from fwk.recording.replay.recording import Recording, RecordingError
from fwk.recording.replay.replay import Replay
from fwk.testing.plans import plan_of
from lcmtypes.core import tick_record_t
from lcmtypes.robot import imu_t
from lcmtypes.soccer import pose_t
from tests.fwk.recording.replay.replay_logs import PERIOD_US, HandMadeLog

SENSOR, COUNTER = 0, 1
ACQUIRE, THINK = 1, 5


class Sensor(Component):
    """Counts its iterations."""

    stage = "sensor_acquire"
    clock: Clock
    imu: Writes[imu_t]

    def loop(self) -> None:
        self.imu.value.heading_rad += 1.0
        self.imu.write()


class Counter(Component):
    """Sums up what it hears."""

    stage = "think"
    main_loop: MainLoop
    imu: Reads[imu_t]
    pose: Writes[pose_t]

    def loop(self) -> None:
        self.pose.value.heading_rad += sum(each.heading_rad for each in self.imu.fresh)
        self.pose.write()


class Doubling(Sensor):
    """Writes twice in each iteration."""

    def loop(self) -> None:
        super().loop()
        super().loop()


class Seldom(Sensor):
    """Iterates in every second tick."""

    every = 2


class Thinking(Sensor):
    """Iterates in another stage."""

    stage = "think"


class Continuous(Component):
    """Iterates at a rate of its own."""

    rate_hz = 10
    imu: Writes[imu_t]

    def loop(self) -> None:
        self.imu.write()


class Director(Sensor):
    """Stops the counter in its fourth iteration and starts it again in the sixth."""

    plugins: PluginControl

    def loop(self) -> None:
        super().loop()
        if self.clock.tick in (4, 6):
            (self.plugins.stop if self.clock.tick == 4 else self.plugins.start)("r/counter")


class Loud:
    """Sink of a branch that keeps everything."""

    def __init__(self) -> None:
        self.records: list[tick_record_t] = []
        self.messages: list[tuple[str, bytes, int]] = []

    def message(self, channel: str, data: bytes, time_us: int) -> None:
        if channel == "fwk/record":
            self.records.append(tick_record_t.decode(data))
        else:
            self.messages.append((channel, data, time_us))

    def tick(self) -> None:
        pass

    def close(self) -> None:
        pass

    def poses(self) -> list[tuple[int, float]]:
        """Returns sequence number and heading of the counter's messages."""
        found = [data for channel, data, _ in self.messages if channel == "r/pose"]
        return [(sequence_of(data), pose_t.decode(data).heading_rad) for data in found]


def plan() -> Plan:
    return plan_of({"r/sensor": Sensor, "r/counter": Counter})


def recorded(path: Path, ticks: int = 3, last: Callable[[list[TickEvent]], list[TickEvent]] = list) -> Recording:
    """A recording of some ticks; `last` changes the events of the last one."""
    log, total = HandMadeLog(path, plan()), 0.0
    for tick in range(1, ticks + 1):
        events: list[TickEvent] = [HostStarted(host, 1, 0) for host in (SENSOR, COUNTER)] if tick == 1 else []
        events += [StageBegun(ACQUIRE, ACQUIRE), StageDone(SENSOR, tick, ACQUIRE)]
        events += [StageBegun(THINK, THINK), StageDone(COUNTER, tick, THINK)]
        imu, pose = imu_t(), pose_t()
        total += tick
        imu.heading_rad, pose.heading_rad = float(tick), total
        log.message("r/imu", imu, "r/sensor", tick, ACQUIRE)
        changed = last(events) if tick == ticks else events
        if StageDone(COUNTER, tick, THINK) in changed:
            log.message("r/pose", pose, "r/counter", tick, THINK)
        log.tick(tick, changed)
    log.replayed()
    return Recording(path)


def branched(recording: Recording, to_tick: int = 3, until: int = 5) -> tuple[Branch, Loud]:
    """A branch after `to_tick`, and its messages."""
    branch, sink = Branch(recording), Loud()
    branch.run(to_tick)
    branch.check_state()
    branch.go_on(until, sink)
    return branch, sink


def test_state_numbers_and_time_continue(tmp_path: Path) -> None:
    branch, sink = branched(recorded(tmp_path / "log"))
    assert sink.poses() == [(4, 1.0 + 2 + 3 + 4), (5, 1.0 + 2 + 3 + 4 + 5)]
    assert [time_us for _, _, time_us in sink.messages[::2]] == [4 * PERIOD_US, 5 * PERIOD_US]
    stages = [StageBegun(ACQUIRE, ACQUIRE), StageDone(0, 4, ACQUIRE), StageBegun(THINK, THINK), StageDone(1, 4, THINK)]
    assert list(events_of(sink.records[0].events)) == stages
    assert (branch.absent, branch.differences) == ({}, [])


def test_numbers_of_another_class_have_no_gap(tmp_path: Path) -> None:
    recording = recorded(tmp_path / "log")
    with_classes(recording, {"r/sensor": f"{__name__}:Doubling"})
    branch, sink = Branch(recording, {"r/sensor": ""}), Loud()
    branch.run(3)
    branch.go_on(4, sink)
    numbers = [sequence_of(data) for channel, data, _ in sink.messages if channel == "r/imu"]
    assert numbers == [4, 5]
    assert sink.poses() == [(4, 1.0 + 2 + 3 + 7 + 8)]
    assert branch.differences == []


def imu_ticks(recording: Recording) -> list[int]:
    """The ticks in which a branch after tick 3 has messages of the sensor, up to tick 8."""
    branch, sink = Branch(recording, {"r/sensor": ""}), Loud()
    branch.run(3)
    branch.go_on(8, sink)
    return [time_us // PERIOD_US for channel, _, time_us in sink.messages if channel == "r/imu"]


def test_every_of_another_class_counts_in_the_branch(tmp_path: Path) -> None:
    recording = recorded(tmp_path / "log")
    with_classes(recording, {"r/sensor": f"{__name__}:Seldom"})
    assert imu_ticks(recording) == [4, 6, 8]


def test_every_of_the_launch_file_stays_with_another_class(tmp_path: Path) -> None:
    recording = recorded(tmp_path / "log")
    sensor, counter = recording.plan.components
    recording.plan = replace(recording.plan, components=(replace(sensor, every=4, offset=1), counter))
    with_classes(recording, {"r/sensor": f"{__name__}:Seldom"})
    assert imu_ticks(recording) == [5]


@pytest.mark.parametrize(("kind", "turns"), [("Thinking", "in think"), ("Continuous", "continuously")])
def test_another_class_of_other_stages_is_refused(tmp_path: Path, kind: str, turns: str) -> None:
    text = f"{kind}: it iterates {turns}, the component of the run in sensor_acquire; give the class"
    with pytest.raises(RecordingError, match=text):
        with_classes(recorded(tmp_path / "log"), {"r/sensor": f"{__name__}:{kind}"})


def test_stage_of_the_launch_file_stays_with_another_class(tmp_path: Path) -> None:
    recording = recorded(tmp_path / "log")
    sensor, counter = recording.plan.components
    recording.plan = replace(recording.plan, components=(replace(sensor, stages=(0,)), counter))
    with_classes(recording, {"r/sensor": f"{__name__}:Thinking"})
    assert recording.plan.components[0].stages == (0,)


def test_only_iterations_that_ran_are_counted(tmp_path: Path) -> None:
    recording = recorded(tmp_path / "log", ticks=5)
    with_classes(recording, {"r/sensor": f"{__name__}:Seldom"})
    replay = Replay(recording)
    replay.run()
    assert replay.iterations == 5 + 2


def test_a_late_iteration_ends_in_the_first_live_tick(tmp_path: Path) -> None:
    late = recorded(tmp_path / "log", last=lambda events: [*events[:-1], HostLate(COUNTER)])
    _, sink = branched(late)
    assert next(iter(events_of(sink.records[0].events))) == StageDone(COUNTER, 3, THINK)
    assert sink.poses() == [(3, 6.0), (4, 10.0), (5, 15.0)]


def test_a_host_that_leaves_finalizes_and_stays_absent(tmp_path: Path) -> None:
    branch, sink = branched(recorded(tmp_path / "log", last=lambda events: [*events, HostStopped(COUNTER)]))
    assert sink.poses() == []
    assert branch.absent == {"r/counter": "it did not run in tick 3"}
    lost, sink = branched(recorded(tmp_path / "lost", last=lambda events: [*events[:-2], HostLost(COUNTER)]))
    assert lost.absent == branch.absent
    assert all(channel == "r/imu" for channel, _, _ in sink.messages)


def test_requests_of_components_are_carried_out(tmp_path: Path) -> None:
    recording = recorded(tmp_path / "log")
    with_classes(recording, {"r/sensor": f"{__name__}:Director"})
    branch, sink = Branch(recording, {"r/sensor": ""}), Loud()
    branch.run(3)
    branch.check_state()
    branch.go_on(8, sink)
    events = {record.tick: list(events_of(record.events)) for record in sink.records}
    assert events[5][:3] == [HostStopped(COUNTER), FinalDone(COUNTER, 4), HostLost(COUNTER)]
    assert StageDone(COUNTER, 6, THINK) not in events[6]
    assert events[7][0] == HostStarted(COUNTER, 2, 0)
    assert sink.poses() == [(4, 10.0), (5, 7.0), (6, 15.0)], "a new incarnation begins anew with its numbers"
    assert (branch.absent, branch.decisions.participants.refused) == ({}, [])


@pytest.mark.parametrize("change", ["", "changed"])
def test_recorded_stops_happen_in_the_branch(tmp_path: Path, change: str) -> None:
    stopped: list[TickEvent] = [HostStopped(COUNTER), FinalDone(COUNTER, 3), HostLost(COUNTER)]
    recording = recorded(tmp_path / "log", 4, lambda events: [*stopped, *events[:2]])
    branch, sink = Branch(recording, {"r/sensor": change} if change else {}), Loud()
    branch.run(2)
    branch.check_state()
    branch.go_on(6, sink)
    assert [events_of(record.events)[:3] == stopped for record in sink.records] == [False, True, False, False]
    assert sink.poses() == [(3, 6.0)]


def test_a_main_loop_that_cannot_be_rebuilt_is_refused(tmp_path: Path) -> None:
    given = recorded(tmp_path / "log", last=lambda events: [MainLoopGiven(COUNTER), *events])
    branched(given, to_tick=2)
    with pytest.raises(RecordingError, match="cannot go on live after tick 3: in tick 3 the main loop passes to a"):
        branched(given)


class Limits(Config):
    least: int = 0
    most: int = 5

    @model_validator(mode="after")
    def _in_order(self) -> "Limits":
        if self.least > self.most:
            raise ValueError("least is more than most")
        return self


class Limited(Sensor):
    config: Limits


def test_settings_are_checked_without_a_replay(tmp_path: Path) -> None:
    log = HandMadeLog(tmp_path / "log", plan_of({"r/sensor": Limited}))
    for tick in (1, 2, 3):
        log.tick(tick, [], settings={SENSOR: {"least": 0, "most": 9}} if tick == 2 else None)
    log.replayed()
    branch = Branch(Recording(tmp_path / "log"))
    assert [new.values["least"] for new in branch.check(["r/sensor.least=7"], 2)] == [7]
    for sets, tick, reason in (
        ("r/sensor.leest=7", 2, "--set: r/sensor: no setting 'leest'; did you mean 'least'"),
        ("r/sensor.least=7", 1, "least is more than most"),
    ):
        with pytest.raises(RecordingError, match=reason):
            branch.check([sets], tick)


def test_a_wrong_setting_is_refused_before_the_replay(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    log, ran = recorded(tmp_path / "log"), []
    monkeypatch.setattr(Branch, "run", lambda *_: ran.append("replay"))
    with pytest.raises(RecordingError, match="no component 'r/sensors'; did you mean 'r/sensor'"):
        go_on_live(log, BranchRequest(2, None, ["r/sensors.gain=1"]), as_json=False)
    assert not ran
