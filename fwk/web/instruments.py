"""Instruments: drawings of the messages of devices, chosen by the members of the message type.

A channel of any project gets the instrument of the first kind whose members its type has.
"""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from fwk.web.scene import Point, Scene

_LINE = "#1e88e5"
_MARK = "#e53935"
_SOFT = "#8796a5"
_GOOD = "#43a047"
_BEAMS_MAX = 2000
_DIAL_STEPS = 12
_ROW = (1.0, 1.5, 2.0, 3.0, 5.0, 7.5, 10.0, 15.0)
"""Parts of a power of ten that end scales."""


@dataclass(frozen=True)
class Instrument:
    """A kind of device and its drawing."""

    title: str
    icon: str
    members: frozenset[str]
    """Members that a message type needs."""
    draw: Callable[[Any, Scene], None]
    """Draws a message."""


def instrument_of(members: Iterable[str]) -> Instrument | None:
    """Returns the instrument for messages with these members; None: there is none."""
    there = set(members)
    return next((each for each in INSTRUMENTS if each.members <= there), None)


def _draw_camera(frame: Any, scene: Scene) -> None:
    scene.headline = f"frame {frame.frame}, {frame.width_px} x {frame.height_px} px"


def _draw_laser(scan: Any, scene: Scene) -> None:
    """Draws the beams in the frame of the sensor, x to the right; the nearest one is marked."""
    valid = [
        (range_m, scan.angle_min_rad + number * scan.angle_step_rad)
        for number, range_m in enumerate(scan.ranges_m)
        if scan.range_min_m <= range_m <= scan.range_max_m
    ]
    beams = valid[:: math.ceil(len(valid) / _BEAMS_MAX) or 1]
    reach_m = _rounded_up(max((range_m for range_m, _ in valid), default=1.0))
    scene.bounds = (-reach_m, -reach_m, reach_m, reach_m)
    for part in (0.25, 0.5, 0.75, 1.0):
        scene.circle(0.0, 0.0, part * reach_m, stroke=_SOFT, width_m=reach_m / 400)
        scene.text(0.0, part * reach_m, f"{part * reach_m:.3g} m", _SOFT, reach_m / 30)
    scene.polygon([(0.0, 0.0), *(_polar(*beam) for beam in beams)], fill="#1e88e533")
    for beam in beams:
        scene.circle(*_polar(*beam), reach_m / 150, fill=_LINE)
    scene.line([(0.0, 0.0), (reach_m / 10, 0.0)], _MARK, reach_m / 100)
    scene.headline = f"{len(scan.ranges_m)} beams, {len(valid)} valid"
    if valid:
        range_m, angle_rad = min(valid)
        scene.circle(*_polar(range_m, angle_rad), reach_m / 50, stroke=_MARK, width_m=reach_m / 200)
        scene.headline += f", nearest {range_m:.2f} m at {_degrees(angle_rad):.0f}°"


def _draw_gps(fix: Any, scene: Scene) -> None:
    """Draws two standard deviations around the fix, east to the right, in units of the ring."""
    kind = _constant(fix, "kind")
    scene.headline = "no fix" if kind == "none" else f"{fix.latitude_deg:.7f}°, {fix.longitude_deg:.7f}°"
    deviation_m = math.sqrt(max(0.0, fix.covariance_m2[0][0], fix.covariance_m2[1][1]))
    reach_m = _rounded_up(2 * deviation_m) if math.isfinite(deviation_m) and deviation_m > 0.0 else 1.0
    scene.bounds = (-1.3, -1.3, 1.3, 1.3)
    _cross(scene, 1.0)
    if kind != "none":
        scene.circle(0.0, 0.0, 0.025, fill=_MARK)
        scene.ellipse(0.0, 0.0, [[part / reach_m**2 for part in row[:2]] for row in fix.covariance_m2[:2]], _LINE)
    scene.text(0.0, 1.15, "north", _SOFT, 0.08)
    scene.text(0.0, -1.1, f"ring {reach_m:.3g} m", _SOFT, 0.08)
    scene.text(0.0, -1.24, f"{kind}, {fix.satellites} satellites, {fix.altitude_m:.2f} m", _SOFT, 0.08)


