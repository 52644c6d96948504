"""Files of a report whose names are those of pipes and devices."""

import os
import socket
from collections.abc import Callable
from pathlib import Path

import pytest

from procs.evaluation import match
from procs.scenarios import evaluation as scenarios

NAMES = ("table.csv", "table.json", "measures.png")
CURE = "it is neither a file nor a folder, but a pipe, a socket or a device; move it away, or choose another folder"


def bound(path: Path) -> None:
    with socket.socket(socket.AF_UNIX) as made:
        made.bind(os.path.relpath(path))


MADE: dict[str, Callable[[Path], None]] = {
    "pipe": os.mkfifo,
    "device": lambda path: path.symlink_to("/dev/zero"),
    "socket": bound,
}


@pytest.mark.timeout(60)
@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("kind", MADE)
def test_pipes_and_devices_are_refused_at_once(tmp_path: Path, kind: str, name: str) -> None:
    MADE[kind](tmp_path / name)
    with pytest.raises(OSError, match=CURE) as raised:
        match.report([{"ball known": [1.0]}], tmp_path)
    assert raised.value.filename == str(tmp_path / name)
    with pytest.raises(OSError, match=CURE):
        scenarios.report([{"mine": []}], tmp_path)
    assert [file.name for file in tmp_path.iterdir()] == [name]


def test_links_to_files_and_former_reports_are_written(tmp_path: Path) -> None:
    (tmp_path / "table.csv").symlink_to("elsewhere.csv")
    for value in (1.0, 0.0):
        match.report([{"ball known": [value]}], tmp_path)
        assert f",{value}," in (tmp_path / "elsewhere.csv").read_text()


@pytest.mark.parametrize("name", NAMES)
def test_folder_in_the_place_of_a_file_is_named(tmp_path: Path, name: str) -> None:
    (tmp_path / name).mkdir()
    with pytest.raises(IsADirectoryError) as raised:
        match.report([{"ball known": [1.0]}], tmp_path)
    assert raised.value.filename == str(tmp_path / name)
