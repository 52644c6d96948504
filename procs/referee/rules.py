"""Rules of the referee: from the reports of the linesmen to the state of the game.

A simplification of the rules of the middle size league: no cards, no dribbling limit, and fouls are free kicks. As
there, a goal counts only if the scoring team touched the ball last in the opponents' half, own goals excepted, and a
set piece is released once all robots keep their distance and, at a kick-off, their half.
"""

import math
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import NamedTuple

from pydantic import BaseModel, ConfigDict, NonNegativeFloat, PositiveFloat

from procs.model.field import Field, Point
from procs.referee import restarts
from procs.referee.positions import misplaced
from procs.referee.restarts import Restart, State, Team
from procs.simulation.physics.events import Event, Kind

_MISPLACED_M = 0.6  # the crew may have to put the ball beside a robot; further away, a robot has pushed it
_CREW_S = 0.5  # until the report shows a placement


class Rules(BaseModel):
    """Times and limits of a match."""

    model_config = ConfigDict(extra="forbid", use_attribute_docstrings=True)

    half_s: PositiveFloat = 900.0
    """Length of a half, stoppages included."""
    half_time_s: NonNegativeFloat = 5.0
    """Break between the halves."""
    kick_off_stoppage_s: NonNegativeFloat = 6.0
    """From a goal or the beginning of a half until the kick-off may be taken."""
    stoppage_s: NonNegativeFloat = 3.0
    """From an interruption until the set piece may be taken."""
    positions_s: NonNegativeFloat = 6.0
    """Longest further wait for robots that are too near to the ball or in the wrong half."""
    set_piece_s: PositiveFloat = 7.0
    """Time for a set piece; after it play goes on."""
    moved_m: PositiveFloat = 0.2
    """A set piece is taken when the ball has moved that far."""
    deadlock_s: PositiveFloat = 10.0
    """A ball that stays within `deadlock_m` for so long is dropped elsewhere."""
    deadlock_m: PositiveFloat = 0.5
    collision_m_s: PositiveFloat = 3.0
    """Closing speed above which a collision is a foul of the faster robot."""
    field: Field = Field()


class Sight(NamedTuple):
    """Report of the linesmen about a tick."""

    ball: Point
    events: Sequence[Event] = ()
    robots: Mapping[str, Point] = MappingProxyType({})
    """Middle of each robot on the field."""


class Referee:
    """Leads a match: call `step` once a tick and read the attributes."""

    def __init__(self, rules: Rules) -> None:
        self.rules = rules
        self.state, self.team, self.spot = restarts.kick_off(Team.CYAN)
        self.stopped = True
        """Robots take position; the ball is not to be touched."""
        self.half = 1
        self.score = {Team.CYAN: 0, Team.MAGENTA: 0}
        self.time_in_half_s = 0.0
        self.time_in_state_s = 0.0
        self.placements = 1
        """A higher number than before: the ball is to be put on `spot`."""
        self._resting_at = self.spot  # where the ball was when it was last seen to move on
        self._resting_s = 0.0
        self._since_placed_s = 0.0
        self._last_touch = self.spot  # where the ball was touched last in play

    @property
    def over(self) -> bool:
        """Whether the match has ended."""
        return self.state is State.FROZEN

    def step(self, duration_s: float, sight: Sight) -> None:
        """Runs one tick of `duration_s`."""
        self.time_in_state_s += duration_s
        if self.over:
            return
        if self.state is State.HALF_TIME:
            if self.time_in_state_s >= self.rules.half_time_s:
                self.half, self.time_in_half_s = 2, 0.0
                self._interrupt(restarts.kick_off(Team.MAGENTA))
            return
        self.time_in_half_s += duration_s
        if self.time_in_half_s >= self.rules.half_s:
            self._enter(State.HALF_TIME if self.half == 1 else State.FROZEN, Team.NONE, stopped=True)
        elif self.stopped:
            self._wait_for_robots(duration_s, sight)
        else:
            self._watch(duration_s, sight)

    def _wait_for_robots(self, duration_s: float, sight: Sight) -> None:
        ball = sight.ball
        self._since_placed_s += duration_s
        if math.dist(ball, self.spot) > _MISPLACED_M and self._since_placed_s > _CREW_S:
            self._place()
        kicks_off = self.state is State.KICK_OFF
        stoppage_s = self.rules.kick_off_stoppage_s if kicks_off else self.rules.stoppage_s
        if self.time_in_state_s < stoppage_s:
            return
        patient = self.time_in_state_s < stoppage_s + self.rules.positions_s
        if patient and misplaced(Restart(self.state, self.team, self.spot), sight.robots):
            return
        self._enter(self.state, self.team, stopped=False)
        self._resting_at, self._resting_s, self._last_touch = ball, 0.0, ball

    def _watch(self, duration_s: float, sight: Sight) -> None:
        for event in sight.events:
            if event.kind in (Kind.TOUCH, Kind.KICK):
                self._last_touch = Point(event.x_m, event.y_m)
        restart = next(filter(None, map(self._call, sight.events)), None)
        if restart:
            self._interrupt(restart)
            return
        self._resting_s += duration_s
        limit_m = self.rules.deadlock_m if self.state is State.PLAY else self.rules.moved_m
        if math.dist(sight.ball, self._resting_at) > limit_m:
            self._resting_at, self._resting_s = sight.ball, 0.0
            if self.state is not State.PLAY:
                self._play()
        elif self.state is not State.PLAY:
            if self.time_in_state_s >= self.rules.set_piece_s:
                self._play()
        elif self._resting_s >= self.rules.deadlock_s:
            self._interrupt(restarts.dropped_ball(sight.ball, self.rules.field))

    def _call(self, event: Event) -> Restart | None:
        field, place, team = self.rules.field, Point(event.x_m, event.y_m), restarts.team_number(event.robot)
        match event.kind:
            case Kind.GOAL:
                return self._goal(place, team)
            case Kind.OUT_SIDE:
                return restarts.after_side_line(place, team, field)
            case Kind.OUT_END:
                return restarts.after_goal_line(place, team, field)
            case Kind.COLLISION if event.speed_m_s > self.rules.collision_m_s:
                if restarts.team_number(event.other) is not team:
                    return restarts.after_foul(place, team, field)
        return None

    def _goal(self, place: Point, touched_by: Team) -> Restart:
        conceding = Team.CYAN if place.x_m < 0 else Team.MAGENTA
        from_own_half = self._last_touch.x_m * place.x_m < 0
        if touched_by is conceding.other and from_own_half:
            return restarts.goal_kick(conceding, place.y_m, self.rules.field)
        self.score[conceding.other] += 1
        return restarts.kick_off(conceding)

    def _interrupt(self, restart: Restart) -> None:
        self._enter(restart.state, restart.team, stopped=True)
        self.spot = restart.spot
        self._place()

    def _place(self) -> None:
        self.placements += 1
        self._since_placed_s = 0.0

    def _play(self) -> None:
        self._enter(State.PLAY, Team.NONE, stopped=False)

    def _enter(self, state: State, team: Team, stopped: bool) -> None:
        self.state, self.team, self.stopped = state, team, stopped
        self.time_in_state_s = 0.0
