"""The picture from above: objects at their positions and in the right colours."""

import numpy as np
import pytest

from fwk.web import Newest
from lcmtypes.soccer import game_state_t, ground_truth_t, true_robot_t, world_model_t
from procs.model.field import Field
from procs.model.robot import ROBOT
from procs.simulation.physics.reports import field_message
from procs.view.ground import GRASS, WHITE, arc_places
from procs.view.palette import TEAM_COLOURS
from procs.view.top_view import BALL, BAR, SHADOW, TopView, _view, picture, picture_with_beliefs
from procs.vision.colours import Picture

VIEW = TopView(960)
PX_PER_M = 960 / 24


def truth(*robots: tuple[str, float, float, float]) -> ground_truth_t:
    made = ground_truth_t()
    made.ball_x_m, made.ball_y_m = 3.0, 2.0
    for name, x_m, y_m, heading_rad in robots:
        robot = true_robot_t()
        robot.name, robot.x_m, robot.y_m, robot.heading_rad = name, x_m, y_m, heading_rad
        made.robots.append(robot)
    return made


def colour_at(drawn: Picture, x_m: float, y_m: float) -> tuple[int, ...]:
    bar_px = VIEW.height_px - 16 * PX_PER_M
    row, column = round(bar_px + (8.0 - y_m) * PX_PER_M), round((12.0 + x_m) * PX_PER_M)
    return tuple(drawn[row, column].tolist())


def test_size_follows_from_the_width_and_is_even() -> None:
    assert VIEW.draw(truth()).shape == (VIEW.height_px, 960, 3)
    for width_px in (333, 640, 1281):
        assert all(size % 2 == 0 for size in TopView(width_px).draw(truth()).shape[:2])


def test_lines_are_white_and_grass_is_green() -> None:
    drawn = VIEW.draw(truth())
    for place in ((0.0, 3.0), (0.0, 6.93), (10.93, 5.0), (8.81, 2.0), (1.37, 1.37), (-7.4, 0.0)):
        assert colour_at(drawn, *place) == pytest.approx(WHITE, abs=12)
    assert colour_at(drawn, 5.0, 5.0) in GRASS


def test_robots_have_team_colours_and_ball_is_at_its_position() -> None:
    drawn = VIEW.draw(truth(("cyan1", -5.0, 1.0, 0.0), ("magenta2", 4.0, -3.0, 0.0)))
    assert colour_at(drawn, -5.0, 0.88) == pytest.approx(TEAM_COLOURS["cyan"], abs=12)
    assert colour_at(drawn, 4.0, -3.12) == pytest.approx(TEAM_COLOURS["magenta"], abs=12)
    assert colour_at(drawn, 3.0, 2.0) == pytest.approx(BALL, abs=12)


def test_shadow_of_a_flying_ball_is_away_from_it() -> None:
    flying = truth()
    flying.ball_z_m = 2.0
    drawn = VIEW.draw(flying)
    assert colour_at(drawn, 3.0, 2.0) == pytest.approx(BALL, abs=12)
    assert colour_at(drawn, 3.63, 1.16) == pytest.approx(SHADOW, abs=12)


def test_heading_is_drawn() -> None:
    left, up = VIEW.draw(truth(("cyan1", 0.0, 0.0, 0.0))), VIEW.draw(truth(("cyan1", 0.0, 0.0, np.pi / 2)))
    assert sum(colour_at(left, 0.21, 0.0)) > sum(colour_at(up, 0.21, 0.0)) + 200
    assert sum(colour_at(up, 0.0, 0.21)) > sum(colour_at(left, 0.0, 0.21)) + 200


def test_bar_shows_the_score() -> None:
    def bar(**fields: int) -> Picture:
        state = game_state_t()
        for name, value in fields.items():
            setattr(state, name, value)
        return VIEW.draw(truth(), state)[:40]

    assert (VIEW.draw(truth())[:40] == BAR).all()
    assert (bar() != bar(score_cyan=1)).any()
    assert (bar(score_cyan=1) == bar(score_cyan=1)).all()


def test_estimates_are_drawn_where_the_robot_sees_the_ball() -> None:
    belief = world_model_t()
    belief.ball.known, belief.ball.x_m, belief.ball.y_m = True, -6.0, -4.0
    belief.ball.covariance = [[0.25, 0, 0, 0], [0, 0.01, 0, 0], [0] * 4, [0] * 4]
    without, drawn = VIEW.draw(truth()), VIEW.draw(truth(), beliefs={"magenta1": belief})
    rows, columns = np.nonzero((without != drawn).any(axis=2))
    assert np.ptp(columns) / PX_PER_M == pytest.approx(2.0, abs=0.1)
    assert np.ptp(rows) / PX_PER_M == pytest.approx(0.4, abs=0.1)
    assert columns.mean() / PX_PER_M - 12.0 == pytest.approx(-6.0, abs=0.05)


