"""Ball and robots: kicks, ball handling, bounces, and the events for the referee."""

import math
from itertools import pairwise

import numpy as np
import pytest

from procs.model.events import Event, Kind
from procs.model.kinematics import Velocity, wheels_of
from procs.simulation.physics.kick_mechanism import KickerCommand
from procs.simulation.physics.realism import PRESETS, Noise
from procs.simulation.physics.settings import ContactSettings, HandlingSettings, KickerSettings, PhysicsSettings
from procs.simulation.physics.start_places import Pose
from procs.simulation.physics.world import World

TICK_US = 50_000
IN_MOUTH_M = 0.25 * math.cos(math.radians(30)) + 0.11 + 0.002


def world_with(*robots: str, noise: Noise | None = None, **starts: Pose) -> World:
    return World(robots or tuple(starts), np.random.default_rng(1), noise=noise, starts=starts)


def run(world: World, ticks: int) -> list[Event]:
    return [event for _ in range(ticks) for event in world.advance(TICK_US)]


def shoot(world: World, vx_m_s: float, vy_m_s: float = 0.0) -> None:
    world.ball.body.velocity = (vx_m_s, vy_m_s)


def kick(world: World, robot: str, speed_m_s: float, kick_id: int = 1) -> None:
    world.kickers[robot].command(KickerCommand(kick_id, speed_m_s, dribble=False), world.time_us)


def dribble(world: World, velocity: Velocity, ticks: int = 60) -> None:
    """Speeds up during the first second."""
    for tick in range(ticks):
        now = Velocity(*(part * min(1.0, tick / 20) for part in velocity))
        world.robots["cyan1"].drive.command(wheels_of(now, 0.2), world.time_us)
        world.kickers["cyan1"].command(KickerCommand(0, 0.0, dribble=True), world.time_us)
        world.advance(TICK_US)


def ball_in_mouth(noise: Noise | None = None) -> World:
    world = world_with(noise=noise, cyan1=Pose(0.0, 0.0, 0.0))
    world.ball.put(IN_MOUTH_M, 0.0)
    return world


def test_kick_gives_the_ball_speed_and_the_robot_recoil() -> None:
    world = ball_in_mouth()
    kick(world, "cyan1", 10.0)
    events = run(world, 1)
    assert [(event.kind, event.robot) for event in events] == [(Kind.TOUCH, "cyan1"), (Kind.KICK, "cyan1")]
    assert events[1].speed_m_s == pytest.approx(10.0)
    assert world.ball.body.velocity == pytest.approx((10.0 - 3.0 * 0.05, 0.0))
    assert world.robots["cyan1"].velocity.vx_m_s < 0


def test_kick_is_limited_and_needs_time_to_charge() -> None:
    world = ball_in_mouth()
    kick(world, "cyan1", 99.0)
    assert run(world, 1)[-1].speed_m_s == pytest.approx(12.0)
    assert not world.kickers["cyan1"].charged(world.time_us)
    world.ball.put(IN_MOUTH_M, 0.0)
    kick(world, "cyan1", 5.0, kick_id=2)
    assert Kind.KICK not in [event.kind for event in run(world, 28)]
    assert not world.kickers["cyan1"].charged(world.time_us)
    run(world, 1)
    assert world.kickers["cyan1"].charged(world.time_us)
    world.ball.put(*world.robots["cyan1"].body.local_to_world((IN_MOUTH_M, 0.0)))
    kick(world, "cyan1", 5.0, kick_id=3)
    assert Kind.KICK in [event.kind for event in run(world, 1)]


def test_same_number_kicks_once_and_speed_zero_never() -> None:
    world = ball_in_mouth()
    kick(world, "cyan1", 0.0, kick_id=1)
    assert run(world, 1) == []
    kick(world, "cyan1", 3.0, kick_id=1)
    assert run(world, 1)[-1].kind == Kind.KICK
    run(world, 40)
    world.ball.put(*world.robots["cyan1"].body.local_to_world((IN_MOUTH_M, 0.0)))
    kick(world, "cyan1", 3.0, kick_id=1)
    assert Kind.KICK not in [event.kind for event in run(world, 2)]


