"""Messages of the referee on the bench."""

import math
from typing import Any

import pytest

from fwk import Component, Reads, channel
from fwk.lcm import messages
from fwk.testing import Bench, MemorySystem
from lcmtypes.core import answer_t
from lcmtypes.soccer import game_event_t, game_state_t, match_event_t, match_history_t, true_robot_t
from procs.referee.referee import Referee
from procs.simulation.simulator import Simulator


def make(kind: int, robot: str = "cyan2", x_m: float = 6.0) -> match_event_t:
    made = match_event_t()
    made.kind, made.robot, made.x_m, made.speed_m_s = kind, robot, x_m, 5.0
    return made


def state(bench: Bench) -> Any:
    return bench.port("game_state").sent[-1]


def history(bench: Bench) -> list[game_event_t]:
    events: list[game_event_t] = bench.port("match_history").sent[-1].events
    assert state(bench).decisions == len(events)
    return events


def playing() -> Bench:
    bench = Bench(Referee, "world/referee", kick_off_stoppage_s=0.5)
    for _ in range(12):
        bench.port("match_events").put()
        bench.iterate()
    bench.port("match_events").put(ball_x_m=3.0)
    bench.iterate()
    assert state(bench).state == game_state_t.PLAY
    return bench


def test_first_tick_kicks_off_and_places_the_ball() -> None:
    bench = Bench(Referee, "world/referee")
    bench.iterate()
    assert (state(bench).state, state(bench).stopped) == (game_state_t.KICK_OFF, True)
    placed = bench.port("ball_placement").sent
    assert [(each.placement_id, each.x_m, each.y_m) for each in placed] == [(1, 0.0, 0.0)]
    bench.iterate(5)
    assert len(bench.port("ball_placement").sent) == 1
    assert len(bench.port("game_state").sent) == 6


def test_goal_is_counted_and_the_ball_goes_to_the_centre() -> None:
    bench = playing()
    bench.port("match_events").put(
        ball_x_m=11.2, events=[make(match_event_t.TOUCH), make(match_event_t.GOAL, x_m=11.2)]
    )
    bench.iterate()
    now = state(bench)
    assert (now.score_cyan, now.score_magenta, now.state, now.state_team) == (
        1,
        0,
        game_state_t.KICK_OFF,
        game_state_t.TEAM_MAGENTA,
    )
    assert bench.port("ball_placement").sent[-1].placement_id == 2
    assert bench.logged[-1].text.startswith("kick-off for magenta, cyan 1:0 magenta")


def test_events_of_several_ticks_all_count() -> None:
    bench = playing()
    bench.port("match_events").put(ball_x_m=6.0, events=[make(match_event_t.TOUCH)])
    bench.port("match_events").put(ball_x_m=11.2, events=[make(match_event_t.GOAL, x_m=11.2)])
    bench.port("match_events").put(ball_x_m=11.3)
    bench.iterate()
    assert state(bench).score_cyan == 1


def test_unknown_kinds_of_events_are_ignored() -> None:
    bench = playing()
    bench.port("match_events").put(ball_x_m=3.0, events=[make(99)])
    bench.iterate()
    assert state(bench).state == game_state_t.PLAY


@pytest.mark.parametrize(
    ("asked", "state", "team"),
    [
        ({"name": "freekick", "team": "cyan"}, game_state_t.FREE_KICK, game_state_t.TEAM_CYAN),
        ({"name": "throwin", "team": "magenta"}, game_state_t.THROW_IN, game_state_t.TEAM_MAGENTA),
        ({"name": "corner", "team": "cyan"}, game_state_t.CORNER_KICK, game_state_t.TEAM_CYAN),
        ({"name": "penalty", "team": "magenta"}, game_state_t.PENALTY, game_state_t.TEAM_MAGENTA),
        ({"name": "drop_ball"}, game_state_t.DROP_BALL, game_state_t.TEAM_NONE),
        ({"name": "goal", "team": "cyan"}, game_state_t.KICK_OFF, game_state_t.TEAM_MAGENTA),
        ({"name": "second_half"}, game_state_t.KICK_OFF, game_state_t.TEAM_MAGENTA),
        ({"name": "half_time"}, game_state_t.HALF_TIME, game_state_t.TEAM_NONE),
        ({"name": "end_game"}, game_state_t.FROZEN, game_state_t.TEAM_NONE),
    ],
)
def test_command_by_hand(asked: dict[str, str], state: int, team: int) -> None:
    bench = playing()
    bench.port("referee_command").put(**asked)
    bench.iterate()
    now = bench.port("game_state").sent[-1]
    assert (now.state, now.state_team, now.stopped) == (state, team, True)
    assert bench.port("referee_command").sent[-1].answer.state == answer_t.DONE


