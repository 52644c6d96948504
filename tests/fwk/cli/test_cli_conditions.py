"""Conditions on the command line: their meaning, and the ones that are refused."""

import re
import sys
from datetime import datetime

import pytest
import typer

from fwk.cli.conditions import moment_us, pattern, ticks, times_us
from fwk.clock import US_PER_S, wall_us


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("7", (7, 7)),
        ("3..5", (3, 5)),
        ("3-5", (3, 5)),
        ("3..", (3, sys.maxsize)),
        ("..5", (0, 5)),
    ],
)
def test_ticks(text: str, meant: tuple[int, int]) -> None:
    assert ticks(text) == meant


@pytest.mark.parametrize(
    ("text", "meant"), [("1.5..2", (1_500_000, 2_000_000)), ("..1", (0, 1_000_000)), ("2..", (2_000_000, sys.maxsize))]
)
def test_times(text: str, meant: tuple[int, int]) -> None:
    assert times_us(text) == meant


def test_moments() -> None:
    assert abs(wall_us() - 90 * US_PER_S - moment_us("90", "--since")) < 10 * US_PER_S
    earlier = moment_us("00:00", "--since")
    assert datetime.fromtimestamp(earlier / US_PER_S).strftime("%H:%M:%S") == "00:00:00"  # noqa: DTZ006 - local time
    assert 0 <= wall_us() - earlier <= 25 * 3600 * US_PER_S
    to_come = moment_us("23:59:59", "--since")
    assert to_come <= wall_us()


@pytest.mark.parametrize(
    ("read", "text", "error"),
    [
        (ticks, "soon", "--tick: 'soon' is not a tick; use 120, or 100..200"),
        (ticks, "..", "is not a tick"),
        (ticks, "5..2", "--tick: '5..2' begins after its end; give the smaller number first"),
        (times_us, "1.5..0", "--time: '1.5..0' begins after its end"),
        (ticks, "1..x", "is not a tick"),
        (ticks, "9" * 5000, "is not a tick"),
        (times_us, "5", "--time: '5' is not a range of seconds; use 1.5..2"),
        (times_us, "..", "is not a range"),
        (times_us, "inf..", "is not a range"),
        (lambda text: moment_us(text, "--since"), "-3", "--since: '-3' is not a time; give seconds ago"),
        (lambda text: moment_us(text, "--since"), "25:00", "is not a time"),
        (lambda text: moment_us(text, "--since"), "nan", "is not a time"),
        (lambda text: pattern(text, "--text"), "a(b", r"--text: 'a(b' is not a regular expression: "),
    ],
)
def test_invalid_conditions_are_refused_with_a_correct_example(read: object, text: str, error: str) -> None:
    with pytest.raises(typer.BadParameter, match=re.escape(error)):
        read(text)  # type: ignore[operator]


def test_a_pattern_that_python_warns_about_is_accepted() -> None:
    assert pattern("[[a]", "--text").search("[")


def test_a_pattern_ignores_case() -> None:
    assert pattern("TURN.*left", "--text").search("it turned left")