def test_kick_without_a_ball_discharges_the_kicker() -> None:
    world = ball_in_mouth()
    world.ball.put(1.0, 0.0)
    kick(world, "cyan1", 8.0)
    assert run(world, 1) == []
    assert world.ball.speed_m_s == 0.0
    assert world.kickers["cyan1"].kick_id == 1


def test_delayed_kick_happens_within_the_tick() -> None:
    world = ball_in_mouth(Noise(kick_delay_s=0.04))
    kick(world, "cyan1", 10.0)
    assert run(world, 1)[-1].kind == Kind.KICK
    assert world.ball.body.position.x == pytest.approx(IN_MOUTH_M + 10.0 * 0.01, abs=0.002)


def test_noise_turns_kicks_and_changes_their_speed() -> None:
    noise = Noise(kick_direction_sd_deg=2.0, kick_speed_sd=0.05)
    angles, speeds = [], []
    for seed in range(60):
        world = World(["cyan1"], np.random.default_rng(seed), noise=noise, starts={"cyan1": Pose(0.0, 0.0, 0.0)})
        world.ball.put(IN_MOUTH_M, 0.0)
        kick(world, "cyan1", 8.0)
        speeds.append(run(world, 1)[-1].speed_m_s)
        angles.append(world.ball.body.velocity.angle_degrees)
    assert 1.4 < np.std(angles) < 2.6
    assert 0.28 < np.std(speeds) < 0.52


@pytest.mark.parametrize(
    "velocity", [Velocity(2.0, 0.0, 0.0), Velocity(-1.5, 0.0, 0.0), Velocity(0.0, 1.0, 0.0), Velocity(0.0, 0.0, 4.0)]
)
def test_ball_handling_keeps_the_ball(velocity: Velocity) -> None:
    world = ball_in_mouth()
    dribble(world, velocity)
    assert world.kickers["cyan1"].mouth.holds_ball
    assert world.last_touch == "cyan1"


def test_fast_turn_loses_the_ball() -> None:
    world = ball_in_mouth()
    dribble(world, Velocity(0.0, 0.0, 8.0))
    assert not world.kickers["cyan1"].mouth.holds_ball


@pytest.mark.parametrize("speed_m_s", [-0.3, -1.0])
def test_two_rivals_pull_at_the_ball_equally(speed_m_s: float) -> None:
    world = world_with(cyan1=Pose(-IN_MOUTH_M, 0.0, 0.0), magenta1=Pose(IN_MOUTH_M, 0.0, math.pi))
    for _ in range(20):
        for name, robot in world.robots.items():
            robot.drive.command(wheels_of(Velocity(speed_m_s, 0.0, 0.0), 0.2), world.time_us)
            world.kickers[name].command(KickerCommand(0, 0.0, dribble=True), world.time_us)
        world.advance(TICK_US)
        assert world.ball.body.position == pytest.approx((0.0, 0.0), abs=1e-9)


def test_without_ball_handling_driving_backwards_leaves_the_ball() -> None:
    world = ball_in_mouth()
    for _ in range(40):
        world.robots["cyan1"].drive.command(wheels_of(Velocity(-1.0, 0.0, 0.0), 0.2), world.time_us)
        world.advance(TICK_US)
    assert world.ball.body.position.x == pytest.approx(IN_MOUTH_M, abs=0.01)


def test_mouth_absorbs_more_of_a_shot_than_the_back() -> None:
    speeds = {}
    for heading_rad in (0.0, math.pi):
        world = world_with(cyan1=Pose(0.0, 0.0, heading_rad))
        world.ball.put(1.0, 0.0)
        world.ball.friction.roll(-4.0, 0.0)
        shoot(world, -4.0)
        rebounds = []
        for _ in range(8):
            run(world, 1)
            rebounds.append(world.ball.body.velocity.x)
        speeds[heading_rad] = max(rebounds)
    assert 0.2 < speeds[0.0] < 0.6 * speeds[math.pi]


