"""A real run is inspected from another terminal, and its settings are changed."""

import json
import os
import re
import socket
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from fwk.control.address import gateway_address, supervisor_address
from fwk.control.client import RefusedError
from fwk.model.plain_values import value_of
from fwk.model.tick_events import HostStopped
from tests.harness.commands import BIN
from tests.harness.logs import Recording
from tests.harness.runs import TIMEOUT_S, PortBlock, fwk
from tests.programs.control_system import Steered, write_system

pytestmark = pytest.mark.system


@pytest.fixture
def run(tmp_path: Path, ports: PortBlock, launch: Callable[..., object]) -> Steered:
    write_system(tmp_path, ports)
    return Steered(launch("small.yaml"), ports)  # type: ignore[arg-type]


def test_status_and_top_show_every_component(run: Steered, ports: PortBlock) -> None:
    status = run.json("status")
    assert (status["plan"], status["bus_port"]) == ("small", ports.bus)
    assert [each["name"] for each in status["components"]] == ["r/counter", "r/follower", "r/camera", "r/finder"]
    assert {each["state"] for each in status["components"]} == {"running"}
    run.launched.until_true(
        lambda: all(each["iterations"] for each in run.ask("status")["components"]), "a report of each component"
    )
    (newer,) = [json.loads(run.fwk("top", "--once", "--json", "--since", "now", "--interval", "0.1"))["times"]]
    (counter,) = run.json("status", "r/counter")["components"]
    assert {each["setting"]: each["type"] for each in counter["parameters"]} == {
        "step": "float",
        "hang": "bool",
        "log_level": "debug | info | warning | error",
    }
    text = run.fwk("status", "r")
    assert all(name in text for name in ("r/counter", "sensor_acquire", "worst ms"))
    top = run.json("top", "--once", "--interval", "0.1")
    assert top["processes"][0]["name"] == "supervisor"
    assert all(each["memory_bytes"] > 1_000_000 for each in top["processes"])
    times = top["times"]
    assert list(times["stages"]) == ["sensor_acquire", "sensor_prepare", "think", "act"]
    assert times["components"].keys() == {"r/counter", "r/follower", "r/camera", "r/finder"}
    measured = (*times["stages"].values(), *times["components"].values(), times["loop"], times["cycle"])
    assert all(0 < each["p50_ms"] <= each["p95_ms"] <= each["p99_ms"] <= each["max_ms"] for each in measured)
    for each in measured:
        assert sum(count for _, count in each["histogram"]) == each["count"] > 0
        assert each["p50_ms"] in {longest_ms for longest_ms, _ in each["histogram"]} | {each["max_ms"]}
    assert newer["loop"]["count"] < times["loop"]["count"]
    assert "cycle" in run.fwk("top", "--once", "--interval", "0.1")
    assert run.ask("state", name="r/counter")["state"] == "running"
    assert run.ask("period", name="r/counter")["period_us"] == 50_000
    assert run.ask("time_awake", name="r/counter")["awake_s"] > 0
    parameters = run.ask("parameters", name="r/counter")["parameters"]
    assert [each["setting"] for each in parameters] == ["step", "hang", "log_level"]
    for verb, fields in (("kill", {"name": "r"}), ("watch_settings", {"names": ["r/none"]})):
        with pytest.raises(RefusedError, match=r"no component 'r'|no component 'r/none'"):
            run.ask(verb, **fields)
    run.ask("set", changes=["r/counter.step=2"])
    run.ask("kill", name="r/counter")
    assert run.component("r/counter")["state"] == "stopped"
    run.end()


