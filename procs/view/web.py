"""The match in the web console: a view from above, and the referee's page."""

from collections.abc import Iterable
from typing import Any

from fwk.web import Newest, OpenPage, Page, RunAccess, Scene, View
from lcmtypes.soccer import ground_truth_t, navigator_state_t, pose_t, true_robot_t, world_model_t
from procs.model.ball import BALL
from procs.model.field import SIDES, Field, Point
from procs.model.geometry import ahead, plausible
from procs.model.robot import CYAN, MAGENTA, ROBOT, number_in, team_in
from procs.referee.orders import CARDS, GOALS, HALVES, PLAIN
from procs.referee.reasons import REPAIRS
from procs.referee.refusals import SET_PIECES
from procs.view.camera_sight import CALIBRATION, SEES, draw_sight
from procs.view.ground import arc_places
from procs.view.measures import MEASURES, field_in, recent
from procs.view.scoreboard import GAME_STATE, TRUTH, headline

COLOURS = {CYAN: "#00b0d6", MAGENTA: "#d628aa"}
MIND = ("pose", "world_model", "drive_target", "navigator_state", "role", "skill_status")
"""Channels of a robot with its beliefs, its target and the way to it, its role and its skill."""
_UNKNOWN = "#787878"
_GRASS = "#30803c"
_SURROUND = "#245c30"
_WHITE = "#f0f4f0"
_ARC_STEPS = 24
_NOSE_M = 0.3  # length of the line that shows a robot's heading
_BLOCKED = "(way blocked)"
_RING_M = 0.03  # distance between the radius of a robot and that of the ring where it believes it is


class MatchView(View):
    """The field from above: the truth, and the beliefs, targets, roles and skills of the robots."""

    title = "Match"
    needs = (TRUTH,)
    channels = (TRUTH, MEASURES, GAME_STATE, *(f"*/{name}" for name in MIND))
    sees = SEES
    sight_settings = CALIBRATION
    settings = ("world/*.robot", "world/*.ball", "world/*.field")

    def draw(self, newest: Newest, scene: Scene) -> None:
        """Draws the newest messages."""
        truth, field = newest(TRUTH), field_in(newest)
        scene.headline = headline(newest)
        scene.background = _SURROUND
        x_m, y_m = field.half_length_m + field.border_m, field.half_width_m + field.border_m
        scene.bounds = (-x_m, -y_m, x_m, y_m)
        scene.ground(_draw_ground, field)
        if truth is None:
            return
        robot_radius_m = newest.settings("world/*", "robot").get("radius_m", ROBOT.radius_m)
        robots = [each for each in truth.robots if plausible(each.x_m, each.y_m, each.heading_rad)]
        for robot in robots:
            _draw_mind(scene, newest, truth, robot, robot_radius_m)
        for robot in robots:
            _draw_robot(scene, robot, robot_radius_m)
        ball_radius_m = newest.settings("world/*", "ball").get("radius_m", BALL.radius_m)
        _draw_ball(scene, truth, ball_radius_m)  # above the beliefs of the robots about it

    def sight(self, camera: str, newest: Newest, scene: Scene) -> None:
        """Draws the detections of a robot over an image of its camera."""
        draw_sight(camera, newest, scene)

    async def moved(self, run: RunAccess, name: str, x_m: float, y_m: float) -> None:
        """Puts the ball or a robot, as `name` states, at another place of the world frame."""
        if name == "ball":
            await run.call("world/place_ball", {"x_m": x_m, "y_m": y_m})
            return
        truth = (await run.link.newest((TRUTH,))).get(TRUTH)
        heading_rad = next((robot.heading_rad for robot in truth.robots if robot.name == name), 0.0) if truth else 0.0
        await run.call("world/place_robot", {"robot": name, "x_m": x_m, "y_m": y_m, "heading_rad": heading_rad})


