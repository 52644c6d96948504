"""The memory of the referee: one that was restarted goes on with the match of the one before it."""

from typing import Any

import pytest

from fwk.testing import Bench
from lcmtypes.soccer import game_event_t, game_state_t, match_event_t, match_history_t, true_robot_t
from procs.model.field import Point
from procs.model.game_states import State
from procs.referee.cards import Card
from procs.referee.memory import recall
from procs.referee.referee import Referee
from procs.referee.rules import Rules
from procs.referee.whistle import Whistle

ROBOTS = [f"{team}{number}" for team in ("cyan", "magenta") for number in (1, 2, 3)]


class Led:
    """A referee on the bench that commands lead."""

    def __init__(self, **rules: Any) -> None:
        self.rules = {"automatic": False, "penalties": 2} | rules
        self.bench = Bench(Referee, "world/referee", **self.rules)
        self.bench.iterate()

    def ask(self, *commands: str) -> None:
        """Gives commands such as `goal cyan`, one in a tick."""
        for command in commands:
            name, _, whose = command.partition(" ")
            robots = [true_robot_t() for _ in ROBOTS]
            for place, robot in enumerate(robots):
                robot.name, robot.x_m, robot.y_m = ROBOTS[place], place - 2.5, 4.0
            self.bench.port("ground_truth").put(robots=robots)
            self.bench.port("match_events").put(ball_x_m=self.state.ball_x_m, ball_y_m=self.state.ball_y_m)
            self.bench.port("referee_command").put(name=name, **{"robot" if whose[-1:].isdigit() else "team": whose})
            self.bench.iterate()
            assert self.bench.port("referee_command").sent[-1].answer.reason == ""

    def restart(self, **report: Any) -> None:
        """Puts a new referee in the place of this one; without a report the world is frozen at first."""
        memory, history = self.bench.port("referee_memory").sent[-1], self.bench.port("match_history").sent[-1]
        tick = self.bench.tick
        self.bench = Bench(Referee, "world/referee", **self.rules)
        self.bench.tick = tick
        self.bench.port("told_memory").put(memory)
        self.bench.port("told_history").put(history)
        self.bench.port("match_events").put(**(report or {"frozen": True}))
        self.bench.iterate()

    def go_on(self, time_s: float) -> None:
        """Lets time pass."""
        for _ in range(round(time_s / 0.05)):
            self.bench.port("match_events").put(ball_x_m=self.state.ball_x_m, ball_y_m=self.state.ball_y_m)
            self.bench.iterate()

    @property
    def whistle(self) -> Whistle:
        """The referee's state machine."""
        machine: Whistle = self.bench.component._whistle
        return machine

    @property
    def state(self) -> game_state_t:
        """The newest state."""
        newest: game_state_t = self.bench.port("game_state").sent[-1]
        return newest

    @property
    def stands(self) -> tuple[Any, ...]:
        """How the game stands."""
        now = self.state
        score = now.score_cyan, now.score_magenta
        game = State(now.state), now.state_team, now.stopped, now.half, now.cyan_side, now.ball_x_m, now.ball_y_m
        return *game, score, tuple(now.sent_off), now.decisions, now.time_in_half_s


@pytest.mark.parametrize(
    "commands",
    [
        "",
        "goal cyan, goal magenta, goal cyan",
        "start",
        "corner magenta",
        "corner magenta, start",
        "red_card cyan2, double_yellow magenta1, repair cyan3",
        "park",
        "half_time",
        "half_time, kickoff cyan",
        "second_half, start, goal cyan, end_game",
        "second_half_overtime, end_game, penalty magenta, start",
    ],
)
def test_restarted_referee_goes_on(commands: str) -> None:
    led = Led()
    led.ask(*filter(None, commands.split(", ")))
    before, placed = led.stands, len(led.bench.port("ball_placement").sent)
    led.restart()
    assert led.stands == before
    assert placed
    assert led.bench.port("ball_placement").sent == [], "the ball stays where it is"


def test_restarted_referee_places_with_numbers_of_its_own() -> None:
    led = Led()
    led.ask("corner cyan", "throwin cyan")
    before = led.bench.port("ball_placement").sent[-1].placement_id
    led.restart()
    led.ask("freekick cyan")
    assert led.bench.port("ball_placement").sent[-1].placement_id > before


def test_cards_are_known_after_a_restart() -> None:
    led = Led(double_yellow_s=5.0, repair_s=2.0)
    led.ask("yellow_card cyan2", "double_yellow cyan3", "red_card magenta3", "repair magenta2")
    led.restart()
    for _ in range(20):
        led.bench.port("match_events").put()
        led.bench.iterate()
    led.ask("yellow_card cyan2")
    assert led.state.sent_off == ["cyan2", "cyan3", "magenta2", "magenta3"], "the second yellow card of cyan2"
    for time_s, away in ((1.2, ["cyan2", "cyan3", "magenta3"]), (3.0, ["cyan2", "magenta3"]), (9.0, ["magenta3"])):
        for _ in range(round(time_s / 0.05)):
            led.bench.port("match_events").put()
            led.bench.iterate()
        assert led.state.sent_off == away


@pytest.mark.parametrize("restarts", [True, False])
def test_deciding_penalties_go_on_after_a_restart(restarts: bool) -> None:
    led = Led(automatic=True)
    led.ask("penalties", "goal cyan", "goal magenta", "start", "penalty magenta")  # cyan misses its second one
    if restarts:
        led.restart()
    assert (led.state.state, led.state.state_team) == (game_state_t.PENALTY, game_state_t.TEAM_MAGENTA)
    led.ask("goal magenta")
    assert State(led.state.state) is State.FROZEN