def test_stop_by_hand_holds_the_game_until_start() -> None:
    bench = playing()
    bench.port("referee_command").put(name="stop")
    bench.iterate(400)
    assert state(bench).stopped
    bench.port("referee_command").put(name="start")
    bench.iterate()
    assert not state(bench).stopped


@pytest.mark.parametrize(
    ("asked", "reason"),
    [
        ({"name": "freekick"}, "'freekick' needs a team: cyan or magenta"),
        ({"name": "freekick", "team": "red"}, "no team 'red'; there are cyan, magenta"),
        ({"name": "subgoal", "team": "cyan"}, "cyan has no goal to take back; the score is cyan 0:0 magenta"),
        ({"name": "yellow_card", "robot": "cyan9"}, "no robot 'cyan9'; there are none"),
        ({"name": "red_card"}, "'red_card' needs a team or a robot; there are none"),
        ({"name": "red_card", "team": "cyan"}, "no robot of cyan is on the field"),
        ({"name": "start"}, "nothing to start: the game runs; stop or a set piece interrupts it"),
    ],
)
def test_impossible_command_by_hand(asked: dict[str, str], reason: str) -> None:
    bench = playing()
    bench.port("referee_command").put(**asked)
    bench.iterate()
    answer = bench.port("referee_command").sent[-1].answer
    assert (answer.state, answer.reason) == (answer_t.REJECTED, reason)


@pytest.mark.parametrize(("name", "right"), [("kick", "did you mean 'kickoff'?"), ("xyz", "there are kickoff, ")])
def test_unknown_command_lists_the_known_ones(name: str, right: str) -> None:
    bench = playing()
    bench.port("referee_command").put(name=name)
    bench.iterate()
    assert bench.port("referee_command").sent[-1].answer.reason.startswith(f"no command '{name}'; {right}")


def test_led_by_hand_the_referee_calls_nothing() -> None:
    bench = Bench(Referee, "world/referee", automatic=False)
    bench.iterate(400)
    assert (state(bench).state, state(bench).stopped) == (game_state_t.KICK_OFF, True)
    bench.port("referee_command").put(name="start")
    bench.iterate(10)
    bench.port("match_events").put(ball_x_m=11.2, events=[make(match_event_t.GOAL, x_m=11.2)])
    bench.iterate()
    assert (state(bench).state, state(bench).score_cyan) == (game_state_t.PLAY, 0)


def test_reset_begins_the_match_anew() -> None:
    bench = playing()
    goal = [make(match_event_t.TOUCH), make(match_event_t.GOAL, x_m=11.2)]
    bench.port("match_events").put(ball_x_m=11.2, events=goal)
    bench.port("referee_command").put(name="second_half")
    bench.iterate()
    assert (state(bench).score_cyan, state(bench).half, state(bench).cyan_side) == (1, 2, 1)
    bench.port("referee_command").put(name="reset")
    bench.iterate()
    now = state(bench)
    assert (now.score_cyan, now.half, now.cyan_side, now.time_in_half_s) == (0, 1, -1, 0.0)
    assert (now.state, now.state_team, now.stopped) == (game_state_t.KICK_OFF, game_state_t.TEAM_CYAN, True)
    assert [each.goal for each in history(bench)] == [False]


def test_history_is_written_at_first_and_when_it_grows() -> None:
    bench = Bench(Referee, "world/referee")
    bench.iterate()
    assert [each.state for each in history(bench)] == [game_state_t.KICK_OFF]
    bench.iterate(5)
    assert len(bench.port("match_history").sent) == 1
    bench.port("referee_command").put(name="goal", team="cyan")
    bench.iterate(5)
    assert len(bench.port("match_history").sent) == 2
    assert [each.goal for each in history(bench)] == [False, True, False]
    bench.iterate(100)
    assert len(bench.port("match_history").sent) == 3, "repeated for readers outside that come late"


