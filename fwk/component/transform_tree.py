"""Tree of frames of reference with a history, and lookups in it."""

import math
from bisect import bisect_left
from collections import deque
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fwk.clock import US_PER_S
from fwk.model.errors import hint

Floats = NDArray[np.float64]
HISTORY_US = 10 * US_PER_S


class TransformError(Exception):
    """A lookup has no answer, or a frame does not fit into the tree; the text names the frames."""


class UnknownFrameError(TransformError):
    """No frame has this name."""


class DisconnectedError(TransformError):
    """Two frames have no common ancestor."""


class ExtrapolationError(TransformError):
    """A frame is not known at the time of the lookup."""


@dataclass(frozen=True)
class Transform:
    """Transform from coordinates of a child frame to its parent: a rotation, then a translation."""

    translation_m: Floats
    """Origin of the child in the parent, x, y, z, in m; shape (3,)."""
    rotation: Floats
    """Axes of the child in the parent as a unit quaternion w, x, y, z; shape (4,)."""

    @classmethod
    def of(cls, translation_m: tuple[float, float, float], yaw_rad: float = 0.0) -> "Transform":
        """Returns the transform of a child frame that is turned about its parent's z axis and shifted."""
        turn = np.array([math.cos(yaw_rad / 2), 0.0, 0.0, math.sin(yaw_rad / 2)])
        return cls(np.array(translation_m, float), turn)

    @classmethod
    def of_angles(
        cls, translation_m: tuple[float, float, float], roll_rad: float, pitch_rad: float, yaw_rad: float
    ) -> "Transform":
        """Returns the transform of a child that is turned about its parent's x axis, then y, then z, and shifted."""
        axes = np.eye(3)
        parts = [
            np.array([math.cos(angle / 2), *(math.sin(angle / 2) * axis)])
            for angle, axis in zip((roll_rad, pitch_rad, yaw_rad), axes, strict=True)
        ]
        return cls(np.array(translation_m, float), _product(parts[2], _product(parts[1], parts[0])))

    @property
    def yaw_rad(self) -> float:
        """Rotation about the z axis, in rad, -pi to pi."""
        w, x, y, z = self.rotation
        return math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))

    def apply(self, points_m: Floats) -> Floats:
        """Returns points of the child frame, shape (..., 3), in m, in the parent frame."""
        return np.asarray(points_m @ self.matrix.T + self.translation_m)

    @property
    def matrix(self) -> Floats:
        """The rotation as a matrix of shape (3, 3)."""
        w, x, y, z = self.rotation
        return np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
            ]
        )

    @property
    def inverse(self) -> "Transform":
        """Transform from the parent to the child."""
        return Transform(-self.translation_m @ self.matrix, self.rotation * np.array([1.0, -1.0, -1.0, -1.0]))

    def __matmul__(self, inner: "Transform") -> "Transform":
        """Returns the transform that applies `inner` first, then this one."""
        return Transform(self.apply(inner.translation_m), _product(self.rotation, inner.rotation))

    def towards(self, other: "Transform", part: float) -> "Transform":
        """Interpolates linearly and along the shorter rotation; `part` 0 is this transform, 1 the other."""
        translation = (1 - part) * self.translation_m + part * other.translation_m
        cosine = float(self.rotation @ other.rotation)
        end = other.rotation if cosine >= 0 else -other.rotation
        angle = math.acos(min(1.0, abs(cosine)))
        if angle < 1e-6:
            turn = (1 - part) * self.rotation + part * end
        else:
            turn = (math.sin((1 - part) * angle) * self.rotation + math.sin(part * angle) * end) / math.sin(angle)
        return Transform(translation, turn / np.linalg.norm(turn))


def _product(left: Floats, right: Floats) -> Floats:
    (a, b, c, d), (w, x, y, z) = left, right
    return np.array(
        [
            a * w - b * x - c * y - d * z,
            a * x + b * w + c * z - d * y,
            a * y - b * z + c * w + d * x,
            a * z + b * y - c * x + d * w,
        ]
    )