def test_goal_is_reported_once_with_the_last_touch() -> None:
    world = ball_in_mouth()
    world.robots["cyan1"].put(9.0, 0.3, 0.0)
    world.ball.put(9.0 + IN_MOUTH_M, 0.3)
    kick(world, "cyan1", 6.0)
    goals = [event for event in run(world, 40) if event.kind == Kind.GOAL]
    assert [event.robot for event in goals] == ["cyan1"]
    assert goals[0].x_m == pytest.approx(11.11, abs=0.04)
    assert not world.ball_in_field
    assert world.ball.body.position.x < 11.6


@pytest.mark.parametrize(
    ("start", "velocity", "kind"),
    [
        ((0.0, 6.5), (0.0, 2.0), Kind.OUT_SIDE),
        ((0.0, -6.5), (0.0, -2.0), Kind.OUT_SIDE),
        ((10.5, 3.0), (2.0, 0.0), Kind.OUT_END),
        ((-10.5, -3.0), (-2.0, 0.0), Kind.OUT_END),
        ((-10.5, -1.0), (-2.0, 0.0), Kind.GOAL),
    ],
)
def test_ball_leaves_the_field(start: tuple[float, float], velocity: tuple[float, float], kind: Kind) -> None:
    world = world_with()
    world.ball.put(*start)
    shoot(world, *velocity)
    events = run(world, 20)
    assert [(event.kind, event.robot) for event in events] == [(kind, "")]


def test_ball_on_the_line_is_not_out() -> None:
    world = world_with()
    world.ball.put(0.0, 7.1)
    assert run(world, 2) == []
    assert world.ball_in_field


def test_post_sends_the_ball_back() -> None:
    world = world_with()
    world.ball.put(10.0, 1.2625)
    shoot(world, 6.0)
    assert [event.kind for event in run(world, 10)] == []
    assert world.ball.body.velocity.x < -1.0


def test_wall_keeps_the_hardest_shot_in() -> None:
    world = world_with()
    world.ball.put(0.0, 0.0)
    for _ in range(50):
        shoot(world, 12.0, 7.0)
        run(world, 10)
        assert abs(world.ball.body.position.x) < 12.0
        assert abs(world.ball.body.position.y) < 8.0


def test_ball_of_any_speed_stays_between_the_walls() -> None:
    world = world_with()
    for velocity in ((300.0, 0.0), (-200.0, 250.0)):
        world.ball.put(9.0, 3.0)
        shoot(world, *velocity)
        for _ in range(20):
            world.advance(TICK_US)
            x_m, y_m = world.ball.body.position
            assert abs(x_m) < 11.9
            assert abs(y_m) < 7.9


def test_collision_names_the_faster_robot_first() -> None:
    world = world_with(cyan1=Pose(0.0, 0.0, 0.0), magenta1=Pose(1.0, 0.0, math.pi))
    collisions = []
    for _ in range(30):
        world.robots["magenta1"].drive.command(wheels_of(Velocity(1.5, 0.0, 0.0), 0.2), world.time_us)
        collisions += [event for event in world.advance(TICK_US) if event.kind == Kind.COLLISION]
    assert (collisions[0].robot, collisions[0].other) == ("magenta1", "cyan1")
    assert 0.8 < collisions[0].speed_m_s <= 1.5


def test_robots_in_a_scrum_hardly_overlap() -> None:
    starts = {f"cyan{n}": Pose(math.cos(n) * 0.8, math.sin(n) * 0.8, n + math.pi) for n in range(1, 6)}
    world = World(list(starts), np.random.default_rng(1), starts=starts)
    closest_m = 1.0
    for _ in range(60):
        for robot in world.robots.values():
            robot.drive.command(wheels_of(Velocity(1.0, 0.0, 0.0), 0.2), world.time_us)
        world.advance(TICK_US)
        places = [robot.body.position for robot in world.robots.values()]
        closest_m = min(closest_m, *(one.get_distance(two) for one in places for two in places if one is not two))
    assert 0.49 < closest_m < 0.505


