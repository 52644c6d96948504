"""A full disk, and processes killed while they write: acknowledged data stays, the run goes on."""

import json
import os
import random
import re
import signal
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from fwk.clock import sleep_s
from fwk.control.yaml_edit import read
from fwk.lcm.event_log import LogReader
from fwk.logs.reader import read_lines
from tests.harness import commands
from tests.harness.commands import BIN, Command
from tests.harness.runs import TIMEOUT_S, Launched, PortBlock, fill, fwk
from tests.programs.control_system import Steered, write_system

pytestmark = pytest.mark.system

Disk = Callable[[int], Path]
Launch = Callable[..., Launched]


def test_a_full_disk_stops_log_and_recording_only(
    tmp_path: Path, ports: PortBlock, launch: Launch, small_disk: Disk
) -> None:
    disk = small_disk(24)
    write_system(tmp_path, ports)
    chatty = tmp_path / "small.py"
    loop = "        self.imu.value.heading_rad += self.config.step\n"
    chatty.write_text(chatty.read_text().replace(loop, loop + "        self.log.debug('counting')\n"))
    options = ("--set", "r/counter.log_level=debug", "--set", "speed=4")
    run = launch("small.yaml", *options, env={"HOME": str(disk)})
    steered = Steered(run, ports)
    steered.ticks_pass(20)
    big = fill(disk)
    run.until("log.lcm: cannot record: No space left on device")
    run.until_count("cannot log there: No space left on device", 2)
    steered.ticks_pass(20)
    assert steered.json("status", "r/counter")["components"][0]["state"] == "running"
    big.unlink()
    run.until_count("the disk has room again; ", 3)
    room_at = steered.tick
    steered.ticks_pass(20)
    run.signal(signal.SIGINT)
    assert run.wait() == 0, run.text
    assert run.text.count("No space left on device") == 3
    assert "messages are missing in the recording" in run.text
    assert re.search(r"^recording: .*log\.lcm; [1-9][0-9]* messages are missing in it$", run.text, re.MULTILINE)
    (folder,) = (disk / ".cache" / "fwk" / "runs").iterdir()
    reader = LogReader(folder / "log.lcm")
    numbers = [event.number for event in reader]
    assert reader.skipped_bytes == 0
    assert numbers[:3] == [0, 1, 2]
    assert len(numbers) < numbers[-1] + 1
    ticks = [line["tick"] for line in read_lines(folder / "fwk.log.jsonl") if line["text"] == "counting"]
    assert set(range(1, 15)) < set(ticks)
    assert set(range(room_at + 1, room_at + 15)) < set(ticks)
    said = [line["text"] for line in read_lines(folder / "fwk.log.jsonl")]
    assert any("fwk.log.jsonl: the disk has room again; " in text for text in said)


def test_a_setting_that_cannot_be_kept_is_not_set(
    tmp_path: Path, ports: PortBlock, launch: Launch, small_disk: Disk
) -> None:
    disk = small_disk(1)
    write_system(disk, ports)
    file = disk / "small.host.yaml"
    file.write_text("# mine\nconfig:\n  r/counter:\n    step: 3.0  # why\n")
    run = Steered(launch(str(disk / "small.yaml")), ports)
    before = file.read_text()
    big = fill(disk)
    refused = run.fwk("config", "set", "r/counter.step=4", "--save", code=1)
    assert "small.host.yaml: cannot be written: No space left on device; it is unchanged; nothing was set" in refused
    assert (run.fwk("config", "get", "r/counter.step"), file.read_text()) == ("3.0\n", before)
    assert not list(disk.glob(".*"))
    run.ticks_pass()
    big.unlink()
    assert "kept in" in run.fwk("config", "set", "r/counter.step=5", "--save")
    assert file.read_text() == before.replace("3.0", "5")
    run.end()


@pytest.mark.slow
def test_acknowledged_settings_survive_sigkill(tmp_path: Path, ports: PortBlock, launch: Launch) -> None:
    write_system(tmp_path, ports)
    file = tmp_path / "small.host.yaml"
    file.write_text("# this machine\nconfig:\n  r/counter:\n    step: 0  # as ever\n")
    launched = launch("small.yaml")
    Steered(launched, ports)
    dice, acknowledged, killed = random.Random(7), 0, 0
    for number in range(1, 9):
        command = [
            str(BIN / "fwk"),
            "config",
            "set",
            f"r/counter.step={number}",
            "--save",
            "--bus-port",
            str(ports.bus),
        ]
        said = tmp_path / f"said-{number}.txt"
        with open(said, "wb") as output:
            setting = commands.start(command, tmp_path, dict(os.environ), output.fileno(), output.fileno())
        with_mercy = number % 4 == 0
        if not with_mercy:
            _when_it_is_about_to_write(setting, file.parent, dice.uniform(0.0, 0.06))
            setting.send_signal(signal.SIGKILL)
        code = setting.wait(TIMEOUT_S)
        if "kept in small.host.yaml" in said.read_text():
            acknowledged = number
        killed += code == -signal.SIGKILL
        text = file.read_text()
        assert acknowledged <= read(text)["config"]["r/counter"]["step"] <= number
        assert text.startswith("# this machine\n")
        assert text.endswith("  # as ever\n")
    assert acknowledged == 8
    assert killed >= 3
    launched.signal(signal.SIGKILL)
    assert launched.gone_within(30)
    (row,) = json.loads(fwk(tmp_path, "config", "get", "r/counter.step", "--file", "small.yaml", "--json"))
    assert (row["value"], row["origin"]) == (8.0, "small.host.yaml:4")


def _when_it_is_about_to_write(setting: "Command | subprocess.Popen[bytes]", folder: Path, later_s: float) -> None:
    """Waits until the folder is locked for writing or the process has ended, and then for a random moment."""
    while setting.poll() is None:
        if str(folder) in _open_files(setting.pid):
            sleep_s(later_s)
            return


def _open_files(pid: int) -> list[str]:
    try:
        return [os.readlink(link) for link in Path(f"/proc/{pid}/fd").iterdir()]
    except OSError:  # closed or ended in between
        return []