def _draw_joints(state: Any, scene: Scene) -> None:
    """Draws a dial for each joint: its position as an angle, its velocity as an arc."""
    count = max(1, len(state.names))
    columns = math.ceil(math.sqrt(count))
    rows = math.ceil(count / columns)
    scene.bounds = (-1.5, -3.0 * rows + 1.5, 3.0 * columns - 1.5, 1.7)
    for number, name in enumerate(state.names):
        x_m, y_m = 3.0 * (number % columns), -3.0 * (number // columns)
        scene.circle(x_m, y_m, 1.0, stroke=_SOFT, width_m=0.03)
        scene.text(x_m, y_m + 1.3, name, _SOFT, 0.26)
        position, velocity, effort = (
            _item(values, number) for values in (state.positions, state.velocities, state.efforts)
        )
        if math.isfinite(position):
            scene.line([(x_m, y_m), _polar(1.0, position, x_m, y_m)], _LINE, 0.08)
            if math.isfinite(velocity):
                scene.line(_arc(x_m, y_m, 0.75, position, position + _clipped(velocity, math.pi)), _MARK, 0.06)
        words = " ".join(f"{value:.3g}" for value in (position, velocity, effort) if math.isfinite(value))
        scene.text(x_m, y_m - 1.25, words or "not measured", _SOFT, 0.22)
    scene.headline = f"{len(state.names)} joints: position in rad or m, velocity in rad/s or m/s, effort in N m or N"


def _draw_joystick(stick: Any, scene: Scene) -> None:
    """Draws a square for each pair of axes and a lamp for each button."""
    pairs = [(stick.axes[index], _item(stick.axes, index + 1)) for index in range(0, len(stick.axes), 2)]
    scene.bounds = (-1.5, -2.6, 3.0 * max(1, len(pairs), len(stick.buttons) / 5) - 1.5, 1.6)
    for number, (x, y) in enumerate(pairs):
        middle_m = 3.0 * number
        corners = [(middle_m + a, b) for a, b in ((-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0))]
        scene.polygon(corners, stroke=_SOFT, width_m=0.03)
        y = y if math.isfinite(y) else 0.0
        scene.line([(middle_m, 0.0), (middle_m + x, y)], _LINE, 0.06)
        scene.circle(middle_m + x, y, 0.14, fill=_LINE)
        scene.text(middle_m, 1.3, f"axes {2 * number}, {2 * number + 1}", _SOFT, 0.22)
    for number, pressed in enumerate(stick.buttons):
        x_m = 0.6 * number - 1.0
        scene.circle(x_m, -1.7, 0.2, fill=_GOOD if pressed else "", stroke=_SOFT, width_m=0.03)
        scene.text(x_m, -2.2, str(number), _SOFT, 0.22)
    scene.headline = ", ".join(f"{value:+.2f}" for value in stick.axes) or "no axes"


def _draw_imu(imu: Any, scene: Scene) -> None:
    """Draws a compass, the rate of turn as an arc, and the acceleration in the frame of the robot."""
    scene.bounds = (-1.6, -1.6, 5.0, 1.6)
    heading_rad = getattr(imu, "heading_rad", math.nan)
    scene.circle(0.0, 0.0, 1.0, stroke=_SOFT, width_m=0.03)
    for step in range(_DIAL_STEPS):
        angle_rad = math.tau * step / _DIAL_STEPS
        scene.line([_polar(0.92, angle_rad), _polar(1.0, angle_rad)], _SOFT, 0.03)
    if math.isfinite(heading_rad):
        scene.line([(0.0, 0.0), _polar(1.0, heading_rad)], _MARK, 0.08)
        scene.line(_arc(0.0, 0.0, 1.15, heading_rad, heading_rad + _clipped(imu.yaw_rate_rad_s, 6.0)), _LINE, 0.08)
    _cross(scene, 1.0, 3.4)
    along, across = getattr(imu, "ax_m_s2", math.nan), getattr(imu, "ay_m_s2", math.nan)
    longest = max(5.0, math.hypot(along, across)) if math.isfinite(along + across) else math.nan
    scene.line([(3.4, 0.0), (3.4 - across / longest, along / longest)], _MARK, 0.08)
    parts = []
    if math.isfinite(heading_rad):
        parts.append(f"heading {math.degrees(heading_rad):.1f}°")
    parts.append(f"turn {imu.yaw_rate_rad_s:+.2f} rad/s")
    scene.text(0.0, -1.4, ", ".join(parts), _SOFT, 0.2)
    if math.isfinite(along + across):
        parts.append(f"forward {along:+.2f} m/s², left {across:+.2f} m/s²")
        scene.text(3.4, -1.4, "forward is up", _SOFT, 0.2)
    scene.headline = ", ".join(parts)


def _draw_base(base: Any, scene: Scene) -> None:
    """Draws the base over lines a metre apart, with its last seconds, and its velocity as a line."""
    x_m, y_m, heading_rad = base.x_m, base.y_m, base.heading_rad
    scene.bounds = (x_m - 2.5, y_m - 2.5, x_m + 2.5, y_m + 2.5)
    for number in range(-3, 4):
        across_m, along_m = math.floor(x_m) + number, math.floor(y_m) + number
        scene.line([(across_m, y_m - 4), (across_m, y_m + 4)], _SOFT, 0.01)
        scene.line([(x_m - 4, along_m), (x_m + 4, along_m)], _SOFT, 0.01)
    corners = [_polar(0.35, heading_rad + turn, x_m, y_m) for turn in (0.0, 2.65, -2.65)]
    scene.circle(x_m, y_m, 0.06, fill=_LINE, trail="base")
    scene.polygon(corners, fill=_LINE)
    speed_m_s = math.hypot(base.vx_m_s, base.vy_m_s)
    towards_rad = heading_rad + math.atan2(base.vy_m_s, base.vx_m_s)
    scene.line([(x_m, y_m), _polar(speed_m_s, towards_rad, x_m, y_m)], _MARK, 0.05)
    scene.line(_arc(x_m, y_m, 0.6, heading_rad, heading_rad + _clipped(base.omega_rad_s, 6.0)), _GOOD, 0.05)
    scene.headline = (
        f"x {x_m:.2f} m, y {y_m:.2f} m, {_degrees(heading_rad):.0f}°, "
        f"{speed_m_s:.2f} m/s, {base.omega_rad_s:+.2f} rad/s"
    )


def _draw_motion(motion: Any, scene: Scene) -> None:
    """Draws a wanted velocity; forward is up."""
    scene.bounds = (-1.6, -1.6, 1.6, 1.6)
    _cross(scene, 1.0)
    longest = max(1.0, math.hypot(motion.vx_m_s, motion.vy_m_s))
    scene.line([(0.0, 0.0), (-motion.vy_m_s / longest, motion.vx_m_s / longest)], _MARK, 0.08)
    scene.line(_arc(0.0, 0.0, 1.2, math.pi / 2, math.pi / 2 + _clipped(motion.omega_rad_s, 6.0)), _LINE, 0.08)
    scene.headline = (
        f"forward {motion.vx_m_s:+.2f} m/s, left {motion.vy_m_s:+.2f} m/s, turn {motion.omega_rad_s:+.2f} rad/s"
    )
    if not getattr(motion, "enabled", True):
        scene.headline += ", motors off"


def _polar(length_m: float, angle_rad: float, x_m: float = 0.0, y_m: float = 0.0) -> Point:
    return x_m + length_m * math.cos(angle_rad), y_m + length_m * math.sin(angle_rad)


def _arc(x_m: float, y_m: float, radius_m: float, begin_rad: float, end_rad: float) -> list[Point]:
    turn_rad = (end_rad - begin_rad) / 24
    return [_polar(radius_m, begin_rad + step * turn_rad, x_m, y_m) for step in range(25)]


def _cross(scene: Scene, reach_m: float, x_m: float = 0.0) -> None:
    scene.circle(x_m, 0.0, reach_m, stroke=_SOFT, width_m=reach_m / 60)
    scene.line([(x_m - reach_m, 0.0), (x_m + reach_m, 0.0)], _SOFT, reach_m / 120)
    scene.line([(x_m, -reach_m), (x_m, reach_m)], _SOFT, reach_m / 120)


def _clipped(value: float, most: float) -> float:
    return max(-most, min(most, value)) if math.isfinite(value) else 0.0


def _rounded_up(length_m: float) -> float:
    """Returns the next length of a row, so that drawings keep their scale while figures vary."""
    if not 0.0 < length_m < math.inf:
        return 1.0
    unit_m: float = 10.0 ** math.floor(math.log10(length_m))
    return next(factor * unit_m for factor in _ROW if factor * unit_m >= length_m)


def _degrees(angle_rad: float) -> float:
    """Returns an angle from -180 to 180 degrees."""
    return math.degrees(math.remainder(angle_rad, math.tau)) if math.isfinite(angle_rad) else math.nan


def _item(values: Sequence[float], number: int) -> float:
    return values[number] if number < len(values) else math.nan


def _constant(message: Any, member: str) -> str:
    """Returns the name of the type's constant that a member equals, in lower case; otherwise the number."""
    value = getattr(message, member, None)
    names = [name for name, each in vars(type(message)).items() if name.isupper() and each == value]
    return names[0].lower().replace("_", " ") if names and value is not None else str(value)


CAMERA = Instrument("Camera", "photo_camera", frozenset(("frame", "slot", "width_px", "height_px")), _draw_camera)
JOYSTICK = Instrument("Joystick", "sports_esports", frozenset(("axes", "buttons")), _draw_joystick)
MOTION = Instrument("Motion", "open_with", frozenset(("vx_m_s", "vy_m_s", "omega_rad_s")), _draw_motion)
INSTRUMENTS = (
    CAMERA,
    Instrument("Laser", "radar", frozenset(("ranges_m", "angle_min_rad", "angle_step_rad")), _draw_laser),
    Instrument("GPS", "satellite_alt", frozenset(("latitude_deg", "longitude_deg", "covariance_m2")), _draw_gps),
    Instrument(
        "Joints", "precision_manufacturing", frozenset(("names", "positions", "velocities", "efforts")), _draw_joints
    ),
    JOYSTICK,
    Instrument("IMU", "explore", frozenset(("yaw_rate_rad_s",)), _draw_imu),
    Instrument(
        "Base",
        "directions_car",
        frozenset(("x_m", "y_m", "heading_rad", "vx_m_s", "vy_m_s", "omega_rad_s")),
        _draw_base,
    ),
    MOTION,
)
"""All instruments; an earlier one is preferred."""
