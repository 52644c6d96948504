"""Commands on recordings show what a damaged log holds, or end with a sentence."""

import json
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as some
from typer.testing import CliRunner

from fwk import Component, Reads, Writes
from fwk.cli.commands import app as fwk
from fwk.lcm.event_log import LogError, LogReader, LogWriter
from fwk.model.plan_document import document_of
from fwk.model.tick_events import FrameLost, HostLost, HostStarted, StageBegun, StageDone, TickEvent, events_message
from fwk.recording.compare import Comparison
from fwk.recording.log_info import log_info
from fwk.recording.replay.recording import Recording, RecordingError
from fwk.recording.replay.replay import Replay
from fwk.testing import MemorySystem
from fwk.testing.plans import plan_of
from lcmtypes.core import plan_t, protocol_t, settings_change_t, tick_events_t, tick_record_t
from lcmtypes.robot import imu_t
from lcmtypes.soccer import pose_t
from tests.harness.fuzz import damaged

TICKS = 4
FIXTURE = settings(suppress_health_check=[HealthCheck.function_scoped_fixture])


class Sensor(Component):
    stage = "sensor_acquire"
    imu: Writes[imu_t]

    def loop(self) -> None:
        self.imu.value.heading_rad += 0.1
        self.imu.write()


class Thinker(Component):
    stage = "think"
    imu: Reads[imu_t]
    pose: Writes[pose_t]

    def loop(self) -> None:
        self.pose.value.heading_rad = self.imu.value.heading_rad
        self.pose.write()


PARTS: dict[str, type[Component]] = {"r/sensor": Sensor, "r/thinker": Thinker}


def recorded() -> list[tuple[str, bytes]]:
    """A recording of a run with all that the commands show."""
    plan, system = plan_of(PARTS), MemorySystem(PARTS)
    system.tick(TICKS)
    said = plan_t()
    said.version, said.json = protocol_t.VERSION, json.dumps(document_of(plan))
    made = [("fwk/plan", said.encode())]
    for tick in range(TICKS):
        made += [("r/imu", system.sent["r/imu"][tick]), ("r/pose", system.sent["r/pose"][tick])]
        made.append(("fwk/record", record(tick + 1, [1, 5]).encode()))
    return made


def record(tick: int, stages: list[int], *more: TickEvent) -> tick_record_t:
    made = tick_record_t()
    made.version, made.tick, made.time_us = protocol_t.VERSION, tick, tick * 50_000
    events: list[TickEvent] = [HostStarted(host, 1, 0) for host in range(2)] if tick == 1 else []
    for host, stage in enumerate(stages):
        events += [StageBegun(stage, 0), StageDone(host, tick, stage)]
    made.events = events_message([*events, *more])
    return made


def write(path: Path, entries: list[tuple[str, bytes]]) -> Path:
    with LogWriter(path, print) as log:
        for channel, data in entries:
            log.append(channel, data, 0)
    return path


@pytest.fixture
def log(tmp_path: Path) -> Path:
    return write(tmp_path / "log.lcm", recorded())


def replay(path: Path) -> Replay:
    made = Replay(Recording(path))
    made.run()
    return made


def test_the_undamaged_recording_is_valid(log: Path) -> None:
    done = replay(log)
    assert (done.compared, done.differences) == (2 * TICKS, [])


USES: tuple[Callable[[Path, Path], object], ...] = (
    lambda broken, _: log_info(broken),
    lambda broken, log: Comparison(log, broken),
    lambda broken, log: Comparison(broken, log, common=True),
    lambda broken, _: replay(broken),
)


def use(broken: Path, log: Path) -> None:
    for each in USES:
        with suppress(LogError, RecordingError):
            each(broken, log)


@FIXTURE
@given(some.data())
def test_a_damaged_log_is_read_as_far_as_it_goes(log: Path, data: some.DataObject) -> None:
    broken = log.with_name("broken.lcm")
    broken.write_bytes(data.draw(damaged(log.read_bytes())))
    use(broken, log)


@FIXTURE
@given(some.data())
def test_a_log_of_damaged_messages_is_read_as_far_as_it_goes(log: Path, data: some.DataObject) -> None:
    entries = recorded()
    place = data.draw(some.integers(0, len(entries) - 1))
    entries[place] = (entries[place][0], data.draw(damaged(entries[place][1])))
    use(write(log.with_name("broken.lcm"), entries), log)


@FIXTURE
@given(some.binary(max_size=60), some.sampled_from(["fwk/plan", "fwk/record", "r/imu", "fwk/log", "fwk/status"]))
def test_any_bytes_are_allowed_on_any_channel_of_a_log(log: Path, junk: bytes, channel: str) -> None:
    entries = recorded()
    use(write(log.with_name("broken.lcm"), [*entries[:3], (channel, junk), *entries[3:]]), log)


PLAN = document_of(plan_of(PARTS))


@pytest.mark.parametrize("key", PLAN)
@pytest.mark.parametrize("value", [None, 3, "x", [], {}, [3], [{}], [[]]], ids=repr)
def test_a_plan_of_another_shape_is_read_or_refused(tmp_path: Path, key: str, value: Any) -> None:
    made = plan_t()
    made.json = json.dumps({**PLAN, key: value})
    path = write(tmp_path / "log.lcm", [("fwk/plan", made.encode())])
    with suppress(RecordingError):
        replay(path)


