"""Messages as entities of Rerun, on the time lines `tick` and `time`.

Each type gets a sensible view by its members: positions with heading and covariance in their frame of reference, scans,
transforms, images, log lines, and every number as a series of a plot.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import cv2
import numpy as np
import rerun as rr
from numpy.typing import NDArray

from fwk.clock import US_PER_S
from fwk.lcm.messages import current_name, type_name
from fwk.log_tools.columns import Column, columns_of
from fwk.log_tools.frames import WORLD, comment_frame, full_frame
from fwk.log_tools.positions import Position, positions_in
from fwk.log_tools.rerun_drawing import ellipse_outline, shapes_2d, shapes_3d
from fwk.log_tools.rerun_layout import IMAGES, LOG, PLOTS, TICK, TIME, VIEWS, Contents, layout_of
from fwk.log_tools.series import unit_of
from lcmtypes.core import log_t

_LEVELS = {log_t.DEBUG: "DEBUG", log_t.INFO: "INFO", log_t.WARNING: "WARN", log_t.ERROR: "ERROR"}
_RADIUS_M = 0.08
_HEADING_M = 0.3
_LINE_M = 0.01
_SIGMAS = 2.0
_SPAN_M = 10.0
_ROWS = 200
"""Rows of a series that are sent together."""
_JPEG_QUALITY = 85


@dataclass
class _Values:
    """Numbers of one unit in the messages of a channel that wait to be sent."""

    columns: list[Column]
    ticks: list[int] = field(default_factory=list)
    times_s: list[float] = field(default_factory=list)
    rows: list[list[float]] = field(default_factory=list)


class RerunStream:
    """Converts the messages of one run.

    Args:
        stream: where they are sent to.
    """

    def __init__(self, stream: rr.RecordingStream) -> None:
        self._stream = stream
        self._tick, self._time_s = 0, 0.0
        self._values: dict[tuple[str, type[Any]], dict[str, _Values]] = {}
        self._framed: set[str] = set()
        self._scans: dict[str, None] = {}
        self._marked: dict[str, dict[str, str]] = {}
        self._cameras: dict[str, None] = {}
        self._drawn: dict[str, Any] = {}
        self._views: dict[str, None] = {}
        self._span_m = _SPAN_M
        self._laid_out: Contents | None = None
        stream.log("/", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)

    def at(self, tick: int, time_us: int) -> None:
        """Sets tick and logical time of what follows."""
        self._tick, self._time_s = tick, time_us / US_PER_S
        self._stream.set_time(TICK, sequence=tick)
        self._stream.set_time(TIME, duration=self._time_s)

    def show(self, channel: str, message: Any) -> None:
        """Sends a message."""
        kind = current_name(type_name(type(message)))
        if kind == "core.picture_t":
            self._picture(message)
        elif kind == "core.transforms_t":
            for each in message.transforms:
                self._transform(f"{channel}/{each.child}", each)
        elif kind == "core.log_t":
            text = f"{message.component}: {message.text}"
            self._stream.log(f"{LOG}/{message.component}", rr.TextLog(text, level=_LEVELS.get(message.level, "TRACE")))
        elif not kind.startswith("core."):
            if hasattr(message, "ranges_m") and hasattr(message, "angle_step_rad"):
                self._scan(channel, message)
            positions = positions_in(message)
            if positions is not None:
                self._place(channel, positions)
            self._plot(channel, message)

    def frame(self, camera: str, pixels: NDArray[np.uint8]) -> None:
        """Sends a frame of a camera, compressed: height x width, or height x width x 3 (blue, green, red)."""
        if pixels.ndim == 3 and pixels.shape[2] not in (1, 3):
            pixels = np.ascontiguousarray(pixels[:, :, 0])
        data = cv2.imencode(".jpg", pixels, [cv2.IMWRITE_JPEG_QUALITY, _JPEG_QUALITY])[1].tobytes()
        self._image(camera, data, "jpeg")

    def draw(self, view: str, drawing: Mapping[str, Any]) -> None:
        """Sends the drawing of a view of a project, as `Scene.encoded` describes it; unchanged layers are left out."""
        self._views[view] = None
        self._span_m = max(map(abs, drawing.get("bounds") or (_SPAN_M,)))
        shapes: dict[str, list[Any]] = {}
        for number, shape in enumerate(drawing["shapes"]):
            shapes.setdefault(f"{VIEWS}/{view}/{shape['l'] or 'shapes'}", []).append((number, shape))
        layers = shapes_3d(drawing)
        for name, archetypes in layers.items():
            path = f"{VIEWS}/{view}/{name}"
            if self._drawn.get(path) != shapes[path]:
                self._drawn[path] = shapes[path]
                self._in_frame(path, WORLD)
                for part, archetype in archetypes.items():
                    self._stream.log(f"{path}/{part}", archetype)
                    self._in_frame(f"{path}/{part}", WORLD)
        for path in [path for path in self._drawn if path.startswith(f"{VIEWS}/{view}/") and path not in shapes]:
            del self._drawn[path]
            self._stream.log(path, rr.Clear(recursive=True))

    def draw_over(self, camera: str, view: str, drawing: Mapping[str, Any]) -> None:
        """Sends what a view of a project draws over the images of a camera."""
        for part, archetype in shapes_2d(drawing).items():
            self._stream.log(f"{IMAGES}/{camera}/{view}/{part}", archetype)

    def flush(self) -> None:
        """Sends the numbers that wait, and the arrangement of the views if there are new ones."""
        for (channel, _), units in self._values.items():
            for unit, values in units.items():
                self._send(channel, unit, values)
        self._lay_out()
        self._stream.flush()

    def _picture(self, message: Any) -> None:
        if message.format in ("jpeg", "png"):
            self._image(message.camera, bytes(message.data), message.format)
        elif len(message.data) == message.height_px * message.width_px * message.channels:
            shape = message.height_px, message.width_px, message.channels
            self.frame(message.camera, np.frombuffer(bytes(message.data), np.uint8).reshape(shape))

    def _image(self, camera: str, data: bytes, form: str) -> None:
        self._stream.log(f"{IMAGES}/{camera}", rr.EncodedImage(contents=data, media_type=f"image/{form}"))
        self._cameras[camera] = None

    def _transform(self, path: str, each: Any) -> None:
        self._stream.log(
            path,
            rr.Transform3D(
                translation=(each.x_m, each.y_m, each.z_m),
                quaternion=rr.Quaternion(xyzw=(each.qx, each.qy, each.qz, each.qw)),
                parent_frame=each.parent,
                child_frame=each.child,
            ),
        )

    def _scan(self, channel: str, scan: Any) -> None:
        self._scans[channel] = None
        ranges_m = np.asarray(scan.ranges_m, float)
        angles_rad = scan.angle_min_rad + scan.angle_step_rad * np.arange(len(ranges_m))
        seen = np.isfinite(ranges_m)
        hits = np.stack([ranges_m * np.cos(angles_rad), ranges_m * np.sin(angles_rad)], axis=-1)[seen]
        frame = comment_frame(type_name(type(scan)), "angle_min_rad") or "robot"
        self._in_frame(f"{channel}/scan", full_frame(frame, channel))
        self._stream.log(f"{channel}/scan", rr.Points3D(np.pad(hits, ((0, 0), (0, 1))), radii=0.02))

    def _place(self, channel: str, positions: list[Position]) -> None:
        """Sends the positions in a message; those that its channel had before and has no more are removed."""
        frames: dict[str, list[Position]] = {}
        for each in positions:
            frame = full_frame(each.frame, channel)
            frames.setdefault(frame, []).append(each)
            if not each.path and channel.rpartition("/")[2] == "pose" and hasattr(each.struct, "heading_rad"):
                self._robot(channel, frame, each.struct)
        before = self._marked.get(channel, {})
        marked: dict[str, str] = {}
        for frame, found in frames.items():
            for path, archetype in _marks(f"{channel}/{frame.rpartition('/')[2]}", found):
                marked[path] = frame
                self._in_frame(path, frame)
                self._stream.log(path, archetype)
        for path in before.keys() - marked.keys():
            self._stream.log(path, rr.Clear(recursive=False))
        self._marked[channel] = marked

    def _robot(self, channel: str, frame: str, pose: Any) -> None:
        turn = rr.RotationAxisAngle(axis=(0, 0, 1), radians=pose.heading_rad)
        robot = full_frame("robot", channel)
        moved = rr.Transform3D(translation=_xyz(pose), rotation=turn, parent_frame=frame, child_frame=robot)
        self._stream.log(f"{channel}/frame", moved)

    def _plot(self, channel: str, message: Any) -> None:
        key = channel, type(message)
        if key not in self._values:
            self._values[key] = self._series(channel, type(message))
        for unit, values in self._values[key].items():
            values.ticks.append(self._tick)
            values.times_s.append(self._time_s)
            values.rows.append([float(column.value(message)) for column in values.columns])
            if len(values.rows) >= _ROWS:
                self._send(channel, unit, values)

    def _series(self, channel: str, kind: type[Any]) -> dict[str, _Values]:
        units: dict[str, _Values] = {}
        for column in columns_of(kind):
            if not column.dimensions and column.kind != "string" and not column.name.startswith("header."):
                units.setdefault(unit_of(column.name) or "number", _Values([])).columns.append(column)
        for unit, values in units.items():
            names = [f"{channel}.{column.name}" for column in values.columns]
            self._stream.log(_plot_path(channel, unit), rr.SeriesLines(names=names), static=True)
        return units

    def _send(self, channel: str, unit: str, values: _Values) -> None:
        if not values.rows:
            return
        indexes = [rr.TimeColumn(TICK, sequence=values.ticks), rr.TimeColumn(TIME, duration=values.times_s)]
        columns = rr.Scalars.columns(scalars=np.array(values.rows).ravel())
        if len(values.columns) > 1:
            columns = columns.partition([len(values.columns)] * len(values.rows))
        self._stream.send_columns(_plot_path(channel, unit), indexes=indexes, columns=columns)
        values.ticks, values.times_s, values.rows = [], [], []

    def _in_frame(self, path: str, frame: str) -> None:
        """Places an entity in a frame of reference."""
        if path not in self._framed:
            self._framed.add(path)
            self._stream.log(path, rr.CoordinateFrame(frame), static=True)

    def _lay_out(self) -> None:
        """Sends the arrangement of the views if there is something new to arrange."""
        contents = Contents(
            views=tuple(self._views),
            positions=tuple(self._marked),
            scans=tuple(self._scans),
            cameras=tuple(self._cameras),
            plots=tuple(dict.fromkeys(channel for channel, _ in self._values)),
            span_m=self._span_m,
        )
        if contents != self._laid_out:
            self._laid_out = contents
            self._stream.send_blueprint(layout_of(contents))


def _marks(path: str, found: list[Position]) -> Iterator[tuple[str, Any]]:
    """Yields the positions of a message in one frame, with headings and two standard deviations."""
    places = [_xyz(each.struct) for each in found]
    radii = [getattr(each.struct, "radius_m", _RADIUS_M) for each in found]
    labels = [str(getattr(each.struct, "name", "") or each.path.strip() or path.rpartition("/")[0]) for each in found]
    yield path, rr.Points3D(places, radii=radii, labels=labels, show_labels=False)
    headed = [each.struct for each in found if hasattr(each.struct, "heading_rad")]
    if headed:
        turns = [struct.heading_rad for struct in headed]
        vectors = [(_HEADING_M * math.cos(turn), _HEADING_M * math.sin(turn), 0.0) for turn in turns]
        yield f"{path}/heading", rr.Arrows3D(vectors=vectors, origins=list(map(_xyz, headed)))
    ellipses = [outline for each in found if (outline := _deviation(each.struct))]
    if ellipses:
        yield f"{path}/deviation", rr.LineStrips3D(ellipses, radii=_LINE_M)


def _plot_path(channel: str, unit: str) -> str:
    return f"{PLOTS}/{channel}/{rr.escape_entity_path_part(unit)}"


def _xyz(struct: Any) -> tuple[float, float, float]:
    z_m = getattr(struct, "z_m", 0.0)
    return struct.x_m, struct.y_m, z_m if math.isfinite(z_m) else 0.0


def _deviation(struct: Any) -> list[tuple[float, float, float]]:
    """Returns two standard deviations around a position as a closed line; empty without a covariance."""
    covariance = getattr(struct, "covariance_m2", getattr(struct, "covariance", None))
    if not covariance or len(covariance) < 2:
        return []
    (xx, xy), (_, yy) = (row[:2] for row in covariance[:2])
    if not all(map(math.isfinite, (xx, xy, yy))) or xx + yy <= 0:
        return []
    middle, spread = (xx + yy) / 2, math.hypot((xx - yy) / 2, xy)
    axes = (_SIGMAS * math.sqrt(middle + spread), _SIGMAS * math.sqrt(max(0.0, middle - spread)))
    x_m, y_m, z_m = _xyz(struct)
    points = ellipse_outline((x_m, y_m), axes, math.atan2(2 * xy, xx - yy) / 2)
    return [(x, y, z_m) for x, y in (*points, points[0])]