def test_robots_that_overlap_are_pushed_apart() -> None:
    world = world_with(cyan1=Pose(0.0, 0.0, 0.0), magenta1=Pose(0.44, 0.0, 0.0))
    run(world, 40)
    one, two = (robot.body.position for robot in world.robots.values())
    assert one.get_distance(two) > 0.495


def test_energy_of_an_undisturbed_world_decreases_to_rest() -> None:
    starts = {f"cyan{n}": Pose(-1.0 * n, 0.1 * n, 0.0) for n in range(1, 5)}
    world = World(list(starts), np.random.default_rng(1), starts=starts)
    world.ball.put(0.0, 0.3)
    shoot(world, -10.0)
    for robot in world.robots.values():
        robot.body.velocity = (2.0, 0.5)
    friction = world.ball.friction
    bodies = [world.ball.body, *(robot.body for robot in world.robots.values())]
    energies = []
    for _ in range(600):
        world.advance(TICK_US)
        spin_j = world.ball.mass_kg * 2 / 3 * (friction.spin_x_m_s**2 + friction.spin_y_m_s**2) / 2
        # The engine's kinetic_energy is mass times squared speed, without the half.
        energies.append(spin_j + sum(body.kinetic_energy for body in bodies) / 2)
    assert all(after <= before + 1e-6 for before, after in pairwise(energies))
    assert energies[-1] < 1e-4


def test_field_crew_puts_the_ball_down_at_rest() -> None:
    world = ball_in_mouth()
    kick(world, "cyan1", 5.0)
    run(world, 5)
    world.place_ball(-3.0, 2.0)
    assert run(world, 5) == []
    assert world.ball.body.position == pytest.approx((-3.0, 2.0))
    assert world.last_touch == ""


def test_field_crew_does_not_put_the_ball_under_a_robot() -> None:
    world = world_with(cyan1=Pose(0.1, 0.0, 0.0))
    world.place_ball(0.0, 0.0)
    assert world.ball.body.position == pytest.approx((0.1 - 0.38, 0.0))
    assert run(world, 5) == []


def test_goal_can_follow_a_goal_after_the_ball_was_placed() -> None:
    world = world_with()
    for _ in range(2):
        world.place_ball(10.0, 0.0)
        shoot(world, 4.0)
        assert [event.kind for event in run(world, 20)] == [Kind.GOAL]


def test_touch_is_reported_where_it_happened() -> None:
    """A ball that is kicked at the beginning of a tick is far away at its end."""
    world = ball_in_mouth()
    kick(world, "cyan1", 11.0)
    (touch, _) = run(world, 1)
    assert touch.kind is Kind.TOUCH
    assert touch.x_m == pytest.approx(IN_MOUTH_M, abs=0.1)
    assert world.ball.body.position.x > IN_MOUTH_M + 0.4


def test_lob_flies_over_robots_and_comes_down() -> None:
    world = ball_in_mouth()
    world.kickers["cyan1"].command(KickerCommand(1, 5.0, dribble=False, elevation_rad=math.radians(50)), 0)
    run(world, 1)
    assert world.ball.vz_m_s == pytest.approx(5.0 * math.tan(math.radians(50)) - 9.81 * 0.05, abs=0.3)
    heights = []
    while world.ball.flies and world.ball.body.position.x < 9.0:
        run(world, 1)
        heights.append(world.ball.z_m)
    apex_m = (5.0 * math.tan(math.radians(50))) ** 2 / (2 * 9.81)
    assert max(heights) == pytest.approx(apex_m, abs=0.1)
    assert world.ball.body.velocity.x == pytest.approx(5.0, abs=0.01)  # no friction in the air


