"""Tracks one ball from the sightings of several robots, each of which counts at the time of its exposure.

Messages of mates arrive later than frames of the own camera, and a track cannot go back in time over a kick or a
bounce. The tracker therefore keeps the tracks of the last moments: a late input changes the track at its own time, and
all later inputs are applied again.
"""

from bisect import bisect_left
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from operator import itemgetter

from procs.model.ball import BALL, BallModel
from procs.model.frames import Floats
from procs.model.robot import ROBOT
from procs.model.units import US_PER_S
from procs.world_model.ball_filter import BallFilter
from procs.world_model.ball_track import BallTrack, Step
from procs.world_model.contact import Robots
from procs.world_model.flight import Flight
from procs.world_model.seen import Seen
from procs.world_model.sighting import Sighting
from procs.world_model.walls import Walls

_KEPT_US = 400_000  # older inputs are not used
_LONGEST_STEP_US = 100_000  # longest step of the filter
_DOUBT_S = 0.3  # a sighting that does not fit is kept for so long, or until the next frame
_OBSERVER_US = 500_000  # a robot observes the ball for so long after a sighting
_USUAL = Step()  # conditions after the last tick
_PUT_DOWN, _BY_OWN_CAMERA, _BY_MATE, _HELD, _KICKED = range(5)  # order of the inputs of one moment

_Input = Callable[[BallTrack], None]
_Turn = tuple[int, str, tuple[float, ...]]
"""Rank, robot and values of an input; they decide which input of one moment comes first."""


@dataclass
class _Moment:
    """The inputs of one time, and the track after them."""

    track: BallTrack
    inputs: list[tuple[_Turn, _Input]] = field(default_factory=list)
    """Turns and inputs."""


