"""Messages as Foxglove's well-known types: images, transforms, poses, markers, scans, places on the earth, log lines.

Every message with a position gets a view, by the names of its members: `x_m` and `y_m`, perhaps `z_m`, `heading_rad`,
`radius_m` and `name`; so does a scan (`ranges_m`, `angle_min_rad`, `angle_step_rad`), and a place on the earth
(`latitude_deg`, `longitude_deg`). The comment of a member in its .lcm file names its frame of reference.
"""

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import cv2
import numpy as np
from foxglove.messages import (
    ArrowPrimitive,
    Color,
    CompressedImage,
    CylinderPrimitive,
    FrameTransform,
    FrameTransforms,
    LaserScan,
    LocationFix,
    LocationFixPositionCovarianceType,
    Log,
    LogLevel,
    Pose,
    PoseInFrame,
    Quaternion,
    RawImage,
    SceneEntity,
    SceneEntityDeletion,
    SceneEntityDeletionType,
    SceneUpdate,
    SpherePrimitive,
    TextPrimitive,
    Timestamp,
    Vector3,
)
from numpy.typing import NDArray

from fwk.clock import US_PER_S
from fwk.lcm.messages import current_name, type_name
from fwk.log_tools.frames import comment_frame, full_frame
from fwk.log_tools.positions import Position, positions_in
from fwk.recording.pictures import as_picture
from lcmtypes.core import log_t

PREFIX = "view/"
"""Beginning of the topics with views: `view/cyan1/pose` for the channel `cyan1/pose`."""
_LEVELS = {
    log_t.DEBUG: LogLevel.Debug,
    log_t.INFO: LogLevel.Info,
    log_t.WARNING: LogLevel.Warning,
    log_t.ERROR: LogLevel.Error,
}
_ENCODINGS = {1: "mono8", 3: "bgr8"}
_HEIGHT_M = 0.05
_SIZE_M = 0.2
_COLOUR = Color(r=0.2, g=0.6, b=1.0, a=0.8)


class View(NamedTuple):
    """A message for Foxglove."""

    topic: str
    content: Any


