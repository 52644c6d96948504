"""A camera's picture with the findings of the detectors: `python -m procs.view.sight_picture FILE`.

The web console draws the same over live pictures.
"""

import argparse
import json
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TypeVar

import cv2
import numpy as np

from fwk.program import BAD_INPUT, FAILED, complain
from fwk.testing import MemorySystem, PlanError, launch_plan, settings_in, system_of
from fwk.testing.evaluation import failure_of
from fwk.testing.seeds import seed_argument
from lcmtypes.core import picture_t
from lcmtypes.soccer import ball_percept_t, line_points_t, obstacle_percepts_t
from procs.model.algebra import Floats
from procs.model.ball import RADIUS_M
from procs.model.units import US_PER_S
from procs.view.canvas import Colour
from procs.vision.calibration import MirrorConfig
from procs.vision.colours import Picture
from procs.vision.mirror import Mirror

T = TypeVar("T", ball_percept_t, obstacle_percepts_t, line_points_t)

BALL: Colour = (88, 238, 255)
OBSTACLE: Colour = (129, 64, 255)
LINE: Colour = (255, 229, 0)
"""Colours of the findings, as blue, green, red."""
_SHIFT = 4  # OpenCV takes coordinates in sixteenths of a pixel
_STEPS = 32  # number of points on the outline of a foot
_ROBOT = "cyan3"
_PICTURES = "sight/pictures"
"""A component of this program, besides those of the launch file."""
_LAUNCH = "include: {file}\nname: sight\ncomponents: {{{name}: {{use: procs.view.pictures, config: {config}}}}}\n"
_DETECTOR = "omni_ball"
"""Component of a robot whose settings tell mirror and ball."""
_LONGEST_S = 3600.0
_SUFFIXES = (".png", ".jpg")
_FINE = "{format: png, rate_hz: 0}"


def drawn(
    pixels: Picture,
    mirror: Mirror,
    ball: ball_percept_t,
    obstacles: obstacle_percepts_t,
    lines: line_points_t,
    scale: int = 2,
    ball_radius_m: float = RADIUS_M,
) -> Picture:
    """Returns the picture of a camera (size, size, 3), enlarged by `scale`, with the findings drawn into it.

    Points on lines are dots; the feet of robots and the outline of the ball are rings.
    """
    picture = cv2.resize(pixels, None, fx=scale, fy=scale, interpolation=cv2.INTER_NEAREST)
    points_m = np.column_stack((lines.x_m, lines.y_m, np.zeros(len(lines.x_m))))
    for place in _fine(mirror.project(points_m), scale):
        cv2.circle(picture, place.tolist(), scale << _SHIFT, LINE, cv2.FILLED, cv2.LINE_AA, _SHIFT)
    around = np.linspace(0.0, 2 * np.pi, _STEPS, endpoint=False)
    rim = np.column_stack((np.cos(around), np.sin(around), np.zeros(_STEPS)))
    for each in obstacles.obstacles:
        foot = mirror.project(rim * each.radius_m + (each.x_m, each.y_m, 0.0))
        cv2.polylines(picture, [_fine(foot, scale)], True, OBSTACLE, scale, cv2.LINE_AA, _SHIFT)
    if ball.visible:
        *middle, radius_px = mirror.sphere((ball.x_m, ball.y_m, ball.z_m + ball_radius_m), ball_radius_m)
        (place,) = _fine(np.array([middle]), scale)
        radius = round((radius_px + 2.0) * scale * (1 << _SHIFT))
        cv2.circle(picture, place.tolist(), radius, BALL, scale, cv2.LINE_AA, _SHIFT)
    return np.asarray(picture, np.uint8)


def _fine(pixels: Floats, scale: int) -> np.ndarray[tuple[int, int], np.dtype[np.int32]]:
    """Returns pixels (n, 2) of the camera as OpenCV's fixed-point numbers in the larger picture."""
    larger = (pixels + 0.5) * scale - 0.5
    return np.round(larger.clip(-4096, 4096) * (1 << _SHIFT)).astype(np.int32)