def test_the_blackboard_from_outside(run: Steered) -> None:
    run.ticks_pass()
    rows = {row["channel"]: row for row in run.json("bb", "list")}
    assert rows["r/imu"]["type"] == "robot.imu_t"
    assert (rows["r/imu"]["writer"], rows["r/imu"]["readers"]) == ("r/counter", ["r/follower"])
    assert rows["r/imu"]["sequence"] >= 1
    assert "note: no channel matches 'r/imi'; did you mean 'r/imu'?" in run.fwk("bb", "list", "r/imi")
    assert "heading_rad: " in run.fwk("bb", "show", "r/imu")
    assert "did you mean 'r/imu'?" in run.fwk("bb", "show", "r/imi", code=2)
    lines = [json.loads(line) for line in run.fwk("bb", "watch", "r/imu", "--count", "4", "--json").splitlines()]
    headings = [line["value"]["heading_rad"] for line in lines]
    assert headings[1:] == [headings[1], headings[1] + 1, headings[1] + 2]
    said = run.fwk("bb", "watch", "r/imu", "--count", "1", "--field", "heading_rad")
    assert re.fullmatch(r" *\d+  \d+\.\d{3} s  heading_rad=[\d.]+\n", said), said
    assert "no field 'heding'" in run.fwk("bb", "watch", "r/imu", "--field", "heding", code=2)
    script = run.launched.folder / "ticks.py"
    script.write_text("channels = ('r/imu',)\n\n\ndef message(channel, message, time_us):\n    print(time_us)\n")
    times_us = [int(line) for line in run.fwk("monitor", str(script), "--count", "3").splitlines()]
    assert times_us == [times_us[0], times_us[0] + 50_000, times_us[0] + 100_000]
    (row,) = run.json("who", "r/imu")
    assert (row["writer"], row["readers"], row["rate_hz"] > 0) == ("r/counter", ["r/follower"], True)
    nodes = {node["name"]: node["state"] for node in run.json("graph")["nodes"]}
    assert (len(nodes), set(nodes.values())) == (4, {"running"})
    run.end()


def test_settings_change_at_the_recorded_tick(run: Steered) -> None:
    said = run.json("config", "set", "r/counter.step=0.25")
    assert said["settings"] == [{"component": "r/counter", "values": {"step": 0.25}}]
    assert run.fwk("config", "get", "r/counter.step") == "0.25\n"
    assert "did you mean 'step'?" in run.fwk("config", "set", "r/counter.stp=1", code=2)
    assert "should be a valid number" in run.fwk("config", "set", "r/counter.step=far", code=2)
    assert "shared.step=1' changes nothing; name the components" in run.fwk("config", "set", "shared.step=1", code=2)
    run.steer("restart", "r/counter")
    run.ticks_pass()
    assert "step is 0.25" in run.fwk("log", "--component", "r/counter", "--level", "warning")
    log = run.end()
    assert "equal: " in run.fwk("replay", "--verify", str(log.parent))
    recording = Recording(log)
    ((tick, change),) = [(record.tick, each) for record in recording.records for each in record.settings]
    assert (change.component, change.number, value_of(change.values)["step"]) == (0, 1, 0.25)
    (restarted,) = [tick for tick, each in recording.events if isinstance(each, HostStopped) and each.host == 0]
    heading = 0.0
    for imu in recording.decoded("r/imu"):
        heading = (0.0 if imu.header.tick == restarted else heading) + (1.0 if imu.header.tick < tick else 0.25)
        assert imu.heading_rad == heading


def test_watch_reports_settings_and_save_keeps_them(run: Steered) -> None:
    file = run.launched.folder / "small.host.yaml"
    file.write_text("# this machine\nconfig:\n  r/counter:\n    step: 1.0  # as ever\n")
    with subprocess.Popen(
        [BIN / "fwk", "config", "watch", "r/counter", "--json", "--bus-port", str(run.ask("run")["bus_port"])],
        stdout=subprocess.PIPE,
        text=True,
    ) as watch:
        run.launched.until_true(lambda: run.ask("run")["watching"] == 1, "somebody who watches")
        assert "kept in small.host.yaml" in run.fwk("config", "set", "r/counter.step=2", "--save")
        assert watch.stdout
        change = json.loads(watch.stdout.readline())
        assert (change["setting"], change["value"]) == ("step", 2.0)
        run.fwk("config", "set", "r/counter.nonsense=2", "--save", code=2)
        assert file.read_text() == "# this machine\nconfig:\n  r/counter:\n    step: 2  # as ever\n"
        run.ask("set", changes=["r/counter.step=3"])
        assert "r/counter.step = 2.0 since tick" in run.fwk("config", "reload")
        assert "no setting in the files has changed" in run.fwk("config", "reload", "r/counter")
        run.end()
    assert "r/counter.step = 2.0 (small.host.yaml:4)" in fwk(run.launched.folder, "check", "small.yaml")


