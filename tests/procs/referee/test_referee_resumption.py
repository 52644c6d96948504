"""A referee that was restarted goes on with the match that its own messages state."""

import math
from typing import Any

import pytest

from fwk.testing import Bench
from lcmtypes.soccer import game_event_t, game_state_t, match_history_t, true_robot_t
from procs.model.game_states import State
from procs.referee.referee import Referee

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

    def restart(self) -> None:
        """Puts a new referee in the place of this one."""
        told, history, tick = self.state, self.bench.port("match_history").sent[-1], self.bench.tick
        self.bench = Bench(Referee, "world/referee", **self.rules)
        self.bench.tick = tick
        self.bench.port("told_state").put(told)
        self.bench.port("told_history").put(history)
        self.bench.port("match_events").put(frozen=True)
        self.bench.iterate()

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
    "wrong",
    [
        {"state": 99},
        {"state_team": 3},
        {"half": 0},
        {"half": 6},
        {"score_cyan": -1},
        {"time_in_half_s": math.nan},
        {"ball_x_m": math.inf},
        {"time_in_state_s": -1.0},
    ],
)
def test_impossible_state_begins_the_match_anew(wrong: dict[str, float]) -> None:
    bench = Bench(Referee, "world/referee")
    told = game_state_t(state=game_state_t.PLAY, half=2, score_cyan=3)
    for name, value in wrong.items():
        setattr(told, name, value)
    bench.port("told_state").put(told)
    bench.port("told_history").put(match_history_t(events=[game_event_t(team=9, half=5, goal=True)]))
    bench.iterate()
    now = bench.port("game_state").sent[-1]
    assert (now.state, now.half, now.score_cyan, now.decisions) == (game_state_t.KICK_OFF, 1, 0, 1)
