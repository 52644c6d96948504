"""`fwk play`: keys, bad input, what lcm-logger hears, and a live component on a played log."""

import json
import signal
from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner

from fwk.bus.public import PublicBus
from fwk.cli.recordings.play import play
from fwk.cli.recordings.play_controls import Controls
from fwk.lcm.event_log import LogReader
from fwk.recording.play.player import Player
from fwk.recording.play.timeline import Timeline
from lcmtypes.robot import motor_command_t
from tests.clients.bus import PROBE, Bus
from tests.fwk.recording.play.play_logs import recording
from tests.fwk.recording.recording_made import entries, write
from tests.harness.fixtures import Launch, launch  # noqa: F401 - a fixture
from tests.harness.logs import Recording
from tests.harness.runs import PortBlock, fwk, write_files
from tests.harness.terminals import Terminal
from tests.programs.control_system import Steered
from tests.programs.outside_system import outside_system


@pytest.fixture
def controls(tmp_path: Path) -> Controls:
    return Controls(Player(Timeline(recording(tmp_path / "log", ticks=100, notes={40: "ball taken"})), 0))


def pressed(controls: Controls, *keys: str) -> bool:
    return [controls.press(key, 0) for key in keys][-1]


def test_keys_pause_jump_and_change_the_speed(controls: Controls) -> None:
    player = controls.player
    pressed(controls, "space", "+", "+", "right")
    assert (player.paused, player.speed, player.tick) == (True, 4.0, 21)
    assert controls.line().startswith("tick 21, 1.05 of 5.00 s, speed 4, paused, 0 messages   space pause")
    pressed(controls, "space", "-", "left", "l")
    assert (player.paused, player.speed, player.time_us, player.loop) == (False, 2.0, 50_000, True)
    pressed(controls, "m")
    assert "speed max" in controls.line()
    assert pressed(controls, "s")
    assert not controls.quits
    pressed(controls, "q")
    assert controls.quits


@pytest.mark.parametrize(("typed", "time_us"), [("31", 31), ("2.5s", 50), ("ball taken", 40), ("3\x7f4", 4)])
def test_a_typed_moment_is_gone_to(controls: Controls, typed: str, time_us: int) -> None:
    assert not pressed(controls, "g", *("space" if key == " " else key for key in typed))
    assert controls.line().startswith("go to tick, time (12.5s) or bookmark: ")
    pressed(controls, "enter")
    assert controls.player.time_us == time_us * 50_000


def test_a_typed_moment_that_does_not_exist_is_explained(controls: Controls) -> None:
    pressed(controls, "g", "9", "9", "9", "enter")
    assert "no tick 999; the last one is 100" in controls.line()
    pressed(controls, "g", "q", "escape")
    assert not controls.quits


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (["--from", "20"], "no tick 20; the last one is 10"),
        (["--from", "5", "--to", "4"], "--from 5 comes after --to 4; nothing to play"),
        (["--remap", "a"], "--remap 'a': write A=B, the recorded channel and its new name"),
        (["--remap", "a=b", "--remap", "a=c"], "--remap: a cannot be both b and c"),
        (["--plugin", "none"], "'none' is not a plugin; write 'module:Class'"),
        (["--url", "tcp://x"], "'tcp://x' is not an LCM bus"),
        (["--paused"], "--paused needs a terminal"),
    ],
)
def test_bad_input_of_play_is_explained(tmp_path: Path, ports: PortBlock, words: list[str], reason: str) -> None:
    app = typer.Typer()
    app.command()(play)
    done = CliRunner().invoke(app, [str(recording(tmp_path / "log")), "--url", ports.public_url, *words])
    assert (done.exit_code, done.stdout) == (2, "")
    assert reason in done.stderr


def test_without_a_terminal_play_says_that_it_begins(tmp_path: Path, ports: PortBlock) -> None:
    app = typer.Typer()
    app.command()(play)
    words = [str(recording(tmp_path / "log")), "--url", ports.public_url, "--speed", "max", "--from", "4", "--json"]
    done = CliRunner().invoke(app, words)
    assert done.stderr == "log: tick 4, 0.20 of 0.50 s, speed max: plays from here; Ctrl-C ends\n"
    assert json.loads(done.stdout)["rounds"] == 1


