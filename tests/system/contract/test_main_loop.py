"""A component of a real run takes the main loop over and gives it back; the recording replays."""

import re
from pathlib import Path

import pytest

from fwk.model.tick_events import StageBegun, events_of
from tests.harness.components import sources
from tests.harness.fixtures import Launch
from tests.harness.logs import Recording, difference
from tests.harness.runs import PortBlock, replayed, write_files
from tests.programs.control_system import Steered

pytestmark = pytest.mark.system

LAUNCH = """
name: taken
public_url: {url}
speed: max
components:
  a/driver: {{use: "taken:Driver"}}
  b/driver: {{use: "taken:Driver", stage: [act, post_loop], config: {{first: 8, last: 30}}}}
  c/player: {{use: "taken:Player", stage: sensor_acquire}}
  d/player: {{use: "taken:Player"}}
  e/player: {{use: "taken:Player", stage: worldstate}}
"""
STAGES = ("pre_loop", "sensor_acquire", "sensor_prepare", "sensor_process", "worldstate", "think", "skill", "act")
USUAL = ["sensor_acquire", "worldstate", "think", "act", "post_loop"]
TAKEN = ["act", "think", "act", "act", "sensor_acquire"]


@pytest.fixture
def taken(tmp_path: Path, ports: PortBlock) -> Path:
    write_files(tmp_path, {**sources("taken.py"), "taken.yaml": LAUNCH.format(url=ports.public_url)})
    return tmp_path


def orders(recording: Recording) -> dict[int, list[str]]:
    """Returns the stages that each tick ran."""
    names = (*STAGES, "act_exec", "post_loop")
    return {
        record.tick: [names[event.stage] for event in events_of(record.events) if isinstance(event, StageBegun)]
        for record in recording.records
    }


def test_take_over_gives_the_same_in_all_layouts(launch: Launch, taken: Path) -> None:
    run = launch("taken.yaml", "--ticks", "60", "--record", "log.lcm")
    assert run.wait() == 0, run.text
    assert f"a/driver has the main loop from tick 6 on: {', '.join(TAKEN)}" in run.text
    assert run.text.count("b/driver wants the main loop, but a/driver has it; refused until that gives it back") == 3
    assert "a/driver has given the main loop back; tick 13 runs the usual stages" in run.text
    recording = Recording(taken / "log.lcm")
    assert orders(recording) == {tick: TAKEN if 6 <= tick <= 12 else USUAL for tick in range(1, 61)}
    assert recording.gaps() == {}
    places = [(header.tick, header.stage) for header in recording.headers("d/imu") if 5 <= header.tick <= 7]
    assert places == [(5, 7), (6, 0), (6, 2), (6, 3), (7, 0), (7, 2), (7, 3)]
    replayed(taken)
    for arguments in (("--hosting", "single"), ("--hosting", "robot"), ()):
        again = launch("taken.yaml", "--ticks", "60", "--record", "again.lcm", *arguments)
        assert again.wait() == 0, again.text
        assert difference(taken / "log.lcm", taken / "again.lcm") == ""
        replayed(taken, log="again.lcm")


def test_a_component_away_for_many_ticks_sees_the_newest(launch: Launch, taken: Path) -> None:
    sets = ("--set", "a/driver.last=400", "--set", "a/driver.order=[think, act]")
    run = launch("taken.yaml", "--ticks", "410", "--record", "log.lcm", *sets)
    assert run.wait() == 0, run.text
    assert "lost 0" in run.text
    recording = Recording(taken / "log.lcm")
    assert {header.tick for header in recording.headers("e/imu")} == {*range(1, 6), *range(401, 411)}
    replayed(taken)
    again = launch("taken.yaml", "--ticks", "410", "--record", "again.lcm", "--hosting", "single", *sets)
    assert again.wait() == 0, again.text
    assert difference(taken / "log.lcm", taken / "again.lcm") == ""


def test_a_killed_holder_gives_the_main_loop_back(launch: Launch, taken: Path) -> None:
    run = launch("taken.yaml", "--ticks", "40", "--record", "log.lcm", "--set", "a/driver.dies=9")
    assert run.wait() == 0, run.text
    assert "a/driver has given the main loop back; tick 10 runs the usual stages" in run.text
    recording = Recording(taken / "log.lcm")
    assert orders(recording)[9] == TAKEN
    assert orders(recording)[10] == USUAL
    assert recording.gaps() == {}
    replayed(taken)


def test_status_names_the_holder_and_stop_gives_the_loop_back(launch: Launch, taken: Path, ports: PortBlock) -> None:
    file = taken / "taken.yaml"
    file.write_text(file.read_text().replace("speed: max", "speed: 5"))
    run = Steered(launch("taken.yaml", "--set", "a/driver.last=0"), ports)
    run.launched.until("a/driver has the main loop")
    assert f"a/driver has the main loop: {', '.join(TAKEN)}" in run.fwk("status")
    run.ask("pause")
    run.steer("stop", "a/driver")
    assert run.ask("step")["paused"]
    assert run.json("status")["main_loop"] == ""
    assert re.search(r"a/driver has given the main loop back; tick \d+ runs the usual stages", run.launched.text)
    run.ask("resume")
    run.ticks_pass(20)
    log = run.end()
    replayed(taken, log=log)


def test_take_over_in_real_time(launch: Launch, taken: Path) -> None:
    file = taken / "taken.yaml"
    file.write_text(file.read_text().replace("speed: max", "clock: wall\nperiod_s: 0.02\nstage_time_s: 20"))
    run = launch("taken.yaml", "--ticks", "30", "--record", "log.lcm")
    assert run.wait() == 0, run.text
    recording = Recording(taken / "log.lcm")
    assert orders(recording)[6] == TAKEN
    assert orders(recording)[30] == USUAL
    replayed(taken)