@pytest.mark.parametrize("turns", [(2, 0), (3, 2)])
def test_history_is_repeated_though_the_referee_misses_ticks(turns: tuple[int, int]) -> None:
    bench = Bench(Referee, "world/referee", every=turns[0], offset=turns[1])
    bench.iterate(300)
    assert len(bench.port("match_history").sent) == 3


def test_history_that_begins_anew_is_written() -> None:
    bench = Bench(Referee, "world/referee")
    bench.iterate(3)
    bench.port("referee_command").put(name="reset")
    bench.iterate(3)
    assert [len(each.events) for each in bench.port("match_history").sent] == [1, 1]


class Reader(Component):
    """Notes how many events of the history it knows."""

    stage = "think"
    match_history: Reads[match_history_t] = channel("world/match_history")

    def init(self) -> None:
        self.known: list[int] = []

    def loop(self) -> None:
        self.known.append(len(self.match_history.value.events))


def test_reader_that_comes_late_has_the_history() -> None:
    components = {"world/referee": Referee, "world/simulator": Simulator, "a/reader": Reader}
    system = MemorySystem(components, turns={"a/reader": (20, 0)})
    system.tick(20)
    assert [messages.tick_and_sequence_of(each) for each in system.sent["world/match_history"]] == [(1, 1)]
    assert system.runners["a/reader"].component.known == [1]  # type: ignore[attr-defined]


PLAYERS = {
    "anna": {"team": "cyan", "number": 1},
    "bert": {"team": "cyan", "number": 2},
    "cyan2": {"team": "magenta", "number": 1},
    "dora": {"team": "magenta", "number": 3},
}


def with_names() -> Bench:
    bench = Bench(Referee, "world/referee", kick_off_stoppage_s=0.5, positions_s=0.0, players=PLAYERS)
    places = {"anna": -10.0, "bert": -1.0, "cyan2": 10.0, "dora": 5.0, "box": 0.3}
    robots = [true_robot_t() for _ in places]
    for robot, (name, x_m) in zip(robots, places.items(), strict=True):
        robot.name, robot.x_m = name, x_m
    bench.port("ground_truth").put(robots=robots)
    for _ in range(12):
        bench.port("match_events").put()
        bench.iterate()
    bench.port("match_events").put(ball_x_m=3.0)
    bench.iterate()
    return bench


def test_teams_and_numbers_are_those_of_the_players() -> None:
    bench = with_names()
    bench.port("match_events").put(ball_x_m=3.0, events=[make(match_event_t.TOUCH, "anna", -2.0)])
    bench.iterate()
    scored = [make(match_event_t.TOUCH, "bert", 3.0), make(match_event_t.GOAL, "bert", 11.2)]
    bench.port("match_events").put(ball_x_m=11.2, events=scored)
    bench.port("referee_command").put(name="red_card", robot="cyan2")
    bench.iterate()
    now = state(bench)
    assert (now.score_cyan, now.score_magenta, now.sent_off) == (1, 0, ["cyan2"])
    assert (history(bench)[-1].robot, history(bench)[-1].team) == ("cyan2", game_state_t.TEAM_MAGENTA)


@pytest.mark.parametrize(
    ("x_m", "last", "score"),
    [(-3.0, "bert", (0, 0)), (-3.0, "dora", (1, 0)), (3.0, "dora", (0, 0)), (3.0, "bert", (0, 1))],
)
def test_last_of_two_that_touch_the_ball_in_a_tick(x_m: float, last: str, score: tuple[int, int]) -> None:
    """A shot from the own half counts only if the rival turns it in."""
    bench = with_names()
    both = [make(match_event_t.TOUCH, robot, x_m) for robot in ("bert", "dora")]
    bench.port("match_events").put(ball_x_m=x_m, last_touch=last, events=both)
    bench.iterate()
    goal = make(match_event_t.GOAL, last, math.copysign(11.2, -x_m))
    bench.port("match_events").put(ball_x_m=goal.x_m, last_touch=last, events=[goal])
    bench.iterate()
    assert (state(bench).score_cyan, state(bench).score_magenta) == score