def views_of(channel: str, message: Any, time_us: int) -> Iterator[View]:
    """Yields the views of a message; times are logical."""
    stamp = Timestamp(time_us // US_PER_S, time_us % US_PER_S * 1000)
    kind = current_name(type_name(type(message)))
    if kind == "core.picture_t":
        yield View(f"{PREFIX}{message.camera}", _image(message, stamp))
    elif kind == "core.transforms_t":
        yield View(PREFIX + channel, _transforms(message))
    elif kind == "core.log_t":
        level = _LEVELS.get(message.level, LogLevel.Unknown)
        text = {"message": message.text, "name": message.component, "file": message.file}
        yield View(PREFIX + channel, Log(timestamp=stamp, level=level, line=max(0, message.line), **text))
    elif not kind.startswith("core"):
        if all(hasattr(message, each) for each in ("ranges_m", "angle_min_rad", "angle_step_rad")):
            yield View(PREFIX + channel, _scan(channel, message, stamp))
        if hasattr(message, "latitude_deg") and hasattr(message, "longitude_deg"):
            yield View(f"{PREFIX}{channel}/location", _location(channel, message, stamp))
        yield from _positions(channel, message, stamp)


def frame_view(camera: str, pixels: NDArray[np.uint8], time_us: int) -> View:
    """Returns a frame of a camera as an image, compressed: height x width, or height x width x 3 (blue, green, red)."""
    stamp = Timestamp(time_us // US_PER_S, time_us % US_PER_S * 1000)
    data = cv2.imencode(".jpg", as_picture(pixels))[1].tobytes()
    return View(PREFIX + camera, CompressedImage(timestamp=stamp, frame_id=camera, format="jpeg", data=data))


def _scan(channel: str, scan: Any, stamp: Timestamp) -> LaserScan:
    frame = comment_frame(type_name(type(scan)), "angle_min_rad") or "robot"
    return LaserScan(
        timestamp=stamp,
        frame_id=full_frame(frame, channel),
        pose=Pose(position=Vector3(x=0, y=0, z=0), orientation=Quaternion(x=0, y=0, z=0, w=1)),
        start_angle=scan.angle_min_rad,
        end_angle=scan.angle_min_rad + scan.angle_step_rad * max(0, len(scan.ranges_m) - 1),
        ranges=list(scan.ranges_m),
    )


def _location(channel: str, fix: Any, stamp: Timestamp) -> LocationFix:
    covariance_m2 = [value for row in getattr(fix, "covariance_m2", ()) for value in row]
    is_known = any(covariance_m2)
    kinds = LocationFixPositionCovarianceType
    return LocationFix(
        timestamp=stamp,
        frame_id=channel,
        latitude=fix.latitude_deg,
        longitude=fix.longitude_deg,
        altitude=getattr(fix, "altitude_m", 0.0),
        position_covariance=covariance_m2 if is_known else None,
        position_covariance_type=kinds.Known if is_known else kinds.Unknown,
    )


def _positions(channel: str, message: Any, stamp: Timestamp) -> Iterator[View]:
    found = positions_in(message)
    if found is None:
        return
    own = next((place for place in found if not place.path and hasattr(place.struct, "heading_rad")), None)
    if own:
        frame, pose = full_frame(own.frame, channel), _pose(own.struct)
        yield View(PREFIX + channel, PoseInFrame(timestamp=stamp, frame_id=frame, pose=pose))
        if channel.rpartition("/")[2] == "pose":
            yield View(f"{PREFIX}{channel}/frame", _robot(channel, frame, own.struct, stamp))
    frames: dict[str, list[Position]] = {}
    for place in found:
        frames.setdefault(full_frame(place.frame, channel), []).append(place)
    entities = [_entity(frame, channel, stamp, places) for frame, places in frames.items()]
    removed = SceneEntityDeletion(timestamp=stamp, type=SceneEntityDeletionType.All)  # of the message before
    yield View(f"{PREFIX}{channel}/scene", SceneUpdate(deletions=[removed], entities=entities))


def _entity(frame: str, channel: str, stamp: Timestamp, places: list[Position]) -> SceneEntity:
    """Returns the markers of a message in one frame."""
    arrows, cylinders, spheres, texts = [], [], [], []
    for place in places:
        struct, pose = place.struct, _pose(place.struct)
        if hasattr(struct, "heading_rad"):
            arrows.append(
                ArrowPrimitive(
                    pose=pose,
                    shaft_length=0.3,
                    shaft_diameter=0.1,
                    head_length=0.15,
                    head_diameter=0.2,
                    color=_COLOUR,
                )
            )
        elif hasattr(struct, "radius_m"):
            size = Vector3(x=2 * struct.radius_m, y=2 * struct.radius_m, z=_HEIGHT_M)
            cylinders.append(CylinderPrimitive(pose=pose, size=size, bottom_scale=1, top_scale=1, color=_COLOUR))
        else:
            size = Vector3(x=_SIZE_M, y=_SIZE_M, z=_SIZE_M)
            spheres.append(SpherePrimitive(pose=pose, size=size, color=_COLOUR))
        label = str(getattr(struct, "name", "") or place.path.strip())
        if label:
            texts.append(TextPrimitive(pose=pose, billboard=True, font_size=0.2, color=_COLOUR, text=label))
    return SceneEntity(
        timestamp=stamp,
        frame_id=frame,
        id=f"{channel} in {frame}",
        arrows=arrows,
        cylinders=cylinders,
        spheres=spheres,
        texts=texts,
    )


def _pose(struct: Any) -> Pose:
    return Pose(position=_position(struct), orientation=_orientation(struct))


def _position(struct: Any) -> Vector3:
    return Vector3(x=struct.x_m, y=struct.y_m, z=getattr(struct, "z_m", 0.0))


def _orientation(struct: Any) -> Quaternion:
    half = getattr(struct, "heading_rad", 0.0) / 2
    return Quaternion(x=0, y=0, z=math.sin(half), w=math.cos(half))


def _robot(channel: str, frame: str, struct: Any, stamp: Timestamp) -> FrameTransforms:
    """Returns the transform of a robot's frame, which its channel `pose` gives."""
    child = full_frame("robot", channel)
    made = FrameTransform(
        timestamp=stamp,
        parent_frame_id=frame,
        child_frame_id=child,
        translation=_position(struct),
        rotation=_orientation(struct),
    )
    return FrameTransforms(transforms=[made])


def _transforms(message: Any) -> FrameTransforms:
    made = [
        FrameTransform(
            timestamp=Timestamp(each.time_us // US_PER_S, each.time_us % US_PER_S * 1000),
            parent_frame_id=each.parent,
            child_frame_id=each.child,
            translation=Vector3(x=each.x_m, y=each.y_m, z=each.z_m),
            rotation=Quaternion(x=each.qx, y=each.qy, z=each.qz, w=each.qw),
        )
        for each in message.transforms
    ]
    return FrameTransforms(transforms=made)


def _image(picture: Any, stamp: Timestamp) -> CompressedImage | RawImage:
    data = bytes(picture.data)
    if picture.format != "raw":
        return CompressedImage(timestamp=stamp, frame_id=picture.camera, data=data, format=picture.format)
    return RawImage(
        timestamp=stamp,
        frame_id=picture.camera,
        width=picture.width_px,
        height=picture.height_px,
        encoding=_ENCODINGS.get(picture.channels, f"8UC{picture.channels}"),
        step=picture.width_px * picture.channels,
        data=data,
    )
