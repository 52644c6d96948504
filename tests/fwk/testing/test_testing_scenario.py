"""Conditions over messages, and what must happen in a run."""

from types import SimpleNamespace
from typing import Any

import pytest

from fwk.testing import Expectations, Expression, ExpressionError, Watch, play, reads_messages

MESSAGES = {"world/state": SimpleNamespace(score=2, names=["a", "b"]), "r1/pose": SimpleNamespace(x_m=1.5)}


def newest(channel: str) -> Any:
    return MESSAGES[channel]


@reads_messages
def twice(newest: Any) -> float:
    return 2 * float(newest("r1/pose").x_m)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("world.state.score >= 2", True),
        ("world.state.score == 1 or r1.pose.x_m > 1.0", True),
        ("'a' in world.state.names and len(world.state.names) == 2", True),
        ("world.state.names[1]", "b"),
        ("not -r1.pose.x_m < 0", False),
        ("abs(r1.pose.x_m - 2.0) < 0.6", True),
        ("double == 3.0", True),
        ("half(r1.pose.x_m)", 0.75),
        ("(r1.pose.x_m ** 2 + 2 ** 3) * 4 % 7", 41.0 % 7),
        ("(1 << 3) + 2 ** -1", 8.5),
    ],
)
def test_value_of_a_condition(text: str, value: Any) -> None:
    assert Expression(text, {"double": twice, "half": lambda number: number / 2}).value(newest) == value


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("world.state.score >", "invalid syntax; join comparisons such as a.b == 1 with and, or, not"),
        ("world.state.name == offside", "there is no 'offside'; there are .*; a text needs quotes"),
        (" ", "an empty condition; write such as robot.odometry.x_m >= 1"),
        ("__import__('os')", "calls only abs"),
        ("world.state.score.__class__", "begins with an underscore"),
        ("[each for each in world.state.names]", "ListComp is not allowed"),
        ("(lambda: 1)()", "calls only|not allowed"),
        ("world.state.names.append(1)", "calls only"),
        ("world.state.score is 2", "'is' compares no values; write =="),
        ("world.state.score is not 2", "'is not' compares no values; write !="),
        ("doubl > 3", r"'doubl > 3': there is no 'doubl'; did you mean 'double'\?"),
        ("max(wrld, 3) > 3", "there is no 'wrld'; there are abs, double, len"),
        ("-" * 2000 + "1", "cannot be read; write it shorter"),
        ("-" * 20_000 + "1", "^'-{60}': cannot be read; write it shorter$"),
    ],
)
def test_text_that_is_not_a_condition(text: str, message: str) -> None:
    with pytest.raises(ExpressionError, match=message):
        Expression(text, {"double": twice})


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("2 ** 10 ** 10 > 3", r"the result of '\*\*' is too large"),
        ("((9 ** 99) ** 99) ** 99 > 3", r"'\*\*' is too large"),
        ("1 << 10 * 999999999", "'<<' is too large"),
        ("9 ** 200 * 9 ** 200 > 3", r"'\*' is too large"),
        ("len('ab' * 999999999) > 3", r"'\*' takes numbers, not str"),
        ("len(999999999 * world.state.names) > 3", r"'\*' takes numbers, not list"),
        ("'%999999999d' % 1 == 'a'", "'%' takes numbers, not str"),
    ],
)
@pytest.mark.timeout(5)
def test_condition_that_would_take_too_long(text: str, message: str) -> None:
    with pytest.raises(ExpressionError, match=message):
        Expression(text).value(newest)


def test_condition_too_deep_to_be_read() -> None:
    with pytest.raises(ExpressionError, match="cannot be read; write it shorter"):
        Expression("-" * 99_999 + "1")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("world.other.score", "'world.other.score': there is no 'world/other'"),
        ("world.state.scor", r"SimpleNamespace has no 'scor'; did you mean 'score'\?"),
        ("r1.pose.x_m > 'a'", "'>' compares two numbers, but 'a' is a text"),
        ("r1.pose.x_m > 1 or world.other.score", "'world/other'"),
        ("r1.pose.x_m < 1 and world.state.goals", "has no 'goals'; there are names, score"),
        ("2 < r1.pose.x_m < world.other.score", "'world/other'"),
        ("not (r1.pose.x_m or max(1, world.other.score))", "'world/other'"),
    ],
)
def test_condition_that_does_not_fit_the_messages(text: str, message: str) -> None:
    with pytest.raises(ExpressionError, match=message):
        Expression(text).value(newest)


def test_value_that_others_guard_is_not_a_mistake() -> None:
    assert not Expression("len(world.state.names) > 2 and world.state.names[2] == 'c'").value(newest)


def judged(values: list[int], **expected: list[str]) -> list[str]:
    watch = Watch(Expectations(**expected))
    message = SimpleNamespace(x=0)
    for tick, value in enumerate(values):
        message.x = value
        watch.tick(float(tick), lambda _: message)
    return watch.verdict(float(len(values)), lambda _: message).broken


@pytest.mark.parametrize(
    ("expected", "broken"),
    [
        ({"eventually": ["w.m.x == 3", "w.m.x == 1"]}, []),
        ({"eventually": ["w.m.x == 4"]}, ["never: w.m.x == 4"]),
        ({"in_order": ["w.m.x == 1", "w.m.x == 3"]}, []),
        ({"in_order": ["w.m.x == 3", "w.m.x == 1"]}, ["never: w.m.x == 1"]),
        ({"in_order": ["w.m.x > 0", "w.m.x > 0"]}, []),
        ({"always": ["w.m.x < 4"]}, []),
        ({"always": ["w.m.x < 3"]}, ["2.00 s: not w.m.x < 3"]),
        ({"at_end": ["w.m.x == 2"]}, []),
        ({"at_end": ["w.m.x == 3"]}, ["in the end not: w.m.x == 3"]),
    ],
)
def test_verdict(expected: dict[str, list[str]], broken: list[str]) -> None:
    assert judged([1, 2, 3, 2], **expected) == broken


def test_conditions_count_from_the_time_that_is_asked_for() -> None:
    class Counter:
        now_us = 0

        def tick(self) -> None:
            self.now_us += 100_000

        def newest(self, _channel: str) -> Any:
            return SimpleNamespace(x=self.now_us // 100_000)

    early, late = Expectations(eventually=["w.m.x == 2"], time_s=1.0), Expectations(always=["w.m.x > 2"], time_s=1.0)
    assert [play(Counter(), early, from_s=from_s).ok for from_s in (0.0, 0.2, 0.3)] == [True, True, False]
    assert [play(Counter(), late, from_s=from_s).ok for from_s in (0.0, 0.2, 0.3)] == [False, False, True]


def test_watch_is_finished_when_nothing_can_change() -> None:
    message = SimpleNamespace(x=1)
    soon = Watch(Expectations(eventually=["w.m.x == 1"]))
    later = Watch(Expectations(eventually=["w.m.x == 1"], always=["w.m.x > 0"]))
    for watch in (soon, later):
        watch.tick(0.0, lambda _: message)
    assert (soon.finished, later.finished) == (True, False)
