"""A component that joins a running system, or was absent, sees only the newest message of each channel."""

import pytest

from fwk.engine.catch_up import AWAY_TICKS, CatchUp
from fwk.engine.input_view import InputView


@pytest.mark.parametrize(
    ("incarnation", "continuous", "ran", "tick", "applies"),
    [
        (1, False, 0, 1, False),
        (1, False, 0, 2, True),
        (2, False, 0, 1, True),
        (1, False, 5, 5 + AWAY_TICKS, False),
        (1, False, 5, 6 + AWAY_TICKS, True),
        (2, False, 5, 6, False),
        (1, True, 0, 2, True),
        (1, True, 5, 1000, False),
    ],
)
def test_catch_up_applies(incarnation: int, continuous: bool, ran: int, tick: int, applies: bool) -> None:
    rule = CatchUp(incarnation, continuous)
    if ran:
        rule.took_part(ran)
    assert rule.applies(tick) == applies


def test_view_shows_each_message_once() -> None:
    view = InputView(CatchUp())
    view.arrive("r/imu", [b"1"])
    view.arrive("r/imu", [b"2"])
    assert view.take(1) == {"r/imu": [b"1", b"2"]}
    assert view.take(2) == {}


def test_view_of_newcomer_shows_newest_messages() -> None:
    view = InputView(CatchUp())
    view.arrive("r/imu", [b"1", b"2"])
    view.arrive("r/pose", [b"3"])
    assert view.take(5) == {"r/imu": [b"2"], "r/pose": [b"3"]}
    view.arrive("r/imu", [b"4", b"5"])
    assert view.take(6) == {"r/imu": [b"4", b"5"]}


def test_view_shows_newest_message_of_joined_channel() -> None:
    view = InputView(CatchUp())
    view.join("r/spot", [b"1"])
    view.arrive("r/spot", [b"2", b"3"])
    view.arrive("r/imu", [b"4", b"5"])
    assert view.take(1) == {"r/spot": [b"3"], "r/imu": [b"4", b"5"]}
    view.arrive("r/spot", [b"6", b"7"])
    assert view.take(2) == {"r/spot": [b"6", b"7"]}


def test_view_shows_nothing_of_a_channel_that_was_closed() -> None:
    view = InputView(CatchUp())
    view.join("r/spot", [])
    assert view.take(1) == {}
    view.arrive("r/spot", [b"1"])
    view.leave("r/spot")
    assert view.take(2) == {}


def test_view_does_not_change_other_views() -> None:
    arrived = [b"1"]
    for _ in range(2):
        view = InputView(CatchUp())
        view.arrive("r/imu", arrived)
        view.arrive("r/imu", [b"2"])
        assert view.take(1) == {"r/imu": [b"1", b"2"]}
    assert arrived == [b"1"]
