"""Completion of commands, options and values, with and without a running system."""

import json
import subprocess
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from fwk.cli.commands import app
from fwk.cli.complete.candidates import complete
from fwk.control import runs
from fwk.control.client import ControlError, RefusedError
from fwk.control.settings import RunSettings
from lcmtypes.core import plan_t
from tests.fwk.recording.recording_made import write

ANSWERS: dict[str, Any] = {
    "status": {"components": [{"name": "cyan1/agent"}, {"name": "cyan1/base"}, {"name": "world/referee"}]},
    "settings": {"settings": [{"component": "cyan1/base", "setting": "gain"}]},
    "channels": {
        "channels": [
            {"channel": "cyan1/pose", "type": "soccer.pose_t", "outside": True},
            {"channel": "house/pour@commands", "type": "robot.kick_command_t", "outside": False},
        ]
    },
    "run": {"folders": []},
}


class Run:
    def __enter__(self) -> "Run":
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def ask(self, verb: str, *_: object) -> Any:
        return ANSWERS[verb]


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> list[str | None]:
    chosen: list[str | None] = []

    def connect(name: str | None) -> Run:
        chosen.append(name)
        return Run()

    monkeypatch.setattr(runs, "supervisor", connect)
    monkeypatch.setattr(runs, "gateway", connect)
    monkeypatch.setattr(runs, "look", lambda: {17700: {"name": "match"}, 18000: {"name": ""}})
    return chosen


@pytest.mark.parametrize(
    ("typed", "found"),
    [
        ("fwk sto", ["stop"]),
        ("fwk config ", ["--help", "get", "list", "reload", "schema", "search", "set", "unset", "watch"]),
        ("fwk stop cyan1/", ["cyan1/agent", "cyan1/base"]),
        ("fwk stop cyan1/agent world", ["world/referee"]),
        ("fwk stop --run match w", ["world/referee"]),
        ("fwk stop --al", ["--all"]),
        ("fwk bb show c", ["cyan1/pose"]),
        ("fwk call h", ["house/pour"]),
        ("fwk config set cyan1/b", ["cyan1/base.gain="]),
        ("fwk send ", ["cyan1/pose"]),
        ("fwk send cyan1/pose x_m=1 y", ["y_m="]),
        ("fwk bb watch cyan1/pose --field head", ["heading_rad"]),
        ("fwk plot ", ["cyan1/pose.", "house/pour@commands."]),
        ("fwk plot cyan1/pose.x", ["cyan1/pose.x_m"]),
        ("fwk new component arm --kind c", ["c", "continuous"]),
        ("fwk new interface a.b --kind re", ["reply", "request"]),
        ("fwk types x --lang c", ["c", "cpp"]),
        ("fwk monitor --template im", ["imu"]),
        ("fwk new project ", []),
        ("fwk config get cyan1/b", ["cyan1/base.gain"]),
        ("fwk status --run ", ["18000", "match"]),
        ("fwk-launch soccer.yaml --hosting ", ["process", "robot", "single"]),
        ("fwk top --since p", ["picture"]),
        ("fwk nonsense ", []),
        ("fwk note he", []),
    ],
)
def test_words_that_may_follow(asked: list[str | None], typed: str, found: list[str]) -> None:
    assert [each for each in complete(typed.split(" ")) if each.startswith(typed.split(" ")[-1])] == found


def test_the_named_run_is_asked(asked: list[str | None]) -> None:
    complete(["fwk", "stop", "--run", "match", "c"])
    assert asked == ["match"]


def test_several_runs_are_all_asked_if_none_is_named(asked: list[str | None], monkeypatch: pytest.MonkeyPatch) -> None:
    def connect(port: int | str | None) -> Run:
        if port is None:
            raise RefusedError("several runs on this machine")
        if port == 18000:
            raise ControlError("does not answer")
        return Run()

    monkeypatch.setattr(runs, "supervisor", connect)
    monkeypatch.setattr(runs, "look", lambda: {17700: {"name": "one"}, 18000: {"name": "two"}})
    assert complete(["fwk", "stop", "w"]) == ["world/referee"]
    monkeypatch.setenv(runs.RUN_VARIABLE, "three")
    assert complete(["fwk", "stop", "w"]) == []


