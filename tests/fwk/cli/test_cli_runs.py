"""Old run directories are removed, except the newest, those in use, those kept, and other folders."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from fwk.cli.recordings.runs import runs
from fwk.cli.run.run_directory import IN_USE, RUNS, RunDirError, make_run_dir, named, own_name, prune, run_dirs
from fwk.cli.run.run_record import RUN_FILE, write_result
from tests.fwk.cli.cli_processes import PROCS, launch, write_files


def make(folder: Path, *days: int, size: int = 1000) -> list[str]:
    names = [f"2026-01-{day:02}T10-00-00-match-{day}" for day in days]
    for name in names:
        (folder / name / "lcmtypes").mkdir(parents=True)
        (folder / name / "log.lcm").write_bytes(bytes(size))
        (folder / name / IN_USE).touch()
    return names


def there(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def test_the_oldest_are_removed_until_few_are_left(tmp_path: Path) -> None:
    names = make(tmp_path, 3, 1, 2, 4)
    assert [each.path.name[8:10] for each in prune(tmp_path, 2, 0)] == ["01", "02"]
    assert there(tmp_path) == sorted(names)[2:]
    assert prune(tmp_path, 2, 0) == []


def test_the_oldest_are_removed_until_the_rest_is_small(tmp_path: Path) -> None:
    names = make(tmp_path, 1, 2, 3, 4)
    prune(tmp_path, 0, 2500)
    assert there(tmp_path) == names[2:]
    prune(tmp_path, 0, 1)
    assert there(tmp_path) == names[3:]


def test_no_limit_removes_nothing(tmp_path: Path) -> None:
    make(tmp_path, 1, 2, 3)
    assert prune(tmp_path, 0, 0) == []


def test_kept_directories_and_other_folders_stay(tmp_path: Path) -> None:
    names = make(tmp_path, 1, 2, 3)
    (tmp_path / names[0] / "keep").touch()
    (tmp_path / "my notes").mkdir()
    (tmp_path / "2026-01-01T09-00-00-other-9").symlink_to(tmp_path / names[1])
    prune(tmp_path, 1, 0)
    assert there(tmp_path) == ["2026-01-01T09-00-00-other-9", names[0], names[2], "my notes"]


MAKER = """
import os, sys
from pathlib import Path
from fwk.cli.run.run_directory import make_run_dir
print(make_run_dir("used", Path(sys.argv[1])).name, flush=True)
if os.fork() == 0:
    sys.stdin.read()
    os._exit(0)