@pytest.mark.parametrize(
    "text",
    [
        "",
        "{",
        "[]",
        "null",
        '{"half": 2}',
        '{"state": {"State": 99}}',
        '{"state": {"Nothing": 1}}',
        '{"score": {"dict": [{"tuple": [1]}]}}',
        '{"_stretch": {"Touches": {"last": "cyan1"}}}',
        "[" * 100_000,
    ],
)
def test_unreadable_memory_begins_the_match_anew(text: str) -> None:
    bench = Bench(Referee, "world/referee")
    bench.port("told_memory").put(text=text)
    bench.port("told_history").put(match_history_t(events=[game_event_t(team=9, half=5, goal=True)]))
    bench.iterate()
    now = bench.port("game_state").sent[-1]
    assert (now.state, now.half, now.score_cyan, now.decisions) == (game_state_t.KICK_OFF, 1, 0, 1)
    assert any(line.text.startswith("the match begins anew; memory of the referee before: ") for line in bench.logged)


def test_memory_of_another_version_is_named() -> None:
    led = Led()
    text = led.bench.port("referee_memory").sent[-1].text.replace('"released"', '"let_go"')
    with pytest.raises(ValueError, match="Stretch has or lacks let_go, released, as in another version"):
        recall(Whistle(Rules()), text)


def test_game_that_a_person_stopped_stays_stopped() -> None:
    led = Led(automatic=True, stoppage_s=0.1, kick_off_stoppage_s=0.1, positions_s=0.1, ends_s=0.1)
    led.ask("freekick cyan", "stop")
    led.restart()
    led.go_on(2.0)
    assert led.stands[:3] == (State.FREE_KICK, game_state_t.TEAM_CYAN, True)
    led.ask("start")
    assert led.stands[:3] == (State.FREE_KICK, game_state_t.TEAM_CYAN, False)


def test_break_that_a_person_holds_goes_on() -> None:
    led = Led(automatic=True, half_time_s=0.5)
    led.ask("half_time", "stop")
    led.restart()
    led.go_on(2.0)
    assert State(led.state.state) is State.HALF_TIME


@pytest.mark.parametrize("restarts", [True, False])
def test_penalty_goal_taken_back_does_not_decide(restarts: bool) -> None:
    led = Led(automatic=True, penalties=1)
    led.ask("penalties", "goal cyan", "subgoal cyan", "stop")
    if restarts:
        led.restart()
    led.ask("start", "penalty cyan")  # magenta misses, too: 0:0
    assert (State(led.state.state), led.state.state_team) == (State.PENALTY, game_state_t.TEAM_CYAN)


@pytest.mark.parametrize("restarts", [True, False])
def test_fouls_without_a_card_are_remembered(restarts: bool) -> None:
    led = Led(automatic=True)
    for _ in range(2):
        led.whistle.cards.foul("cyan2", led.whistle.rules)
    led.go_on(0.05)
    if restarts:
        led.restart()
    assert led.whistle.cards.foul("cyan2", led.whistle.rules) is Card.YELLOW, "the third foul"


def test_time_beside_the_field_goes_on_over_the_halves() -> None:
    led = Led(double_yellow_s=5.0)
    led.ask("start", "double_yellow cyan3")
    led.go_on(2.0)
    led.ask("half_time", "second_half", "start")
    led.restart()
    led.go_on(2.0)
    assert led.state.sent_off == ["cyan3"]
    led.go_on(1.0)
    assert led.state.sent_off == []


def test_place_where_play_was_stopped_is_remembered() -> None:
    led = Led()
    led.ask("start")
    led.bench.port("match_events").put(ball_x_m=3.0, ball_y_m=-2.0)
    led.bench.port("referee_command").put(name="corner", team="cyan")
    led.bench.iterate()
    left_at = led.whistle.restart_place(Point(0.0, 0.0))
    led.restart()
    assert led.whistle.restart_place(Point(0.0, 0.0)) == left_at != Point(0.0, 0.0)


@pytest.mark.parametrize(
    ("place", "team", "state", "score"),
    [
        ((3.0, 7.3), game_state_t.TEAM_MAGENTA, State.THROW_IN, (0, 0)),
        ((11.3, 4.0), game_state_t.TEAM_MAGENTA, State.GOAL_KICK, (0, 0)),
        ((11.3, 0.3), game_state_t.TEAM_MAGENTA, State.KICK_OFF, (1, 0)),
    ],
)
def test_ball_that_left_without_a_referee_is_called(
    place: tuple[float, float], team: int, state: State, score: tuple[int, int]
) -> None:
    led = Led(automatic=True)
    led.ask("start")
    for x_m, robot in ((0.0, "cyan3"), (2.0, ""), (4.0, "cyan2")):
        touch = match_event_t(kind=match_event_t.TOUCH, robot=robot, x_m=x_m)
        report = {"ball_in_field": True, "last_touch": robot, "events": [touch] if robot else []}
        led.bench.port("match_events").put(ball_x_m=x_m, **report)
        led.bench.iterate()
    assert led.stands[:3] == (State.PLAY, game_state_t.TEAM_NONE, False)
    led.restart(ball_x_m=place[0], ball_y_m=place[1], last_touch="cyan2")
    assert led.stands[:3] == (state, team, True)
    assert (led.state.score_cyan, led.state.score_magenta) == score
