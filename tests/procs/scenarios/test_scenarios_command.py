"""`python -m procs.scenarios`: many seeds, and its end when the terminal or the disk is gone."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from fwk.testing import launch_plan
from procs.scenarios import command
from procs.scenarios.scripted import Script

ROOT = Path(__file__).parents[3]
COMMAND = (sys.executable, "-m", "procs.scenarios")


def test_seeds_are_played_with_files_of_ones_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    good, bad = tmp_path / "good.yaml", tmp_path / "bad.yaml"
    good.write_text("dummies: [cyan2]\nalways: [x(cyan2) < 0]\ntime_s: 0.2\n")
    bad.write_text("dummies: [cyan2]\nalways: [x(cyan2) > 0]\ntime_s: 0.2\n")
    monkeypatch.setattr("sys.argv", ["scenarios", str(good), str(bad), "--seeds", "3..5"])
    assert command.main() == 1
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[:3] for line in lines if line.startswith("good ")] == [["good", "1.000", "0.438"]]
    assert lines[-3:] == [f"bad, seed {seed}: 0.05 s: not x(cyan2) > 0" for seed in (3, 4, 5)]
    for seeds in ("1..2", "7"):
        monkeypatch.setattr("sys.argv", ["scenarios", str(good), "--seeds", seeds])
        assert command.main() == 0


def test_files_of_one_name_are_told_apart_by_their_folders(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    files = [tmp_path / folder / "mine.yaml" for folder in ("one", "two")]
    for file, sign in zip(files, "<>", strict=True):
        file.parent.mkdir()
        file.write_text(f"dummies: [cyan2]\nalways: [x(cyan2) {sign} 0]\ntime_s: 0.2\n")
    monkeypatch.setattr("sys.argv", ["scenarios", *map(str, files)])
    assert command.main() == 1
    judged = [line for line in capsys.readouterr().out.splitlines() if line.startswith(("ok", "failed"))]
    assert judged == [f"ok     {files[0]} (0.2 s)", f"failed {files[1]}, seed 1 (0.1 s)"]


def test_file_in_a_folder_is_never_one_of_the_book(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("sys.argv", ["scenarios", str(tmp_path / "pass-reaches-the-mate.yaml")])
    assert command.main() == 2
    assert "there is no such scenario; did you mean 'pass-reaches-the-mate'?" in capsys.readouterr().err


def test_mistake_that_a_run_shows_is_no_failure(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """With and without seeds the line is named, once, and the others are played."""
    good, wrong = tmp_path / "good.yaml", tmp_path / "wrong.yaml"
    good.write_text("dummies: [cyan2]\nalways: [x(cyan2) < 0]\ntime_s: 0.2\n")
    wrong.write_text("dummies: [cyan2]\nalways: [1 / ball_speed > 0]\ntime_s: 0.2\n")
    for words in ([], ["--seeds", "3..5"]):
        monkeypatch.setattr("sys.argv", ["scenarios", str(wrong), str(good), *words])
        assert command.main() == 2
        shown = capsys.readouterr()
        assert shown.err.count(f"{wrong}:2: ") == 1
        assert "good" in shown.out
        assert "wrong" not in shown.out


def test_component_that_ends_the_program_fails_its_scenario(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """With and without seeds."""
    good, left = tmp_path / "good.yaml", tmp_path / "left.yaml"
    for file, robots in ((left, "scripted: {cyan2: [{}]}"), (good, "dummies: [cyan2]")):
        file.write_text(f"{robots}\nalways: [x(cyan2) < 0]\ntime_s: 0.2\n")

    def leave(script: Script) -> None:
        if script.clock.tick == 2:
            raise SystemExit(0)

    monkeypatch.setattr(Script, "loop", leave)
    for words in ([], ["--seeds", "3..4"]):
        monkeypatch.setattr("sys.argv", ["scenarios", str(left), str(good), *words])
        assert command.main() == 1
        shown = capsys.readouterr().out
        assert "SystemExit: 0" in shown
        assert "good" in shown


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("3..1", "'3..1' is not a range of seeds; use 1..20, or 7"),
        ("a..b", "'a..b' is not a range of seeds"),
        ("-1..2", "'-1..2' is not a range of seeds"),
        ("1..999999", "'1..999999' is too many; use 100,000 seeds at most"),
    ],
)
def test_seeds_that_are_no_range_are_refused(
    text: str, message: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("sys.argv", ["scenarios", f"--seeds={text}"])
    with pytest.raises(SystemExit, match="2"):
        command.main()
    assert message in capsys.readouterr().err


def test_launch_file_has_parts_seed_and_commands(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("sys.argv", ["scenarios", "carried-off-robot-finds-its-place", "--launch-file", "--seed", "7"])
    assert command.main() == 0
    file = tmp_path / "carried.yaml"
    file.write_text(capsys.readouterr().out)
    plan = launch_plan(str(file))
    parts = {each.name: each for each in plan.components}
    assert (plan.name, plan.seed, plan.period_us) == ("carried-off-robot-finds-its-place", 7, 50_000)
    assert parts["cyan2/localization"].config["start_x_m"] == -3.0
    assert parts["cyan2/percepts"].every == 2
    assert parts["team_cyan/radio"].channels["inboxes"] == ("cyan2/team_inbox",)
    assert [each["at_s"] for each in parts["world/crew"].config["actions"]] == [0.5, 0.1]


@pytest.mark.parametrize("words", [[], ["match-ends", "kick-off-own-halves"], ["match-ends", "--seeds", "1..2"]])
def test_launch_file_is_that_of_one_scenario(
    words: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("sys.argv", ["scenarios", "--launch-file", *words])
    with pytest.raises(SystemExit, match="2"):
        command.main()
    assert "--launch-file is that of one scenario with one seed" in capsys.readouterr().err


def two_short(folder: Path) -> list[str]:
    """Writes two scenarios that end at once; returns their paths."""
    files = [folder / "one.yaml", folder / "other.yaml"]
    for file in files:
        file.write_text("dummies: [cyan2]\nalways: [x(cyan2) < 0]\ntime_s: 0.2\n")
    return list(map(str, files))


def test_full_disk_ends_the_command_in_a_sentence(tmp_path: Path) -> None:
    words = [*COMMAND, *two_short(tmp_path)]
    with open("/dev/full", "w") as full:
        done = subprocess.run(words, stdout=full, stderr=subprocess.PIPE, text=True, cwd=ROOT, check=False)
    assert (done.returncode, done.stderr) == (2, "error: the output cannot be written: No space left on device\n")


def test_closed_pipe_ends_the_command_silently(tmp_path: Path) -> None:
    reading, writing = os.pipe()
    os.close(reading)
    words = [*COMMAND, *two_short(tmp_path)]
    done = subprocess.run(words, stdout=writing, stderr=subprocess.PIPE, cwd=ROOT, check=False)
    os.close(writing)
    assert (done.returncode, done.stderr) == (1, b"")


@pytest.mark.parametrize("words", [(), ("--seeds", "1..500")])
def test_interrupt_ends_the_command_silently(words: tuple[str, ...], tmp_path: Path) -> None:
    first, endless = tmp_path / "first.yaml", tmp_path / "endless.yaml"
    first.write_text("dummies: [cyan2]\nalways: [x(cyan2) > 0]\ntime_s: 0.2\n")
    endless.write_text("dummies: [cyan2]\nalways: [x(cyan2) < 0]\ntime_s: 86400\n")
    begun = [*COMMAND, str(first), str(endless), *words]
    with subprocess.Popen(begun, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=ROOT,
                          env={**os.environ, "PYTHONUNBUFFERED": "1"}) as running:  # fmt: skip
        assert running.stdout
        assert running.stderr
        heard = running.stderr if words else running.stdout
        assert "fail" in heard.readline()
        running.send_signal(signal.SIGINT)
        _, errors = running.communicate()
    assert running.returncode == 130
    assert "Traceback" not in errors
