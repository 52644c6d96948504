"""Choice and drawings of instruments; driving by hand."""

import json
import math
from typing import Any

import pytest

from fwk.web.device_view import DeviceView, devices_of
from fwk.web.driving import Deflection, Watchman, drives, members_of
from fwk.web.general_view import GeneralView
from fwk.web.instruments import INSTRUMENTS, instrument_of
from fwk.web.scene import Newest, Scene
from fwk.web.view import View
from lcmtypes.core import frame_t
from lcmtypes.robot import (
    gps_fix_t,
    imu_t,
    joint_state_t,
    joystick_t,
    kicker_state_t,
    laser_scan_t,
    motor_command_t,
    odometry_t,
)


def message(kind: Any, /, **members: Any) -> Any:
    made = kind()
    for name, value in members.items():
        setattr(made, name, value)
    return made


DEVICES = {
    "Camera": message(frame_t, frame=7, width_px=64, height_px=48),
    "Laser": message(
        laser_scan_t, angle_step_rad=0.5, range_max_m=10.0, n_ranges=4, ranges_m=[2.0, math.inf, 1.0, math.nan]
    ),
    "GPS": message(gps_fix_t, kind=3, satellites=9, latitude_deg=48.5, covariance_m2=[[4, 0, 0], [0, 1, 0], [0] * 3]),
    "Joints": message(
        joint_state_t, n_joints=2, names=["pan", "tilt"], positions=[1.0, math.nan], velocities=[0.5, 0.0], efforts=[]
    ),
    "Joystick": message(joystick_t, n_axes=3, axes=[0.5, -1.0, 0.25], n_buttons=2, buttons=[False, True]),
    "IMU": message(imu_t, heading_rad=1.0, yaw_rate_rad_s=0.5, ax_m_s2=2.0, ay_m_s2=-1.0),
    "Base": message(odometry_t, x_m=3.0, y_m=-1.0, heading_rad=0.49 + 4 * math.pi, vx_m_s=1.0, omega_rad_s=0.2),
    "Motion": message(motor_command_t, vx_m_s=1.5, vy_m_s=-0.5, omega_rad_s=1.0),
}


def drawing(title: str) -> dict[str, Any]:
    scene = Scene()
    DeviceView("a/device").draw(Newest({"a/device": DEVICES[title]}), scene)
    made: dict[str, Any] = json.loads(scene.encoded())
    return made


def words(made: dict[str, Any]) -> str:
    return " | ".join([made["headline"], *(shape["s"] for shape in made["shapes"] if shape["k"] == "text")])


def test_every_kind_of_device_is_known_by_its_members() -> None:
    found = {title: instrument_of(device.__slots__) for title, device in DEVICES.items()}
    assert {title: each.title for title, each in found.items() if each} == {title: title for title in DEVICES}
    assert {each.title for each in INSTRUMENTS} == {*DEVICES}
    types = {"a/scan": laser_scan_t, "a/kicker": kicker_state_t, "a/drive@outside": motor_command_t}
    assert [*devices_of(types)] == ["a/scan"]


@pytest.mark.parametrize(
    ("title", "said"),
    [
        ("Camera", "frame 7, 64 x 48 px"),
        ("Laser", "4 beams, 2 valid, nearest 1.00 m at 57°"),
        ("GPS", "48.5000000°, 0.0000000° | north | ring 5 m | kinematic, 9 satellites"),
        ("Joints", "pan | 1 0.5 | tilt | 0"),
        ("Joystick", "+0.50, -1.00, +0.25 | axes 0, 1 | axes 2, 3"),
        ("IMU", "heading 57.3°, turn +0.50 rad/s, forward +2.00 m/s², left -1.00 m/s²"),
        ("Base", "x 3.00 m, y -1.00 m, 28°, 1.00 m/s, +0.20 rad/s"),
        ("Motion", "forward +1.50 m/s, left -0.50 m/s, turn +1.00 rad/s, motors off"),
    ],
)
def test_an_instrument_says_what_the_device_measures(title: str, said: str) -> None:
    made = drawing(title)
    assert said in words(made).replace(" (tick 0, 0:00.00)", "")
    assert made["bounds"]


