"""Feeds a robot's ball tracker with kicks, the crew's spot, the own mouth, the own camera and mates, in this order."""

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from lcmtypes.robot import kicker_state_t
from lcmtypes.soccer import ball_percept_t, game_state_t, team_message_t
from procs.model.frames import Floats
from procs.model.units import US_PER_S
from procs.world_model.ball_tracker import BallTracker
from procs.world_model.contact import RobotRow, Robots
from procs.world_model.empty_mouth import EmptyMouth
from procs.world_model.kicks import Kick, Kicks
from procs.world_model.own_sights import OwnSights
from procs.world_model.own_view import OwnView
from procs.world_model.placed_ball import PlacedBall
from procs.world_model.seen import Seen
from procs.world_model.settings import STALE_S, WorldModelConfig, counts
from procs.world_model.sighting import Sighting
from procs.world_model.team import Mate
from procs.world_model.told import IN_MOUTH_M, ball_of, held_by
from procs.world_model.walls import Walls

_OUTSIDE_M = 3.0  # a ball this far outside the walls is another thing, however poorly it is seen
_HIGHEST_M = 20.0  # no kick lifts a ball higher
_IN_MOUTH_M2 = np.eye(2) * IN_MOUTH_M**2
"""Covariance of the place of a ball in the mouth."""


class BallNews(NamedTuple):
    """News of a tick about the ball."""

    now_us: int
    """Logical time."""
    passed_s: float
    """Time since the last tick."""
    iteration_s: float
    """Usual time from one tick to the next."""
    holds: bool
    """Whether the robot has the ball in its mouth."""
    kicker: kicker_state_t | None
    """Newest state of the own kicker; None before the first."""
    game: game_state_t | None
    """Newest state of the game; None before the first."""
    percept: ball_percept_t | None
    """Percept of the own camera, if there is a new one."""
    told: Sequence[tuple[team_message_t, Mate]]
    """New messages of mates."""


