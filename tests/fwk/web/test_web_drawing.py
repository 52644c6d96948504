"""Drawings of views, as browsers get them."""

import json
import math
from types import SimpleNamespace
from typing import Any

import pytest

from fwk.web.drawings import drawn
from fwk.web.general_view import GeneralView
from fwk.web.scene import Newest, Scene
from fwk.web.view import View


def shapes(scene: Scene) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = json.loads(scene.encoded())["shapes"]
    return found


def test_shapes_carry_their_layer_and_what_people_do_with_them() -> None:
    scene = Scene()
    scene.layer("truth", of="robot")
    scene.circle(1.00049, 2.0, 0.5, fill="red", pick="a/robot", drag="robot", trail="robot")
    (circle,) = shapes(scene)
    assert circle == {
        **{"k": "circle", "l": "truth", "x": 1.0, "y": 2.0, "r": 0.5, "fill": "red", "width": 0.02},
        "of": "robot",
        **{"pick": "a/robot", "drag": "robot", "trail": "robot"},
    }


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_shapes_that_lie_nowhere_are_left_out(bad: float) -> None:
    scene = Scene()
    scene.circle(bad, 0.0, 1.0)
    scene.line([(0.0, 0.0), (1.0, bad)], "red")
    scene.ellipse(0.0, 0.0, [[bad, 0.0], [0.0, 1.0]], "red")
    scene.text(0.0, 0.0, "here", "red")
    assert [shape["k"] for shape in shapes(scene)] == ["text"]


def test_an_ellipse_shows_two_standard_deviations() -> None:
    scene = Scene()
    scene.ellipse(0.0, 0.0, [[4.0, 0.0], [0.0, 1.0]], "red")
    scene.ellipse(0.0, 0.0, [[2.5, 1.5], [1.5, 2.5]], "red")
    upright, turned = shapes(scene)
    assert (upright["a"], upright["b"], upright["t"]) == (4.0, 2.0, 0.0)
    assert (turned["a"], turned["b"], turned["t"]) == (4.0, 2.0, round(math.pi / 4, 3))


def test_the_general_view_shows_whatever_has_a_position() -> None:
    place = SimpleNamespace(x_m=1.0, y_m=2.0, heading_rad=0.0, covariance_m2=[[1.0, 0.0], [0.0, 1.0]])
    many = SimpleNamespace(x_m=[1.0, 2.0], y_m=[1.0, 2.0])
    scene = Scene()
    GeneralView().draw(Newest({"b/points": many, "a/place": place}), scene)
    assert [(shape["k"], shape["l"]) for shape in shapes(scene)] == [
        (kind, "a/place") for kind in ("circle", "text", "line", "ellipse")
    ]


def test_the_mistake_of_a_view_is_shown_in_its_place() -> None:
    class Broken(View):
        def draw(self, newest: Newest, scene: Scene) -> None:
            scene.circle(0.0, 0.0, 1.0)
            raise ZeroDivisionError("no field")

    made = json.loads(drawn(Broken(), {}).encoded())
    assert made["shapes"] == []
    assert made["headline"] == "Broken: ZeroDivisionError: no field"