@pytest.mark.parametrize("text", ["", "null", "[]", "{}", "[" * 100_000, '{"components": 3}'])
def test_a_malformed_plan_is_named(tmp_path: Path, text: str) -> None:
    made = plan_t()
    made.version, made.json = protocol_t.VERSION, text
    with pytest.raises(RecordingError, match="its plan cannot be read"):
        replay(write(tmp_path / "log.lcm", [("fwk/plan", made.encode())]))


def test_a_record_of_an_unknown_host_is_refused_with_its_place(log: Path) -> None:
    change = settings_change_t()
    unknown, blind = record(9, [1, 5], HostLost(77)), record(9, [1, 5], FrameLost(0, 0, 1))  # not a camera
    strange, broken, short = (record(9, [1, 5]) for _ in range(3))
    strange.n_marks, strange.channel, strange.sequence = 1, [65_536], [1]
    broken.settings, broken.n_settings = [change], 1  # without values
    short.events.kind[0] = tick_events_t.FINAL_DONE  # an index beyond its list
    entries = [(each.channel, each.data) for each in LogReader(log)]
    for wrong in (unknown, blind, strange, broken, short):
        write(log, [*entries, ("fwk/record", wrong.encode())])
        with pytest.raises(RecordingError, match=f"event {len(entries)}, a record of the main loop"):
            replay(log)


def test_an_impossible_mark_is_refused_and_takes_no_memory(log: Path) -> None:
    entries = [(each.channel, each.data) for each in LogReader(log)]
    far = record(9, [1, 5])
    far.n_marks, far.channel, far.sequence = 1, [0], [1 << 60]
    write(log, [*entries, ("fwk/record", far.encode())])
    with pytest.raises(RecordingError, match=r"cannot have 1\d{18} messages in tick 9; .* --to-tick 8"):
        replay(log)


def test_an_impossible_message_is_refused_and_takes_no_memory(log: Path) -> None:
    entries = [(each.channel, each.data) for each in LogReader(log)]
    place = next(place for place, (channel, _) in enumerate(entries) if channel == "r/imu")
    data = bytearray(entries[place][1])
    data[16:24] = (1 << 60).to_bytes(8, "big")  # the sequence number in the header
    entries[place] = ("r/imu", bytes(data))
    with pytest.raises(RecordingError, match=r"r/imu cannot have message 1\d{18} in tick 1; .* --to-tick 0"):
        replay(write(log, entries))


def test_a_component_failing_in_replay_is_named_with_its_place(log: Path) -> None:
    entries = [(each.channel, each.data) for each in LogReader(log)]
    cut = [(channel, data[:50] if channel == "r/imu" else data) for channel, data in entries]
    with pytest.raises(RecordingError, match=r"r/thinker fails in tick 1, .*(?s:.*)in loop"):
        replay(write(log, cut))


def test_a_truncated_log_is_replayed_to_its_end_and_reported(log: Path) -> None:
    cut = log.with_name("cut.lcm")
    cut.write_bytes(log.read_bytes()[:-10])
    shown = CliRunner().invoke(fwk, ["replay", str(cut), "--verify"])
    assert shown.exit_code == 0
    assert "cut off: its last" in shown.output
    assert "equal" in shown.output


def test_a_log_that_lacks_messages_is_replayed_up_to_the_gap(log: Path) -> None:
    whole = log.read_bytes()
    at = whole.index(b"r/pose", whole.index(b"fwk/record", whole.index(b"fwk/record") + 1))
    damaged_log = log.with_name("damaged.lcm")
    damaged_log.write_bytes(whole[: at - 28] + bytes(60) + whole[at + 32 :])
    with pytest.raises(RecordingError, match=r"missing after tick 2: \d+ bytes are damaged.* --to-tick 2"):
        replay(damaged_log)
    before = Replay(Recording(damaged_log))
    before.run(to_tick=2)
    assert (before.compared, before.differences) == (4, [])


def test_a_type_changed_since_the_recording_is_named(log: Path) -> None:
    entries = recorded()
    other = [(channel, b"12345678" + data[8:] if channel == "r/pose" else data) for channel, data in entries]
    write(log, other)
    with pytest.raises(RecordingError, match=r"r/pose has a message that is not a soccer\.pose_t as it is now"):
        replay(log)
    sensor = Replay(Recording(log), ["r/sensor"])
    sensor.run()
    assert (sensor.compared, sensor.differences) == (TICKS, [])


def test_a_record_of_another_version_is_named(log: Path) -> None:
    entries = [(channel, b"12345678" + data[8:] if channel == "fwk/record" else data) for channel, data in recorded()]
    with pytest.raises(RecordingError, match=r"fwk/record has a message that is not a core\.tick_record_t as it is"):
        replay(write(log, entries))


def test_a_component_that_no_longer_exists_is_named(log: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(f"{__name__}.Thinker")
    with pytest.raises(RecordingError, match=r"r/thinker: .*:Thinker cannot be imported any more: AttributeError"):
        Replay(Recording(log), ["r/thinker"])
