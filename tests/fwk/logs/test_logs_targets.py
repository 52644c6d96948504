"""Text lines reach each target from the level of that target on."""

from pathlib import Path

import pytest

from fwk.component.log import LEVELS
from fwk.logs import targets
from fwk.logs.reader import read_lines
from fwk.logs.rotating import read_rotating
from fwk.model.sections import LogPlan
from lcmtypes.core import log_t


def line(level: str) -> bytes:
    made = log_t()
    made.level, made.component, made.text = LEVELS[level], "a/b", f"of {level}"
    return made.encode()


class Heard:
    def __init__(self) -> None:
        self.heard: list[str] = []

    def message(self, channel: str, data: bytes, _time_us: int) -> None:
        self.heard.append(log_t.decode(data).text if channel == "fwk/log" else channel)

    def tick(self) -> None:
        self.heard.append("tick")

    def close(self) -> None:
        self.heard.append("end")


@pytest.mark.parametrize(
    ("level", "texts"),
    [
        ("debug", ["of debug", "of info", "of warning", "of error"]),
        ("info", ["of info", "of warning", "of error"]),
        ("warning", ["of warning", "of error"]),
        ("error", ["of error"]),
        ("off", []),
    ],
)
def test_each_target_has_its_level(level: str, texts: list[str]) -> None:
    heard = Heard()
    sink = targets.above(heard, level)
    for each in LEVELS:
        sink.message("fwk/log", line(each), 0)
    sink.message("a/imu", b"", 0)
    sink.tick()
    sink.close()
    assert heard.heard == [*texts, "a/imu", "tick", "end"]


def test_the_requested_files_are_written(tmp_path: Path) -> None:
    def write(folder: str, log: LogPlan) -> Path:
        (tmp_path / folder).mkdir()
        for sink in targets.files(log, tmp_path / folder, pytest.fail):
            for each in LEVELS:
                sink.message("fwk/log", line(each), 0)
            sink.close()
        return tmp_path / folder

    both = write("both", LogPlan(file="error", json_lines="warning"))
    assert [text.endswith("of error") for text in read_rotating(both / "fwk.log")] == [True]
    assert [each["level"] for each in read_lines(both / "fwk.log.jsonl")] == ["warning", "error"]
    assert not list(write("none", LogPlan(file="off", json_lines="off")).iterdir())


def test_the_files_stay_small(tmp_path: Path) -> None:
    for sink in targets.files(LogPlan(file_mb=0.01, files=3), tmp_path, pytest.fail):
        for _ in range(1000):
            sink.message("fwk/log", line("info"), 0)
        sink.close()
    sizes = {path.name: path.stat().st_size for path in tmp_path.iterdir()}
    assert sorted(sizes) == sorted(f"fwk.log{kind}{old}" for kind in ("", ".jsonl") for old in ("", ".1", ".2"))
    assert max(sizes.values()) <= 10_000
