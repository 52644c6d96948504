"""Settings that no field, ball, robot or error can have are refused by the launch plan, with name and limit."""

import math
from itertools import combinations
from pathlib import Path

import pytest

from fwk.model.errors import PlanError
from fwk.testing import Bench, launch_plan, system_of
from lcmtypes.soccer import ground_truth_t, obstacle_t, world_model_t
from procs.model.robot import Player, number_of, player_of
from procs.simulation.simulator import Simulator

LAUNCH = Path("launch").resolve()
SIX = f"""
include: [{LAUNCH}/msl-field.yaml, {LAUNCH}/msl-percepts.yaml, {LAUNCH}/msl-radio.yaml]
name: six
robots:
  team_cyan: {{use: msl_radio, values: {{team: cyan}}}}
  team_magenta: {{use: msl_radio, values: {{team: magenta}}}}
  cyan1: {{use: msl_robot_percepts}}
  cyan6: {{use: msl_robot_percepts}}
  magenta6: {{use: msl_robot_percepts}}
"""


@pytest.mark.parametrize(
    ("setting", "mistake"),
    [
        ("shared.field.length_m=-22", "'field.length_m' is -22; it should be greater than 0"),
        ("shared.field.length_m=.nan", "'field.length_m' is nan; it should be a finite number"),
        ("shared.field.length_m=1e6", "'field.length_m' is 1000000.0; it should be less than or equal to 100"),
        ("shared.field.width_m=0", "'field.width_m' is 0; it should be greater than 0"),
        ("shared.field.ramp_width_m=-1", "'field.ramp_width_m' is -1; it should be greater than or equal to 0"),
        ("shared.field.goal_width_m=20", "is 20; goal_width_m of 20 m should be at most width_m, which is 14 m"),
        (
            "shared.field.penalty_area_depth_m=15",
            "is 15; penalty_area_depth_m of 15 m should be at most half of length_m, which is 11 m",
        ),
        ("shared.field.border_m=0.3", "goal_depth_m of 0.6 m should be at most border_m, which is 0.3 m"),
        ("shared.robot.mouth_half_angle_deg=120", "'robot.mouth_half_angle_deg' is 120; it should be less than 90"),
        ("shared.robot.radius_m=3", "'robot.radius_m' is 3; it should be less than or equal to 0.5"),
        ("shared.robot.mass_kg=.inf", "'robot.mass_kg' is inf; it should be a finite number"),
        ("shared.ball.radius_m=3", "'ball.radius_m' is 3; it should be less than or equal to 0.3"),
        ("shared.ball.spin_s=.inf", "'ball.spin_s' is inf; it should be a finite number"),
        (
            "world/simulator.errors.drive_delay_s=-1",
            "'errors' is {'drive_delay_s': -1}; drive_delay_s should be greater than or equal to 0",
        ),
        (
            "world/simulator.errors={friction_spread: 3, handling_loss: 2}",
            "friction_spread should be less than 1; handling_loss should be less than or equal to 1",
        ),
        ("world/simulator.errors.kick_speed_sd=.nan", "'errors.kick_speed_sd' is nan; it should be a finite number"),
        (
            "world/simulator.physics.contacts.hull_friction=.inf",
            "'physics.contacts.hull_friction' is inf; it should be a finite number",
        ),
        ("*/percepts.ball_px=1e9", "'ball_px' is 1000000000.0; it should be less than or equal to 50"),
        ("*/percepts.reach_m=1000", "'reach_m' is 1000; it should be less than or equal to 20"),
        ("*/percepts.gap_s=3600", "'gap_s' is 3600; it should be less than or equal to 60"),
        ("team_*/radio.delay_s=100", "'delay_s' is 100; it should be less than or equal to 10"),
        ("*/percepts.line_missed=1.5", "'line_missed' is 1.5; it should be less than or equal to 1"),
        ("*/percepts.ring_distances_m=[0.7,-1]", "'ring_distances_m.1' is -1; it should be greater than 0"),
        (
            "world/simulator.starts.cyan1=[100,0,0]",
            "cyan1 at (100, 0) is outside the walls; x is at most 11.75 m, y 7.75 m",
        ),
        (
            "world/simulator.starts.cyan1=[-11.0,1.26,0]",
            "cyan1 at (-11, 1.26) is in a post or a net of a goal; a robot needs 0.25 m",
        ),
        (
            "world/simulator.starts={cyan1: [1,1,0], cyan2: [1.1,1,0]}",
            "cyan1 and cyan2 are 0.1 m apart; robots need 0.5 m",
        ),
        (
            "world/simulator.starts={cyan1: [0, 0]}",
            "'starts.cyan1' is [0, 0]; it should be the numbers x_m, y_m and heading_rad, such as [-1.0, 0.5, 0.0]",
        ),
        (
            "world/simulator.starts={cyan1: [1, 0, 90]}",
            "cyan1: heading_rad is 90; it should be from -6.28 to 6.28, in radians",
        ),
        ("world/simulator.starts={cyan7: [-1, 0, 0]}", "starts: no robot 'cyan7'; there are: cyan1, cyan2, "),
        ("world/simulator.stuck_wheels={cyan7: [1]}", "stuck_wheels: no robot 'cyan7'; there are: cyan1, cyan2, "),
        ("world/simulator.silent_imus=[cyan7]", "silent_imus: no robot 'cyan7'; there are: cyan1, cyan2, "),
        ("world/simulator.stuck_wheels={cyan1: [2, 2]}", "cyan1: wheel 2 occurs twice; name each wheel once"),
        ("world/simulator.stuck_wheels={cyan1: [4]}", "'stuck_wheels.cyan1.0' is 4; it should be 1, 2 or 3"),
        ("shared.players={cyan1: {team: cyan, number: 2}}", "players: cyan1 and cyan2 are both cyan 2"),
        ("shared.players={cyan1: {team: cyan, number: 3000000000}}", "should be less than or equal to 2147483647"),
    ],
)
def test_nonsense_is_refused_by_name_and_limit(setting: str, mistake: str) -> None:
    with pytest.raises(PlanError) as raised:
        launch_plan("soccer-percepts.yaml", (setting,))
    assert mistake in str(raised.value)