def test_laser_beams_lie_where_they_hit() -> None:
    (beams,) = [shape["p"] for shape in drawing("Laser")["shapes"] if shape["k"] == "polygon"]
    assert beams == [[0.0, 0.0], [2.0, 0.0], [round(math.cos(1.0), 3), round(math.sin(1.0), 3)]]


def test_the_nearest_of_very_many_beams_is_found() -> None:
    ranges_m = [5.0] * 9000
    ranges_m[6751] = 1.25
    scan = message(laser_scan_t, angle_min_rad=-math.pi, angle_step_rad=math.tau / 9000, range_max_m=8.0)
    scan.n_ranges, scan.ranges_m = 9000, ranges_m
    scene = Scene()
    DeviceView("a/device").draw(Newest({"a/device": scan}), scene)
    assert scene.headline.startswith("9000 beams, 9000 valid, nearest 1.25 m at 90°")
    assert len(json.loads(scene.encoded())["shapes"]) < 2100


def test_gps_shows_centimetres_and_where_there_is_no_fix() -> None:
    fix = message(gps_fix_t, kind=3, covariance_m2=[[0.0001, 0, 0], [0, 0.0001, 0], [0] * 3], capture_us=61_500_000)
    scene = Scene()
    DeviceView("a/device").draw(Newest({"a/device": fix}), scene)
    made = json.loads(scene.encoded())
    (ellipse,) = [shape for shape in made["shapes"] if shape["k"] == "ellipse"]
    assert (ellipse["a"], "ring 0.02 m" in words(made)) == (1.0, True)
    assert made["headline"].endswith("(tick 0, 1:01.50)")
    scene = Scene()
    DeviceView("a/device").draw(Newest({"a/device": gps_fix_t()}), scene)
    assert scene.headline.startswith("no fix")


@pytest.mark.parametrize("kind", [type(each) for each in DEVICES.values()])
def test_devices_that_measure_nothing_are_drawn(kind: Any) -> None:
    scene = Scene()
    DeviceView("a/device").draw(Newest({"a/device": kind()}), scene)
    assert scene.headline
    json.loads(scene.encoded())


def test_a_device_without_messages_says_so() -> None:
    scene = Scene()
    DeviceView("a/device").draw(Newest({}), scene)
    assert scene.headline == "a/device: never written"


def test_views_draw_detections_over_images() -> None:
    class Sight(View):
        sees = ("found",)

        def draw(self, newest: Newest, scene: Scene) -> None:
            raise AssertionError

        def sight(self, camera: str, newest: Newest, scene: Scene) -> None:
            found = newest("a/found")
            scene.circle(found.x_m, found.y_m, 3.0, stroke="red")

    view = DeviceView("a/device", [GeneralView(), Sight()])
    scene = Scene()
    view.draw(Newest({"a/device": DEVICES["Camera"], "a/found": DEVICES["Base"]}), scene)
    made = json.loads(scene.encoded())
    assert view.channels == ["a/device", "a/found"]
    assert made["picture"] == {"camera": "a/device", "frame": 7, "width": 64, "height": 48}
    assert [(shape["x"], shape["y"]) for shape in made["shapes"]] == [(3.0, -1.0)]


def test_what_drives_is_known_by_its_members() -> None:
    assert {title for title, device in DEVICES.items() if drives({*device.__slots__})} == {"Joystick", "Motion"}


def test_a_deflection_becomes_the_message_of_the_channel() -> None:
    stick = Deflection.of({"at": [1.0, -0.5, 9.0], "buttons": [2], "held": True})
    motion = members_of({*motor_command_t.__slots__}, stick, 2.0, 3.0)
    assert motion == {"vx_m_s": 2.0, "vy_m_s": -1.0, "omega_rad_s": 3.0, "enabled": True}
    joystick = members_of({*joystick_t.__slots__}, stick, 2.0, 3.0)
    assert joystick["axes"] == [0.5, 1.0, -1.0]
    assert [number for number, pressed in enumerate(joystick["buttons"]) if pressed] == [2]


def test_a_held_pad_that_falls_silent_is_let_go_once() -> None:
    now_us = 0
    watchman = Watchman(lambda: now_us)
    watchman.told(Deflection(forward=1.0, held=True))
    now_us = 500_000
    assert not watchman.lets_go()
    now_us = 500_001
    assert watchman.lets_go()
    assert not watchman.lets_go()
    watchman.told(Deflection())
    now_us = 5_000_000
    assert not watchman.lets_go()
