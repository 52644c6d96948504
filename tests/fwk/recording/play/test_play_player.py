"""The player: pace, pause, steps, jumps and loop by a clock of the test."""

from pathlib import Path

import pytest

from fwk.lcm.event_log import LogReader
from fwk.recording.play.player import NEVER_US, Player
from fwk.recording.play.timeline import Timeline
from tests.fwk.recording.play.play_logs import foreign, heard, recording

START_US = 1_000_000


@pytest.fixture
def timeline(tmp_path: Path) -> Timeline:
    return Timeline(recording(tmp_path / "log"))


def played(player: Player, now_us: int = START_US) -> list[tuple[int, int]]:
    """Plays to the end; returns the wall time of each message since the start, and its number in the log."""
    found = []
    while not player.ended:
        now_us = max(now_us, player.due_us())
        found += [(now_us - START_US, event.number) for event in player.due(now_us)]
    return found


@pytest.mark.parametrize(("speed", "last_us"), [(1.0, 450_000), (2.0, 225_000), (0.5, 900_000), (0.0, 0)])
def test_messages_are_due_by_their_time_stamps(timeline: Timeline, speed: float, last_us: int) -> None:
    found = played(Player(timeline, START_US, speed))
    assert [number for _, number in found] == list(range(21))
    assert (found[0][0], found[-1][0]) == (0, last_us)


@pytest.mark.parametrize("made", [recording, heard, foreign])
def test_every_log_is_played_whole_and_in_order(tmp_path: Path, made: object) -> None:
    assert callable(made)
    log = made(tmp_path / "log")
    found = played(Player(Timeline(log), START_US, 1000.0))
    assert [number for _, number in found] == [event.number for event in LogReader(log)]


def test_from_and_to_bound_what_is_played(timeline: Timeline) -> None:
    end = timeline.after(timeline.of_tick(6).position)
    player = Player(timeline, START_US, 1.0, timeline.of_tick(4), end)
    assert played(player) == [(0, 7), (0, 8), (50_000, 9), (50_000, 10), (100_000, 11), (100_000, 12)]
    assert player.rounds == 1


def test_a_pause_stops_time_and_a_step_plays_one_tick(timeline: Timeline) -> None:
    player = Player(timeline, START_US)
    player.due(START_US)
    player.pause()
    assert (player.due_us(), player.due(START_US + 10**6)) == (NEVER_US, [])
    assert [event.number for event in player.step(START_US + 10**6)] == [3, 4]
    assert (player.tick, player.paused) == (2, True)
    player.resume(START_US + 3 * 10**6)
    assert player.due_us() == START_US + 3 * 10**6 + 50_000


def test_a_new_speed_holds_from_the_present_moment_on(timeline: Timeline) -> None:
    player = Player(timeline, START_US)
    player.due(START_US)
    player.set_speed(0.1, START_US + 10_000)
    assert player.due_us() == START_US + 10_000 + 500_000


def test_jumps_end_at_the_ends_of_the_log(timeline: Timeline) -> None:
    player = Player(timeline, START_US)
    player.seek_by(0.2, START_US)
    assert [event.number for event in player.due(START_US)] == [9, 10]
    player.seek_by(-60.0, START_US)
    assert [event.number for event in player.due(START_US)] == [0, 1, 2]
    player.seek_by(60.0, START_US)
    assert [event.number for event in player.due(START_US)] == [19, 20]
    assert player.ended


def test_a_loop_begins_again_until_it_is_ended(timeline: Timeline) -> None:
    player = Player(timeline, START_US, 0.0, timeline.of_tick(9), loop=True)
    numbers = [event.number for _ in range(5) for event in player.due(START_US)]
    assert numbers == [17, 18, 19, 20, 17, 18, 19, 20, 17, 18]
    assert player.rounds == 2
    player.loop = False
    player.due(START_US)
    assert player.ended