class _Edge:
    """Pose of a frame in its parent over time."""

    def __init__(self, parent: str, fixed: bool) -> None:
        self.parent = parent
        self.fixed = fixed
        self.times_us: deque[int] = deque()
        self.transforms: deque[Transform] = deque()

    def put(self, time_us: int, transform: Transform) -> None:
        if self.fixed or (self.times_us and time_us == self.times_us[-1]):
            self.times_us.clear()
            self.transforms.clear()
        self.times_us.append(time_us)
        self.transforms.append(transform)
        while self.times_us[0] < time_us - HISTORY_US:
            self.times_us.popleft()
            self.transforms.popleft()

    def at(self, time_us: int) -> Transform | None:
        """Returns the transform at a time; None if it is not known."""
        if self.fixed:
            return self.transforms[0]
        place = bisect_left(self.times_us, time_us)
        if place == len(self.times_us) or (place == 0 and self.times_us[0] != time_us):
            return None
        if self.times_us[place] == time_us:
            return self.transforms[place]
        before, after = self.times_us[place - 1], self.times_us[place]
        part = (time_us - before) / (after - before)
        return self.transforms[place - 1].towards(self.transforms[place], part)


class TransformTree:
    """Poses of frames in their parents over the last ten seconds."""

    def __init__(self) -> None:
        self._edges: dict[str, _Edge] = {}  # by child

    def put(self, parent: str, child: str, time_us: int, transform: Transform, *, fixed: bool = False) -> None:
        """Adds the pose of a frame in its parent at a logical time; a `fixed` frame never moves.

        Raises:
            TransformError: the frame has another parent, would be its own ancestor, or is known at a later time.
        """
        edge = self._edges.get(child)
        if edge is None:
            if child in [parent, *self._ancestors(parent)]:
                way = " in ".join([child, parent, *self._ancestors(parent)])
                raise TransformError(f"frames would form a cycle: {way}")
            edge = self._edges[child] = _Edge(parent, fixed)
        if edge.parent != parent:
            raise TransformError(f"frame '{child}' has the parent '{edge.parent}' and cannot also have '{parent}'")
        if edge.times_us and time_us < edge.times_us[-1]:
            raise TransformError(
                f"frame '{child}' is known at {_seconds(edge.times_us[-1])} and cannot be set at {_seconds(time_us)}"
            )
        edge.put(time_us, transform)

    @property
    def frames(self) -> list[str]:
        """Names of all frames, in alphabetical order."""
        return sorted({*self._edges, *(edge.parent for edge in self._edges.values())})

    def lookup(self, target: str, source: str, time_us: int | None = None) -> Transform:
        """Returns the transform from coordinates of the source frame to the target frame.

        Without a time it is the newest at which all frames between the two are known.

        Raises:
            UnknownFrameError: a frame does not exist.
            DisconnectedError: the two frames have no common ancestor.
            ExtrapolationError: a frame between the two is not known at that time.
        """
        frames = self.frames
        for name in (target, source):
            if name not in frames:
                raise UnknownFrameError(f"no frame '{name}'; {hint(name, frames)}")
        up, down = [source, *self._ancestors(source)], [target, *self._ancestors(target)]
        common = next((name for name in up if name in down), None)
        if common is None:
            ways = f"{' in '.join(up)}, but {' in '.join(down)}"
            raise DisconnectedError(f"no path from frame '{source}' to '{target}': {ways}")
        rising, falling = up[: up.index(common)], down[: down.index(common)]
        if time_us is None:
            moving = [edge for name in (*rising, *falling) if not (edge := self._edges[name]).fixed]
            time_us = min((edge.times_us[-1] for edge in moving), default=0)
        found = Transform.of((0.0, 0.0, 0.0))
        for name in rising:
            found = self._at(name, time_us) @ found
        back = Transform.of((0.0, 0.0, 0.0))
        for name in falling:
            back = self._at(name, time_us) @ back
        return back.inverse @ found

    def _at(self, name: str, time_us: int) -> Transform:
        edge = self._edges[name]
        found = edge.at(time_us)
        if found is None:
            known = f"from {_seconds(edge.times_us[0])} to {_seconds(edge.times_us[-1])}"
            raise ExtrapolationError(f"frame '{name}' in '{edge.parent}' is known {known}, not at {_seconds(time_us)}")
        return found

    def _ancestors(self, name: str) -> list[str]:
        found: list[str] = []
        while name in self._edges:
            name = self._edges[name].parent
            found.append(name)
        return found


def _seconds(time_us: int) -> str:
    return f"{time_us / US_PER_S:.3f} s"
