"""Referees the match: calls goals, balls out and fouls, places the ball, shows cards, keeps time and score."""

from fwk import Clock, Component, Config, Logger, Reads, Serves, Writes, channel
from lcmtypes.soccer import (
    ball_placement_t,
    game_event_t,
    game_state_t,
    ground_truth_t,
    match_event_t,
    match_events_t,
    match_history_t,
    referee_command_t,
    referee_memory_t,
)
from procs.model.events import Event, Kind
from procs.model.field import Point
from procs.model.game_states import State
from procs.model.teams import Team
from procs.referee.calls import Call
from procs.referee.memory import recall, written
from procs.referee.names import Names
from procs.referee.orders import carry_out
from procs.referee.reasons import OFF_FIELD, Reason
from procs.referee.rules import Rules
from procs.referee.sight import LEAVES, Sight, left_unseen
from procs.referee.whistle import Whistle

_KINDS = frozenset(Kind)
_REPEATED_TICKS = 100  # from one message with the history to the next, for readers outside that come late


class RefereeConfig(Config, Rules):
    """Times and limits of the match."""


class Referee(Component):
    """Decides from the reports of the linesmen and the true positions of the robots; obeys manual commands.

    While the world is frozen, time stands still for the referee, too: it only obeys commands.

    `fwk call world/referee_command name=freekick team=cyan`
    """

    stage = "post_loop"

    config: RefereeConfig
    clock: Clock
    log: Logger
    match_events: Reads[match_events_t]
    ground_truth: Reads[ground_truth_t]
    referee_command: Serves[referee_command_t]
    told_memory: Reads[referee_memory_t] = channel("world/referee_memory")
    """Own messages, with which a referee that was restarted goes on; so is `told_history`."""
    told_history: Reads[match_history_t] = channel("world/match_history")
    game_state: Writes[game_state_t]
    match_history: Writes[match_history_t]
    """Written in the first iteration, when a decision is added, with each command, and every 100 ticks."""
    ball_placement: Writes[ball_placement_t]
    referee_memory: Writes[referee_memory_t]

    def init(self) -> None:
        self._whistle = Whistle(self.config)
        self._placed = 0
        self._before_us = -1
        self._names = Names(self.config.players)
        self._has_grown = False  # the history, since it was written
        self._awaited = Team.NONE
        self._begun = False

    def loop(self) -> None:
        whistle = self._whistle
        whistle.rules = self.config
        passed_s = self.clock.period_s if self._before_us < 0 else self.clock.since_s(self._before_us)
        self._before_us = self.clock.now_us
        sight = self._sight()
        if not self._begun and self._begin():
            sight = self._with_unseen(sight)
        if sight.events or not self.match_events.value.frozen:
            whistle.step(passed_s, sight)
            for call in whistle.calls:
                self._record(call)
            self._tell_awaited(sight)
        self._write_history(due=(self.clock.tick - 1) % _REPEATED_TICKS < self.clock.every)
        self._write_state()
        self._obey(sight)
        if whistle.placements != self._placed:
            self._placed = placement_id = whistle.placements
            placement = self.ball_placement.value
            placement.placement_id, placement.x_m, placement.y_m = placement_id, *whistle.spot
            self.ball_placement.write()
        self.referee_memory.value.text = written(whistle)
        self.referee_memory.write()

    def _begin(self) -> bool:
        """Begins the match, or goes on with that of the referee before a restart; returns whether it goes on."""
        self._begun = True
        whistle = self._whistle
        if self.told_memory.has_value:
            try:
                recall(whistle, self.told_memory.value.text)
            except ValueError as error:
                self.log.warning(f"the match begins anew; memory of the referee before: {error}")
            else:
                self.match_history.value.events = self.told_history.value.events
                self._has_grown, self._placed = True, whistle.placements
                self.log.info(f"goes on, {self._stands()}")
                return True
        self._record(Call(whistle.state, whistle.team))
        return False

    def _with_unseen(self, sight: Sight) -> Sight:
        """Adds that the ball has left the field, if it did between the referee before and this one."""
        report = self.match_events.value
        told = any(event.kind in LEAVES for event in sight.events)
        if told or report.ball_in_field or report.frozen or not self.match_events.has_value or self._whistle.stopped:
            return sight
        radius_m = self.config.ball.radius_m
        unseen = left_unseen(sight.ball, sight.last_touch, self.config.field, radius_m)
        return sight._replace(events=[*sight.events, unseen])

    def _sight(self) -> Sight:
        ball, name_of = self.match_events.value, self._names.of_player
        self._names.learn(robot.name for robot in self.ground_truth.value.robots)
        robots = {name_of(robot.name): robot for robot in self.ground_truth.value.robots}
        robots.pop("", None)  # what plays in neither team
        reported = [event for report in self.match_events.fresh for event in report.events if event.kind in _KINDS]
        events = [_event(event, self._names) for event in reported if event.kind in LEAVES or self._concerns(event)]
        return Sight(
            Point(ball.ball_x_m, ball.ball_y_m),
            events,
            {name: Point(robot.x_m, robot.y_m) for name, robot in robots.items()},
            {name: Point(robot.vx_m_s, robot.vy_m_s) for name, robot in robots.items()},
            name_of(ball.last_touch),
        )

    def _concerns(self, event: match_event_t) -> bool:
        """Returns whether all robots of an event are players."""
        name_of = self._names.of_player
        return bool(name_of(event.robot) and (name_of(event.other) or event.kind != Kind.COLLISION))

    def _obey(self, sight: Sight) -> None:
        """Carries the commands of a tick out; each is followed by the history and the state that it has led to."""
        for command in self.referee_command:
            asked, self._whistle.calls = command.value, []
            refused = carry_out(self._whistle, sight, asked.name, asked.team, asked.robot, self._names)
            if refused:
                command.reject(refused)
                continue
            if asked.name == "reset":
                self.match_history.value.events = []
            for call in self._whistle.calls:
                self._record(call)
            self._write_history(due=True)
            self._write_state()
            command.done()

    def _tell_awaited(self, sight: Sight) -> None:
        """Logs for which team a set piece waits, once each time."""
        awaited, least = self._whistle.awaited, self.config.least_robots
        if awaited and awaited is not self._awaited:
            there = len(sight.without(self._whistle.cards.sent_off).team(awaited))
            team = awaited.name.lower()
            self.log.warning(f"the game waits for robots of {team}: {there} on the field, and least_robots is {least}")
        self._awaited = awaited

    def _record(self, call: Call) -> None:
        """Adds a decision to the history and logs it."""
        whistle, event = self._whistle, game_event_t()
        event.goal, event.card, event.state, event.team = call.goal, call.card, call.state, call.team
        event.half, event.time_in_half_s = whistle.half, whistle.time_in_half_s
        event.robot, event.reason = self._names.namespace(call.robot), str(call.reason or "")
        if call.card or call.reason or call.state not in (State.HALF_TIME, State.FROZEN):
            self.match_history.value.events.append(event)
            self._has_grown = True
        if not call.goal:
            self.log.info(self._words(call))

    def _words(self, call: Call) -> str:
        when = self._when()
        if call.card:
            return f"{call.card.name.lower().replace('_', ' ')} card for {self._names.namespace(call.robot)}, {when}"
        if call.reason is Reason.SUBGOAL:
            return f"goal of {call.team.name.lower()} taken back, {self._stands()}"
        if call.reason in OFF_FIELD:
            return f"{call.reason}{f' of {self._names.namespace(call.robot)}' if call.robot else ''}, {when}"
        what = "final whistle" if call.state is State.FROZEN else call.state.words
        whose = f" for {call.team.name.lower()}" if call.team else ""
        why = f" ({', '.join(filter(None, (call.reason, self._names.namespace(call.robot))))})" if call.reason else ""
        return f"{what}{whose}{why}, {self._stands()}"

    def _stands(self) -> str:
        return f"{self._whistle.standing}, {self._when()}"

    def _when(self) -> str:
        return f"{self._whistle.time_in_half_s:.1f} s into half {self._whistle.half}"

    def _write_state(self) -> None:
        whistle, game = self._whistle, self.game_state.value
        game.state, game.state_team = whistle.state, whistle.team
        game.stopped, game.half, game.cyan_side = whistle.stopped, whistle.half, round(whistle.ends.cyan_side)
        game.score_cyan, game.score_magenta = whistle.score[Team.CYAN], whistle.score[Team.MAGENTA]
        game.time_in_half_s, game.time_in_state_s = whistle.time_in_half_s, whistle.time_in_state_s
        game.ball_x_m, game.ball_y_m = whistle.spot
        game.sent_off = self._names.namespaces(whistle.cards.sent_off)
        game.decisions = len(self.match_history.value.events)
        self.game_state.write()

    def _write_history(self, due: bool) -> None:
        if self._has_grown or due:
            self._has_grown = False
            self.match_history.write()


def _event(event: match_event_t, names: Names) -> Event:
    robot, other = names.of_player(event.robot), names.of_player(event.other)
    return Event(Kind(event.kind), robot, other, event.x_m, event.y_m, event.speed_m_s)
