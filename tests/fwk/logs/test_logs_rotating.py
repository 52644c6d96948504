"""Text files of bounded size and number, and their readers during rotation."""

import itertools
import os
from collections.abc import Callable, Generator, Iterator
from pathlib import Path
from typing import cast

import pytest

from fwk.logs import rotating
from fwk.logs.rotating import RotatingFile, read_rotating


def written(folder: Path, lines: int, max_bytes: int = 100, files: int = 3) -> Path:
    log = RotatingFile(folder / "log", max_bytes, files, pytest.fail)
    for number in range(lines):
        log.write(f"line {number:04}")
    log.close()
    return folder / "log"


def test_size_and_number_are_bounded_and_the_newest_stay(tmp_path: Path) -> None:
    log = written(tmp_path, 95)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["log", "log.1", "log.2"]
    assert all(path.stat().st_size <= 100 for path in tmp_path.iterdir())
    assert list(read_rotating(log)) == [f"line {number:04}" for number in range(70, 95)]


@pytest.mark.parametrize("files", [1, 2, 5])
def test_any_number_of_files(tmp_path: Path, files: int) -> None:
    log = written(tmp_path, 100, files=files)
    assert list(read_rotating(log)) == [f"line {number:04}" for number in range(100 - 10 * files, 100)]


def test_a_line_larger_than_a_file_has_a_file_of_its_own(tmp_path: Path) -> None:
    log = RotatingFile(tmp_path / "log", 100, 3, pytest.fail)
    for text in ("a", "b" * 500, "c"):
        log.write(text)
    assert list(read_rotating(tmp_path / "log")) == ["a", "b" * 500, "c"]
    log.close()


def test_an_existing_log_is_continued(tmp_path: Path) -> None:
    written(tmp_path, 3)
    assert len(list(read_rotating(written(tmp_path, 2)))) == 5


def test_a_deleted_log_is_reported_and_begun_again(tmp_path: Path) -> None:
    said: list[str] = []
    log = RotatingFile(tmp_path / "log", 1000, 2, said.append)
    log.write("before")
    (tmp_path / "log").unlink()
    for line in ("after", "later"):
        log.write(line)
    assert (tmp_path / "log").read_text() == "after\nlater\n"
    assert said == [f"{tmp_path / 'log'}: was deleted; a new file begins here, the lines before are lost"]


def test_a_follower_misses_nothing_during_rotation(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rotating, "sleep_s", lambda _: None)
    log = RotatingFile(tmp_path / "log", 100, 4, pytest.fail)
    numbers = itertools.count()

    def write_some() -> bool:
        """Called at each read: writes no more than one file holds, so that no file disappears before it was read."""
        for _ in range(next(sizes)):
            log.write(f"{next(numbers):09}")
        return next(looks)

    sizes = itertools.cycle([8, 0, 1, 10, 3])
    looks: Iterator[bool] = itertools.chain([True] * 50, itertools.repeat(False))
    seen = [int(line) for line in read_rotating(tmp_path / "log", write_some)]
    assert seen == list(range(len(seen)))
    assert len(seen) >= 200
    log.close()


def test_a_slow_follower_continues_with_the_oldest_file(tmp_path: Path) -> None:
    log = RotatingFile(tmp_path / "log", 100, 2, pytest.fail)
    log.write(f"{0:09}")
    lines = cast(Generator[str, None, None], read_rotating(tmp_path / "log", lambda: True))
    assert next(lines) == f"{0:09}"
    for number in range(1, 45):
        log.write(f"{number:09}")
    assert [int(next(lines)) for _ in range(9)] == list(range(1, 10))  # the file that was open stays readable
    following = [int(next(lines)) for _ in range(10)]
    assert following[0] > 10
    assert following == list(range(following[0], following[0] + 10))
    lines.close()
    log.close()


def test_an_unfinished_line_is_passed_over(tmp_path: Path) -> None:
    log = written(tmp_path, 2)
    with open(log, "a") as file:
        file.write("torn")
    assert list(read_rotating(log)) == ["line 0000", "line 0001"]


def test_a_full_disk_and_its_end_are_reported_once(small_disk: Callable[[int], Path]) -> None:
    folder = small_disk(4)
    said: list[str] = []
    log = RotatingFile(folder / "log", 1 << 30, 3, said.append)
    log.write("first")
    (folder / "big").write_bytes(bytes(free_bytes(folder)))
    for _ in range(100):
        log.write("x" * 200)
    assert len(said) == 1
    assert f"{folder}/log: cannot log there: No space left on device; the run goes on" in said[0]
    assert (folder / "log").read_text().endswith("\n")
    (folder / "big").unlink()
    log.write("last")
    assert len(said) == 2
    assert "the disk has room again; " in said[1]
    lines = list(read_rotating(folder / "log"))
    assert (lines[0], lines[-1]) == ("first", "last")
    assert 2 + 100 - len(lines) == int(said[1].partition("again; ")[2].split()[0])
    log.close()


def free_bytes(folder: Path) -> int:
    disk = os.statvfs(folder)
    return disk.f_bavail * disk.f_frsize
