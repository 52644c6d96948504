"""Renders what a forward pair of cameras sees: the ground, and robots as upright cylinders with a pattern."""

import math
from collections.abc import Sequence

import cv2
import numpy as np

from procs.model.algebra import Floats
from procs.model.field import Field
from procs.model.frames import Indices
from procs.simulation.rendering.carpet import NEW, Wear, lay_carpet
from procs.simulation.rendering.renderer import Pose
from procs.simulation.rendering.shapes import Bodies
from procs.vision.stereo_rig import Grey, StereoRig

_SKY = 170  # grey level above the horizon
_NEAREST_M = 0.05
_PANEL_RAD, _PANEL_M = 0.15, 0.05  # size of the patches on the bodies of robots


class StereoRenderer:
    """Looks along the ray of every pixel, column by column, and paints upright bodies from far to near."""

    def __init__(
        self,
        rig: StereoRig,
        field: Field,
        bodies: Bodies,
        wear: Wear = NEW,
        tilt_rad: tuple[float, float] = (0.0, 0.0),
    ) -> None:
        """Prepares the ground.

        Args:
            rig: calibration of the pair.
            field: measures of the field.
            bodies: measures of the robots.
            wear: signs of use on the field.
            tilt_rad: small uncalibrated tilt of the pair as a whole about the robot's x and y axis.
        """
        self._rig, self._bodies, self._tilt_rad = rig, bodies, tilt_rad
        carpet = lay_carpet(field, wear=wear)
        self._origin_px, self._scale_m = carpet.origin_px, carpet.metres_per_px
        self._grey = cv2.cvtColor(carpet.pixels, cv2.COLOR_BGR2GRAY)
        rows = rig.rows
        self._ground_rows = rows > 0.02
        self._ground_m = rig.height_m / rows[self._ground_rows]  # distance ahead that each row sees

    def render(
        self, own: Pose, robots_m: Sequence[tuple[float, float]], shake_px: tuple[float, float] = (0.0, 0.0)
    ) -> Grey:
        """Returns both frames side by side, without noise.

        `robots_m` are the middles of the other robots, world frame. `shake_px` moves both frames by so many columns and
        rows.
        """
        halves = [self._moved(self._frame(own, robots_m, aside_m), shake_px) for aside_m in (0.5, -0.5)]
        return np.hstack(halves)

    def _moved(self, frame: Grey, shake_px: tuple[float, float]) -> Grey:
        """Returns the frame as a pair shows it that is tilted and shaken; at its edges the outermost pixels go on."""
        roll_rad, pitch_rad = self._tilt_rad
        right_px, down_px = shake_px[0], shake_px[1] - self._rig.focal_px * pitch_rad
        if not (roll_rad or right_px or down_px):
            return frame
        height_px, width_px = frame.shape
        middle_px = (width_px - 1) / 2, (height_px - 1) / 2
        to_frame = np.asarray(cv2.getRotationMatrix2D(middle_px, math.degrees(roll_rad), 1.0), np.float64)
        to_frame[:, 2] += right_px, down_px
        moved = cv2.warpAffine(frame, to_frame, (width_px, height_px), borderMode=cv2.BORDER_REPLICATE)
        return np.asarray(moved, np.uint8)

    def _frame(self, own: Pose, robots_m: Sequence[tuple[float, float]], side: float) -> Grey:
        rig = self._rig
        cosine, sine = np.cos(own.heading_rad), np.sin(own.heading_rad)
        left_m = side * rig.baseline_m
        x_m = own.x_m + cosine * rig.forward_m - sine * left_m
        y_m = own.y_m + sine * rig.forward_m + cosine * left_m
        frame = np.full((rig.height_px, rig.width_px), _SKY, np.uint8)
        if len(self._ground_m):
            frame[self._ground_rows] = self._ground(x_m, y_m, cosine, sine)
        if len(robots_m):
            dx, dy = np.array(robots_m).T - ((x_m,), (y_m,))
            self._paint(frame, cosine * dx + sine * dy, cosine * dy - sine * dx)
        return frame

    def _ground(self, x_m: float, y_m: float, cosine: float, sine: float) -> Grey:
        """Returns the rows that see the ground, for a camera at a place of the world that looks along a direction."""
        ahead_m = self._ground_m[:, None]
        aside_m = -self._rig.columns[None] * ahead_m
        column = (x_m + cosine * ahead_m - sine * aside_m) / self._scale_m + self._origin_px[0]
        row = (y_m + sine * ahead_m + cosine * aside_m) / self._scale_m + self._origin_px[1]
        ground = cv2.remap(
            self._grey, column.astype(np.float32), row.astype(np.float32), cv2.INTER_NEAREST, borderValue=(_SKY - 60,)
        )
        return np.asarray(ground, np.uint8)

    def _paint(self, frame: Grey, ahead_m: Floats, left_m: Floats) -> None:
        """Paints robots (robots) at these places of the camera's frame."""
        rig, radius_m = self._rig, self._bodies.robot_radius_m
        slope = -rig.columns  # of each column's ray: to the left for a metre ahead
        lengths = 1.0 + slope**2
        half = (ahead_m[:, None] + slope * left_m[:, None]) / lengths
        square = half**2 - (ahead_m**2 + left_m**2 - radius_m**2)[:, None] / lengths
        near_m = half - np.sqrt(np.maximum(square, 0.0))
        near_m[(square <= 0) | (near_m <= _NEAREST_M)] = -np.inf  # not seen in that column
        for number in np.argsort(-near_m, axis=0, kind="stable"):  # of a robot in each column, the farthest first
            depth_m = np.take_along_axis(near_m, number[None], axis=0)[0]
            hit = np.flatnonzero(depth_m > 0.0)
            if len(hit):
                robot, depth_m = number[hit], depth_m[hit]
                around_rad = np.arctan2(slope[hit] * depth_m - left_m[robot], depth_m - ahead_m[robot])
                self._paint_columns(frame, hit, depth_m, around_rad)

    def _paint_columns(self, frame: Grey, hit: Indices, depth_m: Floats, around_rad: Floats) -> None:
        """Paints the columns `hit`, which see a robot at these distances ahead and bearings from its middle."""
        height_m = self._rig.height_m - self._rig.rows[:, None] * depth_m
        shade = _pattern(np.broadcast_to(around_rad / _PANEL_RAD, height_m.shape), height_m / _PANEL_M)
        body = (height_m >= 0.0) & (height_m <= self._bodies.robot_height_m)
        frame[:, hit] = np.where(body, shade, frame[:, hit])


def _pattern(across: Floats, up: Floats) -> Floats:
    """Returns grey levels of a smooth random pattern at places (rows, columns); the same in every process."""
    column, row = np.floor(across).astype(np.int64), np.floor(up).astype(np.int64)
    right, above = across - column, up - row
    low = _level(column, row) * (1 - right) + _level(column + 1, row) * right
    high = _level(column, row + 1) * (1 - right) + _level(column + 1, row + 1) * right
    return np.asarray(low * (1 - above) + high * above)


def _level(column: Indices, row: Indices) -> Floats:
    """Returns a level from 10 to 137 by the numbers of a place."""
    mixed = (column * 374761393 + row * 668265263) & 0xFFFFFFFF
    mixed = ((mixed ^ (mixed >> 13)) * 1274126177) & 0xFFFFFFFF
    return np.asarray(((mixed ^ (mixed >> 16)) & 127) + 10, np.float64)
