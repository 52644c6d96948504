"""The systems in launch/: each has no mistakes and contains what its name says."""

from pathlib import Path

import pytest

from fwk.model.errors import PlanError
from fwk.model.plan import Plan
from fwk.plan.load import LaunchOptions, load_plan

FOLDER = Path(__file__).parents[2] / "launch"
SYSTEMS = {
    "soccer.yaml": (5, 5),
    "soccer-greedy.yaml": (5, 5),
    "soccer-1v1.yaml": (1, 1),
    "soccer-percepts.yaml": (5, 5),
    "soccer-truth.yaml": (5, 5),
    "soccer-truth-greedy.yaml": (5, 5),
    "soccer-refbox.yaml": (5, 5),
    "one-robot.yaml": (1, 0),
}
TOOLS = {"vision.yaml", "frames.yaml", "kidnapped.yaml", "soccer-baselines.yaml", "scenarios.yaml"}
PARTS = {"msl-field.yaml", "msl-radio.yaml", "msl-robot.yaml", "msl-percepts.yaml", "msl-stereo.yaml", "msl-truth.yaml"}


def plan_of(file: str, *sets: str) -> Plan:
    return load_plan(str(FOLDER / file), LaunchOptions(sets=sets))


def test_every_file_is_a_system_or_a_part_of_one() -> None:
    assert {path.name for path in FOLDER.glob("*.yaml")} == set(SYSTEMS) | TOOLS | PARTS


@pytest.mark.parametrize(("file", "robots"), SYSTEMS.items())
def test_a_system_has_its_robots_each_complete(file: str, robots: tuple[int, int]) -> None:
    plan = plan_of(file)
    namespaces = {each.namespace for each in plan.components}
    expected = {f"cyan{n + 1}" for n in range(robots[0])} | {f"magenta{n + 1}" for n in range(robots[1])}
    assert {name for name in namespaces if name[-1].isdigit()} == expected
    for robot in expected:
        members = [each.name.rpartition("/")[2] for each in plan.components if each.namespace == robot]
        eyes = {
            "soccer-percepts.yaml": "percepts localization",
            "soccer-truth.yaml": "",
            "soccer-truth-greedy.yaml": "",
            "one-robot.yaml": "camera omni_ball omni_field stereo_camera stereo_obs obstacle_fusion localization",
        }.get(file, "camera omni_ball omni_field localization")
        assert members == f"base kicker {eyes} world_model agent skiller navigator".split()
    assert plan.period_us == 40_000


def test_a_team_hears_only_itself() -> None:
    plan = plan_of("soccer.yaml")
    for team in ("cyan", "magenta"):
        radio = next(each for each in plan.components if each.name == f"team_{team}/radio")
        own = tuple(f"{team}{n}" for n in range(1, 6))
        assert radio.channels["messages"] == tuple(f"{robot}/team_message" for robot in own)
        assert radio.channels["inboxes"] == tuple(f"{robot}/team_inbox" for robot in own)


def test_only_cameras_referee_and_crew_read_the_truth() -> None:
    plan = plan_of("soccer.yaml")
    truth = next(channel for channel in plan.channels if channel.name == "world/ground_truth")
    readers = [plan.components[index] for index in truth.readers]
    assert [each.name for each in readers if each.namespace == "world"] == ["world/referee", "world/crew"]
    assert {each.name.rpartition("/")[2] for each in readers if each.namespace != "world"} == {"camera"}


def test_shared_sizes_reach_all_that_use_them() -> None:
    plan = plan_of("soccer.yaml", "shared.ball.radius_m=0.1", "shared.robot.radius_m=0.26")
    settings = {each.name: each.config for each in plan.components}
    for robot in ("cyan1", "magenta5"):
        for name in ("agent", "skiller", "navigator", "world_model", "camera"):
            config = settings[f"{robot}/{name}"]
            assert (config["ball"]["radius_m"], config["robot"]["radius_m"]) == (0.1, 0.26), name


@pytest.mark.parametrize(
    ("option", "difference"),
    [
        ("cyan1/localization.field.length_m=18", "18.0 in cyan1/localization, but 22.0 in world/simulator"),
        ("world/simulator.field.width_m=12", "12.0 in world/simulator, but 14.0 in world/referee"),
        ("cyan1/omni_field.field.goal_width_m=2", "2.0 in cyan1/omni_field, but 2.4 in world/simulator"),
        ("world/crew.field.border_m=2", "2.0 in world/crew, but 1.0 in world/simulator"),
        ("magenta1/world_model.players.cyan1.number=7", "7 in magenta1/world_model, but 1 in world/simulator"),
        ("world/referee.players.zoe={team: cyan, number: 8}", "8} in world/referee, but missing in world/simulator"),
    ],
)
def test_a_match_has_one_field_and_the_same_players(option: str, difference: str) -> None:
    with pytest.raises(PlanError) as caught:
        plan_of("soccer-1v1.yaml", option)
    (mistake,) = caught.value.problems
    assert difference in mistake.text


def test_vision_alone_has_a_camera_of_files_and_both_detectors() -> None:
    plan = plan_of("vision.yaml")
    camera, *detectors = plan.components
    assert (camera.name, camera.module) == ("cyan1/camera", "procs.drivers.camera_driver")
    assert [each.name for each in detectors] == ["cyan1/omni_ball", "cyan1/omni_field"]


def test_users_of_transforms_need_the_frame_tree() -> None:
    plan = plan_of("frames.yaml")
    (tree,) = [each for each in plan.components if each.module == "procs.localization.frame_tree"]
    (spot,) = [each for each in plan.components if each.module == "procs.world_model.ball_spot"]
    assert spot.needs == (tree.index,)
    assert spot.channels["tf.transforms"] == ("cyan1/transforms",)
