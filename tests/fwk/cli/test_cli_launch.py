"""`fwk-launch` checks its arguments, reports on the run, and returns an exit code."""

import json
import os
import pty
import signal
import subprocess
from pathlib import Path

import cv2
import pytest
import yaml
from typer.testing import CliRunner

from fwk.bus.port_lock import PortLock
from fwk.cli.run.launch_command import app
from fwk.lcm.event_log import LogReader
from fwk.model.ports import Ports
from tests.fwk.cli.cli_processes import PROCS, TIMEOUT_S, environment, launch, write_files
from tests.harness.runs import PortBlock

CARDS = "launch/cards.yaml"
PICTURE = {"procs/picture.py": "import numpy as np\n\ndef draw(newest):\n    return np.zeros((48, 64, 3), np.uint8)\n"}
FAST = (CARDS, "--speed", "max")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write_files(tmp_path, PROCS)
    return tmp_path


@pytest.mark.parametrize(
    ("typed", "answer"),
    [
        ("f.yaml --speed 0", "'0' is not a pace"),
        ("f.yaml --time never", "'never' is not a duration"),
        ("f.yaml --ticks 0", "--ticks"),
        ("f.yaml --hosting thread", "'process', 'robot', 'single'"),
        ("f.yaml --bus-port 80", "--bus-port"),
        ("f.yaml --record /", "'/' is a folder"),
        ("f.yaml --record /dev/null/log", "cannot be written"),
        ("f.yaml --video film.avi", "film.mp4"),
        ("f.yaml --record a --no-record", "exclude each other"),
        ("f.yaml --video a.mp4 --no-record", "leave out --no-record"),
        ("f.yaml --tiks 3", "--ticks"),
        ("no-such-file.yaml", "no-such-file.yaml"),
        ("", "FILE"),
    ],
)
def test_bad_input_is_refused_with_a_correct_example(typed: str, answer: str) -> None:
    result = CliRunner().invoke(app, typed.split())
    assert result.exit_code == 2
    assert answer in " ".join(result.output.replace("│", " ").split())
    assert "Traceback" not in result.output


@pytest.mark.system
@pytest.mark.core
def test_a_run_ends_by_itself_and_reports_its_result(folder: Path) -> None:
    result = launch(folder, *FAST, "--ticks", "30", "--record", "mine.log")
    assert result.returncode == 0, result.stdout
    assert "cards: 30 ticks done" in result.stdout
    assert "30 ticks, 1.50 s of logical time" in result.stdout
    assert f"recording: {folder / 'mine.log'}" in result.stdout
    counts = [event for event in LogReader(folder / "mine.log") if event.channel == "left/count"]
    assert len(counts) == 30


@pytest.mark.system
def test_the_run_directory_holds_the_files_of_the_run(folder: Path) -> None:
    launch(folder, *FAST, "--time", "0.5", "--set", "left/counter.last=700")
    (run_dir,) = (folder / ".cache" / "fwk" / "runs").iterdir()
    assert "-cards-" in run_dir.name
    assert {"plan.json", "log.lcm", "fwk.log"} <= {path.name for path in run_dir.iterdir()}
    settings = (run_dir / "config.yaml").read_text().splitlines()
    assert settings[::2] == ["left/counter.last: 700  # --set", "right/counter.last: 1000000  # default"]
    assert settings[1::2] == [f'{side}/counter.log_level: "info"  # default' for side in ("left", "right")]
    assert yaml.safe_load("\n".join(settings))["left/counter.last"] == 700
    assert {"core.lcm", "cards.lcm"} <= {path.name for path in (run_dir / "lcmtypes").iterdir()}
    assert {"python", "fwk", "lcm"} <= set(json.loads((run_dir / "versions.json").read_text()))


@pytest.mark.system
def test_without_the_option_there_is_no_recording(folder: Path) -> None:
    result = launch(folder, *FAST, "--ticks", "5", "--no-record")
    assert "recording: " not in result.stdout
    assert not list(folder.rglob("log.lcm"))


@pytest.mark.system
def test_names_in_a_row_choose_components(folder: Path) -> None:
    result = launch(folder, *FAST, "--ticks", "5", "--without", "left/counter", "--record", "mine.log")
    assert result.returncode == 0, result.stdout
    channels = {event.channel for event in LogReader(folder / "mine.log")}
    assert "right/count" in channels
    assert "left/count" not in channels


