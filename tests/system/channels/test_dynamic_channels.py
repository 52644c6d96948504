"""Channels that components of real processes open and close while the run goes on."""

import os
import random
import re
import signal
from pathlib import Path

import pytest

from fwk.model.tick_events import ChannelsChanged, HostLost
from fwk.recording.compare import compare
from tests.harness.fixtures import Launch
from tests.harness.logs import Recording
from tests.harness.runs import UNHURRIED, PortBlock, fwk, pause, replayed, write_files
from tests.programs.control_system import Steered
from tests.programs.dynamic_channels_system import brief, market

pytestmark = pytest.mark.system

GROUPS = "hosts: {stall: [a/trader, c/trader, a/bystander]}"
TRADERS = ("a/trader", "b/trader", "c/trader", "d/trader")


def test_every_layout_of_processes_gives_the_same_messages(tmp_path: Path, ports: PortBlock, launch: Launch) -> None:
    for name, more in (("process", ""), ("groups", GROUPS), ("single", "")):
        write_files(tmp_path, market(ports.public_url, more))
        hosting = ["--hosting", "single"] if name == "single" else []
        run = launch("market.yaml", "--ticks", "160", "--record", f"{name}.log", *hosting)
        assert run.wait() == 0, run.text
    assert compare(tmp_path / "process.log", tmp_path / "groups.log") is None
    assert compare(tmp_path / "process.log", tmp_path / "single.log") is None
    recording = Recording(tmp_path / "process.log")
    goods = [channel for channel in recording.messages if channel.startswith("shop/good")]
    assert len(goods) >= 3
    assert len({header.writer for channel in goods for header in recording.headers(channel)}) == 3
    replayed(tmp_path, log="process.log")
    replayed(tmp_path, "--only", "b/trader", log="process.log")


@pytest.mark.parametrize(
    ("clock", "hosts"), [("lockstep", GROUPS), ("real time", "")], ids=["lockstep-groups", "real time-process"]
)
def test_a_restart_closes_dynamic_channels_and_replays(
    tmp_path: Path, ports: PortBlock, launch: Launch, clock: str, hosts: str
) -> None:
    files = market(ports.public_url, hosts, wanderer=True)
    if clock == "real time":
        files["launch/market.yaml"] = files["launch/market.yaml"].replace("speed: max", "clock: wall")
    write_files(tmp_path, files)
    run = Steered(launch("market.yaml", "--record", "log.lcm", *(UNHURRIED if clock == "lockstep" else ())), ports)
    luck = random.Random(4)
    for _ in range(20):
        run.ticks_pass(luck.randrange(2, 12))
        components, name = run.ask("status")["components"], luck.choice(TRADERS)
        one = next(each for each in components if each["name"] == name)
        what = luck.choice(["kill", "kill", "restart", "hold", "set"])
        if what == "kill" and one["pid"]:
            os.kill(one["pid"], signal.SIGKILL)
        elif what == "restart":
            run.steer("restart", *[each["name"] for each in components if each["process"] == one["process"]])
        elif what == "hold" and one["pid"]:
            os.kill(one["pid"], signal.SIGSTOP)
            if clock == "real time":
                run.ticks_pass(luck.randrange(1, 4))
            os.kill(one["pid"], signal.SIGCONT)
        else:
            run.ask("set", changes=[f"{one['name']}.gain={luck.randrange(1, 9)}"])
    run.launched.signal(signal.SIGINT)
    assert run.launched.wait() == 0, run.launched.text
    kinds = {type(event) for _, event in Recording(tmp_path / "log.lcm").events}
    assert {ChannelsChanged, HostLost} <= kinds
    replayed(tmp_path)
    replayed(tmp_path, "--only", "c/trader", "--only", "d/trader")


def test_replay_finds_a_change_on_a_dynamic_channel(tmp_path: Path, ports: PortBlock, launch: Launch) -> None:
    write_files(tmp_path, market(ports.public_url))
    run = launch("market.yaml", "--ticks", "40", "--record", "log.lcm")
    assert run.wait() == 0, run.text
    code = tmp_path / "traders.py"
    changed = "float(self.digest) + (self.clock.tick >= 20 and self.name == 'b/trader')"
    code.write_text(code.read_text().replace("heading_rad = float(self.digest)\n", f"heading_rad = {changed}\n"))
    said = replayed(tmp_path, code=1)
    assert re.search(r"b/trader: b/spot: tick 20, stage 6, message \d+ by b/trader: heading_rad is", said), said


def test_a_refused_dynamic_channel_names_both_sides(tmp_path: Path, ports: PortBlock, launch: Launch) -> None:
    write_files(tmp_path, market(ports.public_url))
    run = launch("market.yaml", "--ticks", "300")
    assert run.wait() == 0, run.text
    assert re.search(r"shop/good\d: (./trader) is its writer; ./trader has to wait; refused", run.text)
    other = (
        r"shop/good\d: ./trader wants it as robot.odometry_t \(\w{16}\), but it is robot.imu_t \(\w{16}\) to ./trader"
    )
    assert re.search(other, run.text), run.text


def test_fwk_bb_shows_dynamic_channels(tmp_path: Path, ports: PortBlock, launch: Launch) -> None:
    write_files(tmp_path, market(ports.public_url))
    run = Steered(launch("market.yaml", "--speed", "1"), ports)
    run.ticks_pass(20)
    rows = fwk(tmp_path, "bb", "list", "--bus-port", str(ports.bus))
    assert re.search(r"b/spot\b.*robot\.imu_t.*b/trader", rows), rows
    assert "heading_rad" in fwk(tmp_path, "bb", "show", "b/spot", "--bus-port", str(ports.bus))


def test_last_messages_on_a_dynamic_channel_are_recorded(tmp_path: Path, ports: PortBlock, launch: Launch) -> None:
    write_files(tmp_path, brief(ports.public_url))
    run = Steered(launch("brief.yaml", "--record", "log.lcm"), ports)
    run.ticks_pass(2)
    gateway, writer = run.launched.gateway(), run.component("a/writer")["pid"]
    os.kill(gateway, signal.SIGSTOP)
    run.ask("set", changes=["a/writer.wants=true"])
    pause(0.3)  # ticks go on until the main loop needs the gateway
    os.kill(writer, signal.SIGKILL)
    os.kill(gateway, signal.SIGCONT)
    run.ticks_pass(3)
    run.end()
    recording = Recording(tmp_path / "log.lcm")
    assert recording.gaps() == {}
    assert recording.messages["a/brief"]
    replayed(tmp_path)