@pytest.mark.parametrize("radius_m", [0.2, 0.35])
def test_ring_of_a_right_belief_lies_around_the_robot(radius_m: float) -> None:
    view, still = TopView(960, robot=ROBOT.model_copy(update={"radius_m": radius_m})), truth(("cyan1", 0.0, 0.0, 0.0))
    belief = world_model_t(localized=True)
    rows, columns = np.nonzero((view.draw(still) != view.draw(still, beliefs={"cyan1": belief})).any(axis=2))
    assert np.ptp(columns) / PX_PER_M == np.ptp(rows) / PX_PER_M == pytest.approx(2 * (radius_m + 0.03), abs=0.06)


def test_extreme_values_are_drawn_or_left_out_but_never_fatal() -> None:
    belief = world_model_t()
    belief.localized, belief.ball.known = True, True
    belief.x_m, belief.ball.x_m = 1e9, float("nan")
    belief.ball.covariance = [[float("inf")] * 4] * 4
    inf = float("inf")
    wild = truth(("cyan1", float("nan"), 0.0, 0.0), ("goalie", 1e12, 0.0, 0.0), ("cyan2", 0.0, 0.0, inf))
    wild.ball_x_m = inf
    assert VIEW.draw(wild, game_state_t(time_in_half_s=inf), beliefs={"cyan1": belief}).shape == (
        VIEW.height_px,
        960,
        3,
    )


def test_goal_that_is_deeper_than_wide_is_drawn() -> None:
    assert TopView(320, Field(border_m=10.0, goal_depth_m=10.0, goal_width_m=1.2)).width_px == 320


def test_picture_of_the_newest_messages() -> None:
    belief = world_model_t()
    belief.localized, belief.x_m, belief.y_m = True, 5.0, 5.0
    messages = {"world/ground_truth": truth(("cyan1", 0.0, 0.0, 0.0)), "cyan1/world_model": belief}
    plain, believed = picture(messages.get), picture_with_beliefs(messages.get)
    assert plain is not None
    assert believed is not None
    _, columns = np.nonzero((plain != believed).any(axis=2))
    assert columns.mean() / plain.shape[1] == pytest.approx((12.0 + 5.0) / 24.0, abs=0.002)
    assert np.ptp(columns) < 40


def test_belief_of_a_silent_robot_is_not_in_the_picture() -> None:
    belief, now = world_model_t(), truth(("cyan1", 0.0, 0.0, 0.0))
    belief.localized, belief.x_m, now.header.time_us = True, 5.0, 2_000_000
    messages = {"world/ground_truth": now, "cyan1/world_model": belief}
    plain, believed = picture(messages.get), picture_with_beliefs(messages.get)
    assert plain is not None
    assert believed is not None
    assert np.array_equal(plain, believed)


def test_views_of_many_fields_do_not_fill_the_memory() -> None:
    kept = []
    for length_m in np.linspace(18.0, 22.0, 8):
        measures = field_message(Field(length_m=float(length_m)))
        picture({"world/ground_truth": truth(), "world/field": measures}.get)
        kept.append(_view.cache_info().currsize)
    assert max(kept) < 8


def test_small_corner_arcs_stay_in_the_field() -> None:
    """The round ends of a thick line are longer than such an arc."""
    field = Field(corner_radius_m=0.13)
    corners = [arc for arc in field.arcs() if arc.radius_m < 0.2]
    assert len(corners) == 4
    for arc in corners:
        for place in arc_places(arc, 48, field.line_width_m / arc.radius_m):
            assert abs(place.x_m) < field.half_length_m
            assert abs(place.y_m) < field.half_width_m


def test_picture_shows_the_field_of_the_simulation() -> None:
    small = Field(length_m=18.0, width_m=12.0, border_m=1.5)
    messages = {"world/ground_truth": truth(("cyan1", 0.0, 0.0, 0.0)), "world/field": field_message(small)}
    drawn, usual = picture(messages.get), picture({"world/ground_truth": messages["world/ground_truth"]}.get)
    assert drawn is not None
    assert usual is not None
    assert drawn.shape[0] == TopView(drawn.shape[1], small).height_px
    assert drawn.shape[0] != usual.shape[0]


def test_picture_shows_robot_and_ball_as_large_as_the_settings() -> None:
    message = truth(("cyan1", -5.0, 1.0, 0.0))
    usual = picture(Newest({"world/ground_truth": message}))
    large = Newest(
        {"world/ground_truth": message},
        {("world/simulator", "robot.radius_m"): 0.4, ("world/simulator", "ball.radius_m"): 0.2},
    )
    drawn = picture(large)
    assert drawn is not None
    assert usual is not None
    rows, columns = np.nonzero((drawn != usual).any(axis=2))
    px_per_m, left = drawn.shape[1] / 24.0, columns < drawn.shape[1] / 2
    assert np.ptp(rows[left]) / px_per_m == pytest.approx(0.8, abs=0.1)
    assert np.ptp(rows[~left]) / px_per_m == pytest.approx(0.4, abs=0.1)


def test_before_the_first_world_message_there_is_no_picture() -> None:
    assert picture(lambda _: None) is None
    assert picture_with_beliefs(lambda _: None) is None