@pytest.mark.system
def test_permanent_failure_is_named_and_exits_with_1(folder: Path) -> None:
    result = launch(folder, *FAST, "--ticks", "50", "--set", "right/counter.last=10")
    assert result.returncode == 1, result.stdout
    assert "right/counter" in result.stdout
    assert "counted too far" in result.stdout


@pytest.mark.system
def test_all_mistakes_of_a_launch_file_are_listed_with_lines(folder: Path) -> None:
    (folder / CARDS).write_text(
        "components:\n  a/counter: { use: procs.counter, config: { lost: 3 } }\n  b/counter: { use: procs.countess }\n"
    )
    result = launch(folder, CARDS)
    assert result.returncode == 2
    assert "launch/cards.yaml:2: a/counter: " in result.stdout
    assert "launch/cards.yaml:3: b/counter: " in result.stdout


@pytest.mark.system
def test_a_video_is_drawn_when_the_run_has_ended(folder: Path) -> None:
    write_files(folder, PICTURE)
    (folder / CARDS).write_text(PROCS[CARDS] + "video: procs.picture:draw\n")
    result = launch(folder, *FAST, "--ticks", "25", "--video", "films/cards.mp4")
    assert result.returncode == 0, result.stdout
    assert f"video: {folder / 'films' / 'cards.mp4'}, 25 pictures" in result.stdout
    assert cv2.VideoCapture(str(folder / "films" / "cards.mp4")).get(cv2.CAP_PROP_FRAME_COUNT) == 25


@pytest.mark.system
def test_a_video_needs_a_drawing(folder: Path) -> None:
    result = launch(folder, *FAST, "--ticks", "25", "--video", "cards.mp4")
    assert result.returncode == 2
    assert "names no drawing" in result.stdout


@pytest.mark.system
def test_a_home_that_takes_no_run_directory_is_named(folder: Path) -> None:
    (folder / ".cache").write_text("a file in its place")
    result = launch(folder, *FAST, "--ticks", "5")
    assert result.returncode == 2
    assert "cannot create the run directory there" in result.stdout


@pytest.mark.system
def test_debugging_a_component_that_is_not_there_is_refused(folder: Path) -> None:
    result = launch(folder, CARDS, "--debug", "left/countr")
    assert result.returncode == 2
    assert "did you mean 'left/counter'?" in " ".join(result.stdout.replace("│", " ").split())


@pytest.mark.system
def test_a_run_with_a_port_conflict_is_refused(folder: Path, ports: PortBlock) -> None:
    lock = PortLock(Ports(ports.bus, 1, 1), "test")
    arguments = ["fwk-launch", *FAST, "--ticks", "1", "--bus-port", str(ports.bus)]
    result = subprocess.run(arguments, cwd=folder, env=environment(folder), capture_output=True, text=True, check=False)
    lock.release()
    assert result.returncode == 2
    assert "--bus-port" in result.stderr


@pytest.mark.system
@pytest.mark.core
def test_ctrl_c_on_a_terminal_stops_everything_tidily(folder: Path, ports: PortBlock) -> None:
    screen, terminal = pty.openpty()
    arguments = ["fwk-launch", CARDS, "--bus-port", str(ports.bus)]
    process = subprocess.Popen(
        arguments, cwd=folder, env=environment(folder), stdin=terminal, stdout=terminal, start_new_session=True
    )
    os.close(terminal)
    shown = ""
    interrupted = False
    while chunk := _read(screen):
        shown += chunk
        if "tick " in shown and not interrupted:
            os.killpg(process.pid, signal.SIGINT)  # as the terminal does: to all processes in the foreground
            interrupted = True
    os.close(screen)
    assert process.wait(TIMEOUT_S) == 0
    assert "cards: interrupted" in shown
    assert shown.rindex("\x1b[?25h") > shown.rindex("\x1b[?25l")


def _read(screen: int) -> str:
    try:
        return os.read(screen, 65536).decode(errors="replace")
    except OSError:  # the other side of the terminal is closed
        return ""


def test_compression_without_its_library_is_refused(folder: Path) -> None:
    write_files(folder, {"zstandard.py": "raise ImportError\n"})  # the folders of a plan come first
    ended = launch(folder, CARDS, "--ticks", "1", "--record-compress")
    assert (ended.returncode, "Traceback" in ended.stdout) == (2, False)
    assert "compressed recordings need another library: pip install 'fwk[compress]'" in ended.stdout
