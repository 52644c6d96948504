"""Types without a header: what readers inside a run see, and what is recorded and published outside."""

from pathlib import Path

import pytest

from fwk import Component, Each, Reads, Writes, channel
from fwk.gateway.unwrap import Unwrap
from fwk.lcm import envelope
from fwk.lcm.envelope import STAMP
from fwk.lcm.event_log import LogReader, LogWriter
from fwk.lcm.messages import Header, MessageError
from fwk.lcm.stamped_log import StampedLog
from fwk.recording.compare import compare
from fwk.recording.log_info import log_info
from fwk.testing import Bench, MemorySystem
from lcmtypes.core import header_t, stamp_t
from lcmtypes.robot import imu_t
from lcmtypes.soccer import obstacle_t

STICK, MOTORS = "STICK", "r/motor"


class Driver(Component):
    """A driver whose device type `obstacle_t` has no header."""

    stage = "think"
    stick: Reads[obstacle_t] = channel("/STICK", history=2)
    motor: Writes[obstacle_t]
    parts: Each[Writes[obstacle_t]]
    total: Writes[imu_t]

    def loop(self) -> None:
        self.motor.value.x_m = 2 * self.stick.value.x_m
        self.motor.write()
        for part in self.parts.values():
            part.value.x_m = self.stick.value.x_m
            part.write()
        self.total.value.heading_rad = sum(each.x_m for each in self.stick.history)
        self.total.value.yaw_rate_rad_s = self.stick.changed + 10 * self.stick.refreshed
        self.total.write()


class Listener(Component):
    stage = "act"
    parts: Each[Reads[obstacle_t]]
    one: Reads[obstacle_t] = channel("left/parts")


def obstacle(x_m: float) -> obstacle_t:
    made = obstacle_t()
    made.x_m = x_m
    return made


@pytest.fixture
def system() -> MemorySystem:
    return MemorySystem({"r/driver": Driver, "s/listener": Listener}, outside={STICK: obstacle_t})


def test_device_messages_pass_unchanged_in_both_directions(system: MemorySystem) -> None:
    system.come_in(STICK, obstacle(0.5))
    system.tick()
    assert system.newest(MOTORS).x_m == 1.0
    assert system.newest("left/parts").x_m == 0.5
    assert envelope.content(system.sent[STICK][0]) == obstacle(0.5).encode()
    reader = system.runners["r/driver"].component.stick  # type: ignore[attr-defined]
    header = reader.header
    assert (header.tick, header.stage, header.sequence, header.writer) == (1, -1, 1, "outside")
    stamp = Header.of(system.sent[MOTORS][0])
    assert (stamp.tick, stamp.stage, stamp.sequence, stamp.writer) == (1, 5, 1, "r/driver")
    assert stamp.time_us == system.now_us


@pytest.mark.parametrize(("sticks", "told"), [([0.0], 11), ([0.5], 11), ([0.5, 0.5], 10), ([0.5, 0.25], 11), ([], 0)])
def test_a_difference_in_any_byte_counts_as_a_change(sticks: list[float], told: float) -> None:
    bench = Bench(Driver)
    for x_m in sticks:
        bench.port("stick").put(x_m=x_m)
        bench.iterate()
    if not sticks:
        bench.iterate()
    assert bench.port("total").sent[-1].yaw_rate_rad_s == told
    assert bench.port("total").sent[-1].heading_rad == sum(sticks)


def test_the_bench_stamps_messages_without_a_header() -> None:
    bench, header = Bench(Driver), header_t()
    header.tick, header.time_us, header.writer = 7, 350_000, "outside"
    bench.port("stick").put(obstacle(1.0), header=header)
    bench.iterate()
    seen = bench.component.stick.header
    assert (seen.tick, seen.time_us, seen.writer, seen.sequence) == (7, 350_000, "outside", 1)


def test_a_value_that_a_field_cannot_hold_is_named() -> None:
    bench = Bench(Driver)
    bench.component.motor.value.y_m = "left"
    with pytest.raises(MessageError, match=r"robot/motor: cannot encode soccer\.obstacle_t: y_m is 'left'"):
        bench.iterate()


class Kept:
    """A sink that keeps what it is given."""

    def __init__(self) -> None:
        self.messages: list[tuple[str, bytes]] = []

    def message(self, channel: str, data: bytes, _time_us: int) -> None:
        self.messages.append((channel, data))

    def tick(self) -> None: ...

    def close(self) -> None: ...


