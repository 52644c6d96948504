"""The match in the console: what is drawn of the truth and of the beliefs, and what dragging does."""

import asyncio
import json
import math
from fnmatch import fnmatchcase
from typing import Any, cast

import pytest

from fwk.web import Newest, RunAccess, Scene
from lcmtypes.soccer import (
    drive_target_t,
    game_state_t,
    ground_truth_t,
    navigator_state_t,
    pose_t,
    role_t,
    skill_status_t,
    true_robot_t,
    world_model_t,
)
from procs.model.field import Field, Point
from procs.referee.orders import HALVES, PLAIN, carry_out
from procs.referee.rules import Rules
from procs.referee.sight import Sight
from procs.referee.whistle import Whistle
from procs.view.web import COLOURS, MatchView, RefereePage


def match() -> dict[str, Any]:
    robot = true_robot_t()
    robot.name, robot.number, robot.x_m, robot.y_m, robot.heading_rad = "cyan1", 1, 1.0, 2.0, 0.0
    truth = ground_truth_t()
    truth.robots, truth.n, truth.ball_x_m, truth.ball_y_m = [robot], 1, 3.0, -1.0
    model = world_model_t()
    model.localized, model.x_m, model.y_m = True, 1.1, 2.1
    model.ball.known, model.ball.x_m, model.ball.y_m = True, 3.2, -1.1
    model.ball.covariance = [[0.25, 0.0, 0.0, 0.0], [0.0, 0.01, 0.0, 0.0], [0.0] * 4, [0.0] * 4]
    pose = pose_t()
    pose.x_m, pose.y_m, pose.covariance = 1.1, 2.1, [[0.09, 0.0, 0.0], [0.0, 0.04, 0.0], [0.0] * 3]
    target = drive_target_t()
    target.x_m, target.y_m = 2.0, 0.0
    role, skill = role_t(), skill_status_t()
    role.role, skill.skill = "attacker", "get_ball"
    return {
        "world/ground_truth": truth,
        "world/game_state": game_state_t(),
        "cyan1/world_model": model,
        "cyan1/pose": pose,
        "cyan1/drive_target": target,
        "cyan1/role": role,
        "cyan1/skill_status": skill,
    }


def drawn(messages: dict[str, Any], settings: dict[tuple[str, str], Any] | None = None) -> dict[str, Any]:
    scene = Scene()
    MatchView().draw(Newest(messages, settings), scene)
    made: dict[str, Any] = json.loads(scene.encoded())
    return made


def test_robots_and_ball_lie_where_they_truly_are() -> None:
    shapes = drawn(match())["shapes"]
    places = {shape["drag"]: (shape["x"], shape["y"]) for shape in shapes if "drag" in shape}
    assert places == {"cyan1": (1.0, 2.0), "ball": (3.0, -1.0)}
    assert shapes[-1]["drag"] == "ball"  # above what robots believe of it


def test_robots_and_ball_have_the_sizes_of_the_settings() -> None:
    names = ("robot.radius_m", "ball.radius_m", "field.length_m")
    sizes = {("world/simulator", name): size_m for name, size_m in zip(names, (0.26, 0.1, 18.0), strict=True)}
    for settings, radii_m in ((sizes, {"cyan1": 0.26, "ball": 0.1}), (None, {"cyan1": 0.25, "ball": 0.11})):
        shapes = drawn(match(), settings)["shapes"]
        assert {shape["drag"]: shape["r"] for shape in shapes if "drag" in shape} == radii_m
    assert all(
        fnmatchcase(f"{component}.{name.partition('.')[0]}", pattern)
        for (component, name), pattern in zip(sizes, MatchView.settings, strict=True)
    )


def test_ground_is_that_of_the_settings_before_the_first_message() -> None:
    made = drawn(match(), {("world/simulator", "field.length_m"): 18.0})
    assert made["bounds"][2] == pytest.approx(9.0 + Field().border_m)


def test_beliefs_of_a_silent_robot_are_not_drawn() -> None:
    messages = match()
    assert {shape["l"] for shape in drawn(messages)["shapes"]} > {"beliefs", "targets", "roles"}
    messages["world/ground_truth"].header.time_us = 16_000_000
    assert {shape["l"] for shape in drawn(messages)["shapes"]} == {"", "truth"}


@pytest.mark.parametrize("wild", [math.inf, math.nan])
def test_infinite_headings_and_times_are_never_fatal(wild: float) -> None:
    messages = match()
    messages["world/ground_truth"].robots[0].heading_rad = wild
    messages["world/game_state"].time_in_half_s = wild
    made = drawn(messages)
    assert [shape["drag"] for shape in made["shapes"] if "drag" in shape] == ["ball"]
    assert "--:--" in made["headline"]


@pytest.mark.parametrize(("error", "words"), [(0, "attacker get_ball"), (2, "attacker get_ball (way blocked)")])
def test_blocked_way_is_told_beside_the_role(error: int, words: str) -> None:
    messages = match() | {"cyan1/navigator_state": navigator_state_t(error=error)}
    assert [shape["s"] for shape in drawn(messages)["shapes"] if shape["l"] == "roles"] == [words]


def test_beliefs_targets_and_roles_have_layers_of_their_own() -> None:
    shapes = drawn(match())["shapes"]
    ring, error, own, dot, ellipse = [shape for shape in shapes if shape["l"] == "beliefs"]
    assert (ring["x"], ring["stroke"]) == (1.1, COLOURS["cyan"])
    assert error["p"] == [[1.0, 2.0], [1.1, 2.1]]
    assert (own["x"], own["a"], own["b"]) == (1.1, 0.6, 0.4)
    assert (dot["x"], dot["y"]) == (3.2, -1.1)
    assert (ellipse["x"], ellipse["a"], ellipse["b"]) == (3.2, 1.0, 0.2)
    (path,) = [shape for shape in shapes if shape["l"] == "targets"]
    assert path["p"] == [[1.0, 2.0], [2.0, 0.0]]
    assert [shape["s"] for shape in shapes if shape["l"] == "roles"] == ["attacker get_ball"]


def test_the_empty_field_is_drawn_before_the_match() -> None:
    before = drawn({})
    assert before["bounds"][2] > before["bounds"][0]
    assert not any("drag" in shape for shape in before["shapes"])


def test_dragging_places_robots_and_ball() -> None:
    called: list[Any] = []

    class Link:
        async def newest(self, patterns: Any) -> dict[str, Any]:
            return match()

    class Run:
        link = Link()

        async def call(self, name: str, members: Any) -> None:
            called.append((name, members))

    async def drag() -> None:
        for name in ("ball", "cyan1"):
            await MatchView().moved(cast(RunAccess, Run()), name, 0.5, 0.25)

    asyncio.run(drag())
    assert called == [
        ("world/place_ball", {"x_m": 0.5, "y_m": 0.25}),
        ("world/place_robot", {"robot": "cyan1", "x_m": 0.5, "y_m": 0.25, "heading_rad": 0.0}),
    ]


def test_referee_page_has_a_button_for_every_command() -> None:
    known = carry_out(Whistle(Rules()), Sight(Point(0.0, 0.0)), "nonsense").partition("there are ")[2].split(", ")
    assert sorted(known) == sorted([*PLAIN, *HALVES, *RefereePage.OF_TEAM, *RefereePage.OF_ROBOT])