def test_player_on_the_field_has_the_number() -> None:
    both = {"cyan3": {"team": "cyan", "number": 3}, "anna": {"team": "cyan", "number": 3}}
    for name in both:
        bench, robot = Bench(Referee, "world/referee", players=both), true_robot_t()
        robot.name = name
        bench.port("ground_truth").put(robots=[robot])
        bench.port("referee_command").put(name="red_card", robot=name)
        bench.iterate()
        bench.iterate()
        assert state(bench).sent_off == [name]


def test_robot_is_named_by_its_namespace_in_answers() -> None:
    bench = with_names()
    bench.port("referee_command").put(name="repair", robot="cyan1")
    bench.iterate()
    answer = bench.port("referee_command").sent[-1].answer
    assert answer.reason == "no robot 'cyan1'; there are anna, bert, cyan2, dora"


def test_robot_of_the_other_team_is_not_the_one_meant() -> None:
    bench = with_names()
    bench.port("referee_command").put(name="yellow_card", team="cyan", robot="dora")
    bench.iterate()
    assert bench.port("referee_command").sent[-1].answer.reason == "dora plays for magenta, not for cyan"
    assert not [event for event in history(bench) if event.card]


def test_what_plays_in_neither_team_commits_no_foul() -> None:
    for robot, other, whistled in (("box", "anna", False), ("anna", "box", False), ("anna", "dora", True)):
        bench = with_names()
        hit = make(match_event_t.COLLISION, robot)
        hit.other = other
        bench.port("match_events").put(ball_x_m=3.0, events=[hit])
        bench.iterate()
        assert (state(bench).state == game_state_t.FREE_KICK) == whistled


def test_command_for_a_team_means_its_highest_number_on_field() -> None:
    bench = with_names()
    for name, team, expected in (
        ("yellow_card", "magenta", []),  # dora
        ("yellow_card", "magenta", []),  # cyan2, as dora has one
        ("repair", "cyan", ["bert"]),
        ("double_yellow", "magenta", ["bert", "dora"]),
        ("red_card", "magenta", ["bert", "cyan2", "dora"]),
        ("red_card", "cyan", ["anna", "bert", "cyan2", "dora"]),
    ):
        bench.port("referee_command").put(name=name, team=team)
        bench.iterate()
        assert state(bench).sent_off == expected
    bench.port("referee_command").put(name="repair", team="cyan")
    bench.iterate()
    refused = "no robot of cyan is on the field; a robot that is off it has to be named: anna, bert"
    assert bench.port("referee_command").sent[-1].answer.reason == refused
    shown = [(event.robot, event.card) for event in history(bench) if event.card]
    assert shown == [
        ("dora", game_event_t.YELLOW),
        ("cyan2", game_event_t.YELLOW),
        ("dora", game_event_t.DOUBLE_YELLOW),
        ("cyan2", game_event_t.RED),
        ("anna", game_event_t.RED),
    ]


def test_second_yellow_card_by_hand_is_double() -> None:
    bench = with_names()
    for expected in ([], ["dora"], ["dora"]):  # the third is a first one again
        bench.port("referee_command").put(name="yellow_card", robot="dora")
        bench.iterate()
        assert state(bench).sent_off == expected
    kinds = [event.card for event in history(bench) if event.card]
    assert kinds == [game_event_t.YELLOW, game_event_t.DOUBLE_YELLOW, game_event_t.YELLOW]


def test_awaited_team_is_named_once_each_time() -> None:
    """A match of one against one with `least_robots: 2` never began, and nothing told why."""
    bench = Bench(Referee, "world/referee", kick_off_stoppage_s=0.5, positions_s=0.0, least_robots=2)
    robots = [true_robot_t() for _ in range(3)]
    for robot, name in zip(robots, ("cyan2", "cyan3", "magenta2"), strict=True):
        robot.name = name

    def told() -> list[str]:
        return [each.text for each in bench.logged if "waits" in each.text]

    bench.port("ground_truth").put(robots=robots)
    for _ in range(30):
        bench.port("match_events").put()
        bench.iterate()
    assert told() == ["the game waits for robots of magenta: 1 on the field, and least_robots is 2"]
    assert state(bench).stopped
    bench.port("referee_command").put(name="freekick", team="cyan")
    for _ in range(90):
        bench.port("match_events").put()
        bench.iterate()
    assert len(told()) == 2
