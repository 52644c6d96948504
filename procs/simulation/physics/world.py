"""The world of a match: field, ball and robots, moved by a rigid-body engine in small steps."""

import math
from collections.abc import Callable, Mapping, Sequence

import numpy as np
import pymunk

from procs.model.ball import BALL, BallModel
from procs.model.events import Event, Kind
from procs.model.field import Field, Point
from procs.model.geometry import clamp
from procs.model.robot import PLAYERS, ROBOT, Player, RobotModel
from procs.simulation.physics.arena import build_arena
from procs.simulation.physics.ball_body import GRAVITY_M_S2, Ball, longest_step_within_nets_s
from procs.simulation.physics.battery import Battery
from procs.simulation.physics.bodies import Bodies, State
from procs.simulation.physics.contacts import Contacts
from procs.simulation.physics.crossbar import Crossbar
from procs.simulation.physics.drive import Drive, longest_step_s
from procs.simulation.physics.kick_mechanism import Kicker, Push
from procs.simulation.physics.line_judge import LineJudge
from procs.simulation.physics.mouth import Mouth
from procs.simulation.physics.realism import Noise, factor
from procs.simulation.physics.robot_body import Robot
from procs.simulation.physics.room import Room
from procs.simulation.physics.settings import PhysicsSettings
from procs.simulation.physics.start_places import Pose, starting_pose
from procs.simulation.physics.tops import Tops

_DEVIATIONS = 6.0  # no draw of a normal distribution is further from its mean
_FREE_M = 0.02  # between robot and ball when the field crew puts it down
_PRESSED_M = 0.002  # as much as bodies that touch may overlap