def test_ball_passes_over_a_robot_only_above_it() -> None:
    for height_m, touched in ((0.9, False), (0.3, True)):
        world = world_with(cyan2=Pose(1.0, 0.0, math.pi))
        world.ball.put(0.0, 0.0)
        world.throw_ball(height_m, (6.0, 0.0, 0.6))
        events = run(world, 4)
        assert (Kind.TOUCH in [event.kind for event in events]) is touched


@pytest.mark.parametrize(
    ("height_m", "kind", "comes_back"),
    [(0.3, Kind.GOAL, False), (0.95, None, True), (1.4, Kind.OUT_END, False)],
)
def test_crossbar_separates_goals_from_balls_over_it(height_m: float, kind: Kind | None, comes_back: bool) -> None:
    world = world_with("cyan1", cyan1=Pose(-5.0, 0.0, 0.0))
    world.ball.put(10.5, 0.0)
    world.throw_ball(height_m, (6.0, 0.0, 0.5))
    events = [event.kind for event in run(world, 4)]
    assert events == ([] if kind is None else [kind])
    assert (world.ball.body.velocity.x < -1.0) is comes_back


def test_handling_loses_the_ball_in_a_fast_turn_only() -> None:
    for omega_rad_s, kept in ((2.5, True), (6.0, False)):
        world = ball_in_mouth(PRESETS["realistic"].model_copy(update={"drive_delay_s": 0.0}))
        dribble(world, Velocity(0.0, 0.0, omega_rad_s))
        assert world.kickers["cyan1"].mouth.holds_ball is kept


@pytest.mark.parametrize("half_width_m", [0.05, 0.1, 0.3, 0.5])
def test_light_barrier_is_as_wide_as_set(half_width_m: float) -> None:
    physics = PhysicsSettings(handling=HandlingSettings(half_width_m=half_width_m))
    world = World(["cyan1"], np.random.default_rng(1), physics=physics, starts={"cyan1": Pose(0.0, 0.0, 0.0)})
    for beside_m, held in ((half_width_m - 0.005, True), (half_width_m + 0.005, False)):
        world.ball.put(IN_MOUTH_M, beside_m)
        assert world.kickers["cyan1"].mouth.holds_ball is held


def rebound_m_s(vx_m_s: float, vy_m_s: float, **contacts: float) -> float:
    """Returns the ball's speed after it has met what lies ahead, 0.6 m away in the field's middle or the wall."""
    physics = PhysicsSettings(contacts=ContactSettings(**contacts))
    world = World(["cyan1"], np.random.default_rng(1), physics=physics, starts={"cyan1": Pose(0.0, 0.0, 0.0)})
    world.ball.put(*((0.0, 0.6) if vy_m_s < 0 else (0.6, 0.0) if vx_m_s < 0 else (11.5, 4.0)))
    shoot(world, vx_m_s, vy_m_s)
    run(world, 5)
    return math.hypot(*world.ball.body.velocity)


@pytest.mark.parametrize(
    ("name", "velocity"), [("wall_bounce", (8.0, 0.0)), ("hull_bounce", (0.0, -6.0)), ("mouth_bounce", (-6.0, 0.0))]
)
def test_bounce_is_a_setting(name: str, velocity: tuple[float, float]) -> None:
    assert rebound_m_s(*velocity, **{name: 0.0}) + 1.0 < rebound_m_s(*velocity, **{name: 0.9})


def test_handling_rests_after_a_kick_as_long_as_set() -> None:
    fetched = []
    for release_s in (0.0, 1.0):
        physics = PhysicsSettings(kicker=KickerSettings(release_s=release_s))
        world = World(["cyan1"], np.random.default_rng(1), physics=physics, starts={"cyan1": Pose(0.0, 0.0, 0.0)})
        world.ball.put(IN_MOUTH_M, 0.0)
        world.kickers["cyan1"].command(KickerCommand(1, 0.3, dribble=True), 0)
        assert Kind.KICK in [event.kind for event in run(world, 12)]
        fetched.append(world.kickers["cyan1"].mouth.holds_ball)
    assert fetched == [True, False]
