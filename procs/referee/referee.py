"""Referees the match: calls goals, balls out and fouls, places the ball, keeps time and score."""

from fwk import Clock, Component, Config, Logger, Reads, Writes
from lcmtypes.soccer import ball_placement_t, game_event_t, game_state_t, ground_truth_t, match_event_t, match_events_t
from procs.model.field import Point
from procs.referee.restarts import State, Team
from procs.referee.rules import Referee as Whistle
from procs.referee.rules import Rules, Sight
from procs.simulation.physics.events import Event, Kind

_KINDS = frozenset(Kind)


class RefereeConfig(Config, Rules):
    """Times and limits of the match."""


class Referee(Component):
    """Decides from the reports of the linesmen and the true positions of the robots."""

    stage = "post_loop"

    config: RefereeConfig
    clock: Clock
    log: Logger
    match_events: Reads[match_events_t]
    ground_truth: Reads[ground_truth_t]
    game_state: Writes[game_state_t]
    ball_placement: Writes[ball_placement_t]

    def init(self) -> None:
        self._whistle = Whistle(self.config)
        self._placed = 0
        self._before_us = -1

    def loop(self) -> None:
        whistle = self._whistle
        whistle.rules = self.config
        before, score = (whistle.state, whistle.stopped), dict(whistle.score)
        events = [
            _event(event) for report in self.match_events.fresh for event in report.events if event.kind in _KINDS
        ]
        ball = self.match_events.value
        passed_s = self.clock.period_s if self._before_us < 0 else self.clock.since_s(self._before_us)
        self._before_us = self.clock.now_us
        robots = {robot.name: Point(robot.x_m, robot.y_m) for robot in self.ground_truth.value.robots}
        whistle.step(passed_s, Sight(Point(ball.ball_x_m, ball.ball_y_m), events, robots))
        for team in whistle.score:
            if whistle.score[team] > score[team]:
                self._remember(True, team)
        if (whistle.state, whistle.stopped) != before or self.clock.tick == 1:
            if whistle.stopped and whistle.state is not State.PLAY:
                self._remember(False, whistle.team)
            self._announce()
        self._write_state()
        if whistle.placements != self._placed:
            self._placed = placement_id = whistle.placements
            placement = self.ball_placement.value
            placement.placement_id, placement.x_m, placement.y_m = placement_id, *whistle.spot
            self.ball_placement.write()

    def _remember(self, goal: bool, team: int) -> None:
        event = game_event_t()
        event.goal, event.state, event.team = goal, self._whistle.state, team
        event.half, event.time_in_half_s = self._whistle.half, self._whistle.time_in_half_s
        self.game_state.value.history.append(event)

    def _write_state(self) -> None:
        whistle, game = self._whistle, self.game_state.value
        game.state, game.state_team, game.stopped, game.half = (
            whistle.state,
            whistle.team,
            whistle.stopped,
            whistle.half,
        )
        game.score_cyan, game.score_magenta = whistle.score[Team.CYAN], whistle.score[Team.MAGENTA]
        game.time_in_half_s, game.time_in_state_s = whistle.time_in_half_s, whistle.time_in_state_s
        game.ball_x_m, game.ball_y_m = whistle.spot
        self.game_state.write()

    def _announce(self) -> None:
        whistle = self._whistle
        if whistle.state is State.PLAY:
            return
        score = f"{whistle.score[Team.CYAN]}:{whistle.score[Team.MAGENTA]}"
        what = "final whistle" if whistle.over else whistle.state.name.lower().replace("_", " ")
        whose = f" for {whistle.team.name.lower()}" if whistle.team else ""
        if whistle.stopped:
            self.log.info(
                f"{what}{whose}, cyan {score} magenta, {whistle.time_in_half_s:.1f} s into half {whistle.half}"
            )


def _event(event: match_event_t) -> Event:
    return Event(Kind(event.kind), event.robot, event.other, event.x_m, event.y_m, event.speed_m_s)