class BallTracker:
    """Track of the ball: `advance` once a tick, then the inputs of the tick."""

    def __init__(self, ball: BallModel = BALL, fastest_m_s: float = ROBOT.fastest_ball_m_s) -> None:
        self.ball = ball
        """Friction and bounce of the ball."""
        self.fastest_m_s = fastest_m_s
        """Speed that no ball exceeds."""
        self._now_us = 0
        self._steps: list[Step] = []
        """The last ticks."""
        self._moments = [_Moment(BallTrack(-_KEPT_US, ball, fastest_m_s))]
        self._sound = 1  # number of moments whose tracks contain all inputs
        self._current: BallTrack | None = None

    @property
    def known(self) -> bool:
        """True if the ball was seen within the time-out; this takes no prediction."""
        self._settle()
        newest = self._moments[-1].track
        parts = self._parts(newest.time_us, self._now_us)
        return newest.filter is not None and not any(newest.is_forgotten(*part) for part in parts)

    @property
    def track(self) -> BallFilter:
        """Filter of a known ball.

        Raises:
            ValueError: the ball is not known.
        """
        found = self._at_now().filter
        if found is None:
            raise ValueError("the ball is not known; ask 'known' first")
        return found

    @property
    def flight(self) -> Flight | None:
        """Height and lift of a ball in the air; None for a ball on the ground."""
        return self._at_now().flight

    @property
    def age_s(self) -> float:
        """Time since the newest sighting."""
        return (self._now_us - self._at_now().seen_us) / US_PER_S

    @property
    def observers(self) -> int:
        """Number of robots with a sighting in the last half second."""
        return sum(self._now_us - seen_us < _OBSERVER_US for seen_us, _ in self._at_now().confirmed.values())

    def advance(
        self,
        duration_s: float,
        timeout_s: float,
        *,
        contact: float = 0.0,
        robots: Robots | None = None,
        walls: Walls | None = None,
        next_s: float = 0.0,
    ) -> None:
        """Moves the track on by `duration_s`; forgets a ball without a sighting for `timeout_s`.

        Args:
            duration_s: time since the last call.
            timeout_s: longest time without a sighting.
            contact: probability that a post or a wall reaches the ball.
            robots: those that may touch the ball.
            walls: limits of the ball's way.
            next_s: time from a frame of the own camera within which the next one comes; 0: not known.
        """
        self._now_us += round(duration_s * US_PER_S)
        self._current = None
        oldest_us = self._now_us - _KEPT_US
        self._steps = [step for step in self._steps if step.end_us >= oldest_us]
        timeout_us, doubt_us = round(timeout_s * US_PER_S), round(max(_DOUBT_S, next_s) * US_PER_S)
        self._steps.append(Step(self._now_us, self.ball.rolling_m_s2, contact, robots, timeout_us, doubt_us, walls))
        self._settle()
        while len(self._moments) > 1 and self._moments[1].track.time_us <= oldest_us:
            del self._moments[0]
        if len(self._moments) == 1 and self._moments[0].track.time_us < oldest_us:
            self._moments[0] = _Moment(self._moved(self._moments[0].track, oldest_us))
        self._sound = len(self._moments)

    def see(self, sighting: Sighting, *others: Sighting) -> None:
        """Takes a sighting; `others` are other things in the same frame that may be the ball, if the first is not."""
        rank = _BY_OWN_CAMERA if sighting.own else _BY_MATE
        turn = rank, sighting.robot, tuple(sighting.position_m.tolist())
        self._take(turn, sighting.age_s, lambda track: track.see(sighting, others))

    def hold(self, robot: str, state: Floats, covariance: Floats, age_s: float = 0.0) -> None:
        """Takes a ball in a mouth of the team; earlier sightings do not count any more.

        Args:
            robot: name of the robot.
            state: (4) of the ball: x, y, vx, vy, world frame.
            covariance: (4, 4) that the robot's pose and velocity add to it.
            age_s: time since the mouth was looked at.
        """
        turn = _HELD, robot, tuple(state.tolist())
        self._take(turn, age_s, lambda track: track.hold(robot, state, covariance))

    def kick(
        self,
        velocity_m_s: Floats,
        age_s: float = 0.0,
        mouth: Seen = Seen.NOTHING,
        lift_m_s: float = 0.0,
        time_sd_s: float = 0.0,
    ) -> None:
        """Takes a kick that gave the ball a velocity; call it before `advance`.

        Args:
            velocity_m_s: (2), world frame.
            age_s: time since the kick; a negative one lies after the last tick, within the step of the next `advance`.
            mouth: place of the ball at the kick (0 or 1), such as the mouth of a mate; 0: that of the track.
            lift_m_s: velocity upwards.
            time_sd_s: deviation of the age.
        """
        turn = _KICKED, "", (*velocity_m_s.tolist(), lift_m_s)
        self._take(turn, age_s, lambda track: track.kick(velocity_m_s, lift_m_s, mouth, time_sd_s))

    def put_down(self, spot_m: Floats) -> None:
        """Takes a ball that the crew has just put on or beside a spot (2), world frame; earlier inputs do not count.

        A ball that seems to lie there already stays where it is.
        """
        self._take((_PUT_DOWN, "", tuple(spot_m.tolist())), 0.0, lambda track: track.put_down(spot_m))

    def _take(self, turn: _Turn, age_s: float, taken: _Input) -> None:
        """Keeps an input of `age_s` ago, unless that is too old."""
        time_us = self._now_us - round(age_s * US_PER_S)
        times_us = [moment.track.time_us for moment in self._moments]
        place = bisect_left(times_us, time_us)
        if place == 0 and time_us < times_us[0]:
            return
        if place == len(times_us) or times_us[place] != time_us:
            self._moments.insert(place, _Moment(BallTrack(time_us, self.ball, self.fastest_m_s)))
            self._sound = min(self._sound, place)
        moment = self._moments[place]
        last = not moment.inputs or moment.inputs[-1][0] <= turn
        moment.inputs.append((turn, taken))
        if place < self._sound and (last or place == 0):  # no track is kept that is earlier than the first
            taken(moment.track)
            place += 1
        self._sound = min(self._sound, place)
        self._current = None

    def _at_now(self) -> BallTrack:
        """Returns the track now, computed once a change."""
        if self._current is None:
            self._settle()
            self._current = self._moved(self._moments[-1].track, self._now_us)
        return self._current

    def _settle(self) -> None:
        """Applies the inputs of all moments again, from the first one that changed."""
        for place in range(self._sound, len(self._moments)):
            moment = self._moments[place]
            moment.track = self._moved(self._moments[place - 1].track, moment.track.time_us)
            moment.inputs.sort(key=itemgetter(0))
            for _, taken in moment.inputs:
                taken(moment.track)
        self._sound = len(self._moments)

    def _moved(self, track: BallTrack, time_us: int) -> BallTrack:
        """Returns a track at a later time, through the conditions of the ticks between."""
        for part in self._parts(track.time_us, time_us):
            track = track.moved(*part)
        return track

    def _parts(self, from_us: int, to_us: int) -> Iterator[tuple[int, Step]]:
        """Yields the end and the conditions of each part into which a prediction is divided."""
        while from_us < to_us:
            from_us = min(to_us, from_us + _LONGEST_STEP_US)
            yield from_us, next((step for step in self._steps if step.end_us >= from_us), _USUAL)