def sight_in(system: MemorySystem, robot: str, mirror: MirrorConfig, ball_radius_m: float = RADIUS_M) -> Picture | None:
    """Returns the newest picture of a robot's camera with the findings of its tick; None if there is none.

    It shows what the detectors see of the frame. The system needs a component `sight/pictures` that publishes every
    picture.
    """
    for data in reversed(system.sent[_PICTURES]):
        seen = picture_t.decode(data)
        if seen.camera != f"{robot}/image":
            continue
        pixels = np.asarray(cv2.imdecode(np.frombuffer(seen.data, np.uint8), cv2.IMREAD_COLOR), np.uint8)
        tick = seen.header.tick
        ball = _of_tick(system.sent.get(f"{robot}/ball_percept", ()), ball_percept_t, tick)
        obstacles = _of_tick(system.sent.get(f"{robot}/obstacle_percepts", ()), obstacle_percepts_t, tick)
        lines = _of_tick(system.sent.get(f"{robot}/line_points", ()), line_points_t, tick)
        return drawn(mirror.fitted(pixels), mirror.mirror(), ball, obstacles, lines, ball_radius_m=ball_radius_m)
    return None


def _of_tick(sent: Sequence[bytes], kind: type[T], tick: int) -> T:
    """Returns the message of a tick; an empty one if there is none."""
    found: Iterator[T] = map(kind.decode, sent)
    return next((each for each in found if each.header.tick == tick), kind())


def _included(launch: str) -> str:
    """Returns how a launch file in another folder includes this one: by its path, or by its name if fwk provides it."""
    places = (Path(launch), Path("launch") / launch)
    return next((str(place.absolute()) for place in places if place.is_file()), launch)


def _refused(text: str, code: int = BAD_INPUT) -> SystemExit:
    """Says what is wrong; returns the end of the program, with an exit code."""
    complain(text)
    return SystemExit(code)


def _time_s(text: str) -> float:
    with suppress(ValueError):
        if 0.0 <= (time_s := float(text)) <= _LONGEST_S:
            return time_s
    raise argparse.ArgumentTypeError(f"'{text}' is not a time; use seconds from 0 to {_LONGEST_S:g}")


def main() -> None:
    """Plays the beginning of a match and writes the picture."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("file", type=Path, help="picture to write, .png or .jpg")
    parser.add_argument("--launch", default="soccer.yaml", help="launch file; default: soccer.yaml")
    parser.add_argument("--robot", default=_ROBOT, help=f"robot whose camera is shown; default: {_ROBOT}")
    parser.add_argument("--time", type=_time_s, default=9.0, help="logical time in s; default: 9")
    parser.add_argument("--seed", type=seed_argument, default=7, help="seed of the match; default: 7")
    asked = parser.parse_args()
    if asked.file.suffix not in _SUFFIXES:
        raise _refused(f"'{asked.file}' ends in '{asked.file.suffix}'; it should end in {' or '.join(_SUFFIXES)}")
    if not asked.file.absolute().parent.is_dir():
        raise _refused(f"'{asked.file}' cannot be written: there is no folder '{asked.file.parent}'")
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "sight.yaml"
        file.write_text(_LAUNCH.format(file=json.dumps(_included(asked.launch)), name=_PICTURES, config=_FINE))
        try:
            launch_plan(asked.launch)  # its mistakes name the file that was asked for
            settings = settings_in(str(file), f"{asked.robot}/{_DETECTOR}")
        except KeyError as error:
            names = (each.name for each in launch_plan(str(file)).components)
            robots = [robot for robot, _, short in (name.rpartition("/") for name in names) if short == _DETECTOR]
            there = ", ".join(robots) or "none"
            raise _refused(f"{asked.launch}: no {_DETECTOR} of {asked.robot}; robots with one: {there}") from error
        except PlanError as error:
            raise _refused(str(error)) from error
        try:
            system = system_of(str(file), seed=asked.seed)
            while system.now_us < asked.time * US_PER_S:
                system.tick()
        except Exception as error:  # of a component, such as a camera without its pictures
            raise _refused(f"{asked.launch}: {failure_of(error)}", FAILED) from error
        mirror = MirrorConfig(**settings["mirror"])
        picture = sight_in(system, asked.robot, mirror, settings["ball"]["radius_m"])
    if picture is None:
        raise _refused(f"no picture of {asked.robot}/image until {asked.time:g} s; a later --time would show one")
    if not cv2.imwrite(str(asked.file), picture):
        raise _refused(f"'{asked.file}' cannot be written")


if __name__ == "__main__":
    main()
