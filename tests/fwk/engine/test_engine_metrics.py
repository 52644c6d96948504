"""Refused datagrams: each kind named once, all counted."""

import pytest

from fwk.bus.receiver import Complaints
from fwk.clock import Clock
from fwk.component.log import Logger
from fwk.engine.metrics import ComponentMetrics, told
from lcmtypes.core import log_t


class Lines:
    def __init__(self) -> None:
        self.lines: list[log_t] = []
        self.complaints = Complaints(Logger("r/base", Clock(), self.lines.append))

    @property
    def texts(self) -> list[str]:
        return [line.text for line in self.lines]


def test_repeated_complaint_is_named_at_powers_of_ten() -> None:
    said = Lines()
    for _ in range(1234):
        said.complaints("r/pose", "datagram from port 4711; refused")
    assert said.texts == [
        "r/pose: datagram from port 4711; refused",
        *(f"r/pose: datagram from port 4711; refused ({count} times)" for count in (10, 100, 1000)),
    ]
    assert said.complaints.total == 1234
    assert {line.level for line in said.lines} == {log_t.WARNING}


def test_each_channel_and_each_kind_is_named() -> None:
    said = Lines()
    for channel in ("r/pose", "r/imu"):
        for text in ("truncated; refused", "wrong type; refused"):
            said.complaints(channel, text)
    assert len(said.texts) == 4


def test_foreign_sender_with_endless_kinds_fills_no_memory() -> None:
    said = Lines()
    for number in range(100_000):
        said.complaints("r/pose", f"datagram from port {number}; refused")
    assert said.complaints.total == 100_000
    assert len(said.texts) < 110


def test_figures_sum_up_iterations() -> None:
    figures = ComponentMetrics("r/base", iter((100, 175)).__next__, state="running")
    for duration_us in (10, 30, 20):
        figures.times.add(duration_us)
    message = figures.message()
    assert (message.name, message.state, message.iterations) == ("r/base", "running", 3)
    assert (message.busy_us, message.worst_us) == (60, 30)
    assert message.awake_us == 75


class NoWordsError(Exception):
    def __str__(self) -> str:
        raise ValueError


@pytest.mark.parametrize(
    ("error", "text"),
    [
        (KeyError("x"), "KeyError: 'x'"),
        (NoWordsError(), "NoWordsError: its text cannot be made (ValueError)"),
        (OSError("file \udcff"), "OSError: file \\udcff"),
        (OSError("a\0b"), "OSError: a\\0b"),
    ],
)
def test_any_exception_can_be_described(error: BaseException, text: str) -> None:
    assert told(error) == text
    assert told(error).encode()


def test_descriptions_are_bounded() -> None:
    assert len(told(ValueError("x" * 100_000))) < 1100
    assert "characters more" in told(ValueError("x" * 100_000))
