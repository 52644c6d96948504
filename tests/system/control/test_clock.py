"""The clock of a real run is paused, stepped and set to other speeds without a change to any message."""

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from fwk.control.client import RefusedError
from fwk.recording.compare import Comparison
from tests.harness.logs import Recording
from tests.harness.runs import PortBlock
from tests.programs.control_system import Steered, write_system

pytestmark = pytest.mark.system

Start = Callable[..., Steered]


@pytest.fixture
def start(tmp_path: Path, ports: PortBlock, launch: Callable[..., object]) -> Start:
    write_system(tmp_path, ports)
    return lambda *arguments: Steered(launch("small.yaml", *arguments), ports)  # type: ignore[arg-type]


def test_pause_step_and_speed_leave_messages_unchanged(start: Start, tmp_path: Path) -> None:
    run = start("--speed", "0.2")
    said = run.json("pause")
    tick = said["tick"]
    assert said["paused"]
    assert f"paused after tick {tick};" in run.fwk("status")
    assert run.ask("pause")["tick"] == tick
    assert f"paused, tick {tick + 1}, " in run.fwk("step")
    assert run.json("step", "5")["tick"] == tick + 6
    assert run.tick == tick + 6
    assert run.json("speed") == {**said, "tick": tick + 6, "time_us": (tick + 6) * 50_000, "ok": True}
    run.ask("speed", speed=0.0)
    assert run.tick == tick + 6
    assert "running at speed max" in run.fwk("resume")
    run.ticks_pass(50)
    assert "is not a pace" in run.fwk("speed", "fast", code=2)
    assert "running at speed 3" in run.fwk("speed", "3")
    run.ask("step", ticks=2)
    assert run.ask("status")["paused"]
    ticks = run.tick
    steered = run.end()
    assert "asked to step 5 ticks" in run.launched.text
    plain = start("--ticks", str(ticks), "--speed", "max", "--record", "plain.lcm").launched
    assert plain.wait() == 0, plain.text
    compared = Comparison(tmp_path / "plain.lcm", steered, False)
    assert compared.difference is None
    assert compared.messages == 4 * ticks


def test_a_very_slow_run_can_be_sped_up_again(start: Start) -> None:
    run = start()
    assert "running at speed 1e-06" in run.fwk("speed", "1e-6")
    assert "is not a pace" in run.fwk("speed", "1e-9", code=2)
    for impossible in (1e-9, 1e30):
        with pytest.raises(RefusedError, match=r"1e-06 to 1e|less than or equal to 1000000"):
            run.ask("speed", speed=impossible)
    for typed in ("nan", "1e30", "-1", "0"):
        assert f"'{typed}' is not a duration" in run.fwk("stop", "r/counter", "--timeout", typed, code=2)
    tick = run.tick
    run.fwk("speed", "max")
    run.ticks_pass(5)
    assert run.tick > tick
    run.end()


def test_the_wall_clock_refuses_pause_step_and_speed(start: Start) -> None:
    run = start("--set", "clock=wall")
    asked = {
        ("pause",): "paused",
        ("resume",): "resumed",
        ("step", "2"): "stepped",
        ("speed", "2"): "run at another speed",
    }
    for words, what in asked.items():
        assert f"the wall clock cannot be {what}, and this run follows it" in run.fwk(*words, code=2)
    assert "running at speed" in run.fwk("speed")
    run.ticks_pass(2)
    run.end()


def test_a_paused_run_is_steered_and_the_recording_replays(start: Start) -> None:
    run = start()
    tick = run.ask("pause")["tick"]
    assert run.ask("set", changes=["r/counter.step=2"])["tick"] == tick + 1
    run.steer("restart", "r/counter")
    run.ask("set", changes=["r/counter.step=3"])
    run.steer("stop", "r/follower")
    states = {each["name"]: (each["state"], each["starts"]) for each in run.json("status")["components"]}
    assert (states["r/counter"], states["r/follower"]) == (("running", 2), ("stopped", 1))
    assert run.fwk("config", "get", "r/counter.step") == "3.0\n"
    assert run.tick == tick
    assert run.ask("step", ticks=3)["tick"] == tick + 3
    run.steer("start", "r/follower")
    run.ask("resume")
    run.ticks_pass()
    log = run.end()
    assert "equal: " in run.fwk("replay", "--verify", str(log.parent))
    recording = Recording(log)
    headings = {imu.header.tick: imu.heading_rad for imu in recording.decoded("r/imu")}
    assert (headings[tick], headings[tick + 1], headings[tick + 2]) == (float(tick), 3.0, 6.0)
    assert not {tick + 1, tick + 2, tick + 3} & {header.tick for header in recording.headers("r/pose")}
    changes = [(record.tick, each.number) for record in recording.records for each in record.settings]
    assert changes == [(tick + 1, 1), (tick + 1, 2)]


def test_the_wall_clock_refuses_the_control_of_time(start: Start, tmp_path: Path) -> None:
    file = tmp_path / "small.yaml"
    file.write_text(file.read_text() + "clock: wall\n")
    run = start()
    for words in (("pause",), ("resume",), ("step",), ("speed", "2")):
        assert "this run follows it; for a simulation set 'clock: simulated'" in run.fwk(*words, code=2)
    assert not json.loads(run.fwk("speed", "--json"))["paused"]
    for fields in ({"ticks": 0}, {"ticks": 1.5}, {"speed": -1}):
        with pytest.raises(RefusedError, match="not a request"):
            run.ask("step", **fields)
    run.ticks_pass()
    run.end()