@pytest.mark.parametrize(
    ("words", "found"),
    [
        ("replay {log} --debug ", ["world/camera"]),
        ("replay {log} --only w", ["world/camera"]),
        ("replay {log} --with w", ["world/camera="]),
        ("replay {log} --set ", ["world/camera.gain="]),
        ("cut {log} --channels ", ["world/image", "world/imu"]),
        ("play {log} --remap world/im", ["world/image=", "world/imu="]),
        ("plot --from {log} world/im", ["world/image.", "world/imu."]),
        ("plot world/imu.yaw_rate_r --from {log} world/imu.yaw_rate_r", ["world/imu.yaw_rate_rad_s"]),
        ("cut {log}.none --channels ", []),
    ],
)
def test_a_typed_recording_names_its_parts(tmp_path: Path, words: str, found: list[str]) -> None:
    said = plan_t()
    camera = {"name": "world/camera", "origins": {"gain": "default"}}
    types = {"world/image": "core.frame_t", "world/imu": "robot.imu_t"}
    channels = [{"name": name, "type_name": kind} for name, kind in types.items()]
    said.json = json.dumps({"components": [camera], "channels": channels})
    log = write(tmp_path / "log", [("fwk/plan", said.encode(), 0)])
    assert complete(["fwk", *words.format(log=log).split(" ")]) == found


def test_launch_files_and_recordings_are_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "launch").mkdir()
    (tmp_path / "launch" / "garden.yaml").touch()
    (tmp_path / ".cache" / "fwk" / "runs" / "2026-garden-7").mkdir(parents=True)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("HOME", str(tmp_path))
    assert complete(["fwk-launch", "g"]) == ["garden.yaml"]
    assert complete(["fwk", "replay", "20"]) == ["2026-garden-7"]
    assert complete(["fwk", "compare", "2026-garden-7", "2"]) == ["2026-garden-7"]
    (tmp_path / ".cache" / "fwk" / "runs" / "2026-11-22T22-44-07-my-bed-25068").mkdir()
    for words in ("log-info", "cut", "play", "export", "compare", "view --from", "cam --log"):
        assert complete(["fwk", *words.split(), "my"]) == ["my-bed"], words
    assert complete(["fwk", "runs", "keep", "my"]) == []
    assert complete(["fwk", "import", ""]) == []


@pytest.mark.parametrize(
    ("typed", "found"),
    [
        ("fwk-launch garden.yaml --set bed/", ["bed/probe.gain="]),
        ("fwk check garden.yaml --set bed/", ["bed/probe.gain="]),
        ("fwk-launch garden.yaml --without ", ["bed/probe"]),
        ("fwk config get --file garden.yaml ", ["bed/probe.gain"]),
        ("fwk status --run match w", ["world/referee"]),
    ],
)
def test_a_typed_launch_file_names_components_and_settings(
    asked: list[str | None], typed: str, found: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(RunSettings, "rows", lambda *_: [{"component": "bed/probe", "setting": "gain"}])
    monkeypatch.setattr(RunSettings, "__init__", lambda *_: None)
    monkeypatch.setattr("fwk.plan.load.load_plan", str)
    assert complete(typed.split(" ")) == found


def test_a_launch_file_with_mistakes_names_nothing(tmp_path: Path) -> None:
    (tmp_path / "broken.yaml").write_text("components: {a/b: {use: nowhere}}")
    assert complete(["fwk-launch", str(tmp_path / "broken.yaml"), "--set", "a"]) == []


def test_without_a_run_there_are_no_names(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(_: object) -> Run:
        raise ControlError("nothing runs on this machine")

    monkeypatch.setattr(runs, "supervisor", refuse)
    assert complete(["fwk", "stop", "c"]) == []


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_every_shell_has_a_script(shell: str) -> None:
    script = CliRunner().invoke(app, ["completion", shell])
    assert script.exit_code == 0
    assert "fwk __complete" in script.output


def test_bash_completes_commands_and_assignments(tmp_path: Path) -> None:
    script = CliRunner().invoke(app, ["completion", "bash"]).output
    fake = tmp_path / "fwk"
    fake.write_text('#!/bin/sh\ncase "$*" in *config*) echo cyan1/base.gain= ;; *) echo stop; echo start ;; esac\n')
    fake.chmod(0o755)
    probe = (
        f"PATH={tmp_path}:$PATH\n{script}\ncompopt() {{ :; }}\n"
        'COMP_LINE="fwk st" COMP_POINT=6 COMP_WORDS=(fwk st) COMP_CWORD=1; _fwk_complete; echo "${COMPREPLY[@]}"\n'
        'COMP_LINE="fwk config set cy"; COMP_POINT=${#COMP_LINE} COMP_WORDS=(fwk config set cy) COMP_CWORD=3\n'
        '_fwk_complete; echo "${COMPREPLY[@]}"\n'
    )
    done = subprocess.run(["bash", "-c", probe], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines() == ["stop start", "cyan1/base.gain="]