os._exit(0)
"""


def test_directories_in_use_by_any_process_of_the_run_stay(tmp_path: Path) -> None:
    (tmp_path / "2026-01-01T10-00-00-first-1").mkdir()
    with subprocess.Popen(
        [sys.executable, "-c", MAKER, str(tmp_path)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as maker:
        assert maker.stdout
        assert maker.stdin
        used = maker.stdout.readline().strip()
        newest = "9999-01-01T10-00-00-last-1"
        (tmp_path / newest).mkdir()
        assert maker.wait() == 0  # its child is still running
        assert [each.in_use for each in run_dirs(tmp_path)] == [False, True, False]
        prune(tmp_path, 1, 0)
        assert there(tmp_path) == [used, newest]
        maker.stdin.close()
        assert maker.stdout.read() == ""  # the child has ended
    while [each.in_use for each in run_dirs(tmp_path)] == [True, False]:
        os.sched_yield()
    prune(tmp_path, 1, 0)
    assert there(tmp_path) == [newest]


def test_a_directory_is_found_by_its_listed_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.chdir(tmp_path)
    made = make_run_dir("garden")
    assert named(Path(made.name)) == made
    assert named(Path("other")) == Path("other")
    (tmp_path / made.name).mkdir()
    assert named(Path(made.name)) == Path(made.name)


def test_long_name_of_a_run_is_shortened(tmp_path: Path) -> None:
    """Names of files have 255 bytes at most, and a letter has four at most."""
    made = make_run_dir("\N{EARTH GLOBE EUROPE-AFRICA}a" * 200, tmp_path)
    assert [found.path for found in run_dirs(tmp_path)] == [made]
    made = make_run_dir("\N{OLD PERSIAN SIGN A}" * 200, tmp_path)
    assert made.is_dir()


def test_a_new_directory_is_in_use(tmp_path: Path) -> None:
    made = make_run_dir("match", tmp_path / "runs")
    (found,) = run_dirs(tmp_path / "runs")
    assert (found.path, found.in_use, found.kept) == (made, True, False)
    (tmp_path / "file").touch()
    with pytest.raises(RunDirError, match="cannot create the run directory there: "):
        make_run_dir("match", tmp_path / "file")


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("HOME", str(tmp_path))
    (tmp_path / RUNS).mkdir(parents=True)
    return tmp_path / RUNS


def said(*arguments: str, code: int = 0) -> str:
    result = CliRunner().invoke(runs, arguments)
    assert result.exit_code == code, result.output
    return result.output


def test_the_commands(home: Path) -> None:
    names = make(home, 1, 2, 3, size=3_000_000)
    assert f"3 runs, 9.0 MB, in {home}" in said("list")
    said("keep", names[0])
    rows = json.loads(said("list", "--json"))
    assert [(row["kept"], row["in_use"], row["size_bytes"]) for row in rows] == [
        (True, False, 3_000_000),
        (False, False, 3_000_000),
        (False, False, 3_000_000),
    ]
    assert said("prune", "--keep", "2") == f"removed {names[1]}, 3.0 MB\n"
    said("release", names[0])
    said("prune", "--size-gb", "0.004")
    assert there(home) == names[2:]
    assert "'nan' is not a size; give gigabytes" in said("prune", "--size-gb", "nan", code=2)
    assert f"did you mean '{names[2]}'?" in said("keep", names[2] + "1", code=2)


def test_a_run_is_kept_by_its_own_name(home: Path) -> None:
    """As other commands do, the newest of several runs of one name is meant."""
    names = make(home, 1, 2, 3)
    said("keep", own_name(names[0]))
    assert [row["kept"] for row in json.loads(said("list", "--json"))] == [False, False, True]
    said("release", own_name(names[0]))
    assert not any(row["kept"] for row in json.loads(said("list", "--json")))
    assert "no run ''" in said("keep", "", code=2)


def test_a_result_of_several_lines_is_shown_in_one_row(home: Path) -> None:
    (name,) = make(home, 1)
    (home / name / RUN_FILE).write_text('{"started_us": 1}')
    write_result(home / name, 1, "not started: a/b: no port\nc/d: no file", 0, 0.0)
    assert "not started: a/b: no port; c/d: no file" in said("list")


def test_the_list_names_what_a_run_waits_for(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made = make_run_dir("match", home)
    row = {"run_dir": str(made), "waits_for": ["a/b"]}
    monkeypatch.setattr("fwk.cli.recordings.runs.states", lambda: [row, {"answers": True, "name": "false"}])
    assert "waits for a/b" in said("list")
    assert json.loads(said("list", "--json"))[0]["waits_for"] == ["a/b"]


@pytest.mark.system
def test_a_run_removes_excess_directories_and_reports_it(tmp_path: Path) -> None:
    folder = tmp_path
    write_files(folder, PROCS)
    names = make(folder / RUNS, 1, 2, 3)
    (folder / "launch" / "cards.host.yaml").write_text("runs: {keep: 2}\n")
    done = launch(folder, "cards.yaml", "--ticks", "3", "--speed", "max")
    assert done.returncode == 0, done.stdout
    assert "removed the 2 oldest run directories" in done.stdout
    assert there(folder / RUNS)[:-1] == names[2:]
    assert not any(each.in_use for each in run_dirs(folder / RUNS))


def test_a_log_is_found_by_the_name_of_its_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Path, "home", lambda: tmp_path)
    names = make(tmp_path / RUNS, 1, 2)
    assert named(Path("match")) == tmp_path / RUNS / names[1]  # the newest
    assert (named(Path(names[0])).name, named(Path("mat"))) == (names[0], Path("mat"))
    (tmp_path / "match").touch()
    monkeypatch.chdir(tmp_path)
    assert named(Path("match")) == Path("match")