def test_unset_erases_a_kept_setting_and_restores_the_files(run: Steered) -> None:
    file = run.launched.folder / "small.host.yaml"
    before = run.ask("settings", names=["r/counter.step"])["settings"][0]
    run.fwk("config", "set", "r/counter.step=7", "--save")
    assert "no setting 'r/counter.nonsense'" in run.fwk("config", "unset", "r/counter.nonsense", code=2)
    assert f"r/counter.step = {before['value']} since tick" in run.fwk("config", "unset", "r/counter.step")
    assert not file.exists()
    after = run.ask("settings", names=["r/counter.step"])["settings"][0]
    assert (after["value"], after["origin"].partition(",")[0]) == (before["value"], "fwk config unset")
    refused = run.fwk("config", "unset", "r/counter.step", code=1)
    assert "small.host.yaml: there is no 'r/counter.step'; nothing was changed" in refused


def test_fwk_log_follows_and_filters(run: Steered) -> None:
    with subprocess.Popen(
        [BIN / "fwk", "log", "-f", "--text", "ASKED", "--bus-port", str(run.ask("run")["bus_port"])],
        stdout=subprocess.PIPE,
        text=True,
    ) as follow:
        assert follow.stdout
        run.steer("restart", "r/finder")
        assert "asked to restart r/finder" in follow.stdout.readline()
        (line,) = [json.loads(each) for each in run.fwk("log", "--file", "control.py", "--json").splitlines()]
        assert (line["component"], line["level"]) == ("supervisor", "info")
        assert run.fwk("log", "--since", "0") == ""
        conditions = ("--since", "600", "--line", str(line["line"]), "--tick", f"{line['tick']}-{line['tick'] + 1}")
        assert "asked" in run.fwk("log", *conditions)
        run.end()
        assert follow.wait(30) == 0


def test_fwk_log_shows_the_last_lines(run: Steered) -> None:
    for text in ("one", "two"):
        run.fwk("note", f"{text} of three")
    assert run.json("note", "three of three")["tick"] > 0
    lines = run.fwk("log", "--text", "of three").splitlines()
    assert len(lines) == 3
    assert run.fwk("log", "--text", "of three", "--last", "2").splitlines() == lines[1:]
    assert run.fwk("log", "--text", "of three", "-n", "7").splitlines() == lines
    assert run.fwk("log", "--text", "of three", "-n", "0") == ""


def test_garbage_on_the_control_sockets_changes_nothing(run: Steered, ports: PortBlock) -> None:
    for address in (supervisor_address(ports.bus), gateway_address(ports.bus)):
        for garbage in (b"hello\n", b"\0" * 200_000, b'{"verb": []}\n' * 1000, b'{"verb":"watch","channel":"\xff"}\n'):
            with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as stranger:
                stranger.connect(address)
                stranger.settimeout(5)
                try:
                    stranger.sendall(garbage)
                    assert b'"ok": false' in stranger.recv(1 << 20)
                except ConnectionError:
                    continue
    run.ticks_pass()
    assert run.json("status")["late"] == 0
    assert run.json("bb", "list")
    recording = Recording(run.end())
    assert not recording.gaps()


def test_commands_without_a_run_report_its_absence(tmp_path: Path) -> None:
    done = subprocess.run([BIN / "fwk", "status", "--bus-port", "1"], capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr.startswith("error: no run '1' on this machine")


def test_log_of_a_named_run_is_followed_to_its_end(run: Steered) -> None:
    folder = run.launched.folder
    command = [str(BIN / "fwk"), "log", run.launched.run_dir.name, "--follow"]
    with subprocess.Popen(
        command, cwd=folder, env={**os.environ, "HOME": str(folder)}, stdout=subprocess.PIPE, text=True
    ) as following:
        assert following.stdout
        run.fwk("note", "here it begins")
        following.stdout.readline()
        run.ticks_pass(10)
        run.fwk("note", "found again")
        run.end()
        said, _ = following.communicate(timeout=TIMEOUT_S)
    assert "found again" in said
    assert "counted enough" in said
