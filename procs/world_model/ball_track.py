"""State of the ball track at one time, from inputs in the order of their times.

Order of the sources of sightings:

1. The light barrier in the robot's own mouth, which replaces whatever the track says.
2. The robot's own camera. Mates' sightings that fit are fused, each by its covariance.
3. Mates, when the robot does not see the ball itself; among them the more precise.

What happens to a sighting that does not fit the track:

- It is dropped if a better source has confirmed the track at the same exposure.
- It begins a new track if the ball moves, something may have touched it, and it can have come from where it was seen
  last. The way from there gives the new velocity.
- Otherwise it is kept as a doubt, until a better source confirms the track. Two doubts that fit each other begin a new
  track: the ball was kicked or placed elsewhere. Two doubts of one robot do not suffice if another robot has confirmed
  the track meanwhile.
- A single sighting suffices for a new track if no robot has seen the ball for a while, the ball can have come there,
  and the sighting is in the air or something may have touched the ball.

A single sighting that turns the ball, or begins a new track in the place of another, may show another thing. The track
before is therefore kept until a second sighting fits one of them: if it fits the track before only, the ball goes on as
before, and the single sighting is a doubt.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from dataclasses import field as of_class

import numpy as np

from procs.model.ball import BallModel
from procs.model.frames import Floats
from procs.model.units import US_PER_S
from procs.world_model.ball_filter import BallFilter
from procs.world_model.ball_modes import NO_CONTACT, Contact, Mode
from procs.world_model.contact import Robots
from procs.world_model.flight import Flight
from procs.world_model.seen import Seen
from procs.world_model.sighting import Sighting
from procs.world_model.told import IN_MOUTH_M
from procs.world_model.walls import Walls

_LOST_US = 250_000  # a ball that no robot has seen for longer may have met something
_USUAL_M_S = 11.0  # speed of a ball that was kicked hard
_LATE_S = 0.03  # time by which a track lags behind a ball that was kicked
_AT_ONCE_US = 20_000  # within this time, all robots see the ball at one place
_MOVES_M_S = 1.0  # a slower ball that seems to jump was more likely seen by a robot that errs about its own place
_MET, _MET_UNSEEN = 0.003, 0.02  # least probability that something has touched a ball that jumps, also unseen
_TURNS_M_S = 2.0  # a single sighting that changes the velocity by more turns the track
_FLIES_M = 0.1  # a ball that seems to fly lower than this may lie on the ground, partly hidden
_BELOW_M = 0.3  # largest deviation of a flying ball's place at which something on the ground is right below it
_NEVER_US = -(1 << 60)
_BESIDE_SPOT_M, _LIES_M_S = 0.6, 0.3  # a ball this near to the spot and this slow may lie beside a robot there
_SPOT_M = 0.1  # deviation of the place of a ball that was put on a spot
_HELD_M_S = 0.1  # deviation of a held ball's velocity in the mouth
_ELSEWHERE_M = 0.3  # a held ball further from the track begins a new one ...
_BEGINS_M = 0.05  # ... with this deviation of its place, besides that of the pose


@dataclass(frozen=True)
class Step:
    """Conditions of the motion during a tick."""

    end_us: int = 0
    """End of the tick."""
    rolling_m_s2: float = 0.0
    """Deceleration of the rolling ball."""
    contact: float = 0.0
    """Probability that a post or a wall reaches the ball."""
    robots: Robots | None = None
    """Robots that may touch the ball."""
    timeout_us: int = 2 * US_PER_S
    """The ball is forgotten after this time without a sighting."""
    doubt_us: int = 300_000
    """A sighting that does not fit is forgotten after this time."""
    walls: Walls | None = None
    """Walls, nets and bars that limit the way of the ball."""


@dataclass
class BallTrack:
    """Filter of the ball with the memory that judges sightings; all times in logical microseconds."""

    time_us: int
    ball: BallModel
    """Friction and bounce of the ball."""
    fastest_m_s: float
    """Speed that no ball exceeds."""
    filter: BallFilter | None = None
    """None while the ball is not known."""
    seen_us: int = _NEVER_US
    """Exposure of the newest sighting."""
    seen_m: tuple[float, float] = (0.0, 0.0)
    """Place of the ball then."""
    confirmed: dict[str, tuple[int, float]] = of_class(default_factory=dict)
    """Robot to exposure and weakness of its newest sighting in the track."""
    doubts: tuple[tuple[int, Sighting], ...] = ()
    """Exposures and sightings that did not fit."""
    carpet: tuple[float, float] | None = None
    """Carpet that the last filter learnt, if the ball is not known."""
    flight: Flight | None = None
    """None while the ball is on the ground."""
    before: "BallTrack | None" = None
    """The track before a single sighting turned it or began this one, until a second sighting fits."""

    def is_forgotten(self, time_us: int, step: Step) -> bool:
        """Returns whether the newest sighting is too old at a later time."""
        return time_us - self.seen_us > step.timeout_us

    def moved(self, time_us: int, step: Step) -> "BallTrack":
        """Returns the track at a later time; this one stays as it is."""
        if self.filter is None or self.is_forgotten(time_us, step):
            return BallTrack(
                time_us, self.ball, self.fastest_m_s, None, self.seen_us, self.seen_m, carpet=self._carpet()
            )
        doubts = self.doubts and tuple(doubt for doubt in self.doubts if time_us - doubt[0] <= step.doubt_us)
        last, ball, confirmed = (self.seen_us, self.seen_m), self.filter.copy(), self.confirmed.copy()
        made = BallTrack(time_us, self.ball, self.fastest_m_s, ball, *last, confirmed, doubts, flight=self.flight)
        made._advance((time_us - self.time_us) / US_PER_S, step)
        if self.before is not None and time_us - self.seen_us <= step.doubt_us:
            made.before = self.before.moved(time_us, step)
        return made

    def _advance(self, duration_s: float, step: Step) -> None:
        """Moves a known ball on."""
        assert self.filter is not None
        grounded_s, walls = duration_s, step.walls
        behind = walls is not None and walls.behind_net(self.filter, self.ball.radius_m)
        contact = self._contact(duration_s, step)
        if self.flight is not None:
            self.flight, grounded_s = self.flight.moved(duration_s, self.ball)
        self.filter.predict(duration_s, step.rolling_m_s2, contact, grounded_s)
        if walls is not None:
            over = self.flight is not None and self.flight.height_m > walls.goal_height_m
            walls.contain(self.filter, nets=not (behind or over))

    def _contact(self, duration_s: float, step: Step) -> Contact:
        """Returns the effect of robots, posts, bars and walls on a known ball in a step that ends now."""
        assert self.filter is not None
        found, robots, walls = NO_CONTACT, step.robots, step.walls
        if robots is not None:
            before_s = (step.end_us - self.time_us) / US_PER_S + duration_s
            found = robots.contact(self.filter, duration_s, before_s, self.flight)
        if walls is not None and self.flight is not None:
            bar = walls.bars.contact(self.filter, self.flight, duration_s)
            found = max(found, bar._replace(probability=found.probability))
        return found._replace(probability=max(found.probability, step.contact))

    def see(self, sighting: Sighting, others: Sequence[Sighting] = ()) -> None:
        """Takes a sighting that was captured at the time of the track.

        Of the `others` in the same frame the first that fits the track counts, if the sighting does not.
        """
        if self.filter is None:
            self._begin(sighting)
        elif (fitting := self._fitting(sighting, *others) or self._fitting_before(sighting, *others)) is not None:
            self._confirm(fitting)
        elif self._strayed(sighting):
            self._jump(sighting)
        elif not self._overruled(sighting) and not self._begin_if_struck(sighting):
            self._doubt(sighting)

    def _fitting(self, *sightings: Sighting) -> Sighting | None:
        """Corrects the track of a known ball with the first sighting that fits; returns that, if there is one."""
        assert self.filter is not None
        former, flight = self.filter.copy(), self.flight
        fitting = next(filter(self._fuse, sightings), None)
        if fitting is not None:
            turned = math.dist(former.likeliest[2:4], self.filter.likeliest[2:4]) > _TURNS_M_S
            self.before = replace(self._doubting(fitting), filter=former, flight=flight) if turned else None
        return fitting

    def _fitting_before(self, *sightings: Sighting) -> Sighting | None:
        """Goes on as before a single sighting turned the track, if another one fits that; returns the other."""
        before = self.before
        if before is None or before.filter is None:
            return None
        fitting = next(filter(before._fuse, sightings), None)
        if fitting is not None:
            self.filter, self.flight, self.before = before.filter, before.flight, None
            self.confirmed, self.doubts = before.confirmed, before.doubts
        return fitting

    def _doubting(self, sighting: Sighting) -> "BallTrack":
        """Returns the track as it is, with a doubt more; it does not follow what happens to this one."""
        doubts, confirmed = (*self.doubts, (self.time_us, sighting)), self.confirmed.copy()
        return replace(self, confirmed=confirmed, doubts=doubts, before=None)

    def _fuse(self, sighting: Sighting) -> bool:
        """Corrects the track of a known ball with a sighting; returns False, and changes nothing, if it does not fit.

        If the place fits but not the height, the sighting replaces the flight: the ball has bounced, or lies on the
        ground. Something on the ground right below a ball in the air is not the ball.
        """
        assert self.filter is not None
        if self.flight is None:
            if not self.filter.see(sighting.position_m, sighting.covariance_m2):
                return False
            self.flight = Flight.of_sight(sighting.height_m, rises=True)
            return True
        flight = self.flight.seen(sighting.height_m) or Flight.of_sight(sighting.height_m)
        if flight is None and self.filter.likeliest.place_m2 < _BELOW_M**2:
            return False
        if not self.filter.see(sighting.position_m, sighting.of_flying_m2()):
            return False
        self.flight = flight
        return True

    def hold(self, robot: str, state: Floats, covariance: Floats) -> None:
        """Takes a ball in the own mouth; see `BallTracker.hold`."""
        if self.filter is None or np.hypot(*(self.filter.state[:2] - state[:2])) > _ELSEWHERE_M:
            self.filter = self._new(state[:2], np.eye(2) * _BEGINS_M**2 + covariance[:2, :2])
        self.filter.hold(state, covariance + np.diag(np.square((IN_MOUTH_M, IN_MOUTH_M, _HELD_M_S, _HELD_M_S))))
        self.flight = self.before = None
        self.confirmed = {robot: (self.time_us, 0.0)}
        self._note_place()
        self.doubts = ()

    def put_down(self, spot_m: Floats) -> None:
        """Takes a ball that the crew has put down; see `BallTracker.put_down`."""
        if self.filter is not None:
            ball = self.filter.likeliest
            off_m = math.hypot(ball.x_m - spot_m[0], ball.y_m - spot_m[1])
            if off_m < _BESIDE_SPOT_M and math.hypot(ball.vx_m_s, ball.vy_m_s) < _LIES_M_S:
                return
        self.filter = self._new(spot_m, np.eye(2) * _SPOT_M**2)
        self.filter.rest()
        self.flight = self.before = None
        self.confirmed, self.doubts = {}, ()
        self._note_place()

    def kick(self, velocity_m_s: Floats, lift_m_s: float, mouth: Seen, time_sd_s: float) -> None:
        """Takes a kick at the time of the track; see `BallTracker.kick`."""
        if len(mouth.positions_m):
            place = mouth.positions_m[0], mouth.covariances_m2[0]
            if self.filter is None:
                self.filter = self._new(*place)
            self.filter.kick(velocity_m_s, *place, time_sd_s)
            self._note_place()
        elif self.filter is not None:
            self.filter.kick(velocity_m_s, time_sd_s=time_sd_s)
        self.flight = Flight.of_kick(lift_m_s)
        self.confirmed, self.doubts, self.before = {}, (), None

    def _new(self, position_m: Floats, covariance_m2: Floats, velocity_m_s: Floats | None = None) -> BallFilter:
        """Returns a filter that begins with a sighting, on the carpet that is known."""
        made, carpet = BallFilter(position_m, covariance_m2, self.ball, velocity_m_s, self.fastest_m_s), self._carpet()
        if carpet is not None:
            made.lie_on(carpet)
        return made

    def _carpet(self) -> tuple[float, float] | None:
        return self.carpet if self.filter is None else self.filter.carpet

    def _overruled(self, sighting: Sighting) -> bool:
        """Returns whether a better source has confirmed the track at the sighting's exposure."""
        return any(
            robot != sighting.robot and seen_us >= self.time_us and weakness < sighting.weakness
            for robot, (seen_us, weakness) in self.confirmed.items()
        )

    def _contradicted(self, robot: str, since_us: int) -> bool:
        """Returns whether another robot has confirmed the track since `since_us`: one may be wrong about its place."""
        return any(name != robot and seen_us >= since_us for name, (seen_us, _) in self.confirmed.items())

    def _doubt(self, sighting: Sighting) -> None:
        """Keeps a sighting that does not fit; begins a new track from two that fit each other."""
        for exposed_us, other in reversed(self.doubts):
            between_s = (self.time_us - exposed_us) / US_PER_S
            spread_m = 3 * np.sqrt(np.trace(sighting.covariance_m2 + other.covariance_m2))
            near = np.hypot(*(sighting.position_m - other.position_m)) <= self.fastest_m_s * between_s + spread_m
            if near and (other.robot != sighting.robot or not self._contradicted(sighting.robot, exposed_us)):
                self._begin(other, self._velocity_to(other, exposed_us))
                self._advance(between_s, Step(rolling_m_s2=self.ball.rolling_m_s2))
                self._fuse(sighting)
                self._confirm(sighting)
                return
        self.doubts = (*self.doubts, (self.time_us, sighting))

    @property
    def _unseen(self) -> bool:
        """Whether no robot has seen the ball for a while."""
        return self.time_us - self.seen_us > _LOST_US

    @property
    def _may_be_touched(self) -> bool:
        """Whether a robot, a post or a wall may have touched a known ball a moment ago."""
        assert self.filter is not None
        least = _MET_UNSEEN if self._unseen else _MET
        return bool(self.filter.weights[Mode.HANDLED] + self.filter.weights[Mode.HIT] >= least)

    def _strayed(self, sighting: Sighting) -> bool:
        """Returns whether one sighting elsewhere shows a known ball that no robot has seen for a while.

        A ball out of sight that nothing can have touched is still on its way: the sighting shows another thing, which
        lies on the ground.
        """
        if not self._unseen:
            return False
        turned = sighting.height_m > 0.0 or self._may_be_touched
        return turned and self._velocity_to(sighting, self.time_us) is not None

    def _begin_if_struck(self, sighting: Sighting) -> bool:
        """Begins a new track with the sighting of a moving ball that met something; returns False if it met nothing.

        A ball can only have met something near it: far from all robots and walls, the sighting shows another thing. A
        ball in the air that met something is at another place: where only the height does not fit, the sighting may
        show another thing, too.
        """
        assert self.filter is not None
        flight, ball = self.flight, self.filter.likeliest
        if not self._may_be_touched:
            return False
        velocity_m_s = self._velocity_to(sighting, self.time_us)
        if velocity_m_s is None or self._contradicted(sighting.robot, self.time_us - _AT_ONCE_US):
            return False
        flies = flight is not None and flight.height_m > _FLIES_M
        if flies and sighting.may_be_nearer((ball.x_m, ball.y_m)):
            return False
        if not flies and math.hypot(ball.vx_m_s, ball.vy_m_s) <= _MOVES_M_S:
            return False
        if flight is not None and self.filter.copy().see(sighting.position_m, sighting.of_flying_m2()):
            return False
        self._jump(sighting, velocity_m_s, flight and flight.seen(sighting.height_m))
        return True

    def _jump(self, sighting: Sighting, velocity_m_s: Floats | None = None, flight: Flight | None = None) -> None:
        """Begins a new track in the place of a known ball with a single sighting; see `_begin`."""
        before = self._doubting(sighting)
        self._begin(sighting, velocity_m_s, flight)
        self.before = before

    def _velocity_to(self, sighting: Sighting, exposed_us: int) -> Floats | None:
        """Returns the mean velocity (2) from where the ball was seen last, if it can have come from there."""
        passed_s = (exposed_us - self.seen_us) / US_PER_S
        way_m = np.asarray(sighting.position_m - self.seen_m)
        length_m = float(np.hypot(*way_m))
        if length_m > self.fastest_m_s * (passed_s + _LATE_S) + 3 * np.sqrt(np.trace(sighting.covariance_m2)):
            return None
        return way_m / max(passed_s, _LATE_S, length_m / _USUAL_M_S)

    def _begin(self, sighting: Sighting, velocity_m_s: Floats | None = None, flight: Flight | None = None) -> None:
        """Begins a new track; without a `flight`, the height of the sighting decides whether the ball flies."""
        rises = velocity_m_s is not None and (self.flight is None or self.flight.lift_m_s > 0.0)
        self.filter = self._new(sighting.position_m, sighting.covariance_m2, velocity_m_s)
        self.flight = flight or Flight.of_sight(sighting.height_m, rises)
        self.confirmed, self.doubts, self.before = {}, (), None
        self._confirm(sighting)

    def _confirm(self, sighting: Sighting) -> None:
        """Notes the source of a sighting in the track; drops the doubts of weaker sources."""
        weakness = sighting.weakness
        self.confirmed[sighting.robot] = (self.time_us, weakness)
        self._note_place()
        self.doubts = tuple(doubt for doubt in self.doubts if doubt[1].weakness <= weakness)

    def _note_place(self) -> None:
        """Notes when and where a known ball was seen last."""
        assert self.filter is not None
        self.seen_us, self.seen_m = self.time_us, self.filter.likeliest[:2]