class RefereePage(Page):
    """State and score of the match, and a button for every command of the referee."""

    title = "Referee"
    path = "referee"
    icon = "sports"
    needs = ("world/referee_command@outside", GAME_STATE)

    OF_TEAM = (*SET_PIECES, *GOALS)
    """Commands that name a team."""
    OF_ROBOT = (*CARDS, *REPAIRS)
    """Commands that name a robot."""

    def build(self, page: OpenPage) -> None:
        """Adds the score to the page, and the buttons if the user may steer the run."""
        from nicegui import ui

        run = page.access
        score = ui.label("").classes("text-h5 q-pa-md").props("data-name=score")

        async def refresh() -> None:
            score.set_text(headline(Newest(await run.link.newest((GAME_STATE,)))) or "before the match")

        page.every(0.5, refresh)
        if not page.may_steer:
            return

        def buttons(names: Iterable[str], team: str = "", colour: str = "primary") -> None:
            with ui.row().classes("q-px-md gap-1"):
                for name in names:
                    button = ui.button(
                        name.replace("_", " "), on_click=lambda name=name: command(name, team), color=colour
                    )
                    button.props("no-caps dense").classes("q-px-sm").props(f'data-name="{name} {team}"')

        async def command(name: str, team: str) -> None:
            members = {"name": name, "team": team, "robot": robot.value or "" if name in self.OF_ROBOT else ""}
            await page.do(run.call("world/referee_command", members))

        buttons(PLAIN)
        buttons(HALVES)
        for team, colour in COLOURS.items():
            ui.label(team).classes("q-px-md text-subtitle1")
            buttons(self.OF_TEAM, team, colour)
        robot = ui.input("robot, such as cyan1").props("dense outlined").classes("q-px-md").props("data-name=robot")
        buttons(self.OF_ROBOT)


def _draw_ground(scene: Scene, field: Field) -> None:
    x_m, y_m = field.half_length_m, field.half_width_m
    scene.polygon([(-x_m, -y_m), (x_m, -y_m), (x_m, y_m), (-x_m, y_m)], fill=_GRASS)
    for segment in field.segments():
        scene.line([segment.start, segment.end], _WHITE, field.line_width_m)
    for arc in field.arcs():
        scene.line(arc_places(arc, _ARC_STEPS), _WHITE, field.line_width_m)
    for mark in field.marks():
        scene.circle(mark.x_m, mark.y_m, field.mark_diameter_m / 2, fill=_WHITE)
    for side in SIDES:
        front_m, half_m = side * field.half_length_m, field.goal_width_m / 2
        back_m = front_m + side * field.goal_depth_m
        scene.line([(front_m, -half_m), (back_m, -half_m), (back_m, half_m), (front_m, half_m)], _WHITE, 0.08)


def _draw_robot(scene: Scene, robot: true_robot_t, radius_m: float) -> None:
    colour = COLOURS.get(team_in(robot), _UNKNOWN)
    scene.layer("truth", of=robot.name)
    body = (robot.x_m, robot.y_m, radius_m, colour, "#202226", 0.06)
    scene.circle(*body, pick=robot.name, drag=robot.name, trail=robot.name)
    place = Point(robot.x_m, robot.y_m)
    scene.line([place, ahead(place, robot.heading_rad, _NOSE_M)], _WHITE, 0.05)
    scene.text(robot.x_m, robot.y_m, str(number_in(robot) or "?"), "#101214", 0.22)


def _draw_ball(scene: Scene, truth: ground_truth_t, radius_m: float) -> None:
    scene.layer("truth", of="ball")
    place = (truth.ball_x_m, truth.ball_y_m, radius_m)
    scene.circle(*place, "#fac41e", "#82591a", 0.03, pick="ball", drag="ball", trail="ball")


def _draw_mind(scene: Scene, newest: Newest, truth: ground_truth_t, robot: true_robot_t, radius_m: float) -> None:
    """Draws the positions of robot and ball in the belief of the robot, its target, role and skill, if it runs."""
    colour = COLOURS.get(team_in(robot), _UNKNOWN)

    def told(name: str) -> Any:
        return recent(newest(f"{robot.name}/{name}"), truth)

    model: world_model_t | None = told("world_model")
    pose: pose_t | None = told("pose")
    if model is not None:
        scene.layer("beliefs", of=robot.name)
        if model.localized:
            scene.circle(model.x_m, model.y_m, radius_m + _RING_M, stroke=colour, width_m=0.03)
            scene.line([(robot.x_m, robot.y_m), (model.x_m, model.y_m)], colour, 0.03)
            if pose is not None:
                scene.ellipse(pose.x_m, pose.y_m, pose.covariance, colour)
        if model.ball.known:
            scene.circle(model.ball.x_m, model.ball.y_m, 0.05, fill=colour)
            scene.ellipse(model.ball.x_m, model.ball.y_m, model.ball.covariance, colour)
    target = told("drive_target")
    if target is not None and not target.stop:
        scene.layer("targets", of=robot.name)
        scene.line([(robot.x_m, robot.y_m), (target.x_m, target.y_m)], colour, 0.02, dashed=True)
    role, skill, navigator = told("role"), told("skill_status"), told("navigator_state")
    blocked = navigator is not None and navigator.error == navigator_state_t.OBSTRUCTED
    words = " ".join(filter(None, (role.role if role else "", skill.skill if skill else "", _BLOCKED * blocked)))
    if words:
        scene.layer("roles", of=robot.name)
        scene.text(robot.x_m, robot.y_m - 0.45, words, _WHITE, 0.2)