def stamped(x_m: float, sequence: int, tick: int = 3, writer: str = "r/drivér#2") -> bytes:
    return envelope.wrapped(obstacle(x_m).encode(), tick, sequence, 50_000 * tick, 5, writer)


def test_outside_a_stamp_precedes_the_plain_message() -> None:
    kept = Kept()
    sink = Unwrap(kept, {MOTORS})
    imu = imu_t().encode()
    sink.message("r/imu", imu, 1)
    sink.message(MOTORS, stamped(0.5, 7), 1)
    assert kept.messages[0] == ("r/imu", imu)
    (_, stamp), plain = kept.messages[1:]
    assert kept.messages[1][0] == STAMP
    assert plain == (MOTORS, obstacle(0.5).encode())
    told = stamp_t.decode(stamp)
    header = told.header
    assert (told.channel, header.tick, header.sequence, header.time_us) == (MOTORS, 3, 7, 150_000)
    assert (header.stage, header.writer) == (5, "r/drivér#2")


def written(path: Path, made: list[bytes], without: int = -1) -> Path:
    """Returns a log of messages on MOTORS, with a foreign message between stamp and message."""
    kept = Kept()
    sink = Unwrap(kept, {MOTORS})
    for data in made:
        sink.message(MOTORS, data, 0)
    with LogWriter(path, pytest.fail) as log:
        for number, (channel, data) in enumerate(kept.messages):
            if number != 2 * without:
                log.append(channel, data, number)
                log.append("fwk/other", b"", number)
    return path


MADE = [stamped(0.5, 1), stamped(0.5, 2), stamped(0.75, 3)]


def test_a_log_gives_back_the_messages_of_the_run(tmp_path: Path) -> None:
    log = written(tmp_path / "log", MADE)
    assert [event.data for event in StampedLog(log) if event.channel == MOTORS] == MADE
    assert [event.data for event in LogReader(log) if event.channel == MOTORS] == [envelope.content(m) for m in MADE]
    info = log_info(log).channels[MOTORS]
    assert (info.types, info.writers, info.lost) == (["soccer.obstacle_t"], ["r/drivér#2"], 0)


@pytest.mark.parametrize(
    ("other", "said"),
    [
        pytest.param(MADE, "None", id="nothing"),
        pytest.param([*MADE[:2], stamped(0.5, 3)], "message 3 by r/drivér#2: x_m is 0.75 in A, 0.5 in B", id="content"),
        pytest.param([*MADE[:2], stamped(0.75, 3, writer="r")], "header.writer is 'r/drivér#2' in A, 'r' in B", id="w"),
        pytest.param(
            [*MADE[:2], stamped(0.75, 3, tick=4)], "message 3 by r/drivér#2: header.tick is 3 in A", id="tick"
        ),
        pytest.param(MADE[:2], "tick 3, stage 5, message 3 by r/drivér#2: there in A, missing in B", id="missing"),
        pytest.param(MADE[::2], "message 2 by r/drivér#2: there in A, missing in B", id="missing between"),
    ],
)
def test_logs_are_compared_with_stamps_and_bytes(tmp_path: Path, other: list[bytes], said: str) -> None:
    found = str(compare(written(tmp_path / "A", MADE), written(tmp_path / "B", other)))
    assert said in found
    assert found == "None" or found.startswith(f"{MOTORS}: tick 3, stage 5, ")


def test_a_missing_stamp_is_a_difference(tmp_path: Path) -> None:
    whole, lacking = written(tmp_path / "A", MADE), written(tmp_path / "B", MADE, without=1)
    assert "message 2 by r/drivér#2: its stamp is there in A, missing in B" in str(compare(whole, lacking))
    assert "message 2 by r/drivér#2: its stamp is missing in B, there in A" in str(compare(lacking, whole))


def test_after_damage_no_message_gets_the_stamp_of_another(tmp_path: Path) -> None:
    log = written(tmp_path / "log", MADE)
    whole = log.read_bytes()
    messages = [envelope.content(data) for data in MADE]
    first = whole.index(messages[0])
    second_stamp = whole.index(b"fwk/stamp", first)
    log.write_bytes(whole[: first - 10] + b"?" * (second_stamp - first) + whole[second_stamp:])
    found = [event.data for event in StampedLog(log) if event.channel == MOTORS]
    assert found == [messages[1], MADE[2]]
