"""Values that do not fit together in a condition are named, with what would fit."""

import re
from types import SimpleNamespace
from typing import Any, NamedTuple

import pytest

from fwk.testing import Expectations, Expression, ExpressionError, Watch, reads_messages
from lcmtypes.core import command_t


class Spot(NamedTuple):
    """A place."""

    x_m: float
    y_m: float


MESSAGES = {"world/state": SimpleNamespace(score=2, names=["a", "b"]), "r1/asked": command_t()}


def newest(channel: str) -> Any:
    return MESSAGES[channel]


@reads_messages
def spot(_newest: Any) -> Spot:
    return Spot(1.0, 2.0)


def far(one: Spot, two: Spot, limit_m: float = 1.0) -> bool:
    return abs(one.x_m - two.x_m) > limit_m


WORDS = {"spot": spot, "far": far}


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("spot < 3", "'<' compares two numbers, but spot is a Spot; take one of its fields, such as spot.x_m"),
        ("0 < world.state.score < spot", "but spot is a Spot; take one of its fields"),
        ("world.state.names >= 2", "but world.state.names is a list; its length is len(world.state.names)"),
        ("world.state.score < far", "but far is a function; call it: far(...)"),
        ("world.state.score < None", "but None is nothing"),
        ("spot - 1 > 0", "'-' takes two numbers, but spot is a Spot"),
        ("-spot.x_m > -spot", "'-' takes a number, but spot is a Spot"),
        ("abs(spot) > 1", "abs takes a number, but spot is a Spot; take one of its fields"),
        ("len(3) > 1", "len takes a list or a text, but 3 is a number"),
        ("max(3) > 1", "max takes a list, but 3 is a number"),
        ("max() > 1", "max takes a list, or at least two numbers; here are none"),
        ("far(spot)", "far takes 2 or 3 values (one, two, limit_m); here is 1"),
        ("far()", "far takes 2 or 3 values (one, two, limit_m); here are none"),
        ("len(world.state.names, 1) > 1", "len takes 1 value; here are 2"),
        ("spot()", "spot is a Spot, not a function; write it without brackets"),
        ("world.state.score[0] > 1", "world.state.score is a number, not a list; it has no [0]"),
        ("world.state.names['a'] == 'a'", "an index is a whole number, but 'a' is a text"),
        ("1 in world.state.score", "'in' looks into a list or a text, but world.state.score is a number"),
        ("world.state.names in 'a'", "'in' looks for a text in 'a', but world.state.names is a list"),
        ("world.state.score == 'b'", "'==' compares values of one kind, but world.state.score is a number and 'b' is"),
        ("world.state.names != 'a'", "world.state.names is a list and 'a' is a text"),
        ("not spot", "spot is a Spot, which always holds; compare one of its fields, such as spot.x_m"),
        ("far and world.state.score > 1", "far is a function, which always holds; call it: far(...)"),
    ],
)
def test_misfit_is_named_in_plain_words(text: str, message: str) -> None:
    with pytest.raises(ExpressionError, match=re.escape(message)) as caught:
        Expression(text, WORDS).value(newest)
    assert str(caught.value).startswith(f"'{text}': ")


@pytest.mark.parametrize(
    "text",
    ["spot == (1.0, 2.0)", "world.state.names == ['a', 'b']", "far(spot, spot) == False", "world.state.score != None"],
)
def test_values_of_one_kind_are_compared(text: str) -> None:
    assert Expression(text, WORDS).holds(newest) is True


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("spot", "spot is a Spot, which always holds; compare one of its fields, such as spot.x_m"),
        ("far", "far is a function, which always holds; call it: far(...)"),
        ("r1.asked", "r1.asked is a command_t, which always holds; compare one of its fields, such as r1.asked."),
        ("1", "a fixed value is no condition; compare something with it"),
        ("'spot.x_m > 3'", "a fixed value is no condition"),
    ],
)
def test_value_that_always_holds_is_no_condition(text: str, message: str) -> None:
    with pytest.raises(ExpressionError, match=re.escape(message)):
        Watch(Expectations(always=[text]), WORDS).tick(0.0, newest)


def test_index_beyond_the_end_is_named() -> None:
    with pytest.raises(ExpressionError, match=r"an index is beyond the end of its list; ask for its length before"):
        Expression("world.state.names[2] == 'c'").holds(newest)


def test_list_or_number_may_be_a_condition() -> None:
    assert Expression("world.state.names").holds(newest)
    assert not Expression("world.state.score - 2").holds(newest)


def test_sound_condition_is_not_spelt_part_by_part(monkeypatch: pytest.MonkeyPatch) -> None:
    """Spelling takes the longer, the longer the condition is."""
    monkeypatch.setattr("ast.get_source_segment", pytest.fail)
    assert Expression(" or ".join(["world.state.score > 1"] * 9)).holds(newest)