def test_number_too_large_for_messages_makes_no_player() -> None:
    assert player_of("cyan2147483647", {}) == Player(team="cyan", number=2147483647)
    assert player_of("cyan2147483648", {}) is None
    assert number_of("cyan2147483648") == 0


def test_robots_that_know_the_truth_have_no_negative_noise() -> None:
    with pytest.raises(PlanError, match="'ball_sd_m' is -1; it should be greater than or equal to 0"):
        launch_plan("soccer-truth.yaml", ("*/world_model.ball_sd_m=-1",))


@pytest.mark.parametrize(
    "settings",
    [
        ("shared.field={length_m: 18, width_m: 12, border_m: 1.5}",),
        ("shared.field={length_m: 12, width_m: 8}",),
        ("shared.ball.radius_m=0.1", "shared.ball.rolling_m_s2=0.6"),
        ("shared.robot={radius_m: 0.2, mouth_half_angle_deg: 45}",),
        ("world/simulator.errors={drive_delay_s: 0.1, friction_spread: 0.9}",),
        ("world/simulator.starts={cyan1: [11.75, 7.75, 0], cyan2: [-11.2, 0.4, 1.5]}",),
    ],
)
def test_unusual_but_possible_settings_are_accepted(settings: tuple[str, ...]) -> None:
    assert launch_plan("soccer-percepts.yaml", settings)


def test_robot_without_an_entry_plays_by_its_name(tmp_path: Path) -> None:
    """Robots have the number 6, which the launch file does not list as players."""
    file = tmp_path / "six.yaml"
    file.write_text(SIX)
    six = system_of(str(file))
    six.tick()
    truth: ground_truth_t = six.newest("world/ground_truth")
    robots = {robot.name: robot for robot in truth.robots}
    assert [(robot.team, robot.number) for robot in robots.values()] == [("cyan", 1), ("cyan", 6), ("magenta", 6)]
    assert robots["cyan6"].x_m < 0.0 < robots["magenta6"].x_m, "each begins in its own half"


def test_robot_without_an_entry_is_a_mate_by_its_name(tmp_path: Path) -> None:
    """The robot starts at a place with lines enough around it to be found."""
    file = tmp_path / "six.yaml"
    file.write_text(SIX)
    six = system_of(str(file), sets=("world/simulator.starts={cyan6: [-3, 2, 0]}",))
    six.tick(75)
    model: world_model_t = six.newest("cyan1/world_model")
    assert [(mate.name, mate.number) for mate in model.mates] == [("cyan6", 6)]
    model = six.newest("cyan6/world_model")
    assert [(mate.name, mate.number) for mate in model.mates] == [("cyan1", 1)]
    assert all(opponent.x_m > 0.0 for opponent in model.opponents), "cyan1 is none of them"
    seen = [each.team for each in six.newest("cyan6/obstacle_percepts").obstacles]
    assert obstacle_t.TEAM_UNKNOWN not in seen


def test_robot_without_an_entry_may_not_be_another_player() -> None:
    players = {"anna": {"team": "cyan", "number": 2}}
    for robots in (("anna", "cyan2"), ("cyan2",)):
        with pytest.raises(ValueError, match=r"players: anna and cyan2 are both cyan 2; players\.cyan2 is missing"):
            Bench(Simulator, name="world/simulator", namespaces=robots, players=players)


def test_robots_that_are_not_players_begin_apart() -> None:
    world = Bench(Simulator, name="world/simulator", namespaces=("anna", "berta", "carla"), realism="none")
    world.iterate(3)
    places = [(robot.x_m, robot.y_m) for robot in world.port("ground_truth").sent[-1].robots]
    assert min(math.dist(one, two) for one, two in combinations(places, 2)) > 0.49
    assert places == [(robot.x_m, robot.y_m) for robot in world.port("ground_truth").sent[0].robots]