@pytest.mark.parametrize("listens", [False, True])
def test_play_says_whether_a_program_listened(tmp_path: Path, ports: PortBlock, listens: bool) -> None:
    app = typer.Typer()
    app.command()(play)
    words = [str(recording(tmp_path / "log")), "--url", ports.public_url, "--speed", "max"]
    other = PublicBus(ports.public_url) if listens else None
    done, plain = CliRunner().invoke(app, [*words, "--json"]), CliRunner().invoke(app, words)
    if other:
        other.close()
    assert json.loads(done.stdout)["heard"] is listens
    unheard = "; no program listened: start one before, or add --wait"
    assert plain.stdout.endswith(f" messages played on {ports.public_url}{'' if listens else unheard}\n")


@pytest.mark.slow
@pytest.mark.system
@pytest.mark.core
def test_lcm_logger_hears_exactly_the_played_log(tmp_path: Path, ports: PortBlock) -> None:
    bus, log = Bus(ports.public_url), write(tmp_path / "log", entries(ticks=60))
    play_options = ("play", log, "--url", ports.public_url, "--speed")
    with bus.logger(tmp_path / "heard"):
        assert "300 messages played" in fwk(tmp_path, *play_options, "max", "--wait")
        part = ("8", "--from", "11", "--to", "1s", "--exclude", "fwk/*", "--remap", "cyan2/odometry=x/odometry")
        assert "44 messages played" in fwk(tmp_path, *play_options, *part)
    heard = [(event.channel, event.data) for event in LogReader(tmp_path / "heard") if event.channel != PROBE]
    recorded = [(event.channel, event.data) for event in LogReader(log)]
    chosen = [(channel, data) for channel, data in recorded[50:105] if channel != "fwk/log"]
    renamed = [("x/odometry" if channel == "cyan2/odometry" else channel, data) for channel, data in chosen]
    assert heard == [*recorded, *renamed]


@pytest.mark.system
def test_a_live_component_reads_a_played_log(
    tmp_path: Path,
    ports: PortBlock,
    launch: Launch,  # noqa: F811
) -> None:
    write_files(tmp_path, outside_system(ports.public_url, "period_s: 0.01"))
    run = Steered(launch("joystick.yaml", "--record", "live.lcm"), ports)
    run.ticks_pass(2)
    message = motor_command_t()
    message.vx_m_s = 1.5
    heard = write(tmp_path / "heard.lcm", [("joystick", message.encode(), n * 20_000) for n in range(20)])
    said = fwk(tmp_path, "play", heard, "--url", ports.public_url, "--wait", "--remap", "joystick=r/wish")
    assert "20 messages played" in said
    run.ticks_pass(5)
    run.launched.signal(signal.SIGINT)
    assert run.launched.wait() == 0, run.launched.text
    assert Recording(tmp_path / "live.lcm").decoded("r/total")[-1].heading_rad == 30.0
    assert "refused" not in run.launched.text


@pytest.mark.system
def test_play_obeys_keys_in_a_terminal(tmp_path: Path, ports: PortBlock) -> None:
    recording(tmp_path / "log", ticks=100)
    words = ("play", "log", "--paused", "--url", ports.public_url)
    terminal = Terminal(tmp_path, "fwk", *words)
    for keys, shown in (
        ("", "tick 1, 0.05 of 5.00 s, speed 1, paused, 0 messages"),
        ("s", "tick 1, 0.05 of 5.00 s, speed 1, paused, 3 messages"),
        ("ss", "tick 3, 0.15 of 5.00 s, speed 1, paused, 7 messages"),
        ("g4s\r", "tick 80, 4.00 of 5.00 s, speed 1, paused, 7 messages"),
        ("g700\r", "no tick 700; the last one is 100"),
    ):
        terminal.child.send(keys)
        terminal.child.expect_exact(shown)
    terminal.child.send("m ")
    terminal.child.expect_exact("49 messages played on")
    assert terminal.end() == 0
