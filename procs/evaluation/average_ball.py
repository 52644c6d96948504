"""Ball of a team as the plain average of the newest sightings of its robots, the baseline of the world model's ball."""

import numpy as np

from fwk import Clock, Component, Reads, Writes
from lcmtypes.soccer import ball_percept_t, pose_t, team_inbox_t, world_model_t
from procs.model.frames import Floats, rotation
from procs.model.geometry import plausible
from procs.model.units import US_PER_S

_STALE_US = 500_000


class AverageBall(Component):
    """Averages as Fawkes' world model did in 2008: no weights, no motion, no delays; the velocity stays 0."""

    stage = "worldstate"

    pose: Reads[pose_t]
    ball_percept: Reads[ball_percept_t]
    team_inbox: Reads[team_inbox_t]
    average_ball: Writes[world_model_t]
    """Only the ball is filled in."""
    clock: Clock

    def init(self) -> None:
        self._seen: dict[str, tuple[int, Floats]] = {}
        """Robot to time and place of its newest sighting; the own one has no name."""

    def loop(self) -> None:
        if self.ball_percept.refreshed:
            self._look()
        for message in (message for inbox in self.team_inbox.fresh for message in inbox.messages):
            if message.ball_visible and message.localized and plausible(message.ball_x_m, message.ball_y_m):
                self._seen[message.robot] = self.clock.now_us, np.array((message.ball_x_m, message.ball_y_m))
        oldest_us = self.clock.now_us - _STALE_US
        self._seen = {robot: seen for robot, seen in self._seen.items() if seen[0] >= oldest_us}
        ball = self.average_ball.value.ball
        ball.known = bool(self._seen)
        if self._seen:
            ball.x_m, ball.y_m = np.mean([place for _, place in self._seen.values()], axis=0).tolist()
            ball.age_s = (self.clock.now_us - max(seen_us for seen_us, _ in self._seen.values())) / US_PER_S
            ball.observers = len(self._seen)
        self.average_ball.write()

    def _look(self) -> None:
        pose, percept = self.pose.value, self.ball_percept.value
        sound = plausible(pose.x_m, pose.y_m, pose.heading_rad, percept.x_m, percept.y_m)
        if percept.visible and pose.localized and sound:
            place = rotation(pose.heading_rad) @ (percept.x_m, percept.y_m) + (pose.x_m, pose.y_m)
            self._seen[""] = self.clock.now_us, place