class World:
    """Field, ball and robots in the world frame. The same calls with the same `rng` give the same world, bit by bit."""

    def __init__(
        self,
        robots: Sequence[str],
        rng: np.random.Generator,
        field: Field | None = None,
        robot: RobotModel = ROBOT,
        ball: BallModel = BALL,
        physics: PhysicsSettings | None = None,
        noise: Noise | None = None,
        starts: Mapping[str, Pose] | None = None,
        players: Mapping[str, Player] = PLAYERS,
    ) -> None:
        """Sets the world up.

        Args:
            robots: their namespaces.
            rng: source of all random numbers.
            field: measures of the field.
            robot: geometry of all robots.
            ball: size and friction of the ball.
            physics: motors, mouths, kickers, contacts.
            noise: errors and delays.
            starts: poses at the beginning; robots without one begin at the places of their `players`.
            players: team and number by namespace.

        Raises:
            ValueError: there is no room for all robots.
        """
        self.time_us = 0
        self.last_touch = ""
        """Robot that touched the ball last since it was placed."""
        self._field = field or Field()
        self._robot = robot
        self._physics = physics or PhysicsSettings()
        noise = noise or Noise()
        hardest_kick = factor(noise.kick_speed_sd, _DEVIATIONS)
        self._step_s = min(
            self._physics.step_s,
            longest_step_s(robot, self._physics.drive),
            longest_step_within_nets_s(ball, robot, hardest_kick),
        )
        self._space = pymunk.Space()
        self._space.collision_slop = 0.001  # pymunk's default is meant for pixels: here it would be 10 cm
        build_arena(self._space, self._field, self._physics.contacts)
        friction_scale = 1.0 + noise.friction_spread * rng.uniform(-1.0, 1.0)
        self.ball = Ball(self._space, ball, friction_scale, robot.height_m, self._field.goal_height_m)
        self._room = Room(self._field)
        border_m = self._field.border_m
        self._walls_m = Point(self._field.half_length_m + border_m, self._field.half_width_m + border_m)
        self._clearance_m = robot.radius_m + ball.radius_m + _FREE_M
        self._bar = Crossbar(self._field, self.ball, self._physics.contacts.post_bounce)
        self.robots: dict[str, Robot] = {}
        self.kickers: dict[str, Kicker] = {}
        self.batteries: dict[str, Battery] = {}
        self._starts = self._start_poses(sorted(robots), starts or {}, players)
        for name in sorted(robots):
            drive = Drive(robot, self._physics.drive, noise.drive_delay_s)
            body = self.robots[name] = Robot(self._space, name, robot, drive, self._physics.contacts)
            body.put(*self._starts[name])
            mouth = Mouth(body, self.ball, self._physics.handling, 1.0 - noise.handling_loss)
            self.kickers[name] = Kicker(mouth, robot, self._physics.kicker, noise, rng)
            self.batteries[name] = Battery(self._physics.battery)
        self._tops = Tops(list(self.robots.values()), robot.height_m, self.ball, self._physics.contacts)
        self._contacts = Contacts(self._space, list(self.robots.values()))
        self._judge = LineJudge(self._field, self.ball.radius_m)
        self._wheel_load_n = robot.mass_kg * GRAVITY_M_S2 / 3
        self._bodies = Bodies(self._space)
        self._in_order = [(name, robot, self.kickers[name]) for name, robot in self.robots.items()]
        self._near_m2 = max([kicker.mouth.far_m for kicker in self.kickers.values()], default=0.0) ** 2
        self._clear_ball(self._starts, self._middles())

    @property
    def ball_in_field(self) -> bool:
        """True if the ball is on the field, lines included."""
        return self._judge.ball_in_field

    def _start_poses(
        self, robots: Sequence[str], starts: Mapping[str, Pose], players: Mapping[str, Player]
    ) -> dict[str, Pose]:
        """Returns the poses at the beginning; robots that share a usual place stand beside each other."""
        found, radius_m = {name: starts[name] for name in robots if name in starts}, self._robot.radius_m
        for name in (name for name in robots if name not in starts):
            x_m, y_m, heading_rad = starting_pose(players.get(name), self._field)
            taken = [Point(pose.x_m, pose.y_m) for pose in found.values()]
            place = self._room.nearest(Point(x_m, y_m), radius_m, taken, 2 * radius_m)
            if place is None:
                raise ValueError(f"there is no room for {name} between the walls")
            found[name] = Pose(*place, heading_rad)
        return found

    def return_to_starts(self) -> None:
        """Sets all robots down at the places where they began, with full batteries and charged kickers."""
        for name, pose in self._starts.items():
            self.robots[name].put(*pose)
            self.kickers[name].begin_anew()
            self.batteries[name].refill()
        self._clear_ball(self._starts, self._middles())

    def place_robot(self, name: str, pose: Pose) -> bool:
        """Sets a robot down at rest, at the nearest place that is free; a ball that lies in its way is put beside it.

        Commands on their way to its motors and its kicker are dropped.
        Returns False, and does nothing, if there is no room for it.
        """
        others = [Point(*robot.body.position) for robot in self.robots.values() if robot.name != name]
        radius_m = self._robot.radius_m
        place = self._room.nearest(Point(pose.x_m, pose.y_m), radius_m, others, 2 * radius_m)
        if place is None or not self._clear_ball({name: Pose(*place, pose.heading_rad)}, [*others, place]):
            return False
        self.robots[name].put(*place, pose.heading_rad)
        self.kickers[name].drop_commands()
        return True

    def place_ball(self, x_m: float, y_m: float) -> bool:
        """Puts the ball down at rest, at the nearest place that is free.

        Returns False, and does nothing, if there is no room for it.
        """
        if not self._put_ball(Point(x_m, y_m), self._middles()):
            return False
        self.last_touch = ""
        self._judge.put_down(*self.ball.body.position)
        return True

    def throw_ball(self, height_m: float, velocity_m_s: tuple[float, float, float]) -> None:
        """Lifts the ball to a height and gives it a velocity, world frame."""
        self.ball.throw(height_m, *velocity_m_s)

    def drop_kicks(self) -> None:
        """Drops the commands that the kickers have received but not yet followed."""
        for kicker in self.kickers.values():
            kicker.drop_commands()

    def advance(self, duration_us: int) -> list[Event]:
        """Moves the world on; returns the events, sorted by kind and robot."""
        steps = max(1, math.ceil(duration_us / (self._step_s * 1e6)))
        start_us = self.time_us
        touched: dict[str, Event] = {}
        events: list[Event] = []
        states = self._bodies.states()
        for step in range(steps):
            self.time_us = start_us + duration_us * step // steps
            states = self._step(duration_us / steps / 1e6, states, touched, events)
        self.time_us = start_us + duration_us
        self._drain_batteries(duration_us / 1e6)
        return sorted([*events, *touched.values(), *self._contacts.take_collisions()])

    def _middles(self) -> list[Point]:
        """Returns the middles of all robots."""
        return [Point(*robot.body.position) for robot in self.robots.values()]

    def _clear_ball(self, poses: Mapping[str, Pose], robots: Sequence[Point]) -> bool:
        """Puts a ball that is where robots are set down beside all `robots`; returns False if there is no room.

        One that flies above them flies on.
        A ball that touches no more than a robot's hull, as in its mouth, stays where it is. One that is in the field
        stays in the field: who sets a robot down scores no goal.
        """
        ball, least_m = self.ball, self.ball.radius_m - _PRESSED_M
        if ball.z_m >= self._robot.height_m or all(
            self.robots[name].gap_m(pose, *ball.body.position) >= least_m for name, pose in poses.items()
        ):
            return True
        at = Point(*ball.body.position)
        was_in_field = self._is_in_field(at)
        return self._put_ball(at, robots, lambda place: self._is_in_field(place) or not was_in_field)

    def _is_in_field(self, place: Point) -> bool:
        return self._field.in_field(*place, self.ball.radius_m)

    def _put_ball(
        self, wanted: Point, robots: Sequence[Point], accepts: Callable[[Point], bool] = lambda _: True
    ) -> bool:
        place = self._room.nearest(wanted, self.ball.radius_m, robots, self._clearance_m, accepts)
        if place is not None:
            self.ball.put(*place)
            self._bar.begin_at(place.x_m)
        return place is not None

    def _drain_batteries(self, duration_s: float) -> None:
        for name, robot, kicker in self._in_order:
            rolled_n_m = self._wheel_load_n * sum(map(abs, robot.drive.wheels_m_s)) * duration_s
            self.batteries[name].drain(robot.drive.take_work_j(), kicker.take_work_j(), rolled_n_m, duration_s)

    def _step(
        self, duration_s: float, states: list[State], touched: dict[str, Event], events: list[Event]
    ) -> list[State]:
        """Moves the world on by one step; returns the new states of the ball and the robots, in this order."""
        pushes: dict[str, Push] = {}
        now_us, ball = self.time_us, states[0]
        ball_x_m, ball_y_m = ball[0], ball[1]
        effects = [0.0, 0.0, 0.0]  # on the ball
        for (name, robot, kicker), state in zip(self._in_order, states[1:], strict=True):
            x_m, y_m = ball_x_m - state[0], ball_y_m - state[1]
            effects += robot.drive.turn(now_us, duration_s, state)
            push = kicker.act(now_us, duration_s, ball if x_m * x_m + y_m * y_m <= self._near_m2 else None)
            if push is not None:
                pushes[name] = push
        self._bodies.push(effects)
        events += self._move_ball(duration_s, ball, pushes)
        self._space.step(duration_s)
        fallen_on = self._tops.fall(duration_s)
        states = self._bodies.states()
        if self._bar.stops(*states[0][:2]) or self._walls_stop(*states[0][:2]):
            states = self._bodies.states()
        touching = self._contacts.take_touches() | pushes.keys()
        if fallen_on is not None:
            touching.add(fallen_on)
        if touching:
            x_m, y_m, _, vx_m_s, vy_m_s, _ = states[0]
            speed_m_s = math.hypot(vx_m_s, vy_m_s)
            touched |= {robot: Event(Kind.TOUCH, robot, "", x_m, y_m, speed_m_s) for robot in touching}
            self.last_touch = touching.pop() if len(touching) == 1 else min(touching, key=self._distance_to_ball)
        call = self._judge.judge(*states[0][:2], self._bar.over_ball)
        if call is not None:
            events.append(self._ball_event(call, self.last_touch))
        return states

    def _move_ball(self, duration_s: float, ball: State, pushes: Mapping[str, Push]) -> list[Event]:
        """Lets kickers and the ground act on the ball for one step; returns the kicks.

        All pushes act on the ball as it was before the step, so that the order of two rivals does not matter.
        """
        x_m, y_m, _, vx_m_s, vy_m_s, omega_rad_s = ball
        for push in pushes.values():
            change_x_m_s, change_y_m_s = push.change_m_s
            vx_m_s, vy_m_s = vx_m_s + change_x_m_s, vy_m_s + change_y_m_s
            self.ball.vz_m_s += push.lift_m_s
        self.ball.rub(duration_s, vx_m_s, vy_m_s, omega_rad_s)
        speed_m_s = math.hypot(vx_m_s, vy_m_s)
        return [Event(Kind.KICK, name, "", x_m, y_m, speed_m_s) for name, push in pushes.items() if push.kicked]

    def _walls_stop(self, x_m: float, y_m: float) -> bool:
        """Puts a ball whose middle is beyond a wall back to it; returns whether there was one.

        Robots squeeze a light ball through, and a very fast one is on the other side after a step.
        """
        if abs(x_m) <= self._walls_m.x_m and abs(y_m) <= self._walls_m.y_m:
            return False
        at_m, way_m_s = [], []
        for place_m, speed_m_s, wall_m in zip((x_m, y_m), self.ball.body.velocity, self._walls_m, strict=True):
            at_m.append(clamp(place_m, self.ball.radius_m - wall_m, wall_m - self.ball.radius_m))
            way_m_s.append(0.0 if abs(place_m) > wall_m else speed_m_s)
        self.ball.body.position, self.ball.body.velocity = (at_m[0], at_m[1]), (way_m_s[0], way_m_s[1])
        return True

    def _ball_event(self, kind: Kind, robot: str) -> Event:
        return Event(kind, robot, "", *self.ball.body.position, self.ball.speed_m_s)

    def _distance_to_ball(self, robot: str) -> tuple[float, str]:
        return self.robots[robot].body.position.get_distance(self.ball.body.position), robot