class BallFollower:
    """The ball as a robot knows it; call `follow` once a tick."""

    def __init__(self, robot: str, config: WorldModelConfig) -> None:
        """Begins without a ball, for the robot with the name `robot`."""
        fastest_m_s = config.robot.fastest_ball_m_s
        self.tracker = BallTracker(config.ball, fastest_m_s)
        """Track of the ball."""
        self.kicks = Kicks(fastest_m_s)
        """Kicks of the robot and its mates."""
        self.untold = Seen.NOTHING
        """Likeliest place of the ball in the newest own percept (0 or 1), until a message to the team has told it."""
        self._robot = robot
        self._own_sights = OwnSights(fastest_m_s)
        self._placed = PlacedBall()
        self._empty_mouth = EmptyMouth()
        self._held = False
        self.apply(config)

    def apply(self, config: WorldModelConfig) -> None:
        """Takes new settings; if they describe another ball or other kickers, the track begins anew."""
        fastest_m_s = config.robot.fastest_ball_m_s
        if (self.tracker.ball, self.tracker.fastest_m_s) != (config.ball, fastest_m_s):
            self.tracker = BallTracker(config.ball, fastest_m_s)
        self.kicks.fastest_m_s = self._own_sights.fastest_m_s = fastest_m_s
        self._config = config
        self._walls = Walls.of(config.field, config.ball)
        self._mouth_m = config.mouth_m

    def follow(self, news: BallNews, view: OwnView, robots: Iterable[RobotRow]) -> Kick | None:
        """Takes the news of a tick; returns the robot's own kick, if it has kicked.

        Args:
            news: news about the ball.
            view: the robot's own pose and velocity.
            robots: all robots at the end of the tick, world frame.
        """
        passed_s, tracker = news.passed_s, self.tracker
        kicked = self.kicks.own(news.kicker, view, self._mouth_m, passed_s) if news.kicker else None
        kicks = self.kicks.of_mates(news.told, news.now_us, self._mouth_m, news.iteration_s)
        for kick in [kicked, *kicks] if kicked else kicks:
            tracker.kick(kick.velocity_m_s, kick.age_s - passed_s, kick.mouth, kick.lift_m_s, kick.time_sd_s)
        near = Robots.near(tracker.track, robots, self._mouth_m, self._config.robot.height_m) if tracker.known else None
        wall = float(tracker.known and self._walls.near(tracker.track, passed_s))
        timeout_s, next_s = self._config.ball_timeout_s, self._own_sights.next_s
        tracker.advance(passed_s, timeout_s, contact=wall, robots=near, walls=self._walls, next_s=next_s)
        if news.game:
            self._take_placed_ball(news.game)
        if news.kicker:
            self._empty_mouth.note(news.kicker)
        if news.holds and view.localized and not kicked:
            self._take_held_ball(view)
        self._held = news.holds
        if news.percept:
            self._look_for_ball(news.percept, view, news.now_us)
        self._take_mates_ball(news)
        return kicked

    def _take_placed_ball(self, game: game_state_t) -> None:
        """Takes the ball that the crew puts down in the tick after the state of the game says so."""
        spot_m = self._placed.spot_m(game, self.tracker)
        if spot_m is not None and self._is_inside_walls(spot_m):
            self.tracker.put_down(spot_m)

    def _take_held_ball(self, view: OwnView) -> None:
        """Takes the ball that the light barrier sees: its place, and its velocity unless it is still rolling in."""
        state, covariance = view.held_ball(self._mouth_m)
        if not self._held and self.tracker.known and view.rolls_in(self.tracker.track.state, state):
            self.tracker.see(Sighting(self._robot, True, state[:2], covariance[:2, :2] + _IN_MOUTH_M2))
        else:
            self.tracker.hold(self._robot, state, covariance)

    def _look_for_ball(self, percept: ball_percept_t, view: OwnView, now_us: int) -> None:
        """Takes a percept of the ball, and keeps its likeliest place for the next message to the team."""
        config = self._config
        age_s = config.age_s(percept.capture_us, now_us)
        exposed_us = now_us - round(age_s * US_PER_S)
        is_none = self._empty_mouth.refutes(percept, exposed_us, self._mouth_m)
        seen = Seen.NOTHING if is_none else view.ball(percept, age_s)
        self.untold = seen if self._is_possible(seen, percept.z_m, age_s) else Seen.NOTHING
        sightings = []
        for candidate, height_m in ((seen, percept.z_m), *view.other_balls(percept, age_s)):
            widened = candidate.widened(config.sight_correlation, config.pose_correlation)
            sightings += self._sightings(self._robot, widened, height_m, view.pose[:2], age_s)
        self._own_sights.note(exposed_us, sightings)
        self._see(sightings)

    def _take_mates_ball(self, news: BallNews) -> None:
        """Takes the ball that mates see, and the one in a mate's mouth unless the own camera sees it elsewhere."""
        in_turn = sorted(news.told, key=lambda told: told[1].name)  # as the tracker orders them: it has less to repeat
        for message, mate in in_turn:
            seen = ball_of(message).widened(self._config.team_correlation, 1.0)
            age_s = self._config.age_s(message.ball_capture_us or message.header.time_us, news.now_us)
            self._see(self._sightings(mate.name, seen, message.ball_z_m, mate.position_m, age_s))
            told_s = (news.now_us - message.header.time_us) / US_PER_S
            kicked_just_now = 0.0 <= (message.header.time_us - message.kick_us) / US_PER_S < news.iteration_s
            if mate.holds_ball and mate.localized and told_s <= STALE_S and not kicked_just_now:
                state, covariance = held_by(mate, self._mouth_m)
                if self._own_sights.contradict((state[0], state[1]), message.header.time_us, news.now_us):
                    mate.holds_ball = False  # its light barrier is dirty
                else:
                    self.tracker.hold(mate.name, state, covariance, told_s)

    def _sightings(self, robot: str, seen: Seen, height_m: float, observer_m: Floats, age_s: float) -> list[Sighting]:
        """Returns a sighting of the ball (0 or 1), unless it is too old, from the future or impossible."""
        if not self._is_possible(seen, height_m, age_s):
            return []
        own = robot == self._robot
        return [
            Sighting(robot, own, position_m, covariance_m2, age_s, height_m, observer_m)
            for position_m, covariance_m2 in zip(seen.positions_m, seen.covariances_m2, strict=True)
        ]

    def _is_possible(self, seen: Seen, height_m: float, age_s: float) -> bool:
        """Returns whether a ball (0 or 1) seen at that height is neither too old, from the future nor elsewhere."""
        inside = all(map(self._is_inside_walls, seen.positions_m))
        return counts(age_s) and abs(height_m) < _HIGHEST_M and inside

    def _is_inside_walls(self, place_m: Floats) -> bool:
        """Returns whether a ball (2) can be there: inside the walls, give or take the error of a poor sighting."""
        field = self._config.field
        return field.in_field(float(place_m[0]), float(place_m[1]), field.border_m + _OUTSIDE_M)

    def _see(self, sightings: list[Sighting]) -> None:
        """Passes the candidates for the ball in one frame to the tracker, the likeliest first."""
        if sightings:
            self.tracker.see(*sightings)
